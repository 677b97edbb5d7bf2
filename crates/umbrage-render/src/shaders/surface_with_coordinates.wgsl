// What vertices hand on: world positions, and the coordinates in every split's map beside them.

struct Surface {
    // By the arithmetic of depth.wgsl.
    @invariant @builtin(position) clip: vec4f,
    // Relative to the origin.
    @location(0) position: vec3f,
    // The same relative to the eye: small near it, so that its derivatives are precise.
    @location(1) from_eye: vec3f,
    @location(2) normal: vec3f,
    @location(3) uv: vec2f,
    @location(4) color: vec4f,
    // In each split's map.
    @location(5) first: vec3f,
    @location(6) second: vec3f,
    @location(7) third: vec3f,
    @location(8) fourth: vec3f,
}

@vertex
fn vs_main(vertex: Vertex, instance: Instance) -> Surface {
    let position = position_from_local(instance, vertex.local);
    let from_eye = position - frame.eye;
    let normal = normal_from_local(instance, vertex.normal);
    let at = umbrage_shadow_coordinates(position);
    return Surface(
        clip_of(from_eye), position, from_eye, normal, vertex.uv, vertex.color, at.first, at.second, at.third, at.fourth,
    );
}

fn shadow_of(in: Surface, query: UmbrageQuery) -> UmbrageShadow {
    let coordinates = UmbrageShadowCoordinates(in.first, in.second, in.third, in.fourth);
    return umbrage_shadow_from_coordinates(query, coordinates);
}
