// What stands in for the library's text in a picture that never heard of shadows: every light shines everywhere.

struct UmbrageQuery {
    position: vec3f,
    normal: vec3f,
    light: u32,
}

struct UmbrageShadow {
    visibility: f32,
    tint: vec3f,
}

fn umbrage_fragment_query(position: vec3f, normal: vec3f, dx: vec3f, dy: vec3f, pixel: vec2f) -> UmbrageQuery {
    return UmbrageQuery(position, normal, 0u);
}

fn umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow {
    return UmbrageShadow(1.0, vec3f(1.0));
}

fn umbrage_light_of(light: u32, visibility: f32) -> vec3f {
    return vec3f(visibility);
}

fn umbrage_in_slice(position: vec3f) -> bool {
    return true;
}

// As in the library: the loop over lights is the same in both.
fn umbrage_zero(metres: f32) -> u32 {
    return select(0u, 1u, metres > 3.0e38);
}
