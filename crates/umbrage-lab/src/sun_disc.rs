//! The sun's disc as the judge samples it.

use umbrage_truth::SunDisc;

/// Number of directions towards a sun with a size.
const SOFT_SAMPLES: u32 = 256;

/// Returns the sun's disc of an angle in degrees; `None` for 0 degrees, a point that casts hard
/// shadows.
#[must_use]
pub fn sun_disc(degrees: f64) -> Option<SunDisc> {
    (degrees > 0.0).then(|| SunDisc::new(degrees.to_radians(), SOFT_SAMPLES))
}
