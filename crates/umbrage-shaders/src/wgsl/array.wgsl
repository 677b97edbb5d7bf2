@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_maps: texture_depth_2d_array;

@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_compare: sampler_comparison;

fn umbrage_map_compare(layer: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    return textureSampleCompareLevel(umbrage_maps, umbrage_compare, texel / texels, layer, depth);
}

fn umbrage_map_load(layer: u32, texel: vec2i) -> f32 {
    return textureLoad(umbrage_maps, texel, layer, 0);
}
