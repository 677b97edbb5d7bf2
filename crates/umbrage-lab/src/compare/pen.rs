//! Text on pictures.

use ab_glyph::{Font as _, FontRef, PxScale, ScaleFont as _, point};
use image::{Rgb, RgbImage};

/// A font at one size in pixels.
#[derive(Debug)]
pub struct Pen {
    font: FontRef<'static>,
    size: f32,
}

impl Pen {
    /// Loads Hack, a font for small sizes.
    #[must_use]
    pub fn new(size: f32) -> Self {
        let font = FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).expect("the embedded font is a font");
        Self { font, size }
    }

    /// Returns the pixels from one line to the next.
    #[must_use]
    pub fn line_height(&self) -> u32 {
        let font = self.font.as_scaled(PxScale::from(self.size));
        (font.height() + font.line_gap()).ceil() as u32 + 1
    }

    /// Returns the width of a line in pixels.
    #[must_use]
    pub fn width(&self, text: &str) -> u32 {
        let font = self.font.as_scaled(PxScale::from(self.size));
        text.chars().map(|c| font.h_advance(font.glyph_id(c))).sum::<f32>().ceil() as u32
    }

    /// Returns the line, or as much of its beginning as fits, with an ellipsis.
    #[must_use]
    pub fn fitted(&self, text: &str, width: u32) -> String {
        if self.width(text) <= width {
            return text.to_owned();
        }
        let mut short: Vec<char> = text.chars().collect();
        while short.pop().is_some() {
            let cut: String = short.iter().collect::<String>().trim_end().to_owned() + "…";
            if self.width(&cut) <= width {
                return cut;
            }
        }
        String::new()
    }

    /// Draws a line whose upper left corner is `at`. Parts outside the picture are cut off.
    pub fn draw(&self, picture: &mut RgbImage, at: [u32; 2], colour: Rgb<u8>, text: &str) {
        let scale = PxScale::from(self.size);
        let font = self.font.as_scaled(scale);
        let mut x = at[0] as f32;
        let baseline = at[1] as f32 + font.ascent();
        for c in text.chars() {
            let id = font.glyph_id(c);
            if let Some(outline) = self.font.outline_glyph(id.with_scale_and_position(scale, point(x, baseline))) {
                let corner = outline.px_bounds().min;
                outline.draw(|dx, dy, coverage| {
                    let (px, py) = (corner.x + dx as f32, corner.y + dy as f32);
                    if px < 0.0 || py < 0.0 || px >= picture.width() as f32 || py >= picture.height() as f32 {
                        return;
                    }
                    let pixel = picture.get_pixel_mut(px as u32, py as u32);
                    let coverage = coverage.clamp(0.0, 1.0);
                    for (channel, wanted) in pixel.0.iter_mut().zip(colour.0) {
                        *channel =
                            (f32::from(*channel) * (1.0 - coverage) + f32::from(wanted) * coverage).round() as u8;
                    }
                });
            }
            x += font.h_advance(id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_that_labels_use_has_a_shape() {
        let pen = Pen::new(14.0);
        for c in "PSSM(4; 512²) λ0.9 ° × · – … % −".chars() {
            assert_ne!(pen.font.glyph_id(c).0, 0, "{c:?} is missing from the font");
        }
    }

    #[test]
    fn words_leave_ink_inside_the_picture_only() {
        let white = Rgb([255; 3]);
        let mut picture = RgbImage::from_pixel(40, 20, white);
        let pen = Pen::new(14.0);
        pen.draw(&mut picture, [2, 2], Rgb([0; 3]), "Ink and more than fits");
        assert!(picture.pixels().any(|pixel| pixel.0[0] < 64), "there is ink");
        let mut blank = RgbImage::from_pixel(40, 20, white);
        pen.draw(&mut blank, [2, 2], Rgb([0; 3]), "");
        pen.draw(&mut blank, [100, 100], Rgb([0; 3]), "outside");
        assert!(blank.pixels().all(|&pixel| pixel == white));
    }

    #[test]
    fn long_lines_are_cut() {
        let pen = Pen::new(14.0);
        assert_eq!(pen.fitted("short", 1000), "short");
        let cut = pen.fitted("a long line of words", 80);
        assert!(cut.ends_with('…') && pen.width(&cut) <= 80 && cut.len() > 4, "{cut}");
        assert_eq!(pen.fitted("word", 0), "");
    }
}
