//! Margins: texels that a map keeps free around the points that it serves.

use crate::{Error, Result};

/// Texels that a map keeps free besides the filter's reach: half a texel for the rounding of a
/// sample, and one to spare.
pub(crate) const EDGE_TEXELS: f64 = 1.5;

/// Texels beyond a kernel's half width that its outermost taps read.
const TAP: f64 = 1.0;

/// Least reach in texels of a filter of known width in metres: that of a disc three texels wide, to
/// which such a filter falls back where depth cannot be loaded.
const LEAST_REACH: f64 = 4.0;

/// Reach of a filter around the sample. Every map keeps a margin of this size around the points
/// that it serves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterReach {
    /// Reach in texels, 0 to 64: 0.5 for one nearest texel, 1 for a bilinear comparison, 1.5 and
    /// 2.5 for tents of 3 and 5.
    pub radius_texels: f64,
    /// Half the width of the filter's kernel in metres, up to 1000 km, if it is known. Splits in
    /// which this is less than `radius_texels` keep a margin of as many metres, and of at least 4
    /// texels ([`crate::Split::filter_radius_texels`]). With `None` all splits keep
    /// `radius_texels`. Warped maps and those of local lights always do.
    pub radius_m: Option<f64>,
}

impl FilterReach {
    /// Checks the values, and that maps of these edges in texels have room for the margins.
    pub(crate) fn check(self, map_sizes: &[u32], is_stabilised: bool) -> Result<()> {
        let Self { radius_texels: radius, radius_m } = self;
        if !(0.0..=64.0).contains(&radius) {
            return Err(Error::setting("radius_texels", format!("{radius} texels; give 0 to 64")));
        }
        if let Some(radius) = radius_m.filter(|metres| !(0.0..=1e6).contains(metres)) {
            return Err(Error::setting("radius_m", format!("{radius} m; give 0 to 1000 km")));
        }
        let least = self.least_map_size(is_stabilised);
        match map_sizes.iter().position(|&size| size < least) {
            Some(map) => {
                let size = map_sizes[map];
                let reason =
                    format!("map {map} is {size} texels wide; give {least} to 65536 with a filter of {radius} texels");
                Err(Error::setting("map-size", reason))
            }
            None => Ok(()),
        }
    }

    /// Edge in texels of the smallest map with room for the filter's margins, one texel beside
    /// them, and one for moving in whole texels.
    pub(crate) fn least_map_size(self, is_stabilised: bool) -> u32 {
        let moving = if is_stabilised { 5.0 } else { 4.0 };
        (2.0 * self.radius_texels + moving).ceil() as u32
    }

    /// The reach for maps whose texels differ in size: the largest.
    pub(crate) fn most(self) -> Self {
        Self { radius_m: None, ..self }
    }

    /// Reach in texels in a map of `size` texels whose shorter edge has to show `edge` metres;
    /// `spare` texels of that edge serve neither.
    ///
    /// With a kernel of radius r the edge takes e + 2 r metres and 2 + spare texels. A texel is
    /// thus (e + 2 r) / (size − 2 − spare), and the reach 1 + r / texel. If that exceeds
    /// `radius_texels`, the reach is `radius_texels` and the filter is narrower than given.
    pub(crate) fn texels(self, edge: f64, size: u32, spare: f64) -> f64 {
        let Some(radius) = self.radius_m else { return self.radius_texels };
        let texel = (edge + 2.0 * radius) / (f64::from(size) - 2.0 * TAP - spare);
        (radius / texel + TAP).max(LEAST_REACH).min(self.radius_texels)
    }
}

#[cfg(test)]
mod tests {
    use super::FilterReach;

    #[test]
    fn a_known_width_takes_as_many_texels_as_it_is_wide() {
        let reach = FilterReach { radius_texels: 16.0, radius_m: Some(0.5) };
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
        assert_eq!(FilterReach { radius_texels: 16.0, radius_m: None }.texels(20.0, 512, 3.0), 16.0);
        assert_eq!(FilterReach { radius_texels: 1.5, radius_m: Some(0.5) }.texels(20.0, 512, 3.0), 1.5);
    }
}
