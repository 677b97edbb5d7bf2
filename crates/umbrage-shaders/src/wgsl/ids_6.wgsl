@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING)
var umbrage_ids_0: texture_2d<u32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING + 1u)
var umbrage_ids_1: texture_2d<u32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING + 2u)
var umbrage_ids_2: texture_2d<u32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING + 3u)
var umbrage_ids_3: texture_2d<u32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING + 4u)
var umbrage_ids_4: texture_2d<u32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING + 5u)
var umbrage_ids_5: texture_2d<u32>;

fn umbrage_map_id(layer: u32, texel: vec2i) -> u32 {
    if layer == 1u {
        return textureLoad(umbrage_ids_1, texel, 0).x;
    }
    if layer == 2u {
        return textureLoad(umbrage_ids_2, texel, 0).x;
    }
    if layer == 3u {
        return textureLoad(umbrage_ids_3, texel, 0).x;
    }
    if layer == 4u {
        return textureLoad(umbrage_ids_4, texel, 0).x;
    }
    if layer == 5u {
        return textureLoad(umbrage_ids_5, texel, 0).x;
    }
    return textureLoad(umbrage_ids_0, texel, 0).x;
}
