// Contact shadows are the first light's, as dark as its others, and off where they are.
fn with_contact(visibility: f32, position: vec3f, normal: vec3f) -> f32 {
    let strength = select(0.0, umbrage_frames[0].strength, umbrage_frames[0].enabled != 0u);
    let to_light = towards(frame.lamps[0], position);
    return min(visibility, mix(1.0, umbrage_contact_visibility(position, normal, to_light, 0.5), strength));
}
