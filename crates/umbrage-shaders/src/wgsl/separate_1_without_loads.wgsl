@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_compare: sampler_comparison;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var umbrage_map_0: texture_depth_2d;

fn umbrage_map_compare(map: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    let place = texel / texels;
    return textureSampleCompareLevel(umbrage_map_0, umbrage_compare, place, depth);
}
