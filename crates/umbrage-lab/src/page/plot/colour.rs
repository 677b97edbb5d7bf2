//! One palette for every chart, in a light and a dark form.

use std::fmt::Write;

/// A colour by its meaning. Each has a form for light paper, which the SVG contains, and one for
/// dark paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Main text and outlines.
    Ink,
    /// Axis labels, captions.
    Quiet,
    /// Grid lines.
    Grid,
    /// Background, to interrupt lines where they cross.
    Paper,
    /// Colour of the n-th of several series, such as techniques. There are eight, then they repeat;
    /// they are readable for the colour-blind (after Okabe and Ito).
    Series(usize),
    /// Colour of a split, nearest first, in the order of the renderer's tints (red, green, blue,
    /// yellow, …).
    Split(usize),
    /// Step `.0` of a ramp of `.1` steps, for ordered values such as a number of splits.
    Step(usize, usize),
}

type Pair = (u32, u32);

const INK: Pair = (0x20242B, 0xE8EAEE);
const QUIET: Pair = (0x626B79, 0x9AA4B2);
const GRID: Pair = (0xE3E6EB, 0x343A44);
const PAPER: Pair = (0xFFFFFF, 0x1B1F26);
const SERIES: [Pair; 8] = [
    (0x0072B2, 0x4FB0E8),
    (0xD55E00, 0xFF8A3D),
    (0x009E73, 0x2FC99B),
    (0xB0478F, 0xE583C3),
    (0xB98900, 0xE6B93A),
    (0x4A4FBF, 0x8F94F5),
    (0x8A5A3C, 0xC99872),
    (0x6F7680, 0xA7AFBA),
];
const SPLITS: [Pair; 8] = [
    (0xD13B3B, 0xFF7A7A),
    (0x2E9140, 0x63D177),
    (0x2F62C9, 0x7BA5FF),
    (0xC29A00, 0xF2D24B),
    (0xB83BB8, 0xF07CF0),
    (0x13949A, 0x55D9DF),
    (0xD97A16, 0xFFAD57),
    (0x7548D6, 0xB392FF),
];
const RAMP: [Pair; 8] = [
    (0xE9A23B, 0xFFC766),
    (0xDD7F33, 0xF7A15A),
    (0xCB5C3F, 0xEE7F62),
    (0xB04156, 0xE06A86),
    (0x8C3169, 0xCB68AC),
    (0x672872, 0xAD70CB),
    (0x442370, 0x8C80E3),
    (0x1F2260, 0x7396F0),
];

impl Colour {
    fn pair(self) -> Pair {
        match self {
            Self::Ink => INK,
            Self::Quiet => QUIET,
            Self::Grid => GRID,
            Self::Paper => PAPER,
            Self::Series(i) => SERIES[i % SERIES.len()],
            Self::Split(i) => SPLITS[i % SPLITS.len()],
            Self::Step(i, of) => {
                let last = RAMP.len() - 1;
                RAMP[if of > 1 { (i * last + (of - 1) / 2) / (of - 1) } else { 0 }.min(last)]
            }
        }
    }

    /// Returns the colour on light paper as `#rrggbb`.
    #[must_use]
    pub fn hex(self) -> String {
        format!("#{:06x}", self.pair().0)
    }
}

/// Returns CSS rules that recolour the charts below `selector` for dark paper. They override the
/// SVG's own attributes.
#[must_use]
pub fn dark_style(selector: &str) -> String {
    let mut css = String::new();
    for (light, dark) in [INK, QUIET, GRID, PAPER].iter().chain(&SERIES).chain(&SPLITS).chain(&RAMP) {
        for attribute in ["fill", "stroke"] {
            // Writing to a string cannot fail.
            let _ = writeln!(css, "{selector} [{attribute}=\"#{light:06x}\"]{{{attribute}:#{dark:06x}}}");
        }
    }
    css
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn a_light_colour_has_one_dark_form() {
        let all: Vec<Pair> = [INK, QUIET, GRID, PAPER].into_iter().chain(SERIES).chain(SPLITS).chain(RAMP).collect();
        let light: HashSet<u32> = all.iter().map(|pair| pair.0).collect();
        assert_eq!(light.len(), all.len(), "the CSS could not tell two equal colours apart");
    }

    #[test]
    fn a_ramp_spans_its_ends() {
        assert_eq!(Colour::Step(0, 7).pair(), RAMP[0]);
        assert_eq!(Colour::Step(6, 7).pair(), RAMP[7]);
        assert_eq!(Colour::Step(0, 1).pair(), RAMP[0]);
        let steps: HashSet<Pair> = (0..7).map(|i| Colour::Step(i, 7).pair()).collect();
        assert_eq!(steps.len(), 7);
    }
}
