//! Upload of pictures to the controls.

use std::sync::Arc;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use image::imageops::FilterType;
use image::{GrayImage, RgbaImage};

use crate::judge::Laid;
use crate::studio::Drawn;

/// Edge in pixels of a map's picture in the panel.
const MAP_EDGE: u32 = 384;

/// Textures of the controls, each uploaded once.
#[derive(Default)]
pub(crate) struct Textures {
    drawn: Option<Arc<Drawn>>,
    pictures: Vec<TextureHandle>,
    maps: Vec<Map>,
    laid: Option<(Laid, TextureHandle)>,
}

/// A map as a picture.
pub(crate) struct Map {
    /// The picture, no larger than the panel shows it.
    pub texture: TextureHandle,
    /// Share of the map's texels in which a depth is stored.
    pub filled: f64,
}

impl Textures {
    /// Returns whether the pictures of `drawn` are uploaded.
    pub fn has(&self, drawn: &Arc<Drawn>) -> bool {
        self.drawn.as_ref().is_some_and(|known| Arc::ptr_eq(known, drawn))
    }

    /// Returns the pictures of `drawn`.
    pub fn pictures(&mut self, ctx: &Context, drawn: &Arc<Drawn>) -> &[TextureHandle] {
        self.take(ctx, drawn);
        &self.pictures
    }

    /// Returns the maps of `drawn`.
    pub fn maps(&mut self, ctx: &Context, drawn: &Arc<Drawn>) -> &[Map] {
        self.take(ctx, drawn);
        &self.maps
    }

    fn take(&mut self, ctx: &Context, drawn: &Arc<Drawn>) {
        if self.drawn.as_ref().is_some_and(|known| Arc::ptr_eq(known, drawn)) {
            return;
        }
        self.drawn = Some(Arc::clone(drawn));
        self.pictures.truncate(drawn.taken.len());
        for (slot, taken) in drawn.taken.iter().enumerate() {
            let image = opaque(&taken.picture);
            match self.pictures.get_mut(slot) {
                // Pixels of the picture are pixels of the window; a smaller one is magnified
                // smoothly.
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => self.pictures.push(ctx.load_texture("picture", image, TextureOptions::LINEAR)),
            }
        }
        // The first picture's; maps of a moving camera come later and keep their place.
        let maps = drawn.taken.first().map_or(&[][..], |taken| &taken.maps);
        if drawn.wants.maps {
            self.maps = maps.iter().map(|map| Map::new(ctx, map)).collect();
        }
    }

    /// Returns the picture of an overlay.
    pub fn overlay(&mut self, ctx: &Context, laid: &Laid) -> egui::TextureId {
        let known = self.laid.as_ref().filter(|(known, _)| known == laid);
        if let Some((_, texture)) = known {
            return texture.id();
        }
        let size = [laid.picture.width() as usize, laid.picture.height() as usize];
        let image = ColorImage::from_rgba_unmultiplied(size, laid.picture.as_raw());
        let texture = ctx.load_texture("overlay", image, TextureOptions::NEAREST);
        let id = texture.id();
        self.laid = Some((laid.clone(), texture));
        id
    }
}

impl Map {
    fn new(ctx: &Context, map: &GrayImage) -> Self {
        let stored = map.pixels().filter(|pixel| pixel.0[0] < u8::MAX).count();
        let filled = stored as f64 / f64::from(map.width() * map.height()).max(1.0);
        let edge = map.width().min(MAP_EDGE);
        let small = image::imageops::resize(map, edge, edge, FilterType::Triangle);
        let image = ColorImage::from_gray([edge as usize; 2], small.as_raw());
        Self { texture: ctx.load_texture("map", image, TextureOptions::LINEAR), filled }
    }
}

fn opaque(picture: &RgbaImage) -> ColorImage {
    ColorImage::from_rgba_premultiplied([picture.width() as usize, picture.height() as usize], picture.as_raw())
}
