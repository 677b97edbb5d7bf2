@group(UMBRAGE_CASTER_GROUP) @binding(0)
var<uniform> umbrage_caster: UmbrageSplit;

fn umbrage_cast(position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast_at(position, instance.code);
}

fn umbrage_cast_at(position: vec3f, code: u32) -> UmbrageCast {
    var result: UmbrageCast;
    result.position = umbrage_map_clip_from_caster(umbrage_caster, position);
    return result;
}

fn umbrage_caster_offset(instance: UmbrageInstance) -> vec2f {
    return umbrage_caster.texel_offset + umbrage_caster.corner;
}

fn umbrage_caster_covers(at: vec4f, offset: vec2f, alpha: f32) -> bool {
    return alpha > umbrage_dither_threshold(vec2i(floor(at.xy - offset)));
}

fn umbrage_caster_depth(position: vec4f) -> f32 {
    let linear = umbrage_bias_linear_depth(vec2f(umbrage_caster.depth_offset, -umbrage_caster.depth_row.w), 1.0 / position.w);
    return select(clamp(position.z, 0.0, 1.0), linear, umbrage_caster.is_linear != 0u);
}

fn umbrage_bias_linear_depth(linear: vec2f, w: f32) -> f32 {
    let near = linear.y / linear.x;
    return clamp((w - near) * (linear.x * (linear.x - 1.0) / linear.y), 0.0, 1.0);
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

fn umbrage_map_clip_from_map(split: UmbrageSplit, at: vec3f) -> vec4f {
    let ndc = (at.xy + split.guard_texels) * (2.0 / split.viewport_texels) - 1.0;
    return vec4f(ndc.x, -ndc.y, at.z, 1.0);
}

fn umbrage_map_clip_from_caster(split: UmbrageSplit, position: vec3f) -> vec4f {
    if umbrage_map_is_warped(split, position) {
        let point = vec4f(position, 1.0);
        let w = umbrage_map_w_at(split, position);
        let place = vec2f(dot(split.u_row, point), dot(split.v_row, point));
        let clip = (place + split.guard_texels * w) * (2.0 / split.viewport_texels) - w;
        return vec4f(clip.x, -clip.y, dot(split.depth_row, point) + split.depth_offset * w, w);
    }
    return umbrage_map_clip_from_map(split, umbrage_map_from_caster(split, position));
}
