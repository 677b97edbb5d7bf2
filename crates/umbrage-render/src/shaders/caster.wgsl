// Casters into one split's map. Opaque ones have no fragment stage; masked ones drop what alpha lets light through.

@vertex
fn vs_opaque(@location(0) local: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return umbrage_caster_position(position_from_local(instance, local));
}

struct MaskedCaster {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) alpha: f32,
}

@vertex
fn vs_masked(
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    instance: Instance,
) -> MaskedCaster {
    return MaskedCaster(umbrage_caster_position(position_from_local(instance, local)), uv, color.a);
}

@fragment
fn fs_masked(in: MaskedCaster) {
    if tested_alpha(in.uv, in.alpha) < material.alpha_cutoff {
        discard;
    }
}
