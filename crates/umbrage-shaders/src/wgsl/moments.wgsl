@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_moment_maps: texture_2d_array<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_smooth: sampler;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var<uniform> umbrage_moments: UmbrageMoments;

fn umbrage_map_moments(layer: u32, texel: vec2f, layer_texels: vec2f, dx: vec2f, dy: vec2f) -> vec4f {
    let at = texel / layer_texels;
    if all(dx == vec2f(0.0)) && all(dy == vec2f(0.0)) {
        return textureSampleLevel(umbrage_moment_maps, umbrage_smooth, at, layer, 0.0);
    }
    return textureSampleGrad(umbrage_moment_maps, umbrage_smooth, at, layer, dx / layer_texels, dy / layer_texels);
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
