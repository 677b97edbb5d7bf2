//! Rectangles of approximately stabilised maps: their edges change in steps, on axes that are fixed
//! to the light.

use glam::DVec2;

use super::size::ENOUGH;
use crate::config::ExtentSteps;
use crate::geometry::region::{DIRECTIONS, Region};
use crate::maths;

/// Relative room for rounding, so that an extent that stays constant while the camera walks also
/// keeps its step.
const ROUNDING: f64 = 1e-9;

/// The orientation and the extent of an approximately stabilised map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    /// Index of the u axis in the fan of directions; v is a quarter turn further.
    pub direction: usize,
    /// Extent along u and v in metres.
    pub extent: DVec2,
}

impl Rectangle {
    fn area(&self) -> f64 {
        self.extent.x * self.extent.y
    }

    /// Centre of `target` along u and v in metres.
    pub fn center(&self, target: &Region) -> DVec2 {
        let (lo, hi) = target.bounds(self.direction);
        0.5 * (lo + hi)
    }

    /// The smallest rectangle along `direction` with edges of whole steps.
    fn around(target: &Region, direction: usize, steps: f64) -> Self {
        let round_up =
            |extent: f64| maths::exp2((steps * maths::log2(extent * (1.0 + ROUNDING))).ceil() / steps).max(extent);
        Self { direction, extent: needed(target, direction).map(round_up) }
    }

    /// This rectangle, with those edges made longer that are too short.
    fn grown_to(&self, target: &Region, steps: f64) -> Self {
        let needed = needed(target, self.direction);
        let around = Self::around(target, self.direction, steps).extent;
        Self { extent: DVec2::select(needed.cmple(self.extent), self.extent, around), ..*self }
    }
}

/// Holds a rectangle from frame to frame for as long as it serves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldRectangle {
    held: Option<Rectangle>,
}

impl HeldRectangle {
    /// The rectangle for `target`. `whole` is the width of the unsplit light frustum in metres, of
    /// which the steps of \[PCSM\] are fractions.
    ///
    /// With geometric steps a rectangle grows where it has to. It is kept while it is at most one
    /// step larger along each edge (or two along one) than the best one, which is the smallest in
    /// whole steps along any of the fan's directions. With `refits` it is kept only while it is
    /// hardly larger. The steps of the source have neither orientation nor memory.
    pub fn hold(&mut self, target: &Region, steps: ExtentSteps, whole: f64, refits: bool) -> Rectangle {
        let rectangle = match steps {
            ExtentSteps::PerDoubling(count) => {
                let steps = f64::from(count);
                let best = least(target, steps);
                let excess = maths::exp2(2.0 / steps);
                let excess = if refits { excess.min(ENOUGH * ENOUGH) } else { excess };
                let enough = best.area() * excess * (1.0 + ROUNDING);
                let grown = self.held.map(|held| held.grown_to(target, steps));
                grown.filter(|grown| grown.area() <= enough).unwrap_or(best)
            }
            ExtentSteps::Levels(count) => {
                let level = whole / f64::from(count);
                let extent = (needed(target, 0) / level - ROUNDING).ceil().max(DVec2::ONE) * level;
                Rectangle { direction: 0, extent: extent * (1.0 + ROUNDING) }
            }
        };
        self.held = Some(rectangle);
        rectangle
    }
}

/// The longest possible edge of a held rectangle for a target that is `widest` metres wide: two
/// steps of rounding and two of hysteresis, if all of them fall on one edge.
pub(crate) fn longest_edge(steps: ExtentSteps, widest: f64, whole: f64) -> f64 {
    match steps {
        ExtentSteps::PerDoubling(count) => widest * maths::exp2(4.0 / f64::from(count)),
        ExtentSteps::Levels(count) => widest + whole / f64::from(count),
    }
}

/// The extent of `target` along a direction and across it. A target without width (a wall seen
/// edge-on by the light) still gets a small extent.
fn needed(target: &Region, direction: usize) -> DVec2 {
    let (lo, hi) = target.bounds(direction);
    let longest = (hi - lo).max_element();
    (hi - lo).max(DVec2::splat(1e-3 * longest.max(1e-3)))
}

