//! The judge of masks: rays.

use bevy::prelude::*;
use umbrage_bevy::umbrage::View;
use umbrage_truth::scores::{
    Answers, Domain, EdgeDistance, MisShadowed, Seams, edge_distance, false_colour, mis_shadowed, seams,
};
use umbrage_truth::{Truth, TruthMask};

use crate::Failure;
use crate::studio::{Picture, Size};
use crate::worlds::Stage;

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
    /// Traces a view of a world. Points of view depths in `range`, in metres, are judged.
    pub fn new(stage: &Stage, truth: &Truth, view: &View, size: Size, range: (f64, f64)) -> Result<Self, Failure> {
        let mask = truth.mask(view, stage.sun, size, &|_| {})?;
        let domain = Domain::new(&mask, range)?;
        Ok(Self { mask, domain })
    }

    /// Judges a picture of [`crate::mask::MaskMaterial`], which has alpha only where a surface is.
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
