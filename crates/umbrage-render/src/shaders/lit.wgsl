// What stands in for the library's text where a mask says what the first light reaches; there is no other light.

@group(2) @binding(0) var lit: texture_2d<f32>;

struct UmbrageQuery {
    position: vec3f,
    normal: vec3f,
    light: u32,
    pixel: vec2f,
}

struct UmbrageShadow {
    visibility: f32,
    tint: vec3f,
}

fn umbrage_fragment_query(position: vec3f, normal: vec3f, dx: vec3f, dy: vec3f, pixel: vec2f) -> UmbrageQuery {
    return UmbrageQuery(position, normal, 0u, pixel);
}

fn umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow {
    return UmbrageShadow(textureLoad(lit, vec2i(query.pixel), 0).r, vec3f(1.0));
}

fn umbrage_light_of(light: u32, visibility: f32) -> vec3f {
    return mix(frame.shadow_colour, vec3f(1.0), visibility);
}

fn umbrage_in_slice(position: vec3f) -> bool {
    return true;
}

// As in the library: the loop over lights is the same in both.
fn umbrage_zero(metres: f32) -> u32 {
    return select(0u, 1u, metres > 3.0e38);
}
