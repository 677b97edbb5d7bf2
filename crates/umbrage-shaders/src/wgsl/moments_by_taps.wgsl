@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_moment_maps: texture_2d_array<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_smooth: sampler;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var<uniform> umbrage_moments: UmbrageMoments;

const UMBRAGE_MOST_ANISOTROPY: f32 = 16.0;

fn umbrage_map_moments(layer: u32, texel: vec2f, layer_texels: vec2f, dx: vec2f, dy: vec2f) -> vec4f {
    let along = select(dy, dx, dot(dx, dx) >= dot(dy, dy));
    let across = min(length(dx), length(dy));
    let long = max(length(along), 1.0);
    let taps = clamp(ceil(long / max(across, 1.0)), 1.0, UMBRAGE_MOST_ANISOTROPY);
    let level = clamp(log2(long / taps), 0.0, 15.0);
    var sum = vec4f(0.0);
    for (var i = 0.0; i < taps; i += 1.0) {
        let at = texel + along * ((i + 0.5) / taps - 0.5);
        sum += umbrage_trilinear(layer, at / layer_texels, level);
    }
    return sum / taps;
}

fn umbrage_trilinear(layer: u32, at: vec2f, level: f32) -> vec4f {
    return textureSampleLevel(umbrage_moment_maps, umbrage_smooth, at, layer, level);
}

struct UmbrageMomentSplit {
    depth: vec2f,
    radius: vec2f,
    @size(16)
    quads: u32
}

struct UmbrageMoments {
    exponents: vec2f,
    bleeding: f32,
    splits: array<UmbrageMomentSplit, 8>
}
