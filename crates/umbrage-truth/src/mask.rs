//! Exact hard shadows, pixel by pixel.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use image::{GrayAlphaImage, LumaA};
use rayon::prelude::*;
use umbrage::{Light, View};

use crate::truth::{Seen, sun};
use crate::{Error, Hit, Result, Truth};

/// Edge in pixels of the blocks that are traced together, so that neighbouring rays find the tree
/// in the cache.
const BLOCK: usize = 8;

/// Ground truth of hard shadows for a view: the first hit of each pixel centre, and whether the
/// light reaches it.
#[derive(Clone, Debug)]
pub struct TruthMask {
    size: [usize; 2],
    light: Light,
    /// View of the rays; `None` if the hits do not come from rays.
    view: Option<View>,
    hits: Vec<Option<Hit>>,
}

impl Truth {
    /// Traces one ray through each pixel centre and one from there to the light. `light_travel` is
    /// the direction in which the light travels and need not be normalised. `size` is width and
    /// height in pixels. `progress` is called with the share that is done, in `[0, 1]`, from
    /// several threads and not always in order. The result does not depend on the number of
    /// threads.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the image has no pixels or the light no direction.
    pub fn mask(
        &self,
        view: &View,
        light_travel: DVec3,
        size: [u32; 2],
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<TruthMask> {
        self.mask_under(view, &sun(light_travel)?, size, progress)
    }

    /// Traces the mask under any light. Rays to a local light end there. Points outside its range
    /// and cone are not shadowed (and not scored: see [`crate::scores::Domain`]).
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the image has no pixels.
    pub fn mask_under(
        &self,
        view: &View,
        light: &Light,
        size: [u32; 2],
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<TruthMask> {
        let mut mask = empty(view, light, size)?;
        let [width, height] = mask.size;
        let rows = AtomicUsize::new(0);
        mask.hits.par_chunks_mut(width * BLOCK).enumerate().for_each_init(Vec::new, |stack, (band, pixels)| {
            self.look_at_band(view, light, (band, [width, height]), pixels, stack);
            let done = rows.fetch_add(pixels.len() / width, Ordering::Relaxed) + pixels.len() / width;
            progress(done as f32 / height as f32);
        });
        Ok(mask)
    }

    /// Begins the mask of [`Truth::mask_under`], to be traced a few rows at a time on the caller's
    /// own thread, if that has other work to do in between.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the image has no pixels.
    pub fn begin_mask(&self, view: &View, light: &Light, size: [u32; 2]) -> Result<Tracing<'_>> {
        Ok(Tracing { truth: self, view: *view, mask: empty(view, light, size)?, bands: 0, stack: Vec::new() })
    }

    /// Traces some rows of an image, from row `band` · [`BLOCK`] on.
    fn look_at_band(
        &self,
        view: &View,
        light: &Light,
        (band, size): (usize, [usize; 2]),
        pixels: &mut [Option<Hit>],
        stack: &mut Vec<u32>,
    ) {
        let width = size[0];
        for (x, y) in in_blocks(width, pixels.len() / width) {
            pixels[y * width + x] = self.look(view, light, ([x, band * BLOCK + y], size), stack);
        }
    }

    /// Traces the centre of one pixel of an image.
    fn look(
        &self,
        view: &View,
        light: &Light,
        (pixel, size): ([usize; 2], [usize; 2]),
        stack: &mut Vec<u32>,
    ) -> Option<Hit> {
        let (origin, direction) = ray_of(view, pixel, size);
        let frustum = view.frustum();
        let mut hit = self.first_hit(origin, direction, (frustum.near, frustum.far), stack)?;
        hit.lit = self.is_lit(&self.seen(origin, direction, &hit), hit.position, light, stack);
        Some(hit)
    }
}

/// Returns a mask of which nothing is traced yet.
fn empty(view: &View, light: &Light, size: [u32; 2]) -> Result<TruthMask> {
    if size.contains(&0) {
        return Err(Error::setting("size", format!("{} x {} pixels; give 1 or more each", size[0], size[1])));
    }
    let size = size.map(|n| n as usize);
    Ok(TruthMask { size, light: *light, view: Some(*view), hits: vec![None; size[0] * size[1]] })
}

/// A mask that is being traced a few rows at a time: see [`Truth::begin_mask`].
#[derive(Debug)]
pub struct Tracing<'t> {
    truth: &'t Truth,
    view: View,
    mask: TruthMask,
    /// Number of bands of [`BLOCK`] rows that are traced.
    bands: usize,
    stack: Vec<u32>,
}

