//! Lines in the world for a camera: frusta of splits, boxes of their maps, boxes of casters.

use glam::{DVec2, DVec3};
use umbrage::config::SplitMetric;
use umbrage::{Aabb, ShadowPlan, Split, View};

/// A line between two world points, in metres.
pub type Segment = [DVec3; 2];

/// Edges of a box whose corners are numbered as a slice's: four near ones (bottom left, bottom
/// right, top left, top right), then four far ones.
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Distance in metres at which an infinite view is cut off, beyond what is visible.
const FARTHEST_M: f64 = 1e7;

/// Returns the colour of a split: that of the picture's tints, a little deeper.
#[must_use]
pub fn split_colour(split: usize) -> [u8; 3] {
    const COLOURS: [[u8; 3]; 8] = [
        [255, 95, 95],
        [80, 215, 90],
        [95, 140, 255],
        [240, 220, 60],
        [240, 95, 240],
        [70, 215, 225],
        [255, 165, 70],
        [165, 120, 255],
    ];
    COLOURS[split % COLOURS.len()]
}

/// Returns the edges of the part of a view between two view depths.
#[must_use]
pub fn slice(view: &View, near: f64, far: f64) -> [Segment; 12] {
    let corners = view.slice_corners(near, far.min(FARTHEST_M));
    EDGES.map(|edge| edge.map(|corner| corners[corner]))
}

/// Returns the edges of a map's volume, from the light's near plane to its far plane; `None` if it
/// has no volume.
#[must_use]
pub fn map_box(split: &Split) -> Option<[Segment; 12]> {
    let world_from_shadow = split.shadow_from_world().inverse();
    let corner = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(u8::from(i >> axis & 1 == 1)));
        world_from_shadow.project_point3(DVec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, z))
    };
    let corners: [DVec3; 8] = std::array::from_fn(corner);
    corners.iter().all(|corner| corner.is_finite()).then(|| EDGES.map(|edge| edge.map(|corner| corners[corner])))
}

/// Returns the edges of a box.
#[must_use]
pub fn edges(bounds: &Aabb) -> [Segment; 12] {
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 1 { bounds.max[axis] } else { bounds.min[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    EDGES.map(|edge| edge.map(corner))
}

/// Lines of a split.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitLines {
    /// Index of the split, from 0 in each face.
    pub split: usize,
    /// Slice of the planned view; empty for bands of distance, which have no planes.
    pub slice: Vec<Segment>,
    /// Volume of the map.
    pub map: Vec<Segment>,
}

/// Returns the lines of a plan's splits, without those that nothing casts a shadow into.
#[must_use]
pub fn frusta(plan: &ShadowPlan, planned: &View) -> Vec<SplitLines> {
    let per_face = (plan.splits.len() / plan.faces().max(1)).max(1);
    let of = |(index, split): (usize, &Split)| {
        let slice = (plan.metric() == SplitMetric::ViewDepth).then(|| slice(planned, split.near, split.far));
        SplitLines {
            split: index % per_face,
            slice: slice.into_iter().flatten().collect(),
            map: map_box(split).into_iter().flatten().collect(),
        }
    };
    plan.splits.iter().enumerate().filter(|(_, split)| !split.casters.is_empty()).map(of).collect()
}

/// Projects a line to the picture, in shares from the upper left; `None` if no part of it is
/// visible.
#[must_use]
pub fn on_screen(view: &View, segment: Segment) -> Option<[DVec2; 2]> {
    let lens = view.frustum();
    let [mut a, mut b] = segment.map(|point| view.view_from_world_point(point));
    // Cut at the near plane: behind it nothing is projected.
    let [da, db] = [-a.z - lens.near, -b.z - lens.near];
    match (da >= 0.0, db >= 0.0) {
        (false, false) => return None,
        (false, true) => a = a.lerp(b, da / (da - db)),
        (true, false) => b = b.lerp(a, db / (db - da)),
        (true, true) => {}
    }
    let project = |p: DVec3| {
        let scale = lens.scale_at((-p.z).max(lens.near));
        let x = (p.x / scale - lens.left) / (lens.right - lens.left);
        let y = (lens.top - p.y / scale) / (lens.top - lens.bottom);
        DVec2::new(x, y)
    };
    clip(project(a), project(b))
}

/// Clips a line to a rectangle a little larger than the picture, because painters handle endless
/// lines badly.
fn clip(a: DVec2, b: DVec2) -> Option<[DVec2; 2]> {
    const LEAST: f64 = -0.05;
    const MOST: f64 = 1.05;
    let way = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        if way[axis] == 0.0 {
            if !(LEAST..=MOST).contains(&a[axis]) {
                return None;
            }
            continue;
        }
        let [s, t] = [(LEAST - a[axis]) / way[axis], (MOST - a[axis]) / way[axis]];
        from = from.max(s.min(t));
        to = to.min(s.max(t));
    }
    (from <= to && from.is_finite() && to.is_finite()).then(|| [a + way * from, a + way * to])
}

