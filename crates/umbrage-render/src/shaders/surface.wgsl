// What vertices hand on: world positions, from which fragments make map coordinates.

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
}

@vertex
fn vs_main(vertex: Vertex, instance: Instance) -> Surface {
    let position = position_from_local(instance, vertex.local);
    let from_eye = position - frame.eye;
    let normal = normal_from_local(instance, vertex.normal);
    return Surface(clip_of(from_eye), position, from_eye, normal, vertex.uv, vertex.color);
}

fn shadow_of(in: Surface, query: UmbrageQuery) -> UmbrageShadow {
    return umbrage_shadow(query);
}
