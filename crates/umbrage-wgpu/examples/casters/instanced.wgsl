@group(1) @binding(0) var<storage, read> world_from_local: array<mat4x4f>;

// The draw's instances are the application's own: see `ShadowMap::rows`. A shader that takes
// `@builtin(instance_index)` itself calls `umbrage_cast_at`, which asks for no built-in.
@vertex fn vertex(@location(0) local: vec3f, @builtin(instance_index) instance: u32) -> UmbrageCast {
    return umbrage_cast_at((world_from_local[instance] * vec4f(local, 1.0)).xyz, instance);
}
