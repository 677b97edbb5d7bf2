@group(1) @binding(0) var<storage, read> joints: array<mat4x4f>;

struct Vertex {
    @location(0) local: vec3f,
    @location(1) joints: vec4u,
    @location(2) weights: vec4f,
}

@vertex fn vertex(in: Vertex, instance: UmbrageInstance) -> UmbrageCast {
    let skin = in.weights.x * joints[in.joints.x] + in.weights.y * joints[in.joints.y]
        + in.weights.z * joints[in.joints.z] + in.weights.w * joints[in.joints.w];
    return umbrage_cast((skin * vec4f(in.local, 1.0)).xyz, instance);
}
