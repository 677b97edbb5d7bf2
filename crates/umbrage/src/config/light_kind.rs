//! Kinds of lights, which a config is checked for.

use crate::Light;

/// Kind of a light that casts shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightKind {
    /// A sun: parallel light.
    #[default]
    Directional,
    /// A cone of light from a point.
    Spot,
    /// Light from a point in all directions: six faces of a cube.
    Point,
}

impl LightKind {
    /// Number of sets of [`crate::ShadowConfig::map_sizes`] maps: 6 for a point light, otherwise 1.
    #[must_use]
    pub const fn faces(self) -> usize {
        match self {
            Self::Directional | Self::Spot => 1,
            Self::Point => 6,
        }
    }

    /// Returns whether the light has a position, as spot and point lights do.
    #[must_use]
    pub const fn is_local(self) -> bool {
        !matches!(self, Self::Directional)
    }
}

impl From<Light> for LightKind {
    fn from(light: Light) -> Self {
        match light {
            Light::Directional(_) => Self::Directional,
            Light::Spot(_) => Self::Spot,
            Light::Point(_) => Self::Point,
        }
    }
}
