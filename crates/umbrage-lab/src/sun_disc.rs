//! The sun's disc as the judge samples it.

use umbrage_truth::SunDisc;

/// Directions by which a sun with a size is looked at.
const SOFT_SAMPLES: u32 = 256;

/// The sun's disc of an angle in degrees; a sun of 0 degrees is a point and casts hard shadows.
#[must_use]
pub fn sun_disc(degrees: f64) -> Option<SunDisc> {
    (degrees > 0.0).then(|| SunDisc::new(degrees.to_radians(), SOFT_SAMPLES))
}
