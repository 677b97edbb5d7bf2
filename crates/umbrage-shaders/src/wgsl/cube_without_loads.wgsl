@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_maps: texture_depth_cube;

@group(UMBRAGE_RECEIVER_GROUP) @binding(2)
var umbrage_compare: sampler_comparison;

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
    let direction = umbrage_map_direction(face, texel / texels);
    return textureSampleCompareLevel(umbrage_maps, umbrage_compare, direction, depth);
}
