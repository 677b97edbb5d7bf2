@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_compare: sampler_comparison;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var umbrage_map_0: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(4)
var umbrage_map_1: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(5)
var umbrage_map_2: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(6)
var umbrage_map_3: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(7)
var umbrage_map_4: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(8)
var umbrage_map_5: texture_depth_2d;

@group(UMBRAGE_RECEIVER_GROUP) @binding(9)
var umbrage_map_6: texture_depth_2d;

fn umbrage_map_compare(map: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    let place = texel / texels;
    if map == 1u {
        return textureSampleCompareLevel(umbrage_map_1, umbrage_compare, place, depth);
    }
    if map == 2u {
        return textureSampleCompareLevel(umbrage_map_2, umbrage_compare, place, depth);
    }
    if map == 3u {
        return textureSampleCompareLevel(umbrage_map_3, umbrage_compare, place, depth);
    }
    if map == 4u {
        return textureSampleCompareLevel(umbrage_map_4, umbrage_compare, place, depth);
    }
    if map == 5u {
        return textureSampleCompareLevel(umbrage_map_5, umbrage_compare, place, depth);
    }
    if map == 6u {
        return textureSampleCompareLevel(umbrage_map_6, umbrage_compare, place, depth);
    }
    return textureSampleCompareLevel(umbrage_map_0, umbrage_compare, place, depth);
}

fn umbrage_map_load(map: u32, texel: vec2i) -> f32 {
    if map == 1u {
        return textureLoad(umbrage_map_1, texel, 0);
    }
    if map == 2u {
        return textureLoad(umbrage_map_2, texel, 0);
    }
    if map == 3u {
        return textureLoad(umbrage_map_3, texel, 0);
    }
    if map == 4u {
        return textureLoad(umbrage_map_4, texel, 0);
    }
    if map == 5u {
        return textureLoad(umbrage_map_5, texel, 0);
    }
    if map == 6u {
        return textureLoad(umbrage_map_6, texel, 0);
    }
    return textureLoad(umbrage_map_0, texel, 0);
}
