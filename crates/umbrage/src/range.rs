//! The shadowed range, `C_0` and `C_m`: as it was given, to the scene's end, or as tight as what the view shows allows; held where maps
//! have to stand still.

use crate::planner::Placed;
use crate::stable::HeldSize;
use crate::volume::{Lies, Slice};
use crate::{Bands, RangeFit, ShadowSettings, Stabilize, View};

/// Share of a depth by which the range exceeds the receivers, so that rounding to `f32` on the way to a shader leaves none
/// outside.
const ROOM: f64 = 1e-4;

/// The least length of a range that is fitted to what is visible, as a share of its far end.
const LEAST_RANGE: f64 = 0.01;

/// Steps per doubling of a held end of the range: one step is 2^(1/4), 19 %.
const STEPS_PER_OCTAVE: f64 = 4.0;

/// Steps that an end may fall short of what it holds before it follows.
const HYSTERESIS: f64 = 2.0;

/// The view depths between which the view shows any of `receivers`, with a little room; `None` if it shows none. Boxes are clipped to
/// the frustum between `near` and `far`, the range to `near`.
///
/// Source: *Parallel-Split Shadow Maps on Programmable GPUs* (seed 001) section 10.2.1, which only says that near and far might be
/// adjusted "so that the view frustum contains the visible objects as tightly as possible". What stands behind something
/// else counts as visible: boxes hide nothing.
pub(crate) fn visible_range<'a>(
    view: &View,
    near: f64,
    far: f64,
    receivers: impl IntoIterator<Item = &'a Placed>,
) -> Option<(f64, f64)> {
    let room = |depth: f64| ROOM * depth.abs();
    let whole = Slice::new(view, near - 0.5 * room(near), far + room(far));
    let forward = view.forward();
    let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut include = |depth: f64| (first, last) = (first.min(depth), last.max(depth));
    for receiver in receivers {
        match whole.classify(receiver.center, receiver.half) {
            Lies::Outside => {}
            Lies::Inside => {
                let (depth, reach) = (view.view_depth(receiver.center), forward.abs().dot(receiver.half));
                include(depth - reach);
                include(depth + reach);
            }
            Lies::Across => {
                whole.clip_box(&receiver.bounds(), |point| include(view.view_depth(point)));
            }
        }
    }
    if first > last {
        return None;
    }
    Some(((first - room(first)).max(near), last + room(last)))
}

/// An end of the range on a ladder of geometric steps, so that a moving camera changes it rarely: rounded up to the next step, and
/// held until it is outgrown or undercut by [`HYSTERESIS`] steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct HeldStep {
    held: Option<f64>,
}

impl HeldStep {
    fn hold(&mut self, size: f64) -> f64 {
        let steps = size.log2() * STEPS_PER_OCTAVE;
        let step = match self.held {
            Some(held) if steps <= held && steps > held - HYSTERESIS => held,
            _ => steps.ceil(),
        };
        self.held = Some(step);
        2f64.powf(step / STEPS_PER_OCTAVE).max(size)
    }
}

/// Both ends of a range that is held: the far one is rounded up, the near one down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct HeldRange {
    inverse_near: HeldStep,
    far: HeldStep,
}

impl HeldRange {
    /// The held range around `near..far`, both greater than 0.
    fn hold(&mut self, near: f64, far: f64) -> (f64, f64) {
        (1.0 / self.inverse_near.hold(1.0 / near), self.far.hold(far))
    }
}

/// The view depths that the planes between splits divide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    /// `C_0`.
    pub near: f64,
    /// The far end that the inner planes `C_1 .. C_{m-1}` are placed for: `far`, or what it was before it was stretched.
    pub inner_far: f64,
    /// `C_m`.
    pub far: f64,
}

impl Range {
    pub fn new(near: f64, far: f64) -> Self {
        Self { near, inner_far: far, far }
    }
}

/// By how much the far end of a held range may exceed the depth for which the inner planes were placed, before they follow: √2.
const MOST_STRETCH: f64 = std::f64::consts::SQRT_2;

/// By how much a range first exceeds the scene, so that an eye that walks away from its far end takes no step at once: half a step.
const FIRST_ROOM: f64 = 1.044_273_782_427_413_8;

/// The far end of a range that ends with the scene.
///
/// The scene's deepest point changes as the camera turns, its farthest does not: the range ends there, in steps of 9 % as the eye walks
/// away from it, and a step moves the last plane only. The inner planes are placed for the depth that the first
/// view asks for, and again, for any that it can ask for by turning, where one asks for √2 times as much. A view that
/// looks out of the scene does not pay for what lies behind it: the range ends at √2 times what the inner planes are placed for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct HeldFar {
    far: HeldSize,
    /// 0 before the first frame.
    inner_far: f64,
}

impl HeldFar {
    /// The range from `near` for a scene that ends at view depth `deepest`, and `farthest` metres from the eye.
    fn hold(&mut self, near: f64, deepest: f64, farthest: f64) -> Range {
        let farthest = farthest.max(deepest);
        if self.inner_far == 0.0 {
            self.inner_far = deepest;
            self.far.hold(farthest * FIRST_ROOM);
        }
        let far = self.far.hold(farthest);
        if deepest > MOST_STRETCH * self.inner_far || far < self.inner_far {
            self.inner_far = deepest.max(far / MOST_STRETCH);
        }
        Range { near, inner_far: self.inner_far, far: far.min(MOST_STRETCH * self.inner_far) }
    }
}

