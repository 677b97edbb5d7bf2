//! Recovery of held sizes to the choice of a new planner, while the camera stands still.
//!
//! A held size is never smaller than a frame needs, but it may be larger while the camera moves, as
//! following every change would move every texel. A camera that stands still gives no reason to
//! wait, and one split's step of a few per cent in a frame is not seen as a jump.

use glam::DVec2;

use super::size::ENOUGH;
use crate::{MAX_SPLITS, View, maths};

/// Frames for which the camera has to stand still before anything recovers. A pause between two
/// movements does not count as a standstill.
const PATIENCE: u32 = 10;

/// Frames within which a recovery ends. With [`PATIENCE`] and one round of slack less than 60.
const DURATION: u32 = 42;

/// Least step by which one split's size changes: 9 %. The step is larger only if [`DURATION`]
/// frames would not be enough.
pub(crate) const STEP: f64 = 1.090_507_732_665_257_7;

/// Tremor of a camera that counts as standing still: a share of the camera's distance to the first
/// plane, and an angle in radians.
const TREMOR: f64 = 1e-5;

/// Relative room for rounding in the extent that a map needs.
const ROUNDING: f64 = 1e-12;

/// Share of a slice that is left if one plane is in another one's way.
const LEAST_GAP: f64 = 0.05;

/// Motion of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Standing {
    /// The camera moves, or has not stood still for long.
    #[default]
    Moving,
    /// The camera has just stood still for long enough to check whether anything should recover.
    Due,
    /// The camera stands still and sizes recover.
    Recovering,
    /// The camera stands still and sizes have recovered.
    Settled,
}

/// Detects whether the camera stands still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Standstill {
    /// The view of the camera since it stands still.
    anchor: Option<View>,
    frames: u32,
    standing: Standing,
}

impl Standstill {
    /// Takes the view of the next frame. Movements within [`TREMOR`] times `reach` metres are
    /// ignored.
    pub fn follow(&mut self, view: &View, reach: f64) -> Standing {
        let stands = self.anchor.is_some_and(|anchor| {
            let (a, b) = (anchor.world_from_view_rotation(), view.world_from_view_rotation());
            anchor.eye().distance(view.eye()) <= TREMOR * reach
                && a.abs_diff_eq(b, TREMOR)
                && anchor.frustum() == view.frustum()
        });
        if !stands {
            *self = Self { anchor: Some(*view), ..Self::default() };
            return Standing::Moving;
        }
        // Nothing asks how long it has stood beyond that: what is held is the same from then on.
        self.frames = (self.frames + 1).min(PATIENCE + DURATION);
        if self.standing == Standing::Moving && self.frames >= PATIENCE {
            self.standing = Standing::Due;
        }
        self.standing
    }

    /// Begins a recovery, goes on with it, or ends it.
    pub fn set(&mut self, standing: Standing) {
        self.standing = standing;
    }

    /// Number of frames left for a recovery.
    pub fn frames_left(&self) -> u32 {
        (PATIENCE + DURATION).saturating_sub(self.frames)
    }

    /// Range of those among `count` independent sizes whose turn it is in this frame of a recovery,
    /// and the step that each may take.
    pub fn turn(&self, count: usize) -> Option<(std::ops::Range<usize>, f64)> {
        let frame = self.frames.checked_sub(PATIENCE).filter(|frame| *frame < DURATION)? as usize;
        let at_once = count.div_ceil(DURATION as usize);
        let turns = count.div_ceil(at_once);
        let begin = frame % turns * at_once;
        // A held size is two steps above its need at most.
        let step = if 2 * turns <= DURATION as usize { STEP } else { STEP * STEP };
        (self.standing == Standing::Recovering).then_some((begin..begin + at_once, step))
    }
}

/// The held values of a stabilised plan: planes and, for each map, half its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    /// `C_0 ..= C_m`.
    pub planes: [f64; MAX_SPLITS + 1],
    /// Half the edges of each map along u and v, in metres.
    pub half: [DVec2; MAX_SPLITS],
    /// Number of splits.
    pub splits: usize,
}

impl Row {
    /// Returns whether any map is larger than that of `fresh` by more than [`ENOUGH`].
    pub fn exceeds(&self, fresh: &Self) -> bool {
        (0..self.splits).any(|i| (self.half[i] / fresh.half[i]).max_element() > ENOUGH)
    }

    /// The largest ratio of any plane or size to that of `target`; for planes in either direction.
    fn ratio(&self, target: &Self) -> f64 {
        let either = |ratio: f64| ratio.max(1.0 / ratio);
        let planes = (1..=self.splits).map(|j| either(self.planes[j] / target.planes[j]));
        let halves = (0..self.splits).map(|i| (self.half[i] / target.half[i]).max_element());
        planes.chain(halves).fold(1.0, f64::max)
    }

