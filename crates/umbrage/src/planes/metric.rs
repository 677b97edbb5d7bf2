//! Measure of the planes between splits: view depth, or distance from the camera.

use glam::DVec3;

use crate::config::SplitMetric;
use crate::{Error, Projection, Result, View};

impl SplitMetric {
    /// Least ratio of view depth to the measure of planes for any point in view. For distances it
    /// is the cosine of the angle between the line of sight and the farthest corner, which in an
    /// off-axis view need not have an opposite corner.
    pub(crate) fn least_depth_share(self, view: &View) -> f64 {
        let f = view.frustum();
        match self {
            Self::ViewDepth => 1.0,
            Self::Distance => {
                DVec3::new(f.left.abs().max(f.right.abs()), f.bottom.abs().max(f.top.abs()), 1.0).length_recip()
            }
        }
    }

    /// Refuses distances for a camera without an eye.
    pub(crate) fn check_view(self, view: &View) -> Result<()> {
        if self == Self::Distance && view.frustum().projection == Projection::Orthographic {
            return Err(Error::CameraConflict {
                setting: "bands",
                reason: "an orthographic camera has no eye to measure distances from; \
                         use bands planar, or a perspective camera"
                    .to_owned(),
            });
        }
        Ok(())
    }
}
