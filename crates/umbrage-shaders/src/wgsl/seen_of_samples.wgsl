struct UmbrageSeen {
    eye_from_clip: mat4x4f,
    empty_depth: f32
}

@group(0) @binding(0)
var<uniform> umbrage_seen_frame: UmbrageSeen;

@group(0) @binding(1)
var umbrage_seen_depth: texture_depth_multisampled_2d;

@group(0) @binding(2)
var<storage, read_write> umbrage_seen_corners: array<vec4f>;

const UMBRAGE_SEEN_FARTHEST: f32 = 3e38;

var<workgroup> umbrage_seen_low: array<vec3f, 64>;

var<workgroup> umbrage_seen_high: array<vec3f, 64>;

@compute @workgroup_size(8, 8)
fn umbrage_seen(@builtin(workgroup_id) tile: vec3u, @builtin(num_workgroups) tiles: vec3u, @builtin(local_invocation_id) own: vec3u, @builtin(local_invocation_index) index: u32) {
    let size = vec2u(textureDimensions(umbrage_seen_depth));
    let begin = max(tile.xy * size / tiles.xy, vec2u(1u)) - 1u;
    let end = min((tile.xy + 1u) * size / tiles.xy + 1u, size);
    var low = vec3f(UMBRAGE_SEEN_FARTHEST);
    var high = vec3f(-UMBRAGE_SEEN_FARTHEST);
    for (var y = begin.y + own.y; y < end.y; y += 8u) {
        for (var x = begin.x + own.x; x < end.x; x += 8u) {
            let stored = textureLoad(umbrage_seen_depth, vec2u(x, y), 0);
            if stored != umbrage_seen_frame.empty_depth {
                let ndc = (vec2f(f32(x), f32(y)) + 0.5) / vec2f(size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
                let at = umbrage_seen_frame.eye_from_clip * vec4f(ndc, stored, 1.0);
                let position = at.xyz / select(at.w, 1e-20, abs(at.w) < 1e-20);
                low = min(low, position);
                high = max(high, position);
            }
        }
    }
    umbrage_seen_low[index] = low;
    umbrage_seen_high[index] = high;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if index < half {
            umbrage_seen_low[index] = min(umbrage_seen_low[index], umbrage_seen_low[index + half]);
            umbrage_seen_high[index] = max(umbrage_seen_high[index], umbrage_seen_high[index + half]);
        }
    }
    if index == 0u {
        let slot = 2u * (tile.y * tiles.x + tile.x);
        umbrage_seen_corners[slot] = vec4f(umbrage_seen_low[0], 0.0);
        umbrage_seen_corners[slot + 1u] = vec4f(umbrage_seen_high[0], 0.0);
    }
}
