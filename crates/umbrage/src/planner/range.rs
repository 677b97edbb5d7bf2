//! Stage 1 of a sun's plan: the shadowed range, `C_0` and `C_m`.

use super::frame::Frame;
use super::scope::{Extent, Scope};
use crate::config::check_range;
use crate::config::{self, SplitMetric, Stability};
use crate::held::ends::{HeldEnds, Range};
use crate::planes::visible::visible_range;
use crate::{Projection, Result, maths};

/// The least length of a range that is fitted to visible receivers, as a share of its far end.
const LEAST_RANGE: f64 = 0.01;

/// Ratio of far to near above which a range that is fitted to visible receivers ends with the
/// shadows, too. With a lower value the range of ordinary views follows their casters; with a
/// higher one grounds of kilometres take texels and depth from the objects on them.
const MOST_OF_FIRST: f64 = 300.0;

/// The range of a frame: the setting; the view depths of the visible receivers; or the camera's
/// near and far, with far capped by the relevant scene. Held if maps have to stand still.
///
/// # Errors
/// [`crate::Error::InvalidSetting`] naming `shadow-range` if it is empty for this camera, even with
/// nothing held.
pub(super) fn shadowed(frame: &Frame<'_>, scope: &Scope<'_>, held: &mut HeldEnds) -> Result<Range> {
    let range = held_range(frame, scope, held);
    if check_range(range.near, range.inner_far).is_ok() {
        return Ok(range);
    }
    // A range that cannot be divided is not held on to.
    *held = HeldEnds::default();
    let range = held_range(frame, scope, held);
    check_range(range.near, range.inner_far)?;
    Ok(range)
}

fn held_range(frame: &Frame<'_>, scope: &Scope<'_>, held: &mut HeldEnds) -> Range {
    let Frame { config, view, receivers, .. } = *frame;
    if let config::Range::Metres { near, far } = config.range {
        return Range::new(near, far);
    }
    let metric = config.selection.metric();
    let fits_view = config.range == config::Range::Visible;
    let (near, camera_far) = (view.frustum().near, view.frustum().far / metric.least_depth_share(view));
    let extent = (!fits_view).then(|| scope.extent());
    let deepest = match (&extent, metric) {
        (None, _) => scope.deepest_receiver(),
        (Some(extent), SplitMetric::ViewDepth) => extent.deepest,
        (Some(extent), SplitMetric::Distance) => extent.farthest,
    };
    // Nothing before the eye: any short range will do.
    let deepest = if deepest > near { deepest } else { 2.0 * near.abs() + 1.0 };
    let deepest = deepest.min(camera_far);
    if fits_view && let Some((first, last)) = visible_range(view, near, deepest, &receivers) {
        let last = if last > MOST_OF_FIRST * first.abs().max(near.abs()) {
            // A ground up to the horizon: no farther than there are shadows on it.
            let extent = scope.extent();
            let ends = if metric == SplitMetric::Distance { extent.farthest } else { extent.deepest };
            last.min(ends).max(first)
        } else {
            last
        };
        let holds = config.is_stabilised() && first > 0.0;
        let (first, last) = if holds { held.visible.hold(first, last) } else { (first, last) };
        // A single wall that faces the camera still gets slices of some depth.
        let first = first.max(near).min(last * (1.0 - LEAST_RANGE));
        return Range::new(first, last.min(camera_far));
    }
    let extent = extent.unwrap_or_else(|| scope.extent());
    let near = first_shown(frame, &extent, deepest, held);
    let range = match config.stability {
        // Almost still maps are held by their own extents, whatever the planes: a range that is
        // held as well would only make them larger, by 8 % in the second of four splits, and saves
        // no step.
        Stability::Tight { .. } | Stability::Approximate { .. } => Range::new(near, deepest),
        Stability::Exact => held.far.hold(near, deepest, extent.farthest.min(camera_far)),
    };
    Range { near, inner_far: range.inner_far.min(camera_far), far: range.far.min(camera_far) }
}

/// Begin of the range: with the camera; or, for an orthographic camera, with the scene, as near as
/// turning can bring it. The distance of such a camera does not change its image.
fn first_shown(frame: &Frame<'_>, extent: &Extent, deepest: f64, held: &mut HeldEnds) -> f64 {
    let frustum = frame.view.frustum();
    if frustum.projection == Projection::Perspective {
        return frustum.near;
    }
    let aside = maths::hypot(frustum.left.abs().max(frustum.right.abs()), frustum.bottom.abs().max(frustum.top.abs()));
    let first = (extent.nearest * extent.nearest - aside * aside).max(0.0).sqrt();
    if first <= frustum.near {
        return frustum.near;
    }
    held.hold_near(frustum.near, first.min(deepest), deepest)
}
