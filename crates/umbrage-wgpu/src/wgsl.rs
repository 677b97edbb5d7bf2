//! Text to put before the app's own shaders.

/// What a vertex shader needs to draw casters; `group` is the index at which the app binds
/// [`crate::ShadowMaps::caster_bind_group`].
#[must_use]
pub fn caster_wgsl(group: u32) -> String {
    umbrage_shaders::caster(group)
}

/// What any shader needs to ask for visibility; `group` is the index at which the app binds
/// [`crate::ShadowMaps::receiver_bind_group`].
#[must_use]
pub fn receiver_wgsl(group: u32) -> String {
    umbrage_shaders::receiver(group)
}

/// [`receiver_wgsl`] for GL and WebGL2, where depth textures cannot be loaded from: [`crate::Filter::Pcss`] is then
/// [`crate::Filter::Disc`].
#[must_use]
pub fn receiver_wgsl_without_loads(group: u32) -> String {
    umbrage_shaders::receiver_without_loads(group)
}
