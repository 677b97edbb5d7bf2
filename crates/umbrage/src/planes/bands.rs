//! What the borders of splits measure: view depth, or distance from the eye.

use crate::{Error, Projection, Result, View};

/// The shape of the borders between splits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bands {
    /// Planes across the line of sight: a point's split follows from its view depth.
    #[default]
    Planar,
    /// Spheres around the eye: a point's split follows from its distance to the eye, so that a camera that only turns changes no point's
    /// split. All depths of the settings and the plan that planar bands take for view depths are then distances, except for
    /// [`crate::Split::coverage`]. Maps are as much larger as the corners of the view are nearer in view depth than in distance. Needs a
    /// perspective camera and a directional light; excludes [`crate::RangeFit::Visible`] (which follows the line of sight) and
    /// [`crate::Selection::Map`] (which has no bands).
    Radial,
}

impl Bands {
    /// View depth over distance from the eye, at least, of anything that the view shows: the cosine of the angle between the line of sight
    /// and the farthest corner, which need not be opposite to another in an off-axis view. 1 for planar bands.
    pub(crate) fn least_depth_share(self, view: &View) -> f64 {
        let f = view.frustum();
        match self {
            Self::Planar => 1.0,
            Self::Radial => 1.0 / f.left.abs().max(f.right.abs()).hypot(f.bottom.abs().max(f.top.abs())).hypot(1.0),
        }
    }

    /// Radial bands need an eye.
    pub(crate) fn check_view(self, view: &View) -> Result<()> {
        if self == Self::Radial && view.frustum().projection == Projection::Orthographic {
            return Err(Error::ConflictingSettings {
                first: "bands",
                second: "camera",
                reason: "an orthographic camera has no eye to measure distances from; \
                         set bands to Planar, or use a perspective camera"
                    .to_owned(),
            });
        }
        Ok(())
    }
}
