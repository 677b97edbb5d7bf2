//! What a map covers, for maps that are chosen by what they contain: its square along the light, less what earlier maps take.

use glam::{DVec2, DVec3};

use crate::Split;

/// Texels beyond the filter's reach by which a caster may be off, for the rounding of a sample's place.
const ROUNDING_TEXELS: f64 = 1.0;

/// The rectangle of a box in a plain map, in texels.
fn rectangle(split: &Split, center: DVec3, half: DVec3) -> (DVec2, DVec2) {
    let middle = DVec2::new(split.u_axis.dot(center), split.v_axis.dot(center)) / split.texel_m - split.min_texel;
    let reach = DVec2::new(split.u_axis.abs().dot(half), split.v_axis.abs().dot(half)) / split.texel_m;
    (middle - reach, middle + reach)
}

/// Whether a box can leave a mark on the map.
pub(crate) fn reaches(split: &Split, center: DVec3, half: DVec3) -> bool {
    let (lo, hi) = rectangle(split, center, half);
    lo.cmple(DVec2::splat(f64::from(split.size) + ROUNDING_TEXELS)).all()
        && hi.cmpge(DVec2::splat(-ROUNDING_TEXELS)).all()
}

/// What the maps before one take away from it.
pub(crate) struct Taken<'a> {
    earlier: &'a [Split],
    /// Texels that a filter reaches around a sample of the map that is planned, rounding included.
    pub margin: f64,
    /// Share of a map's half edge over which it asks the next one, too.
    blend: f64,
    /// The same margin in the map that is planned, metres.
    reach_m: f64,
}

impl<'a> Taken<'a> {
    pub fn new(split: &Split, earlier: &'a [Split], blend: f64) -> Self {
        let margin = split.filter_reach + ROUNDING_TEXELS;
        Self { earlier, margin, blend, reach_m: margin * split.texel_m.max_element() }
    }

    /// Whether all points that a box can shade belong to one earlier map, filter and blend band included: what shades them lies at
    /// the same place of that map.
    pub fn holds(&self, center: DVec3, half: DVec3) -> bool {
        self.earlier.iter().filter(|split| !split.casters.is_empty()).any(|split| {
            let (lo, hi) = rectangle(split, center, half);
            let size = f64::from(split.size);
            let room = split.filter_reach
                + ROUNDING_TEXELS
                + 0.5 * self.blend * size
                + self.reach_m / split.texel_m.min_element();
            lo.cmpge(DVec2::splat(room)).all() && hi.cmple(DVec2::splat(size - room)).all()
        })
    }
}
