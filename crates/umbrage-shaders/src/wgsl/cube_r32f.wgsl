@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_maps: texture_cube<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_nearest: sampler;

fn umbrage_map_direction(face: u32, place: vec2f) -> vec3f {
    let a = 2.0 * place.x - 1.0;
    let b = 2.0 * place.y - 1.0;
    switch face {
        case 0u {
            return vec3f(1.0, -b, -a);
        }
        case 1u {
            return vec3f(-1.0, -b, a);
        }
        case 2u {
            return vec3f(a, 1.0, b);
        }
        case 3u {
            return vec3f(a, -1.0, -b);
        }
        case 4u {
            return vec3f(a, -b, 1.0);
        }
        case default {
            return vec3f(-a, -b, -1.0);
        }
    }
}

fn umbrage_map_compare(face: u32, texel: vec2f, texels: vec2f, depth: f32) -> f32 {
    return umbrage_bilinear_compared(face, texel, depth);
}

fn umbrage_map_load(face: u32, texel: vec2i) -> f32 {
    let place = (vec2f(texel) + 0.5) / vec2f(textureDimensions(umbrage_maps));
    return textureSampleLevel(umbrage_maps, umbrage_nearest, umbrage_map_direction(face, place), 0.0).x;
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
