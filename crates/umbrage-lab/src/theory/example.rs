//! The scene of the diagrams: a street of boxes under a slanting sun, with all cases in which
//! casters and receivers differ. A tower behind the eye and a balloon out of sight cast their
//! shadows into the view.

use glam::DVec3;
use umbrage::config::{Crop, Filter, Preset, Range, Stability, Transition};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, PlannerOptions, ShadowConfig, ShadowPlan, Split, View};

use super::Result;
use crate::page::plot::convex_hull;

/// Number of splits in the diagrams.
pub(super) const SPLITS: usize = 3;

/// The scene, its view and its sun.
#[derive(Clone, Debug)]
pub(super) struct Example {
    pub view: View,
    pub sun: DirectionalLight,
    /// Ground, which only receives shadows, as a terrain does.
    pub ground: Aabb,
    /// Boxes that cast and receive shadows.
    pub boxes: Vec<Aabb>,
}

impl Example {
    pub fn new() -> Result<Self> {
        let on_ground = |x: (f64, f64), height: f64, z: (f64, f64)| {
            Aabb::new(DVec3::new(x.0, 0.0, z.0), DVec3::new(x.1, height, z.1))
        };
        let balloon = Aabb::new(DVec3::new(20.0, 47.0, -5.0), DVec3::new(27.0, 54.0, 2.0));
        let frustum = Frustum::perspective(36f64.to_radians(), 1.5, 2.0, 150.0)?;
        Ok(Self {
            view: View::look_at_upright(DVec3::new(0.0, 9.0, 0.0), DVec3::new(100.0, 3.0, 0.0), frustum)?,
            sun: DirectionalLight::new(DVec3::new(0.7, -1.0, 0.0))?,
            ground: Aabb::new(DVec3::new(-40.0, -1.0, -75.0), DVec3::new(165.0, 0.0, 75.0)),
            boxes: vec![
                on_ground((-15.0, -8.0), 58.0, (-5.0, 5.0)),
                on_ground((13.0, 20.0), 5.0, (-4.0, 3.0)),
                on_ground((42.0, 50.0), 24.0, (5.0, 14.0)),
                on_ground((57.0, 76.0), 9.0, (-19.0, -6.0)),
                on_ground((98.0, 116.0), 14.0, (10.0, 28.0)),
                on_ground((124.0, 132.0), 20.0, (-40.0, -24.0)),
                balloon,
            ],
        })
    }

    /// Plans with hard borders, so that slices are those that the papers draw.
    pub fn plan(&self, crop: Crop) -> Result<ShadowPlan> {
        let settings = ShadowConfig {
            map_sizes: vec![1024; SPLITS],
            crop,
            stability: Stability::tight(),
            filter: Filter::Hard,
            transition: Transition::Hard,
            range: Range::Metres { near: self.view.frustum().near, far: self.view.frustum().far },
            ..Preset::Papers.config()
        };
        let receivers: Vec<Aabb> = self.boxes.iter().copied().chain([self.ground]).collect();
        let options = PlannerOptions { image_size: [1 << 16; 2], ..PlannerOptions::default() };
        Ok(Planner::with_options(&settings, options)?.plan(&self.view, &self.sun, &self.boxes, &receivers)?.clone())
    }
}

/// Returns the eight corners of a map's volume in the world. Bit 0 of the index is u, bit 1 v, bit
/// 2 depth.
pub(super) fn map_corners(split: &Split) -> [DVec3; 8] {
    let lo = split.min_texel * split.texel_m;
    let hi = lo + split.texel_m * f64::from(split.size);
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
        split.u_axis * pick(1, lo.x, hi.x)
            + split.v_axis * pick(2, lo.y, hi.y)
            + split.depth_axis * pick(4, split.depth_near, split.depth_far)
    })
}

/// Pairs of corners of a box (or map) that an edge joins.
pub(super) const BOX_EDGES: [(usize, usize); 12] =
    [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)];

/// A picture plane: the world axes to its right and up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub right: DVec3,
    pub up: DVec3,
}

impl Plane {
    pub fn point(&self, p: DVec3) -> (f64, f64) {
        (self.right.dot(p), self.up.dot(p))
    }

    pub fn points(&self, points: impl IntoIterator<Item = DVec3>) -> Vec<(f64, f64)> {
        points.into_iter().map(|p| self.point(p)).collect()
    }

    /// Returns the outline of a convex body.
    pub fn outline(&self, corners: impl IntoIterator<Item = DVec3>) -> Vec<(f64, f64)> {
        convex_hull(&self.points(corners))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_holds_its_own_corners() {
        let example = Example::new().expect("the example");
        for split in &example.plan(Crop::SceneDependent).expect("a plan").splits {
            for (i, corner) in map_corners(split).into_iter().enumerate() {
                let at = split.map_from_world(corner);
                let expected = [1, 2, 4].map(|bit| if i & bit == 0 { 0.0 } else { 1.0 });
                let size = f64::from(split.size);
                let got = [at.x / size, at.y / size, at.z];
                assert!(got.iter().zip(expected).all(|(g, e)| (g - e).abs() < 1e-9), "{got:?} {expected:?}");
            }
        }
    }

    #[test]
    fn the_example_shows_what_it_is_for() {
        let example = Example::new().expect("the example");
        let plan = example.plan(Crop::SceneDependent).expect("a plan");
        let (tower_behind, balloon) = (0, example.boxes.len() as u32 - 1);
        let casts = |caster: u32| (0..SPLITS).any(|split| plan.casters(split).contains(&caster));
        assert!(casts(tower_behind) && casts(balloon), "{:?}", plan.split_range);
        let sees = |index: u32| {
            let center = example.boxes[index as usize].center();
            let in_view = example.view.view_from_world_point(center);
            let f = example.view.frustum();
            -in_view.z > f.near && in_view.y / -in_view.z < f.top
        };
        assert!(!sees(tower_behind) && !sees(balloon), "both are out of sight");
    }
}
