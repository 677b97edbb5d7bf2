@group(1) @binding(0) var leaf: texture_2d<f32>;
@group(1) @binding(1) var leaf_sampler: sampler;

@vertex fn vertex(@location(0) position: vec3f, @location(1) uv: vec2f, instance: UmbrageInstance) -> UmbrageCast {
    var result = umbrage_cast(position, instance);
    result.uv = uv;
    return result;
}

@fragment fn fragment(@builtin(position) at: vec4f, @location(0) uv: vec2f) -> @location(0) UmbrageTexel {
    if textureSample(leaf, leaf_sampler, uv).a < 0.5 {
        discard;
    }
    return umbrage_caster_texel(at, 0u);
}
