//! Position of the sun: the scene's own, one set by hand, or that of a date, an hour and a place.
//!
//! North is −Z and east is +X.

use glam::{DVec2, DVec3};
use solar_positioning::{Location, SolarPositions, delta_t, time::JulianDate};
use umbrage::DirectionalLight;

/// Degrees that the sun moves while the pointer crosses the picture's height.
const DEGREES_PER_HEIGHT: f64 = 120.0;

/// Position of the sun in the sky, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyPoint {
    /// Bearing from north over east.
    pub bearing: f64,
    /// Elevation above the horizon.
    pub elevation: f64,
}

impl SkyPoint {
    /// Returns the position of a sun whose light travels in direction `travel`.
    #[must_use]
    pub fn of_travel(travel: DVec3) -> Self {
        let to_sun = -travel.normalize_or_zero();
        let bearing = to_sun.x.atan2(-to_sun.z).to_degrees().rem_euclid(360.0);
        Self { bearing, elevation: to_sun.y.clamp(-1.0, 1.0).asin().to_degrees() }
    }

    /// Returns the unit vector along which light travels from here.
    #[must_use]
    pub fn travel(&self) -> DVec3 {
        let (up, across) = self.elevation.to_radians().sin_cos();
        let (east, north) = self.bearing.to_radians().sin_cos();
        -DVec3::new(east * across, up, -north * across)
    }

    /// Returns the position after a drag of so many picture heights to the right and down.
    #[must_use]
    pub fn dragged(&self, by: DVec2) -> Self {
        Self {
            bearing: (self.bearing + by.x * DEGREES_PER_HEIGHT).rem_euclid(360.0),
            elevation: (self.elevation - by.y * DEGREES_PER_HEIGHT).clamp(0.5, 90.0),
        }
    }
}

/// A date, an hour and a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Almanac {
    /// Year, month from 1, and day from 1.
    pub date: (i32, u32, u32),
    /// Hours of Universal Time since midnight, 0 to 24.
    pub hour: f64,
    /// Latitude in degrees north.
    pub latitude: f64,
    /// Longitude in degrees east.
    pub longitude: f64,
}

impl Default for Almanac {
    /// Returns a summer afternoon in Vienna.
    fn default() -> Self {
        Self { date: (2026, 6, 21), hour: 14.0, latitude: 48.21, longitude: 16.37 }
    }
}

impl Almanac {
    /// Computes the position of the sun, without the refraction of the air.
    ///
    /// # Errors
    /// The fault of the date or the place, for users.
    pub fn sky_point(&self) -> Result<SkyPoint, String> {
        let (year, month, day) = self.date;
        let minutes = (self.hour.clamp(0.0, 23.999_9) * 60.0).floor();
        let seconds = (self.hour.clamp(0.0, 23.999_9) * 3600.0 - minutes * 60.0).clamp(0.0, 59.999);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1439 minutes")]
        let minutes = minutes as u32;
        let wrong = |error: &dyn std::fmt::Display| format!("{year}-{month:02}-{day:02}: {error}");
        let delta_t = delta_t::estimate_from_date(year, month).map_err(|error| wrong(&error))?;
        let time = JulianDate::from_utc(year, month, day, minutes / 60, minutes % 60, seconds, delta_t)
            .map_err(|error| wrong(&error))?;
        let place = Location { latitude: self.latitude, longitude: self.longitude };
        let at = SolarPositions::new().at_from_julian(time, place, 0.0, None).map_err(|error| error.to_string())?;
        Ok(SkyPoint { bearing: at.azimuth(), elevation: at.elevation_angle() })
    }
}

/// Choice of the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sun {
    /// The sun of the scene, or of the command line.
    #[default]
    OfScene,
    /// A sun set by hand.
    ByHand(SkyPoint),
    /// The sun of a date, an hour and a place.
    ByDate(Almanac),
}

impl Sun {
    /// Returns the sun, if it is not the scene's.
    ///
    /// # Errors
    /// The reason why there is none: it is night, or the date is invalid.
    pub fn light(&self) -> Result<Option<DirectionalLight>, String> {
        let point = match self {
            Self::OfScene => return Ok(None),
            Self::ByHand(point) => *point,
            Self::ByDate(almanac) => {
                let point = almanac.sky_point()?;
                if point.elevation <= 0.0 {
                    return Err(format!(
                        "the sun stands {:.1}° below the horizon at that hour; the scene keeps its last sun",
                        -point.elevation
                    ));
                }
                point
            }
        };
        DirectionalLight::new(point.travel()).map(Some).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_sky_are_directions() {
        for (bearing, elevation) in [(0.0, 10.0), (90.0, 45.0), (215.0, 89.0), (359.0, 0.5)] {
            let there = SkyPoint::of_travel(SkyPoint { bearing, elevation }.travel());
            assert!((there.bearing - bearing).abs() < 1e-9 && (there.elevation - elevation).abs() < 1e-9, "{there:?}");
        }
        // From the east, light travels west.
        assert!((SkyPoint { bearing: 90.0, elevation: 0.0 }.travel() - DVec3::NEG_X).length() < 1e-12);
        let dragged = SkyPoint { bearing: 350.0, elevation: 80.0 }.dragged(DVec2::new(0.25, -3.0));
        assert_eq!((dragged.bearing, dragged.elevation), (20.0, 90.0));
    }

    #[test]
    fn the_sun_is_where_almanacs_say() {
        // Solstice in Vienna: 65.2° high at local noon, which is 12:00 − 16.37° / 15° an hour + 2
        // min.
        let noon = Almanac { hour: 12.0 - 16.37 / 15.0 + 0.03, ..Almanac::default() }.sky_point().expect("a day");
        assert!((noon.elevation - (90.0 - 48.21 + 23.44)).abs() < 0.05, "{noon:?}");
        assert!((noon.bearing - 180.0).abs() < 0.7, "{noon:?}");
        // An equinox morning at the equator: due east on the horizon.
        let morning = Almanac { date: (2026, 3, 20), hour: 6.12, latitude: 0.0, longitude: 0.0 };
        let morning = morning.sky_point().expect("a day");
        assert!((morning.bearing - 90.0).abs() < 0.5 && morning.elevation.abs() < 0.5, "{morning:?}");
    }

    #[test]
    fn night_and_days_that_are_none_say_so() {
        let night = Sun::ByDate(Almanac { hour: 23.0, ..Almanac::default() }).light().expect_err("night");
        assert!(night.contains("below the horizon"), "{night}");
        for almanac in [
            Almanac { date: (2026, 13, 1), ..Almanac::default() },
            Almanac { date: (2026, 2, 40), ..Almanac::default() },
            Almanac { latitude: 91.0, ..Almanac::default() },
            Almanac { longitude: f64::NAN, ..Almanac::default() },
        ] {
            assert!(Sun::ByDate(almanac).light().is_err(), "{almanac:?}");
        }
        assert_eq!(Sun::OfScene.light(), Ok(None));
    }
}
