@group(UMBRAGE_RECEIVER_GROUP) @binding(UMBRAGE_IDS_BINDING)
var umbrage_ids: texture_2d_array<u32>;

fn umbrage_map_id(layer: u32, texel: vec2i) -> u32 {
    return textureLoad(umbrage_ids, texel, layer, 0).x;
}
