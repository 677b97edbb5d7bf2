//! Lights, and the axes of their maps.

use glam::DVec3;

use crate::bounds::MOST_METRES;
use crate::{Error, Result, maths};

/// Share of a local light's range that is its default near distance: the glass of a lamp casts no
/// shadow.
const NEAR_SHARE: f64 = 1.0 / 256.0;

/// The least range of a local light in metres.
const LEAST_RANGE: f64 = 1e-6;

/// The widest angle in radians between a spot light's axis and the rim of its cone: 85°. Not from a
/// paper: a map of the whole cone then covers 2 tan 85° = 23 times the distance, and a point light
/// is better for wider cones.
const WIDEST_CONE: f64 = 85.0 * std::f64::consts::PI / 180.0;

/// A sun: light that travels in one direction everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    direction: DVec3,
}

impl DirectionalLight {
    /// A sun from the direction in which its light travels (from the sun to the ground). The vector
    /// need not be normalised.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] if the vector is zero or not finite.
    pub fn new(direction: DVec3) -> Result<Self> {
        Ok(Self { direction: unit_direction(direction)? })
    }

    /// Direction in which the light travels, a unit vector in the world.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Axes of the light's maps, fixed to the light and never to the camera: unit vectors along u
    /// (right) and v (down). Together with [`DirectionalLight::direction`] (depth) they are a
    /// right-handed frame (u, v, depth).
    #[must_use]
    pub fn map_axes(&self) -> (DVec3, DVec3) {
        map_axes(self.direction)
    }
}

/// A spot light: light from a point into a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    position: DVec3,
    direction: DVec3,
    outer_angle: f64,
    range: f64,
    near: f64,
}

impl SpotLight {
    /// A light at `position` (world metres) that shines along `direction` (any length), up to
    /// `range` metres away and up to `outer_angle` radians from its axis: half of the cone's
    /// opening angle.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] naming the parameter: a position or direction that is not finite, a
    /// direction of length 0, an angle that is not in (0, 85°], a range outside 10^-6 to 10^12 m.
    pub fn new(position: DVec3, direction: DVec3, outer_angle: f64, range: f64) -> Result<Self> {
        if !(outer_angle > 0.0 && outer_angle <= WIDEST_CONE) {
            return Err(Error::light(
                "outer_angle",
                format!(
                    "{:.3}° from the axis; give more than 0° and at most 85°, or use a point light",
                    outer_angle.to_degrees()
                ),
            ));
        }
        let (position, range) = (place(position)?, reach(range)?);
        Ok(Self { position, direction: unit_direction(direction)?, outer_angle, range, near: range * NEAR_SHARE })
    }

    /// The light with another near distance in metres, within which nothing casts a shadow (such as
    /// its own lamp). The default is 1/256 of the range; a larger one makes the map's depth more
    /// precise.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] unless 0 < `near` < range.
    pub fn with_near(self, near: f64) -> Result<Self> {
        Ok(Self { near: distance_within(near, self.range)?, ..self })
    }

    /// Position of the light in world metres.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Axis of the cone, a unit vector.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Angle between the axis and the rim of the cone in radians.
    #[must_use]
    pub fn outer_angle(&self) -> f64 {
        self.outer_angle
    }

    /// Range of the light in metres.
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// Near distance along the axis in metres, within which nothing casts a shadow.
    #[must_use]
    pub fn near(&self) -> f64 {
        self.near
    }
}

/// A point light: light from a point in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: DVec3,
    range: f64,
    near: f64,
}

impl PointLight {
    /// A light at `position` (world metres) that shines up to `range` metres away.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] naming the parameter: a position beyond 10^12 m, a range outside
    /// 10^-6 to 10^12 m.
    pub fn new(position: DVec3, range: f64) -> Result<Self> {
        let (position, range) = (place(position)?, reach(range)?);
        Ok(Self { position, range, near: range * NEAR_SHARE })
    }

    /// The light with another near distance, as [`SpotLight::with_near`], along the axis of each
    /// face.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] unless 0 < `near` < range.
    pub fn with_near(self, near: f64) -> Result<Self> {
        Ok(Self { near: distance_within(near, self.range)?, ..self })
    }

    /// Position of the light in world metres.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Range of the light in metres.
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// Near distance along a face's axis in metres, within which nothing casts a shadow.
    #[must_use]
    pub fn near(&self) -> f64 {
        self.near
    }
}

