//! Ω_f: the pixels that are scored, and their ground truth.

use glam::DVec3;

use crate::{Error, Result, TruthMask};

/// Least n_g·l of a scored pixel. Below it the surface is dark by its own slope.
pub const LEAST_FACING: f64 = 0.02;

/// Least |B*| of a view that counts. Wholly lit and wholly shaded views do not tell techniques
/// apart.
pub const LEAST_EDGES: usize = 2000;

/// Least difference of the depths of neighbours on different surfaces, as a share of the nearer
/// depth.
const SAME_SURFACE: f64 = 0.05;

/// The scored pixels of a frame, Ω_f, with their depths and their ground truth.
#[derive(Clone, Debug)]
pub struct Domain {
    size: [usize; 2],
    range: (f64, f64),
    /// View depth of each pixel of the image in metres; NaN outside Ω_f.
    depth: Vec<f64>,
    /// V* of each pixel of the image; false outside Ω_f.
    lit: Vec<bool>,
    pixels: Vec<usize>,
    edges: Vec<usize>,
}

impl Domain {
    /// Selects Ω_f of a mask for a shadowed range `[n, f]` in metres of view depth. Points outside
    /// a local light's range and cone do not belong to it.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] unless 0 < n < f < ∞.
    pub fn new(mask: &TruthMask, range: (f64, f64)) -> Result<Self> {
        let (near, far) = range;
        if !(near > 0.0 && far > near && far.is_finite()) {
            let reason = format!("{near}..{far} m; give 0 < near < far, both finite");
            return Err(Error::setting("shadowed range", reason));
        }
        let mut domain = Self {
            size: mask.size(),
            range,
            depth: vec![f64::NAN; mask.hits().len()],
            lit: vec![false; mask.hits().len()],
            pixels: Vec::new(),
            edges: Vec::new(),
        };
        for (pixel, hit) in mask.hits().iter().enumerate() {
            let Some(hit) = hit else { continue };
            let facing = hit.normal.dot(mask.light().to_light(hit.position));
            if facing > LEAST_FACING && mask.light().illuminates(hit.position) && (near..=far).contains(&hit.depth) {
                domain.depth[pixel] = hit.depth;
                domain.lit[pixel] = hit.lit;
                domain.pixels.push(pixel);
            }
        }
        domain.edges = edges_of(&domain, |pixel| domain.lit[pixel]);
        Ok(domain)
    }

    /// Returns width and height of the image in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the shadowed range `[n, f]` in metres of view depth.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// Returns the pixels of Ω_f as indices into the image, rising.
    #[must_use]
    pub fn pixels(&self) -> &[usize] {
        &self.pixels
    }

    /// Returns whether a pixel of the image belongs to Ω_f.
    #[must_use]
    pub fn contains(&self, pixel: usize) -> bool {
        !self.depth[pixel].is_nan()
    }

    /// Returns the view depth of a pixel of Ω_f in metres; NaN outside.
    #[must_use]
    pub fn depth(&self, pixel: usize) -> f64 {
        self.depth[pixel]
    }

    /// Returns V* of a pixel of Ω_f; false outside.
    #[must_use]
    pub fn lit(&self, pixel: usize) -> bool {
        self.lit[pixel]
    }

    /// Returns B*, the pixels at which the true shadow has an edge, as indices into the image,
    /// rising.
    #[must_use]
    pub fn edges(&self) -> &[usize] {
        &self.edges
    }

    /// Returns whether the view counts: it has at least [`LEAST_EDGES`] edge pixels.
    #[must_use]
    pub fn counts_as_view(&self) -> bool {
        self.edges.len() >= LEAST_EDGES
    }

    /// Returns world positions and geometric normals of Ω_f, in the order of [`Domain::pixels`], as
    /// inputs of `umbrage probe`.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] if the domain was not made from this mask.
    pub fn points(&self, mask: &TruthMask) -> Result<Vec<(DVec3, DVec3)>> {
        check_size("the mask", mask.size(), self.size)?;
        self.pixels
            .iter()
            .map(|&pixel| mask.hits()[pixel].map(|hit| (hit.position, hit.normal)))
            .collect::<Option<_>>()
            .ok_or(Error::NothingToScore(
                "the mask has no hit where its domain has a pixel: it is another frame's mask",
            ))
    }

    pub(super) fn not_empty(&self) -> Result<()> {
        if self.pixels.is_empty() {
            return Err(Error::NothingToScore(
                "no pixel faces the light inside the shadowed range; look elsewhere or widen it",
            ));
        }
        Ok(())
    }
}

/// Returns B(V): pixels with a right or lower neighbour on the same surface, both in Ω_f, with
/// another decision.
pub(super) fn edges_of(domain: &Domain, lit: impl Fn(usize) -> bool) -> Vec<usize> {
    let [width, _] = domain.size();
    let count = domain.size()[0] * domain.size()[1];
    let differs = |pixel: usize, other: usize| same_surface(domain, pixel, other) && lit(pixel) != lit(other);
    let has_edge = |&pixel: &usize| {
        (pixel % width + 1 < width && differs(pixel, pixel + 1))
            || (pixel + width < count && differs(pixel, pixel + width))
    };
    domain.pixels().iter().copied().filter(has_edge).collect()
}

/// Returns whether two neighbours, the first of them in Ω_f, both lie in Ω_f and on one surface.
pub(super) fn same_surface(domain: &Domain, pixel: usize, other: usize) -> bool {
    let (z, other_z) = (domain.depth(pixel), domain.depth(other));
    domain.contains(other) && (z - other_z).abs() < SAME_SURFACE * z.min(other_z)
}

/// Checks that two images have one size.
pub(super) fn check_size(what: &'static str, got: [usize; 2], expected: [usize; 2]) -> Result<()> {
    if got == expected { Ok(()) } else { Err(Error::SizeMismatch { what, got, expected }) }
}
