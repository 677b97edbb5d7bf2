@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var umbrage_map_0: texture_2d<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(4)
var umbrage_map_1: texture_2d<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(5)
var umbrage_map_2: texture_2d<f32>;

fn umbrage_map_compare(map: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    return umbrage_bilinear_compared(map, texel, depth);
}

fn umbrage_map_load(map: u32, texel: vec2i) -> f32 {
    if map == 1u {
        return textureLoad(umbrage_map_1, texel, 0).x;
    }
    if map == 2u {
        return textureLoad(umbrage_map_2, texel, 0).x;
    }
    return textureLoad(umbrage_map_0, texel, 0).x;
}

fn umbrage_bilinear_compared(layer: u32, texel: vec2f, depth: f32) -> f32 {
    let corner = floor(texel - 0.5);
    let share = texel - 0.5 - corner;
    let first = vec2i(corner);
    let upper = mix(umbrage_bilinear_lit(layer, first, depth), umbrage_bilinear_lit(layer, first + vec2i(1, 0), depth), share.x);
    let lower = mix(umbrage_bilinear_lit(layer, first + vec2i(0, 1), depth), umbrage_bilinear_lit(layer, first + vec2i(1, 1), depth), share.x);
    return mix(upper, lower, share.y);
}

fn umbrage_bilinear_lit(layer: u32, texel: vec2i, depth: f32) -> f32 {
    return select(0.0, 1.0, depth <= umbrage_map_load(layer, texel));
}
