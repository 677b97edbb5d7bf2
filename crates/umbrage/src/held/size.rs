//! Sizes that change in geometric steps, with hysteresis.

use glam::DVec2;

use crate::{Frustum, maths};

/// Rounds a size up to geometric steps, with one step of hysteresis, so that it changes rarely.
///
/// A size that has never changed is kept as it is. Once it outgrows the held value or falls two
/// steps below it, the next step above the new size is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldSize {
    held: Option<f64>,
}

/// Steps per doubling of a held size: one step is 2^(1/8), 9 %.
const STEPS_PER_OCTAVE: f64 = 8.0;

/// Factor by which a recovering size may exceed the needed size. A smaller step would be visible
/// and gain nothing.
pub(crate) const ENOUGH: f64 = 1.05;

/// Relative room for rounding, so that a size that is reached again in another way is the same.
const ROUNDING: f64 = 1e-13;

impl HeldSize {
    /// The held size for a `size` that recovers: smaller by one step, if that serves and is worth
    /// it.
    pub fn shrink(&mut self, size: f64, step: f64) -> f64 {
        let keeps = |held: f64| size <= held && held <= size * ENOUGH;
        let value = self.held.map_or(size, |held| if keeps(held) { held } else { size.max(held / step) });
        self.held = Some(value);
        value
    }

    /// The held size for `size`, in steps of 2^(1/8).
    pub fn hold(&mut self, size: f64) -> f64 {
        self.hold_in_steps(size, STEPS_PER_OCTAVE)
    }

    /// The held size for `size`, with `steps` steps per doubling.
    pub fn hold_in_steps(&mut self, size: f64, steps: f64) -> f64 {
        let step = |size: f64| maths::exp2((maths::log2(size) * steps).ceil() / steps).max(size);
        let lowest = |held: f64| held * maths::exp2(-2.0 / steps);
        let value = match self.held {
            None => size,
            Some(held) if size <= held * (1.0 + ROUNDING) && size >= lowest(held) => held,
            Some(_) => step(size),
        };
        self.held = Some(value);
        value
    }
}

/// Steps per doubling of a held lens: one step is 2^(1/4), 19 %, so that maps follow a lens once it
/// has narrowed by √2.
///
/// A step changes all texels of all maps at once. With steps of 9 %, one of 600 frames of a slow
/// zoom takes one, and flicker exceeds its limit. The price is sharpness that the zoom would have
/// brought.
const LENS_STEPS_PER_OCTAVE: f64 = 4.0;

/// The lens for which exactly stabilised maps are made: the camera's own until it zooms, then held.
///
/// The lens is held so long, and not the maps' sizes, because sizes follow from the range as well:
/// a camera that does not zoom pays nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldLens {
    width: HeldSize,
}

impl HeldLens {
    /// `frustum`, or one around it that is wider by the same factor on all sides on which it may
    /// grow. A frustum beside the axis does not move away from it.
    pub fn hold(&mut self, frustum: &Frustum) -> Frustum {
        let width = maths::hypot(frustum.right - frustum.left, frustum.top - frustum.bottom);
        let wider = (self.width.hold_in_steps(width, LENS_STEPS_PER_OCTAVE) / width).max(1.0);
        Frustum {
            left: frustum.left.min(frustum.left * wider),
            right: frustum.right.max(frustum.right * wider),
            bottom: frustum.bottom.min(frustum.bottom * wider),
            top: frustum.top.max(frustum.top * wider),
            ..*frustum
        }
    }
}

/// Half the edges of an exactly stabilised map, each held as a [`HeldSize`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldExtents {
    u: HeldSize,
    v: HeldSize,
}

impl HeldExtents {
    pub fn hold(&mut self, half: DVec2) -> DVec2 {
        DVec2::new(self.u.hold(half.x), self.v.hold(half.y))
    }

    /// The held half edges, if there are any.
    pub fn get(&self) -> Option<DVec2> {
        Some(DVec2::new(self.u.held?, self.v.held?))
    }

    /// Holds these half edges from now on.
    pub fn set(&mut self, half: DVec2) {
        (self.u.held, self.v.held) = (Some(half.x), Some(half.y));
    }
}

#[cfg(test)]
mod tests {
    use super::HeldLens;
    use crate::Frustum;

    #[test]
    fn a_held_lens_contains_every_lens_it_is_held_for() {
        // In the middle, to one side of the axis, and beside it (the outer screens of a wall).
        for [left, right, bottom, top] in
            [[-1.0, 1.0, -0.6, 0.6], [-0.2, 1.0, -0.6, 0.1], [0.7, 1.4, -0.4, 0.4], [-2.0, -0.5, 0.1, 0.9]]
        {
            let frustum =
                Frustum { left, right, bottom, top, ..Frustum::perspective(1.0, 1.0, 0.1, 100.0).expect("valid") };
            let (mut held, mut steps, mut before) = (HeldLens::default(), 0, None);
            for k in 0..400 {
                let zoom = 1.0 + 0.9 * (0.03 * f64::from(k)).sin();
                let asked = Frustum {
                    left: left * zoom,
                    right: right * zoom,
                    bottom: bottom * zoom,
                    top: top * zoom,
                    ..frustum
                };
                let lens = held.hold(&asked);
                assert!(lens.left <= asked.left && lens.right >= asked.right, "{lens:?} for {asked:?}");
                assert!(lens.bottom <= asked.bottom && lens.top >= asked.top, "{lens:?} for {asked:?}");
                steps += i32::from(before.is_some_and(|before| before != held));
                before = Some(held);
            }
            assert!((4..60).contains(&steps), "{steps} steps");
        }
    }
}
