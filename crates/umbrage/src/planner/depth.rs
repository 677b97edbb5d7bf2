//! Stage 6 of a sun's plan: depth ranges.

use glam::DVec3;

use super::fit::MapSize;
use super::frame::{Frame, Sun};
use super::layout::Layout;
use super::scope::Scope;
use super::shaft::{Shaft, first_depth};
use crate::Split;
use crate::bounds::Placed;
use crate::casters::Most;
use crate::config::Cache;
use crate::held::depths::HeldDepths;
use crate::maths;

/// Range of depths along the light of stabilised maps whose depth is not clamped, in metres; `None`
/// if nothing determines it.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldDepths(Option<(f64, f64)>);

/// Most lengths of the shadowed region to which a depth range may extend for the whole world. A
/// longer range would cost precision: 32-bit depth resolves 1/8,000,000 of the range.
const MOST_LENGTHS: f64 = 16.0;

impl WorldDepths {
    /// The range from the first caster to the last receiver: of the whole world, or of the region
    /// near the camera if the world is much larger.
    pub fn measure(
        frame: &Frame<'_>,
        sun: &Sun<'_>,
        scope: &Scope<'_>,
        layout: &Layout,
        held: &mut HeldDepths,
    ) -> Self {
        if !frame.stands_still() || frame.depth_clamp {
            return Self(None);
        }
        let direction = sun.direction;
        let near = -frame.casters.most(|c| -first_depth(c, direction));
        let far = frame.receivers.most(|r| -first_depth(r, -direction));
        if !(near.is_finite() && far > near) {
            return Self(None);
        }
        let shaft = around_view(frame, sun, layout);
        if far - near <= MOST_LENGTHS * shaft.half {
            // What is kept would be lost with every caster that leaves the range.
            let is_kept = frame.config.cache == Cache::Kept;
            return Self(Some(if is_kept { held.hold(near, far) } else { (near, far) }));
        }
        // Of a receiver nothing is asked that lies farther from the eye than the range goes.
        let end = |r: &Placed| shaft.passage(r).filter(|_| scope.matters(r)).map(|it| it.1);
        let far = frame.receivers.most(|r| end(r).unwrap_or(f64::NEG_INFINITY));
        let far = far.min(shaft.depth(0.0) + shaft.half);
        let begin = |c: &Placed| shaft.passage(c).map(|it| it.0).filter(|begin| *begin < far);
        let near = -frame.casters.most(|c| -begin(c).unwrap_or(f64::INFINITY));
        let near = near.min(shaft.depth(0.0) - shaft.half);
        Self((far > near).then(|| held.hold(near, far)))
    }
}

/// The shaft around everything that the view can show in range, whichever way it turns.
fn around_view(frame: &Frame<'_>, sun: &Sun<'_>, layout: &Layout) -> Shaft {
    let far = layout.planes().last().copied().unwrap_or_default().min(frame.view.frustum().far);
    let corner = layout.lens.frustum().corners_at(far).map(DVec3::length).into_iter().fold(0.0, f64::max);
    Shaft::new(frame.view.eye(), corner, sun.light)
}

/// The split with its depth range: from before the first caster to behind the last receiver, with
/// room for the bias. If depth is clamped, the range begins at the first receiver. A stabilised
/// split has the world's bounds (or, clamped, its own block's) in whole steps, so that stored
/// depths do not depend on the camera's position.
pub(super) fn ranged(frame: &Frame<'_>, mut split: Split, first: f64, size: &MapSize, world: WorldDepths) -> Split {
    let (texel, radius) = (split.texel_m.max_element(), size.half.max_element());
    let own = (split.depth_near, split.depth_far);
    let ((near, far), step) = match (frame.stands_still(), frame.depth_clamp) {
        (false, true) => (own, None),
        (false, false) => ((own.0.min(first), own.1), None),
        (true, true) => (own, Some(0.5 * radius)),
        (true, false) => {
            let (near, far) = world.0.unwrap_or(own);
            ((near, far), Some((far - near) / 16.0))
        }
    };
    // Finer steps would move more often, and with them what leaks.
    let receivers = frame.stands_still().then_some(radius / 8.0);
    let (begin, end) = split.receiver_depths;
    split.receiver_depths = with_room(begin, end, texel, receivers);
    (split.depth_near, split.depth_far) = with_room(near, far, texel, step);
    split
}

/// A range of depths with room for the bias, in whole steps if there is one.
fn with_room(near: f64, far: f64, texel: f64, step: Option<f64>) -> (f64, f64) {
    let room = 4.0 * texel + 1e-4 * (far - near);
    let (near, far) = (near - room, far + room);
    let Some(step) = step else { return (near, far) };
    let step = maths::exp2(maths::log2(step).round());
    ((near / step).floor() * step, (far / step).ceil() * step)
}
