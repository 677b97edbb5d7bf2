// Opaque casters into the maps of one pass that name the triangles they show.

@vertex
fn vs_named(
    @location(0) local: vec3f,
    instance: Instance,
    @location(8) first_id: u32,
    @location(9) run: u32,
    own: UmbrageInstance,
) -> UmbrageCast {
    var drawn = own;
    drawn.code = instance.code;
    return umbrage_named(umbrage_cast(position_from_local(instance, local), drawn), umbrage_caster_id(first_id, run));
}

@fragment
fn fs_named(@builtin(position) at: vec4f, @location(14) @interpolate(flat, first) id: u32) -> @location(0) UmbrageTexel {
    return umbrage_caster_texel(at, id);
}