#[cfg(test)]
mod tests {
    use umbrage::{DirectionalLight, Frustum, Planner, ShadowConfig};

    use super::*;

    fn view() -> View {
        let lens = Frustum::perspective(1.0, 1.5, 0.5, 200.0).expect("valid");
        View::look_at_upright(DVec3::new(0.0, 3.0, 10.0), DVec3::ZERO, lens).expect("valid")
    }

    #[test]
    fn what_is_before_the_eye_is_seen_and_what_is_behind_is_not() {
        let view = view();
        let ahead = view.eye() + view.forward() * 5.0;
        let behind = view.eye() - view.forward() * 5.0;
        let [a, b] = on_screen(&view, [ahead, ahead + DVec3::X]).expect("ahead");
        assert!((a - 0.5).length() < 1e-9 && b.x > 0.5, "{a} {b}");
        assert_eq!(on_screen(&view, [behind, behind + DVec3::X]), None);
        // A line through the eye is cut at the near plane, and all numbers stay small.
        let [a, b] = on_screen(&view, [behind + DVec3::X, ahead]).expect("half of it");
        assert!(a.abs().max(b.abs()).max_element() <= 1.06, "{a} {b}");
        assert_eq!(on_screen(&view, [ahead + DVec3::X * 1e3, ahead + DVec3::X * 2e3]), None, "beside the picture");
    }

    #[test]
    fn a_slice_is_the_picture_s_edge_and_maps_hold_it() {
        let view = view();
        for segment in slice(&view, 2.0, 20.0).iter().take(8) {
            for end in on_screen(&view, *segment).expect("seen") {
                let at_edge = |v: f64| v.abs() < 1e-9 || (v - 1.0).abs() < 1e-9;
                assert!(at_edge(end.x) && at_edge(end.y), "{end}");
            }
        }
        let world = [
            Aabb::new(DVec3::splat(-2.0), DVec3::splat(1.0)),
            Aabb::new(DVec3::new(-50.0, -2.1, -50.0), DVec3::new(50.0, -2.0, 50.0)),
        ];
        let sun = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("valid");
        let mut planner = Planner::new(&ShadowConfig::default()).expect("valid");
        let plan = planner.plan(&view, &sun, &world, &world).expect("valid");
        let all = frusta(plan, &view);
        assert!(!all.is_empty() && all.iter().all(|lines| (lines.slice.len(), lines.map.len()) == (12, 12)));
        for split in &plan.splits {
            for end in map_box(split).expect("a box").iter().flatten() {
                let at = split.map_from_world(*end);
                let size = f64::from(split.size);
                let near = |v: f64, edge: f64| (v - edge).abs() < 1e-6 * size;
                assert!((near(at.x, 0.0) || near(at.x, size)) && (near(at.y, 0.0) || near(at.y, size)), "{at}");
            }
        }
    }
}
