// Alpha-tested casters into the maps of one pass: they drop what alpha lets light through.

@vertex
fn vs_masked(
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    instance: Instance,
    own: UmbrageInstance,
) -> UmbrageCast {
    var result = umbrage_cast(position_from_local(instance, local), with_code(instance, own));
    result.uv = uv;
    result.alpha = color.a;
    return result;
}

// Where maps are depth alone nobody takes what is returned. Where they name triangles these have
// no name.
@fragment
fn fs_masked(@builtin(position) at: vec4f, @location(0) uv: vec2f, @location(1) alpha: f32) -> @location(0) UmbrageTexel {
    if tested_alpha(uv, alpha) < material.alpha_cutoff {
        discard;
    }
    return umbrage_caster_texel(at, 0u);
}

// The built-ins of what is drawn, with the code that lies among the instances' own data.
fn with_code(instance: Instance, own: UmbrageInstance) -> UmbrageInstance {
    var result = own;
    result.code = instance.code;
    return result;
}
