//! Why a light keeps Bevy's own cascades.

use bevy_ecs::entity::Entity;

/// Why a light's cascades are not planned. The light keeps the cascades that Bevy gave it, and the
/// error is logged once.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The config has more splits than Bevy has cascades.
    #[error("{given} splits, but Bevy draws {most} cascades at most; give {most} map sizes or fewer")]
    TooManySplits {
        /// Splits of the config.
        given: usize,
        /// Cascades that Bevy draws: 4, or 1 in WebGL2.
        most: usize,
    },
    /// The light is volumetric.
    #[error(
        "a VolumetricLight is asked for shadows in the air, where planned maps have none: they are \
         fitted to surfaces; remove VolumetricLight, or add BevyCascades to keep this quiet"
    )]
    Volumetric,
    /// A camera's transform scales or skews.
    #[error(
        "camera {camera} is scaled by {scale}, which changes what its view depths mean; give it and \
         its parents a scale of 1"
    )]
    ScaledCamera {
        /// The camera.
        camera: Entity,
        /// The factor along the axis that is scaled most.
        scale: f32,
    },
    /// The planner refused a camera.
    #[error("camera {camera}: {reason}")]
    Camera {
        /// The camera.
        camera: Entity,
        /// What the planner refused.
        reason: umbrage::Error,
    },
    /// The planner refused the config, the light or the scene.
    #[error(transparent)]
    Planner(#[from] umbrage::Error),
}
