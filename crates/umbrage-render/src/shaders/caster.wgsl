// Opaque casters into the maps of one pass. Where maps are depth there is no fragment stage.

@vertex
fn vs_opaque(@location(0) local: vec3f, instance: Instance, copy: UmbrageCopy) -> UmbrageCast {
    return umbrage_cast_copy(position_from_local(instance, local), copy, instance.code);
}

@fragment
fn fs_opaque(@builtin(position) at: vec4f) -> @location(0) f32 {
    return umbrage_caster_depth(at);
}