/// A light of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// A sun: parallel light.
    Directional(DirectionalLight),
    /// A spot light: light from a point into a cone.
    Spot(SpotLight),
    /// A point light: light from a point in all directions.
    Point(PointLight),
}

impl Light {
    /// The axes of a point light's six faces, in the order of its faces: +X, −X, +Y, −Y, +Z, −Z.
    pub const FACE_AXES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

    /// Position of the light in world metres; `None` for a sun.
    #[must_use]
    pub fn position(&self) -> Option<DVec3> {
        match self {
            Self::Directional(_) => None,
            Self::Spot(light) => Some(light.position),
            Self::Point(light) => Some(light.position),
        }
    }

    /// Range of the light in metres; infinite for a sun.
    #[must_use]
    pub fn range(&self) -> f64 {
        match self {
            Self::Directional(_) => f64::INFINITY,
            Self::Spot(light) => light.range,
            Self::Point(light) => light.range,
        }
    }

    /// Number of maps that together show the light's whole surroundings: 6 for a point light, one
    /// for each face of a cube; otherwise 1. A plan has this many times the number of splits in its
    /// config.
    #[must_use]
    pub fn faces(&self) -> usize {
        match self {
            Self::Directional(_) | Self::Spot(_) => 1,
            Self::Point(_) => 6,
        }
    }

    /// Unit vector from a world point towards the light. At the position of a local light it is 0.
    #[must_use]
    pub fn to_light(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Directional(sun) => -sun.direction,
            Self::Spot(SpotLight { position, .. }) | Self::Point(PointLight { position, .. }) => {
                (*position - point).normalize_or_zero()
            }
        }
    }

    /// Returns whether a world point lies within the light's range and cone. No map is sampled for
    /// points outside.
    #[must_use]
    pub fn illuminates(&self, point: DVec3) -> bool {
        match self {
            Self::Directional(_) => true,
            Self::Spot(light) => {
                let from_light = point - light.position;
                let distance = from_light.length();
                distance <= light.range && light.direction.dot(from_light) >= maths::cos(light.outer_angle) * distance
            }
            Self::Point(light) => point.distance(light.position) <= light.range,
        }
    }

    /// Index of the face of a point light whose frustum contains a world point (see
    /// [`Light::FACE_AXES`]); 0 for other lights. On a border x comes before y and y before z, as
    /// in the WGSL.
    #[must_use]
    pub fn face_of(&self, point: DVec3) -> usize {
        let Self::Point(light) = self else { return 0 };
        let from_light = point - light.position;
        let size = from_light.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        2 * axis + usize::from(from_light[axis] < 0.0)
    }
}

impl From<DirectionalLight> for Light {
    fn from(light: DirectionalLight) -> Self {
        Self::Directional(light)
    }
}

impl From<SpotLight> for Light {
    fn from(light: SpotLight) -> Self {
        Self::Spot(light)
    }
}

impl From<PointLight> for Light {
    fn from(light: PointLight) -> Self {
        Self::Point(light)
    }
}

/// Unit vectors along u (right) and v (down) of a map whose depth axis is `direction`.
pub(crate) fn map_axes(direction: DVec3) -> (DVec3, DVec3) {
    // −Z is "up" for a light that comes straight down, so a map then has north on top.
    let up = if direction.y.abs() > 1.0 - 1e-6 { DVec3::NEG_Z } else { DVec3::Y };
    let u = direction.cross(up).normalize();
    (u, direction.cross(u))
}

fn unit_direction(direction: DVec3) -> Result<DVec3> {
    let length = direction.length();
    if length == 0.0 || !length.is_finite() {
        return Err(Error::light(
            "direction",
            format!(
                "{direction} has no direction; give the way the light travels as three finite numbers, not all zero"
            ),
        ));
    }
    Ok(direction / length)
}

fn place(position: DVec3) -> Result<DVec3> {
    if position.abs().cmple(DVec3::splat(MOST_METRES)).all() {
        return Ok(position);
    }
    Err(Error::light("position", format!("{position} is not a place; give three numbers within ±10^12 m")))
}

fn reach(range: f64) -> Result<f64> {
    if (LEAST_RANGE..=MOST_METRES).contains(&range) {
        return Ok(range);
    }
    Err(Error::light("range", format!("{range} m; give a distance of 10^-6 to 10^12 m, as far as the light shines")))
}

fn distance_within(near: f64, range: f64) -> Result<f64> {
    if near > 0.0 && near < range {
        return Ok(near);
    }
    Err(Error::light("near", format!("{near} m; give a distance greater than 0 and less than the range, {range} m")))
}
