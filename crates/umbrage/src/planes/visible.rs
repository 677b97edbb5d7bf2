//! The range of view depths in which a view shows receivers.

use crate::View;
use crate::casters::Most;
use crate::geometry::volume::{Lies, Slice};

/// Share of a depth by which the range exceeds the receivers, so that rounding to `f32` for the
/// shader leaves none outside.
const ROOM: f64 = 1e-4;

/// The range of view depths in which the view shows any of `receivers`, with a little room; `None`
/// if it shows none. Boxes are clipped to the frustum between `near` and `far`, the range to
/// `near`.
///
/// Source: \[GG3-10\] section 10.2.1, which only says that near and far might be adjusted "so that
/// the view frustum contains the visible objects as tightly as possible". Occluded geometry counts
/// as visible: boxes hide nothing.
pub(crate) fn visible_range(view: &View, near: f64, far: f64, receivers: &impl Most) -> Option<(f64, f64)> {
    let room = |depth: f64| ROOM * depth.abs();
    let whole = Slice::new(view, near - 0.5 * room(near), far + room(far));
    let forward = view.forward();
    // The depth that lies farthest ahead, or farthest back.
    let end = |sign: f64| {
        receivers.most(|receiver| {
            let mut end = f64::NEG_INFINITY;
            match whole.classify(receiver.center, receiver.half) {
                Lies::Outside => {}
                Lies::Inside => {
                    let (depth, reach) = (view.view_depth(receiver.center), forward.abs().dot(receiver.half));
                    end = sign * depth + reach;
                }
                Lies::Across => {
                    whole.clip_box(&receiver.bounds(), |point| end = end.max(sign * view.view_depth(point)));
                }
            }
            end
        })
    };
    let (first, last) = (-end(-1.0), end(1.0));
    if first > last {
        return None;
    }
    Some(((first - room(first)).max(near), last + room(last)))
}
