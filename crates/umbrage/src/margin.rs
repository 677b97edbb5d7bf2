//! How many texels a map keeps free around what it serves.

use crate::ShadowSettings;

/// Texels that a map keeps free besides the filter's reach: half for the texel that a sample's rounding may choose, one for the
/// normal offset of the receiver's bias.
pub(crate) const EDGE_TEXELS: f64 = 1.5;

/// Texels beyond a kernel's half width that its outermost taps read.
const TAP: f64 = 1.0;

/// The fewest texels that a filter of known metres is given: that of a disc three texels wide, which such a filter falls back to where
/// depth cannot be loaded.
const LEAST_REACH: f64 = 4.0;

/// How far a filter reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach {
    /// Texels, at most.
    most: f64,
    /// Half width of its kernel in metres, if that is known.
    metres: Option<f64>,
}

impl Reach {
    pub fn of(settings: &ShadowSettings) -> Self {
        Self { most: settings.filter_radius, metres: settings.filter_half_width_m }
    }

    /// That of maps whose texels differ in size: the most.
    pub fn most(settings: &ShadowSettings) -> Self {
        Self { metres: None, ..Self::of(settings) }
    }

    /// Texels around the sample in a map of `size` texels whose shorter edge has to show `edge` metres; `spare` texels of that edge are for
    /// neither.
    ///
    /// With a kernel of half width h the edge takes e + 2 h metres and 2 + spare texels, so a texel is (e + 2 h) / (size − 2 − spare) and the
    /// reach 1 + h / texel, unless that is more than the filter's most: then it is that, and the filter narrower than asked for.
    pub fn texels(self, edge: f64, size: u32, spare: f64) -> f64 {
        let Some(half_width) = self.metres else { return self.most };
        let texel = (edge + 2.0 * half_width) / (f64::from(size) - 2.0 * TAP - spare);
        (half_width / texel + TAP).max(LEAST_REACH).min(self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::Reach;

    #[test]
    fn a_known_width_takes_as_many_texels_as_it_is_wide() {
        let reach = Reach { most: 16.0, metres: Some(0.5) };
        for edge in [1.0, 20.0, 37.0, 80.0, 300.0, 1e5] {
            let texels = reach.texels(edge, 512, 3.0);
            let texel = edge / (512.0 - 2.0 * texels - 3.0);
            let wanted = 0.5 / texel + 1.0;
            assert!((4.0..=16.0).contains(&texels), "{texels}");
            let is_solved = (texels - wanted).abs() < 1e-9;
            assert!(
                is_solved || (texels == 16.0 && wanted > 16.0) || (texels == 4.0 && wanted < 4.0),
                "{edge}: {wanted}"
            );
        }
        assert_eq!(Reach { most: 16.0, metres: None }.texels(20.0, 512, 3.0), 16.0);
        assert_eq!(Reach { most: 1.5, metres: Some(0.5) }.texels(20.0, 512, 3.0), 1.5);
    }
}
