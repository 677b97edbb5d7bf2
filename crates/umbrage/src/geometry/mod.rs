//! Convex pieces of space and their bounds, as the light and the camera see them.

pub(crate) mod light_frustum;
pub(crate) mod limits;
pub(crate) mod receiver_mask;
pub(crate) mod region;
pub(crate) mod sphere;
pub(crate) mod volume;
