@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_compare: sampler_comparison;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var umbrage_map_0: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(4)
var umbrage_map_1: texture_depth_2d;

fn umbrage_map_compare(map: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    let place = texel / texels;
    if map == 1u {
        return textureSampleCompareLevel(umbrage_map_1, umbrage_compare, place, depth);
    }
    return textureSampleCompareLevel(umbrage_map_0, umbrage_compare, place, depth);
}