    /// Returns whether a plane of `target` lies beyond a neighbour of the same plane here.
    fn is_in_the_way_of(&self, target: &Self) -> bool {
        let passes_before = |j: usize| target.planes[j] <= self.planes[j - 1];
        let passes_behind = |j: usize| j < self.splits && target.planes[j] >= self.planes[j + 1];
        (1..=self.splits).any(|j| passes_before(j) || passes_behind(j))
    }

    /// The lowest depth to which a plane may move without coming too close to the plane before it.
    fn lowest(&self, plane: usize) -> f64 {
        let [before, at] = [self.planes[plane - 1], self.planes[plane]];
        before + LEAST_GAP * (at - before)
    }

    fn highest(&self, plane: usize) -> f64 {
        if plane == self.splits {
            return f64::INFINITY;
        }
        let [at, behind] = [self.planes[plane], self.planes[plane + 1]];
        behind - LEAST_GAP * (behind - at)
    }
}

/// A recovery in progress. Planes move one after the other from the last to the first, each
/// together with the map before it. A map gets room for the next moves of the planes before it. No
/// plane moves without such room, because two maps would then change at once.
///
/// If many planes have to go where others are, rounds alternate with rounds back, from the first
/// plane to the last. Planes that move towards the camera then find no other plane in their way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Recovery {
    /// Number of planes left in this round.
    left: usize,
    goes_back: bool,
    is_way_back: bool,
    step: f64,
    /// Number of visits since the last change.
    idle: usize,
}

impl Recovery {
    /// Moves one plane of `row` towards `target` by a step, and the size of the map that ends
    /// there. `need` gives half the edges that a map needs for its split and a set of planes.
    /// Returns whether anything has changed: false once all sizes are those of the target.
    pub fn step(
        &mut self,
        row: &mut Row,
        target: &Row,
        frames_left: u32,
        need: impl Fn(usize, &[f64]) -> DVec2,
    ) -> bool {
        while self.idle < 2 * row.splits {
            if self.left == 0 {
                self.left = row.splits;
                self.is_way_back = self.goes_back && !self.is_way_back;
                if !self.is_way_back {
                    // A plane gets past those in its way by one slice a round. Few planes have
                    // rounds enough for that.
                    let has_few_rounds = (DURATION as usize) < 2 * row.splits * row.splits;
                    self.goes_back = has_few_rounds && row.is_in_the_way_of(target);
                    let rounds = frames_left / row.splits as u32 / if self.goes_back { 2 } else { 1 };
                    self.step = maths::pow(row.ratio(target), 1.0 / f64::from(rounds.max(1))).max(STEP);
                }
            }
            let plane = if self.is_way_back { row.splits + 1 - self.left } else { self.left };
            self.left -= 1;
            if self.visit(plane, row, target, &need) {
                self.idle = 0;
                return true;
            }
            self.idle += 1;
        }
        false
    }

    /// Moves one plane and its map. Returns whether anything changed.
    fn visit(&self, plane: usize, row: &mut Row, target: &Row, need: impl Fn(usize, &[f64]) -> DVec2) -> bool {
        let before = *row;
        let m = row.splits;
        let towards = |j: usize, step: f64| target.planes[j].clamp(before.planes[j] / step, before.planes[j] * step);
        row.planes[plane] = towards(plane, self.step).clamp(before.lowest(plane), before.highest(plane));
        if plane == 1 && target.planes[0] < row.planes[1] {
            row.planes[0] = target.planes[0];
        }
        // Maps behind it begin there, by their bands of blending the second one, too. Where planes
        // were meant to go elsewhere when it was their turn, it waits.
        let has_room = |row: &Row, i: usize| {
            let most = row.half[i] * (1.0 + ROUNDING);
            need(i, &row.planes[..=m]).cmple(most).all()
        };
        if !(plane..m.min(plane + 2)).all(|i| has_room(row, i)) {
            row.planes = before.planes;
        }
        // Room for this round, and for the way back.
        let ahead = if self.goes_back { self.step * self.step } else { self.step };
        let with_room: [f64; MAX_SPLITS + 1] = std::array::from_fn(|j| match j {
            0 => row.planes[0].min(target.planes[0]),
            j if j < plane && !self.is_way_back => row.planes[j].min(towards(j, ahead)),
            j => row.planes[j],
        });
        let split = plane - 1;
        let least = need(split, &row.planes[..=m]).max(need(split, &with_room[..=m]));
        row.half[split] = least.max(row.half[split] / self.step);
        *row != before
    }
}
