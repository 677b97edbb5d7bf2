@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING)
var umbrage_ids_0: texture_2d<u32>;

fn umbrage_map_id(layer: u32, texel: vec2i) -> u32 {
    return textureLoad(umbrage_ids_0, texel, 0).x;
}