/// The rectangle of least area in whole steps.
fn least(target: &Region, steps: f64) -> Rectangle {
    let around = |direction| Rectangle::around(target, direction, steps);
    (1..DIRECTIONS / 2).map(around).fold(around(0), |best, other| {
        // Steps make ties of rectangles that differ by rounding only; those stay with the first.
        if other.area() < best.area() * (1.0 - ROUNDING) { other } else { best }
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::region::Fan;

    /// A box of `w` by `h` metres seen from above, turned by `angle`.
    fn turned(w: f64, h: f64, angle: f64) -> Region {
        let fan = Fan::new(DVec3::X, DVec3::NEG_Y);
        let (sin, cos) = angle.sin_cos();
        let mut region = Region::EMPTY;
        for (x, y) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
            let (x, y) = (x * w, y * h);
            region.include_point(&fan, DVec3::new(x * cos - y * sin, 0.0, x * sin + y * cos));
        }
        region
    }

    const STEPS: ExtentSteps = ExtentSteps::PerDoubling(8);
    const STEP: f64 = 1.090_507_732_665_257_7;

    #[test]
    fn an_extent_is_rounded_up_to_a_power_of_the_step() {
        let mut held = HeldRectangle::default();
        let rectangle = held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0, false);
        assert_eq!(rectangle.direction, 0);
        // 2^(54/8) = 107.6 is the first above 100, 2^(43/8) = 41.5 the first above 40.
        assert!((rectangle.extent - DVec2::new(2f64.powf(54.0 / 8.0), 2f64.powf(43.0 / 8.0))).length() < 1e-9);
    }

    #[test]
    fn one_step_of_hysteresis_in_either_direction() {
        let mut held = HeldRectangle::default();
        let first = held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0, false);
        for (w, h) in [(107.0, 41.0), (100.0 / STEP, 40.0), (107.0, 41.4 / STEP), (96.0, 37.0), (100.0, 40.0)] {
            assert_eq!(held.hold(&turned(w, h, 0.0), STEPS, 0.0, false), first, "{w} × {h}");
        }
        let larger = held.hold(&turned(108.0, 40.0, 0.0), STEPS, 0.0, false);
        assert!((larger.extent.x / first.extent.x - STEP).abs() < 1e-9, "one step up");
        assert_eq!(held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0, false), larger, "and not down again at once");
        let smaller = held.hold(&turned(60.0, 40.0, 0.0), STEPS, 0.0, false);
        assert!(smaller.extent.x < larger.extent.x / STEP.powi(2));
    }

    #[test]
    fn the_rectangle_turns_with_its_target_now_and_then() {
        let (mut held, mut changes, mut area) = (HeldRectangle::default(), 0, 0.0);
        let mut before = None;
        for k in 0..524 {
            let target = turned(120.0, 70.0, 0.003 * f64::from(k));
            let rectangle = held.hold(&target, STEPS, 0.0, false);
            assert!(needed(&target, rectangle.direction).cmple(rectangle.extent).all());
            changes += i32::from(before.is_some_and(|before| before != rectangle));
            area += rectangle.area() / (120.0 * 70.0) / 524.0;
            before = Some(rectangle);
        }
        // A quarter turn in steps of 0.003 rad.
        assert!(changes < 524 / 10, "{changes} changes");
        assert!(area < 1.3, "{area} times the area on average");
    }

    #[test]
    fn the_source_counts_levels_of_the_whole_frustum() {
        let mut held = HeldRectangle::default();
        let of = |held: &mut HeldRectangle, w| {
            held.hold(&turned(w, 40.0, 0.0), ExtentSteps::Levels(64), 640.0, false).extent
        };
        // s = 640 / 101, 64 / s = 10.1, s_q = 64 / 11: 110 m.
        assert!((of(&mut held, 101.0) - DVec2::new(110.0, 40.0)).length() < 1e-6);
        assert!((of(&mut held, 100.0) - DVec2::new(100.0, 40.0)).length() < 1e-6, "no hysteresis");
        assert!((of(&mut held, 0.5).x - 10.0).abs() < 1e-6, "the first level is all that a near split gets");
    }

    #[test]
    fn no_edge_is_longer_than_promised() {
        let mut held = HeldRectangle::default();
        for k in 0..400 {
            let wave = 1.0 + 0.3 * (f64::from(k) * 0.37).sin();
            let target = turned(100.0 * wave, 40.0 / wave, f64::from(k) * 0.01);
            let edge = held.hold(&target, STEPS, 0.0, false).extent.max_element();
            assert!(edge <= longest_edge(STEPS, target.widest(), 0.0), "{edge}");
        }
    }
}
