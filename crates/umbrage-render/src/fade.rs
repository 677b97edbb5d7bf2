//! A sun that moves in steps. During a fade between two suns, a frame is drawn under both and
//! mixed.
//!
//! An application that draws its own shading needs no second frame: it gives both suns to one set
//! of maps and mixes the visibilities that `umbrage_shadow` returns for them by the fade's weight.

use image::{GrayAlphaImage, RgbaImage};
use umbrage::{DirectionalLight, SunFade};

use crate::{Frame, Lamp, Outputs, ProbeAnswer, ProbePoint, Rendered, Renderer, Result};

impl Renderer {
    /// Draws a frame as [`Renderer::render`] does, under the suns of `fade` in place of the frame's
    /// sun. While two suns are shown, pictures are mixed in linear display light and masks by their
    /// values. Maps, counts of edges and numbers are those of the sun that is faded to; times are
    /// the sum of both.
    ///
    /// Each sun has maps and stabilisation state of its own, which last through the fade.
    ///
    /// # Errors
    /// Those of [`Renderer::render`].
    pub fn render_faded(&mut self, frame: &Frame<'_>, fade: &SunFade, outputs: Outputs) -> Result<Rendered> {
        if !fade.is_fading() {
            self.end_fade();
            return self.render(&under(frame, fade.to), outputs);
        }
        let from = self.render(&under(frame, fade.from), Outputs { maps: false, edges: false, ..outputs })?;
        let to = self.as_faded_to(|this| this.render(&under(frame, fade.to), outputs))?;
        let mut stats = to.stats;
        stats.plan_ms += from.stats.plan_ms;
        stats.shadow_ms += from.stats.shadow_ms;
        stats.frame_ms += from.stats.frame_ms;
        stats.notes.push("a step of the sun is being faded: times are of both suns' maps and views".to_owned());
        Ok(Rendered {
            picture: from.picture.zip(to.picture).map(|(from, to)| mixed_pictures(from, &to, fade)),
            mask: from.mask.zip(to.mask).map(|(from, to)| mixed_masks(from, &to, fade)),
            maps: to.maps,
            edges: to.edges,
            stats,
        })
    }

    /// Probes points as [`Renderer::probe`] does, under the suns of `fade` in place of the frame's
    /// sun. The splits are those of the sun that is faded to.
    ///
    /// # Errors
    /// Those of [`Renderer::probe`].
    pub fn probe_faded(
        &mut self,
        frame: &Frame<'_>,
        fade: &SunFade,
        points: &[ProbePoint],
    ) -> Result<Vec<ProbeAnswer>> {
        if !fade.is_fading() {
            self.end_fade();
            return self.probe(&under(frame, fade.to), points);
        }
        let from = self.probe(&under(frame, fade.from), points)?;
        let mut answers = self.as_faded_to(|this| this.probe(&under(frame, fade.to), points))?;
        for (to, from) in answers.iter_mut().zip(from) {
            to.visibility = fade.mix(f64::from(from.visibility), f64::from(to.visibility)) as f32;
        }
        Ok(answers)
    }

    /// Runs `body` with the state of the sun that is faded to.
    fn as_faded_to<T>(&mut self, body: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        self.view_slot += 1;
        let result = body(self);
        self.view_slot -= 1;
        result
    }

    /// Ends a fade: the sun that was faded to is the only one from now on.
    fn end_fade(&mut self) {
        self.shadows.move_view(self.view_slot + 1, self.view_slot);
    }
}

/// Returns the frame with another sun as its first light.
fn under<'a>(frame: &Frame<'a>, sun: DirectionalLight) -> Frame<'a> {
    Frame { light: Lamp { light: sun.into(), ..frame.light }, ..*frame }
}

fn mixed_masks(mut from: GrayAlphaImage, to: &GrayAlphaImage, fade: &SunFade) -> GrayAlphaImage {
    for (from, to) in from.pixels_mut().zip(to.pixels()) {
        from.0[0] = fade.mix(f64::from(from.0[0]), f64::from(to.0[0])).round() as u8;
    }
    from
}

fn mixed_pictures(mut from: RgbaImage, to: &RgbaImage, fade: &SunFade) -> RgbaImage {
    for (from, to) in from.pixels_mut().zip(to.pixels()) {
        for (from, &to) in from.0.iter_mut().zip(&to.0).take(3) {
            *from = srgb_from_linear(fade.mix(linear_from_srgb(*from), linear_from_srgb(to)));
        }
    }
    from
}

/// Converts an sRGB value to linear light (IEC 61966-2-1).
fn linear_from_srgb(value: u8) -> f64 {
    let value = f64::from(value) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn srgb_from_linear(value: f64) -> u8 {
    let value = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_there_and_back() {
        for value in 0..=255 {
            assert_eq!(srgb_from_linear(linear_from_srgb(value)), value);
        }
        // Half the light of white.
        assert_eq!(srgb_from_linear(0.5), 188);
    }
}
