struct UmbrageMask {
    eye_from_clip: mat4x4f,
    eye: vec3f,
    empty_depth: f32,
    forward: vec3f,
    perspective: f32
}

@group(UMBRAGE_MASK_GROUP) @binding(0)
var<uniform> umbrage_mask: UmbrageMask;

@group(UMBRAGE_MASK_GROUP) @binding(1)
var umbrage_mask_depth: texture_depth_2d;

@group(UMBRAGE_MASK_GROUP) @binding(2)
var umbrage_mask_normals: texture_2d<f32>;

struct UmbrageMaskCorner {
    @builtin(position)
    at: vec4f,
    @location(0) @interpolate(flat)
    column_x: vec4f,
    @location(1) @interpolate(flat)
    column_y: vec4f,
    @location(2) @interpolate(flat)
    column_z: vec4f,
    @location(3) @interpolate(flat)
    column_w: vec4f,
    @location(4) @interpolate(flat)
    eye_and_empty_depth: vec4f,
    @location(5) @interpolate(flat)
    forward_and_perspective: vec4f
}

var<private> umbrage_mask_seen: UmbrageMask;

@vertex
fn umbrage_mask_vertex(@builtin(vertex_index) index: u32) -> UmbrageMaskCorner {
    let columns = umbrage_mask.eye_from_clip;
    return UmbrageMaskCorner(vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0), columns[0], columns[1], columns[2], columns[3], vec4f(umbrage_mask.eye, umbrage_mask.empty_depth), vec4f(umbrage_mask.forward, umbrage_mask.perspective));
}

fn umbrage_mask_from(corner: UmbrageMaskCorner) -> UmbrageMask {
    return UmbrageMask(mat4x4f(corner.column_x, corner.column_y, corner.column_z, corner.column_w), corner.eye_and_empty_depth.xyz, corner.eye_and_empty_depth.w, corner.forward_and_perspective.xyz, corner.forward_and_perspective.w);
}

@fragment
fn umbrage_mask_fragment(corner: UmbrageMaskCorner) -> @location(0) vec4f {
    umbrage_mask_seen = umbrage_mask_from(corner);
    let pixel = vec2i(corner.at.xy);
    let is_empty = textureLoad(umbrage_mask_depth, pixel, 0) == umbrage_mask_seen.empty_depth;
    let from_eye = umbrage_mask_position(pixel);
    let position = umbrage_mask_seen.eye + from_eye;
    var query = umbrage_query(position, umbrage_mask_normal(pixel, from_eye));
    query.pixel = corner.at.xy;
    if UMBRAGE_MASK_FOOTPRINT {
        query.dx = umbrage_mask_step(pixel, from_eye, vec2i(1, 0));
        query.dy = umbrage_mask_step(pixel, from_eye, vec2i(0, 1));
    }
    let shadow = umbrage_shadow(query);
    @if(bounds)
    {
        if umbrage_is_undecided() && !is_empty {
            discard;
        }
    }
    return vec4f(select(shadow.visibility, 1.0, is_empty), select(1.0, 0.0, is_empty), 0.0, 1.0);
}

fn umbrage_mask_position(pixel: vec2i) -> vec3f {
    let size = vec2f(textureDimensions(umbrage_mask_depth));
    let ndc = (vec2f(pixel) + 0.5) / size * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let stored = textureLoad(umbrage_mask_depth, pixel, 0);
    let at = umbrage_mask_seen.eye_from_clip * vec4f(ndc, stored, 1.0);
    return at.xyz / select(at.w, 1e-20, abs(at.w) < 1e-20);
}

fn umbrage_mask_normal(pixel: vec2i, from_eye: vec3f) -> vec3f {
    let normal = textureLoad(umbrage_mask_normals, pixel, 0).xyz;
    if UMBRAGE_MASK_TURNS {
        return umbrage_mask_towards_eye(normal, from_eye);
    }
    return normal;
}

fn umbrage_mask_step(pixel: vec2i, from_eye: vec3f, direction: vec2i) -> vec3f {
    let size = vec2i(textureDimensions(umbrage_mask_depth));
    let ahead = umbrage_mask_position(clamp(pixel + direction, vec2i(0), size - 1)) - from_eye;
    let behind = from_eye - umbrage_mask_position(clamp(pixel - direction, vec2i(0), size - 1));
    let is_last = any(pixel + direction >= size);
    let is_first = any(pixel - direction < vec2i(0));
    let ahead_differs = abs(dot(ahead, umbrage_mask_seen.forward));
    let behind_differs = abs(dot(behind, umbrage_mask_seen.forward));
    return select(ahead, behind, is_last || (!is_first && behind_differs < ahead_differs));
}

fn umbrage_mask_towards_eye(normal: vec3f, from_eye: vec3f) -> vec3f {
    let sight = select(umbrage_mask_seen.forward, from_eye, umbrage_mask_seen.perspective > 0.5);
    let turned = select(normal, -normal, dot(normal, sight) > 0.0);
    let largest = max(max(abs(turned.x), abs(turned.y)), abs(turned.z));
    if largest == 0.0 {
        return -normalize(sight);
    }
    return normalize(turned / largest);
}
