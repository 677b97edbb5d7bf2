//! The ends of the shadowed range, held so that stabilised maps stand still.

use super::size::HeldSize;
use crate::maths;

/// The range of view depths that split planes divide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    /// `C_0`.
    pub near: f64,
    /// The far end for which the inner planes `C_1 .. C_{m-1}` are placed: `far`, or its value
    /// before the range was stretched.
    pub inner_far: f64,
    /// `C_m`.
    pub far: f64,
}

impl Range {
    pub fn new(near: f64, far: f64) -> Self {
        Self { near, inner_far: far, far }
    }
}

/// Steps per doubling of a held end of the range: one step is 2^(1/4), 19 %.
const STEPS_PER_OCTAVE: f64 = 4.0;

/// Steps that an end may fall short of its held value before it follows.
const HYSTERESIS: f64 = 2.0;

/// An end of the range on a ladder of geometric steps, so that a moving camera changes it rarely.
/// It is rounded up to the next step and held until it is outgrown, or undercut by [`HYSTERESIS`]
/// steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct HeldStep {
    held: Option<f64>,
}

impl HeldStep {
    fn hold(&mut self, size: f64) -> f64 {
        let steps = maths::log2(size) * STEPS_PER_OCTAVE;
        let step = match self.held {
            Some(held) if steps <= held && steps > held - HYSTERESIS => held,
            _ => steps.ceil(),
        };
        self.held = Some(step);
        maths::exp2(step / STEPS_PER_OCTAVE).max(size)
    }
}

/// Both ends of a held range: the far end is rounded up, the near end down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldRange {
    inverse_near: HeldStep,
    far: HeldStep,
}

impl HeldRange {
    /// The held range around `near..far`, both greater than 0.
    pub fn hold(&mut self, near: f64, far: f64) -> (f64, f64) {
        (1.0 / self.inverse_near.hold(1.0 / near), self.far.hold(far))
    }
}

/// Factor by which the far end of a held range may exceed the depth for which the inner planes were
/// placed, before the inner planes follow: √2.
const MOST_STRETCH: f64 = std::f64::consts::SQRT_2;

/// Factor by which a range first exceeds the scene, so that a camera that moves away from the
/// scene's far end takes no step at once: half a step.
const FIRST_ROOM: f64 = 1.044_273_782_427_413_8;

/// The far end of a range that ends with the scene.
///
/// The depth of the scene's deepest point changes as the camera turns, the distance of its farthest
/// point does not. The range therefore ends at that distance, in steps of 9 % as the camera moves
/// away, and a step moves the last plane only. The inner planes are placed for the depth that the
/// first view needs. Once a view needs √2 times as much, they are placed again, for any depth that
/// the camera can need by turning. The range ends at √2 times the depth that the inner planes are
/// placed for, at most, so that a view that looks out of the scene does not pay for the parts
/// behind the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldFar {
    far: HeldSize,
    /// 0 before the first frame.
    inner_far: f64,
}

impl HeldFar {
    /// The range from `near` for a scene that ends at view depth `deepest`, and `farthest` metres
    /// from the camera.
    pub fn hold(&mut self, near: f64, deepest: f64, farthest: f64) -> Range {
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

/// Both ways to hold a range: by the scene's far end, or by the receivers in view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldEnds {
    pub far: HeldFar,
    pub visible: HeldRange,
    /// Near end of the range of an orthographic camera that stands off from the scene.
    near: Option<f64>,
}

/// Share of a range's length that its near end leaves free before the scene; at most four times as
/// much.
const NEAR_ROOM: f64 = 1.0 / 16.0;

impl HeldEnds {
    /// A near end between the camera's near plane and `first`, for a range that ends at `deepest`.
    pub fn hold_near(&mut self, near: f64, first: f64, deepest: f64) -> f64 {
        let room = NEAR_ROOM * (deepest - first).max(1e-3 * deepest.abs());
        let serves = |held: &f64| (near..=first).contains(held) && first - held <= 4.0 * room;
        let begin = self.near.filter(serves).unwrap_or((first - room).max(near));
        self.near = Some(begin);
        begin
    }
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
