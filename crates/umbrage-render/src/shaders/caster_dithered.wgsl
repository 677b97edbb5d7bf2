// Translucent casters into the maps of one pass: they cover as many texels as alpha says.

@vertex
fn vs_dithered(
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    instance: Instance,
    own: UmbrageInstance,
) -> UmbrageCast {
    let drawn = with_code(instance, own);
    var result = umbrage_cast(position_from_local(instance, local), drawn);
    result.uv = uv;
    result.alpha = color.a;
    result.offset = umbrage_caster_offset(drawn);
    return result;
}

// Where maps are depth alone nobody takes what is returned. Where they name triangles these have
// no name.
@fragment
fn fs_dithered(
    @builtin(position) at: vec4f,
    @location(0) uv: vec2f,
    @location(1) alpha: f32,
    @location(2) @interpolate(flat) offset: vec2f,
) -> @location(0) UmbrageTexel {
    if !umbrage_caster_covers(at, offset, tested_alpha(uv, alpha)) {
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