impl Tracing<'_> {
    /// Traces the next rows and returns the share of all rows that is done, in `[0, 1]`.
    pub fn advance(&mut self) -> f32 {
        let Self { truth, view, mask, bands, stack } = self;
        let (size, light) = (mask.size, mask.light);
        if let Some(pixels) = mask.hits.chunks_mut(size[0] * BLOCK).nth(*bands) {
            truth.look_at_band(view, &light, (*bands, size), pixels, stack);
            *bands += 1;
        }
        (*bands * BLOCK).min(size[1]) as f32 / size[1] as f32
    }

    /// Returns the mask, or `None` while rows are missing.
    #[must_use]
    pub fn finish(self) -> Option<TruthMask> {
        (self.bands * BLOCK >= self.mask.size[1]).then_some(self.mask)
    }
}

/// Returns the ray through a pixel's centre: its origin in the world, and its direction.
fn ray_of(view: &View, pixel: [usize; 2], size: [usize; 2]) -> (DVec3, DVec3) {
    view.ray_through((pixel[0] as f64 + 0.5) / size[0] as f64, (pixel[1] as f64 + 0.5) / size[1] as f64)
}

impl TruthMask {
    /// Makes a mask from hits that do not come from rays, such as a closed form: one entry for each
    /// pixel, row after row.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] for more or fewer entries than pixels, [`Error::InvalidSetting`] for
    /// a light without direction.
    pub fn from_hits(size: [usize; 2], to_light: DVec3, hits: Vec<Option<Hit>>) -> Result<Self> {
        if hits.len() != size[0] * size[1] {
            return Err(Error::SizeMismatch {
                what: "the list of hits",
                got: [hits.len(), 1],
                expected: [size[0] * size[1], 1],
            });
        }
        Ok(Self { size, light: sun(-to_light)?, view: None, hits })
    }

    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the light.
    #[must_use]
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// Returns one hit per pixel, row by row from the upper left; `None` where the ray meets
    /// nothing.
    #[must_use]
    pub fn hits(&self) -> &[Option<Hit>] {
        &self.hits
    }

    /// Returns the hit of a pixel as the origin of shadow rays, in the truth that the mask was
    /// traced in.
    pub(crate) fn seen(&self, truth: &Truth, pixel: usize, hit: &Hit) -> Seen {
        let Some(view) = &self.view else { return truth.probed(hit.position, hit.normal) };
        let (origin, direction) = ray_of(view, [pixel % self.size[0], pixel / self.size[0]], self.size);
        truth.seen(origin, direction, hit)
    }

    /// Draws the mask as an image: 255 lit, 0 shadowed or turned away from the light; alpha 255, or
    /// 0 where nothing was hit.
    #[must_use]
    pub fn to_image(&self) -> GrayAlphaImage {
        mask_image(self.size, self.hits.iter().map(|hit| hit.map(|hit| f32::from(u8::from(hit.lit)))))
    }
}

/// Draws visibilities in `[0, 1]` as a mask image; `None` is transparent.
pub(crate) fn mask_image(size: [usize; 2], values: impl Iterator<Item = Option<f32>>) -> GrayAlphaImage {
    let mut image = GrayAlphaImage::new(size[0] as u32, size[1] as u32);
    for (pixel, value) in image.pixels_mut().zip(values) {
        *pixel = value.map_or(LumaA([0, 0]), |v| LumaA([(255.0 * v).round() as u8, 255]));
    }
    image
}

/// Reads a mask as `umbrage render --visibility` and `umbrage truth` write it: grey and alpha, 8
/// bits.
///
/// # Errors
/// [`Error::Image`] if the file is missing or no image.
pub fn read_mask(path: &Path) -> Result<GrayAlphaImage> {
    let image = image::open(path).map_err(|source| Error::Image { path: path.to_owned(), source })?;
    Ok(image.into_luma_alpha8())
}

/// Iterates over the pixels of a band, block after block.
pub(crate) fn in_blocks(width: usize, height: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..width)
        .step_by(BLOCK)
        .flat_map(move |left| (0..height).flat_map(move |y| (left..(left + BLOCK).min(width)).map(move |x| (x, y))))
}
