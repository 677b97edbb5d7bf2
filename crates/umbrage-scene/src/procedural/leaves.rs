//! Pictures of twigs with leaves on a transparent background, for cards.

use super::maths::{mix, scramble, sin_cos, unit};
use crate::{Texture, TextureFilter, Wrap};

/// Kinds of leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leaf {
    Oval,
    Round,
    Lance,
    Lobed,
    Needles,
    Scales,
    Pinnate,
}

impl Leaf {
    pub(super) const ALL: [Self; 7] =
        [Self::Oval, Self::Round, Self::Lance, Self::Lobed, Self::Needles, Self::Scales, Self::Pinnate];

    /// Returns the pairs of leaves on a twig, their length and half width as shares of the
    /// picture's width, and the lobes of their edge.
    const fn shape(self) -> (u32, f64, f64, f64) {
        match self {
            Self::Oval => (5, 0.40, 0.11, 0.0),
            Self::Round => (4, 0.36, 0.17, 0.0),
            Self::Lance => (8, 0.44, 0.05, 0.0),
            Self::Lobed => (4, 0.42, 0.15, 5.0),
            Self::Needles => (40, 0.30, 0.010, 0.0),
            Self::Scales => (22, 0.26, 0.03, 0.0),
            Self::Pinnate => (18, 0.44, 0.032, 0.0),
        }
    }
}

/// Draws a twig of leaves, its root at the bottom, on a transparent background.
pub(super) fn leaf_texture(leaf: Leaf) -> Texture {
    const EDGE: u32 = 256;
    let edge = f64::from(EDGE);
    let (pairs, length, half_width, lobes) = leaf.shape();
    let mut canvas = Canvas { coverage: vec![0.0; (EDGE * EDGE) as usize], light: vec![0.7; (EDGE * EDGE) as usize] };
    canvas.stroke([0.5 * edge, edge], [0.5 * edge, 0.06 * edge], 0.012 * edge, 0.0, 0.4);
    for pair in 0..pairs {
        let share = f64::from(pair) / f64::from(pairs);
        for (hand, side) in [(-1.0, 0), (1.0, 1)] {
            let luck = |salt: u64| unit(scramble(salt + 2 * u64::from(pair) + side + 1000 * leaf as u64)) - 0.5;
            let (sin, cos) = sin_cos(mix(12.0, 60.0, share) + 16.0 * luck(7000));
            let reach = length * edge * mix(1.0, 0.55, share) * (1.0 + 0.2 * luck(8000));
            let from = [0.5 * edge, mix(0.92, 0.16, share) * edge];
            let to = [from[0] + hand * reach * cos, from[1] - reach * sin];
            canvas.stroke(from, to, half_width * edge * mix(1.0, 0.7, share), lobes, 0.75 + 0.4 * luck(9000));
        }
    }
    canvas.texture(EDGE)
}

struct Canvas {
    coverage: Vec<f64>,
    light: Vec<f64>,
}

impl Canvas {
    /// Draws a leaf from its stalk to its tip, widest in the middle.
    fn stroke(&mut self, from: [f64; 2], to: [f64; 2], half_width: f64, lobes: f64, light: f64) {
        let edge = self.coverage.len().isqrt();
        let span = |axis: usize| {
            let low = (from[axis].min(to[axis]) - half_width - 2.0).max(0.0) as usize;
            let high = (from[axis].max(to[axis]) + half_width + 3.0).max(0.0) as usize;
            low..high.min(edge)
        };
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        for y in span(1) {
            for x in span(0) {
                let (px, py) = (x as f64 + 0.5 - from[0], y as f64 + 0.5 - from[1]);
                let share = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
                let away = libm::hypot(px - share * dx, py - share * dy);
                let belly = libm::sqrt(sin_cos(180.0 * share).0.max(0.0)).max(0.12);
                let lobed = 1.0 - 0.35 * (0.5 - 0.5 * sin_cos(360.0 * lobes * share).1);
                let cover = (half_width * belly * lobed + 0.5 - away).clamp(0.0, 1.0);
                let pixel = y * edge + x;
                if cover > 0.0 {
                    let vein = if away < 1.0 { 0.75 } else { 1.0 };
                    self.light[pixel] = mix(self.light[pixel], light * vein, cover);
                    self.coverage[pixel] = self.coverage[pixel].max(cover);
                }
            }
        }
    }

    fn texture(&self, edge: u32) -> Texture {
        let byte = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
        let pixel =
            |(&cover, &light): (&f64, &f64)| [byte(0.55 * light), byte(0.72 * light), byte(0.34 * light), byte(cover)];
        let rgba = self.coverage.iter().zip(&self.light).flat_map(pixel).collect();
        Texture { width: edge, height: edge, rgba, wrap: [Wrap::Clamp; 2], filter: TextureFilter::Linear }
    }
}