/// The ends of the shadowed range, and what they hold on to from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldEnds {
    far: HeldFar,
    visible: HeldRange,
}

impl HeldEnds {
    /// `C_0` and `C_m`: the setting; the view depths of the visible receivers; or the camera's near and far, far capped by the
    /// receivers.
    pub fn range(&mut self, settings: &ShadowSettings, view: &View, receivers: &[Placed]) -> Range {
        if let Some((near, far)) = settings.range {
            return Range::new(near, far);
        }
        let forward = view.forward();
        let bands = settings.bands;
        let (near, camera_far) = (view.frustum().near, view.frustum().far / bands.least_depth_share(view));
        let view_depth = |r: &Placed| forward.dot(r.center - view.eye()) + forward.abs().dot(r.half);
        let deepest = match bands {
            Bands::Planar => receivers.iter().map(view_depth).fold(f64::NEG_INFINITY, f64::max),
            Bands::Radial => farthest(view, receivers),
        };
        // Nothing before the eye: any short range will do.
        let deepest = if deepest > near { deepest } else { 2.0 * near.abs() + 1.0 };
        let deepest = deepest.min(camera_far);
        if settings.range_fit == RangeFit::Visible
            && let Some((first, last)) = visible_range(view, near, deepest, receivers)
        {
            let (first, last) = match settings.stabilize {
                Stabilize::Exact | Stabilize::Approximate(_) if first > 0.0 => self.visible.hold(first, last),
                _ => (first, last),
            };
            // A single wall that faces the camera still gets slices of some depth.
            let first = first.max(near).min(last * (1.0 - LEAST_RANGE));
            return Range::new(first, last.min(camera_far));
        }
        let range = match settings.stabilize {
            // Almost still maps are held by their own extents, whatever the planes: a range that is held as well would only make them
            // larger, by 8 % in the second of four splits, and saves no step.
            Stabilize::None | Stabilize::Approximate(_) => Range::new(near, deepest),
            Stabilize::Exact => self.far.hold(near, deepest, farthest(view, receivers).min(camera_far)),
        };
        Range { near, inner_far: range.inner_far.min(camera_far), far: range.far.min(camera_far) }
    }

    /// Lets go of a far end that makes a range which cannot be divided.
    pub fn release_far(&mut self) {
        self.far = HeldFar::default();
    }
}

/// Metres from the eye to the farthest corner of any receiver; 0 without receivers.
fn farthest(view: &View, receivers: &[Placed]) -> f64 {
    receivers.iter().map(|r| ((r.center - view.eye()).abs() + r.half).length()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{HeldFar, HeldRange, MOST_STRETCH};

    #[test]
    fn a_held_far_end_ignores_turning_and_its_inner_planes_start_tight() {
        let mut held = HeldFar::default();
        let first = held.hold(0.1, 300.0, 400.0);
        assert!(first.inner_far == 300.0 && (417.0..418.0).contains(&first.far), "{first:?}");
        // Turning to the far corner, looking out of the scene, and walking ten metres.
        for (deepest, farthest) in [(400.0, 400.0), (20.0, 400.0), (310.0, 410.0)] {
            assert_eq!(held.hold(0.1, deepest, farthest), first);
        }
        let stretched = held.hold(0.1, 300.0, 420.0);
        assert!(stretched.inner_far == 300.0 && (420.0..460.0).contains(&stretched.far), "{stretched:?}");
        // Walking out of it.
        let short = held.hold(0.1, 20.0, 100.0);
        assert!((100.0..110.0).contains(&short.far) && short.inner_far == short.far / MOST_STRETCH, "{short:?}");
        let long = held.hold(0.1, 500.0, 600.0);
        assert!(long.inner_far == 500.0 && long.far >= 600.0, "{long:?}");
    }

    #[test]
    fn a_first_look_out_of_the_scene_is_tight_and_planes_follow_once() {
        let mut held = HeldFar::default();
        let out = held.hold(0.1, 10.0, 400.0);
        assert_eq!((out.inner_far, out.far), (10.0, 10.0 * MOST_STRETCH));
        let mut inner = vec![out.inner_far];
        for degrees in 0..=90 {
            inner.push(held.hold(0.1, 10.0 + 390.0 * f64::from(degrees).to_radians().sin(), 400.0).inner_far);
        }
        inner.dedup();
        assert_eq!(inner.len(), 2, "{inner:?}");
    }

    #[test]
    fn a_held_range_contains_what_it_is_asked_for_and_rarely_moves() {
        let mut held = HeldRange::default();
        let mut changes = 0;
        let mut before = held.hold(10.0, 400.0);
        for i in 0..1000 {
            // Ten per cent to and fro, as ground that rolls under a walking camera.
            let wave = 1.0 + 0.1 * (f64::from(i) * 0.37).sin();
            let now = held.hold(10.0 * wave, 400.0 / wave);
            assert!(now.0 <= 10.0 * wave && now.1 >= 400.0 / wave, "{now:?}");
            changes += usize::from(now != before);
            before = now;
        }
        assert!(changes <= 2, "{changes} changes");
        let (near, far) = held.hold(100.0, 4000.0);
        assert!(near > 80.0 && near <= 100.0 && (4000.0..5000.0).contains(&far), "{near}..{far}");
    }
}
