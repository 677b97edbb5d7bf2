//! Recovery of almost still maps to the choice of a new planner, while the camera stands still.
//!
//! Such a map is fitted to what its slice shows, and that changes at once where a plane passes a
//! house. So maps grow, one after the other and step by step, until each contains its slice by the
//! old planes and by the new ones. Then planes move, and no map changes. Then maps shrink to their
//! new slices, again one after the other and step by step.

use super::recovery::{Row, STEP};
use super::rectangle::{HeldRectangle, Stride};
use crate::maths;

/// Growth in which no step is worth taking: rounding.
const ROUNDING: f64 = 1e-9;

/// Decision on the map that answers for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decides {
    /// The first map that contains the point.
    Map,
    /// The planes between which it lies.
    Planes,
}

impl Decides {
    /// Most frames within which maps grow. They shrink within those that are left.
    const fn growing(self) -> u32 {
        match self {
            Self::Map => 20,
            Self::Planes => 16,
        }
    }

    /// Frames in which planes move: one where nobody sees them.
    const fn moving(self) -> u32 {
        match self {
            Self::Map => 1,
            Self::Planes => 8,
        }
    }
}

/// Part of an approach.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Phase {
    #[default]
    Growing,
    /// Planes move, in so many more frames.
    Moving(u32),
    Shrinking,
}

/// An approach to the choice of a new planner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Approach {
    phase: Phase,
    /// Factor by which an edge changes in a frame; 0 before the first step of a phase.
    step: f64,
}

/// The map that changes in a frame, and how; `None` if no map changes.
pub(crate) type Turn = Option<(usize, Stride)>;

impl Approach {
    /// Moves the planes of `row` towards `target` if it is their turn. Returns the map whose turn
    /// it is otherwise, or `None` once every map is as it should be, which takes at most
    /// `frames_left` frames where nothing in the scene moves.
    pub fn step(
        &mut self,
        row: &mut Row,
        target: &Row,
        (decides, frames_left): (Decides, u32),
        rectangles: &mut [HeldRectangle],
    ) -> Option<Turn> {
        let rectangles = &mut rectangles[..row.splits];
        if self.phase == Phase::Growing {
            if let Some((map, step)) = self.turn(rectangles, HeldRectangle::growth, decides.growing()) {
                return Some(Some((map, Stride::Grow(step))));
            }
            rectangles.iter_mut().for_each(HeldRectangle::clear_goal);
            let moving = if row.planes == target.planes { 1 } else { decides.moving() };
            *self = Self { phase: Phase::Moving(moving), step: 0.0 };
        }
        if let Phase::Moving(left) = self.phase {
            let before = row.planes;
            // Means of two rows in order are in order.
            row.planes = std::array::from_fn(|j| match left {
                1 => target.planes[j],
                _ => before[j] + (target.planes[j] - before[j]) / f64::from(left),
            });
            self.phase = if left == 1 { Phase::Shrinking } else { Phase::Moving(left - 1) };
            return Some(None);
        }
        row.planes = target.planes;
        let (map, step) = self.turn(rectangles, HeldRectangle::excess, frames_left)?;
        Some(Some((map, Stride::Shrink(step))))
    }

    /// The last map that is to change, and the step: 9 %, or more if all maps would need more than
    /// so many frames.
    fn turn(
        &mut self,
        rectangles: &[HeldRectangle],
        ratio: impl Fn(&HeldRectangle) -> f64,
        frames: u32,
    ) -> Option<(usize, f64)> {
        let ratios = || rectangles.iter().map(&ratio).enumerate().filter(|(_, ratio)| *ratio > 1.0 + ROUNDING);
        let (last, _) = ratios().last()?;
        if self.step == 0.0 {
            // Each map's last step may be a part of one.
            let whole = (f64::from(frames) - ratios().count() as f64).max(1.0);
            let doublings: f64 = ratios().map(|(_, ratio)| maths::log2(ratio)).sum();
            self.step = maths::exp2(doublings / whole).max(STEP);
        }
        Some((last, self.step))
    }
}
