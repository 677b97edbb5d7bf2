//! A material that shows what Bevy's shadow maps answer.

use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::pbr::{Material, MaterialPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::AsBindGroup;
use bevy::shader::{Shader, ShaderRef};

const SHADER: Handle<Shader> = uuid_handle!("5d8e1f0a-6a44-4a8c-9a37-0b7f5f1c2d11");

/// The visibility of the first directional light by Bevy's own function: red, green and blue.
#[derive(AsBindGroup, Asset, TypePath, Clone, Debug)]
pub struct MaskMaterial {}

impl Material for MaskMaterial {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }
}

/// Makes [`MaskMaterial`] known to an app.
pub struct MaskPlugin;

impl Plugin for MaskPlugin {
    fn build(&self, app: &mut App) {
        load_internal_asset!(app, SHADER, "mask.wgsl", Shader::from_wgsl);
        app.add_plugins(MaterialPlugin::<MaskMaterial>::default());
    }
}
