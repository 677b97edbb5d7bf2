// Opaque casters into the maps of one pass. Where maps are depth there is no fragment stage.

@vertex
fn vs_opaque(@location(0) local: vec3f, instance: Instance, own: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position_from_local(instance, local), with_code(instance, own));
}

@fragment
fn fs_opaque(@builtin(position) at: vec4f) -> @location(0) f32 {
    return umbrage_caster_depth(at);
}

// The built-ins of what is drawn, with the code that lies among the instances' own data.
fn with_code(instance: Instance, own: UmbrageInstance) -> UmbrageInstance {
    var result = own;
    result.code = instance.code;
    return result;
}
