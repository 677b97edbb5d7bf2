@group(UMBRAGE_CASTER_GROUP) @binding(0)
var<uniform> umbrage_pass: UmbrageCasterPass;

fn umbrage_cast(position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast_at(position, instance.code, u32(instance.view));
}

fn umbrage_cast_at(position: vec3f, code: u32, view: u32) -> UmbrageCast {
    return umbrage_cast_into(position, code, umbrage_caster_index(code, view));
}

fn umbrage_cast_into(position: vec3f, code: u32, index: u32) -> UmbrageCast {
    var result: UmbrageCast;
    if index >= umbrage_pass.end || ((code >> (3u + index)) & 1u) == 0u {
        result.position = vec4f(0.0, 0.0, 0.0, 1.0);
        return result;
    }
    let split = umbrage_pass.splits[index];
    {
        result.position = umbrage_map_clip_from_tile(split, position);
        result.clip_distances = umbrage_map_edges_of_tile(split, position);
    }
    return result;
}

fn umbrage_caster_index(code: u32, view: u32) -> u32 {
    return umbrage_pass.first + (code & 7u) * umbrage_pass.views + view;
}

fn umbrage_caster_offset(instance: UmbrageInstance) -> vec2f {
    let index = min(umbrage_caster_index(instance.code, u32(instance.view)), 7u);
    return umbrage_pass.splits[index].texel_offset + umbrage_pass.splits[index].corner;
}

fn umbrage_caster_covers(at: vec4f, offset: vec2f, alpha: f32) -> bool {
    return alpha > umbrage_dither_threshold(vec2i(floor(at.xy - offset)));
}

fn umbrage_caster_depth(position: vec4f) -> f32 {
    return clamp(position.z, 0.0, 1.0);
}

fn umbrage_dither_threshold(texel: vec2i) -> f32 {
    let y = texel.y;
    let x = texel.x ^ y;
    let rank = ((x & 1) << 3u) | ((y & 1) << 2u) | (x & 2) | ((y & 2) >> 1u);
    return (f32(rank) + 0.5) / 16.0;
}

struct UmbrageSplit {
    u_row: vec4f,
    v_row: vec4f,
    depth_row: vec4f,
    w_row: vec4f,
    texel_offset: vec2f,
    texel_m: vec2f,
    size: f32,
    far: f32,
    blend_begin: f32,
    depth_range_m: f32,
    depth_step_m: f32,
    is_empty: u32,
    viewport_texels: f32,
    guard_texels: f32,
    corner: vec2f,
    layer_texels: vec2f,
    layer: u32,
    depth_offset: f32,
    is_linear: u32,
    filter_radius_texels: f32
}

struct UmbrageCasterPass {
    first: u32,
    end: u32,
    views: u32,
    splits: array<UmbrageSplit, 8>
}

const UMBRAGE_MAP_SNAP: f32 = 256.0;

const UMBRAGE_MAP_SNAP_LIMIT: f32 = 32768.0;

const UMBRAGE_MAP_DEPTH_ROUNDING: f32 = 1.52587890625e-5;

fn umbrage_map_is_warped(split: UmbrageSplit, position: vec3f) -> bool {
    return any(split.w_row != vec4f(0.0)) | (position.x > 3e38);
}

fn umbrage_map_w_at(split: UmbrageSplit, position: vec3f) -> f32 {
    return dot(split.w_row, vec4f(position, 1.0));
}

fn umbrage_map_plane_from_world(split: UmbrageSplit, position: vec3f) -> vec2f {
    let point = vec4f(position, 1.0);
    let place = vec2f(dot(split.u_row, point), dot(split.v_row, point));
    {
        if umbrage_map_is_warped(split, position) {
            return place / umbrage_map_w_at(split, position);
        }
    }
    return place;
}

fn umbrage_map_from_caster(split: UmbrageSplit, position: vec3f) -> vec3f {
    let free = umbrage_map_plane_from_world(split, position);
    let snapped = select(free, round(free * UMBRAGE_MAP_SNAP) / UMBRAGE_MAP_SNAP, abs(free) < vec2f(UMBRAGE_MAP_SNAP_LIMIT));
    let depth = dot(split.depth_row, vec4f(position, 1.0));
    let inside = clamp(depth, 0.0, 1.0);
    let held = select(depth, inside, abs(depth - inside) < UMBRAGE_MAP_DEPTH_ROUNDING);
    return vec3f(snapped + split.texel_offset, held);
}

fn umbrage_map_clip_from_tile(split: UmbrageSplit, position: vec3f) -> vec4f {
    let at = umbrage_map_homogeneous_from_caster(split, position);
    let clip = (at.xy + split.corner * at.w) * (2.0 / split.layer_texels) - at.w;
    return vec4f(clip.x, -clip.y, at.z, at.w);
}

fn umbrage_map_edges_of_tile(split: UmbrageSplit, position: vec3f) -> array<f32, 4> {
    let at = umbrage_map_homogeneous_from_caster(split, position);
    return array<f32, 4>(at.x, split.size * at.w - at.x, at.y, split.size * at.w - at.y);
}

fn umbrage_map_homogeneous_from_caster(split: UmbrageSplit, position: vec3f) -> vec4f {
    if umbrage_map_is_warped(split, position) {
        let point = vec4f(position, 1.0);
        let place = vec2f(dot(split.u_row, point), dot(split.v_row, point));
        let w = umbrage_map_w_at(split, position);
        return vec4f(place, dot(split.depth_row, point) + split.depth_offset * w, w);
    }
    return vec4f(umbrage_map_from_caster(split, position), 1.0);
}
