//! A material that shows what Bevy's shadow maps answer, and the judge of the answers.

use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::pbr::{Material, MaterialPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::AsBindGroup;
use bevy::shader::{Shader, ShaderRef};
use umbrage_bevy::umbrage::View;
use umbrage_truth::scores::{
    Answers, Domain, EdgeDistance, MisShadowed, Seams, edge_distance, false_colour, mis_shadowed, seams,
};
use umbrage_truth::{Truth, TruthMask};

use crate::Failure;
use crate::studio::{Picture, Size};
use crate::worlds::Stage;

const SHADER: Handle<Shader> = uuid_handle!("5d8e1f0a-6a44-4a8c-9a37-0b7f5f1c2d11");

/// The visibility of the first directional light, from Bevy's own function, as red, green and blue.
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

/// What rays say about a view.
pub struct Judge {
    mask: TruthMask,
    domain: Domain,
}

/// How wrong a mask is.
pub struct Verdict {
    pub wrong: MisShadowed,
    pub edges: Option<EdgeDistance>,
    /// Where one cascade follows on another.
    pub seams: Seams,
    /// Truth in grey, leaks red, acne blue.
    pub picture: image::RgbImage,
}

impl Judge {
    /// Traces a view of a world, and judges points from `range.0` to `range.1` metres of view depth.
    pub fn new(stage: &Stage, truth: &Truth, view: &View, size: Size, range: (f64, f64)) -> Result<Self, Failure> {
        let mask = truth.mask(view, stage.sun, size, &|_| {})?;
        let domain = Domain::new(&mask, range)?;
        Ok(Self { mask, domain })
    }

    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Judges a picture of [`MaskMaterial`], which has alpha only where a surface is.
    pub fn judge(&self, picture: &Picture, bounds: &[f32]) -> Result<Verdict, Failure> {
        let pixels = picture.pixels().map(|pixel| (pixel.0[3] > 0).then(|| linear(pixel.0[0]))).collect();
        let answers = Answers::from_pixels(self.domain.size(), pixels)?;
        let inner = &bounds[..bounds.len().saturating_sub(1)];
        let borders: Vec<f64> = inner.iter().map(|&bound| f64::from(bound)).collect();
        Ok(Verdict {
            wrong: mis_shadowed(&self.domain, &answers)?,
            edges: edge_distance(&self.domain, &answers)?,
            seams: seams(&self.domain, &answers, &borders, |pixel| self.domain.depth(pixel))?,
            picture: false_colour(&self.mask, &self.domain, &answers)?,
        })
    }
}

/// The value that an sRGB code stands for.
fn linear(code: u8) -> f32 {
    LinearRgba::from(Srgba::rgb_u8(code, code, code)).red.clamp(0.0, 1.0)
}
