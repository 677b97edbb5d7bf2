//! Convex pieces of space: a slice of the view, and the slice swept towards the light.

use glam::DVec3;

use super::region::bits;
use crate::bounds::{Placed, rounding};
use crate::{Aabb, View};

/// A half space: inside is `normal · p <= offset`. The normal is a unit vector that points
/// outwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Plane {
    pub normal: DVec3,
    pub offset: f64,
}

impl Plane {
    /// The plane through `point` with `normal` turned away from `inside`.
    fn facing_away(normal: DVec3, point: DVec3, inside: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        let normal = if normal.dot(inside - point) > 0.0 { -normal } else { normal };
        Self { normal, offset: normal.dot(point) }
    }

    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// Signed distance of the box's innermost point.
    pub fn nearest(&self, center: DVec3, half: DVec3) -> f64 {
        self.distance(center) - self.normal.abs().dot(half)
    }

    /// Signed distance of the box's outermost point.
    pub fn farthest(&self, center: DVec3, half: DVec3) -> f64 {
        self.distance(center) + self.normal.abs().dot(half)
    }
}

/// Corner indices of the faces near, far, left, right, bottom, top; corners in the order of
/// [`View::slice_corners`].
const FACES: [[usize; 4]; 6] = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6]];

/// Edges as (corner, corner, face, face).
const EDGES: [(usize, usize, usize, usize); 12] = [
    (0, 1, 0, 4),
    (1, 3, 0, 3),
    (3, 2, 0, 5),
    (2, 0, 0, 2),
    (4, 5, 1, 4),
    (5, 7, 1, 3),
    (7, 6, 1, 5),
    (6, 4, 1, 2),
    (0, 4, 2, 4),
    (1, 5, 3, 4),
    (2, 6, 2, 5),
    (3, 7, 3, 5),
];

/// The part of a view between two view depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slice {
    pub corners: [DVec3; 8],
    pub planes: [Plane; 6],
    center: DVec3,
}

/// Corner indices of a box's faces; corners in the order of [`Aabb::corners`].
const BOX_FACES: [[usize; 4]; 6] = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];

/// Position of a box relative to a convex volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lies {
    Outside,
    Across,
    Inside,
}

impl Slice {
    pub fn new(view: &View, from: f64, to: f64) -> Self {
        Self::from_corners(view.slice_corners(from, to), view.forward())
    }

    /// A frustum from its corners, in the order of [`View::slice_corners`], and its opening
    /// direction.
    pub fn from_corners(corners: [DVec3; 8], forward: DVec3) -> Self {
        let center = corners.iter().sum::<DVec3>() / 8.0;
        let planes = std::array::from_fn(|i| match i {
            0 => Plane::facing_away(forward, corners[0], center),
            1 => Plane::facing_away(forward, corners[4], center),
            // Sides pass through the far edge and, unless the near face is a point, the near one.
            _ => {
                let [a, b, c, d] = FACES[i].map(|corner| corners[corner]);
                let diagonals = (c - a).cross(d - b);
                Plane::facing_away(diagonals, c, center)
            }
        });
        Self { corners, planes, center }
    }

    pub fn classify(&self, center: DVec3, half: DVec3) -> Lies {
        let mut lies = Lies::Inside;
        for plane in &self.planes {
            if plane.nearest(center, half) > 0.0 {
                return Lies::Outside;
            }
            if plane.farthest(center, half) > 0.0 {
                lies = Lies::Across;
            }
        }
        lies
    }

    /// Calls `each` with points whose convex hull is the part of `bounds` inside the slice: the
    /// box's faces clipped to the slice and the slice's faces clipped to the box. Returns whether
    /// there was any.
    pub fn clip_box(&self, bounds: &Aabb, mut each: impl FnMut(DVec3)) -> bool {
        let corners = bounds.corners();
        let box_planes = box_planes(bounds);
        let (mut any, mut clipper) = (false, Clipper::new());
        // Planes that lie beyond the box neither cut it nor have a part in it.
        let (center, half) = (bounds.center(), bounds.half_extent());
        let room = |plane: &Plane| BEYOND * ((center.abs() + half).element_sum() + plane.offset.abs());
        let is_near = self.planes.map(|plane| {
            let is_beyond = plane.farthest(center, half) < -room(&plane);
            !is_beyond
        });
        let (mut planes, mut len) = ([Plane::default(); 6], 0);
        for (plane, _) in self.planes.iter().zip(is_near).filter(|(_, is_near)| *is_near) {
            (planes[len], len) = (*plane, len + 1);
        }
        for face in BOX_FACES {
            let part = clipper.clip(face.map(|i| corners[i]), &planes[..len], 0.0);
            any |= !part.is_empty();
            part.iter().for_each(|&point| each(point));
        }
        for (face, _) in FACES.iter().zip(is_near).filter(|(_, is_near)| *is_near) {
            let part = clipper.clip(face.map(|i| self.corners[i]), &box_planes, 0.0);
            any |= !part.is_empty();
            part.iter().for_each(|&point| each(point));
        }
        any
    }

    /// Calls `each` with points whose convex hull is the part of the slice inside another one.
    pub fn clip_slice(&self, other: &Self, mut each: impl FnMut(DVec3)) {
        let mut clipper = Clipper::new();
        for (one, by) in [(self, other), (other, self)] {
            for face in FACES {
                let part = clipper.clip(face.map(|i| one.corners[i]), &by.planes, 0.0);
                part.iter().for_each(|&point| each(point));
            }
        }
    }

    /// Calls `each` with points whose convex hull is the part of `bounds` inside both this slice
    /// and another one.
    pub fn clip_box_with(&self, other: &Self, bounds: &Aabb, mut each: impl FnMut(DVec3)) {
        let corners = bounds.corners();
        let box_planes = box_planes(bounds);
        let mut clipper = Clipper::new();
        let mut emit = |corners: [DVec3; 4], by: [&[Plane]; 2]| {
            let part = clipper.clip(corners, by[0].iter().chain(by[1]), 0.0);
            part.iter().for_each(|&point| each(point));
        };
        for face in BOX_FACES {
            emit(face.map(|i| corners[i]), [&self.planes, &other.planes]);
        }
        for (one, by) in [(self, other), (other, self)] {
            for face in FACES {
                emit(face.map(|i| one.corners[i]), [&box_planes, &by.planes]);
            }
        }
    }

    /// The slice pushed to infinity towards the light that travels along `direction`.
    pub fn swept_towards_light(&self, direction: DVec3) -> SweptVolume {
        self.swept(self.planes.map(|plane| plane.normal.dot(direction) >= 0.0), |_| direction)
    }

    /// The common convex hull of the slice and a light at `position`. The planes through the light
    /// need no division, so a slice that straddles the light's plane, or that has the light inside,
    /// is no special case.
    pub fn swept_towards_point(&self, position: DVec3) -> SweptVolume {
        self.swept(self.planes.map(|plane| plane.distance(position) <= 0.0), |corner| {
            (corner - position).normalize_or_zero()
        })
    }

    /// The faces that are turned `away` from the light, and the planes through the slice's outline
    /// along the light. `travel` is the light's direction at a corner.
    fn swept(&self, away: [bool; 6], travel: impl Fn(DVec3) -> DVec3) -> SweptVolume {
        let mut swept = SweptVolume::default();
        for (plane, away) in self.planes.iter().zip(away) {
            if away {
                swept.push(*plane);
            }
        }
        for (a, b, f, g) in EDGES {
            let normal = (self.corners[b] - self.corners[a]).cross(travel(self.corners[a]));
            // An edge along the light is a point of the outline: its neighbours bound it.
            if away[f] != away[g] && normal.length() > 1e-9 * self.corners[b].distance(self.corners[a]) {
                swept.push(Plane::facing_away(normal, self.corners[a], self.center));
            }
        }
        swept
    }
}

/// Share of a coordinate by which a plane that is not near a box lies beyond it at least: much more
/// than rounding.
pub(super) const BEYOND: f64 = 1e-9;

fn box_planes(bounds: &Aabb) -> [Plane; 6] {
    [
        Plane { normal: DVec3::NEG_X, offset: -bounds.min.x },
        Plane { normal: DVec3::X, offset: bounds.max.x },
        Plane { normal: DVec3::NEG_Y, offset: -bounds.min.y },
        Plane { normal: DVec3::Y, offset: bounds.max.y },
        Plane { normal: DVec3::NEG_Z, offset: -bounds.min.z },
        Plane { normal: DVec3::Z, offset: bounds.max.z },
    ]
}

/// Most corners that clipping can make.
const MOST_CORNERS: usize = 28;

/// A convex volume, open towards the light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SweptVolume {
    planes: [Plane; 18],
    len: usize,
}

impl SweptVolume {
    fn push(&mut self, plane: Plane) {
        self.planes[self.len] = plane;
        self.len += 1;
    }

    pub fn planes(&self) -> &[Plane] {
        &self.planes[..self.len]
    }

    /// The planes that have to be tested for boxes inside a box to answer [`SweptVolume::meets`], a
    /// bit each; `None` if no such box comes within `margin` metres.
    pub fn undecided_in(&self, Placed { center, half }: &Placed, margin: f64) -> Option<u32> {
        let mut left = 0;
        for (bit, plane) in self.planes().iter().enumerate() {
            let (distance, reach) = (plane.distance(*center), plane.normal.abs().dot(*half));
            if distance - reach > margin {
                return None;
            }
            left |= u32::from(distance + reach > margin) << bit;
        }
        Some(left)
    }

    /// [`SweptVolume::meets`] for some of the planes.
    pub fn meets_some(&self, planes: u32, Placed { center, half }: &Placed, margin: f64) -> bool {
        bits(planes).all(|bit| self.planes[bit].nearest(*center, *half) <= margin)
    }

    /// Returns whether a box comes within `margin` metres of the volume (conservative).
    pub fn meets(&self, center: DVec3, half: DVec3, margin: f64) -> bool {
        self.planes[..self.len].iter().all(|plane| plane.nearest(center, half) <= margin)
    }

    /// Calls `each` with the corners of those parts of the box's faces that come within `margin`
    /// metres of the volume. No part of the box in that range lies nearer to the light.
    pub fn clip_box(&self, bounds: &Aabb, margin: f64, mut each: impl FnMut(DVec3)) {
        let (corners, mut clipper) = (bounds.corners(), Clipper::new());
        for face in BOX_FACES {
            let part = clipper.clip(face.map(|i| corners[i]), &self.planes[..self.len], margin);
            part.iter().for_each(|&point| each(point));
        }
    }

    pub fn contains(&self, point: DVec3) -> bool {
        self.planes[..self.len].iter().all(|plane| plane.distance(point) <= 0.0)
    }
}

/// Returns whether a box lies, along some world axis, entirely on the far side of all `receivers`
/// as seen from the light, so that there is nothing behind it to cast a shadow on. The main case is
/// a flat ground below the whole scene, which touches the objects that stand on it. A box that is
/// not flat has to lie `margin` metres beyond, because a filter also reads beside its receiver.
pub(crate) fn lies_below(center: DVec3, half: DVec3, receivers: &Aabb, direction: DVec3, margin: f64) -> bool {
    let slack = rounding(receivers.max - receivers.min);
    (0..3).any(|axis| {
        let beyond = match direction[axis] {
            along if along < -1e-9 => receivers.min[axis] - (center[axis] + half[axis]),
            along if along > 1e-9 => (center[axis] - half[axis]) - receivers.max[axis],
            _ => f64::NEG_INFINITY,
        };
        let is_flat = 2.0 * half[axis] <= slack;
        beyond >= if is_flat { -slack } else { margin }
    })
}

/// Returns whether [`lies_below`] may hold for a box among some, of which `core` has the greatest
/// lower corner and the least upper one.
pub(crate) fn some_lies_below(core: &Aabb, receivers: &Aabb, direction: DVec3) -> bool {
    let slack = rounding(receivers.max - receivers.min);
    (0..3).any(|axis| {
        let beyond = match direction[axis] {
            along if along < -1e-9 => receivers.min[axis] - core.max[axis],
            along if along > 1e-9 => core.min[axis] - receivers.max[axis],
            _ => f64::NEG_INFINITY,
        };
        beyond >= -slack
    })
}

/// Clips convex polygons of a few corners, on the stack.
struct Clipper([[DVec3; MOST_CORNERS]; 2]);

impl Clipper {
    fn new() -> Self {
        Self([[DVec3::ZERO; MOST_CORNERS]; 2])
    }

    /// Sutherland and Hodgman's clipping by one plane after the other, each moved outwards by
    /// `margin` metres. A plane can add one corner, so the most corners are four plus the 18 planes
    /// of a swept volume.
    fn clip<'a>(&mut self, corners: [DVec3; 4], planes: impl IntoIterator<Item = &'a Plane>, margin: f64) -> &[DVec3] {
        let [mut points, mut kept] = self.0.each_mut();
        points[..4].copy_from_slice(&corners);
        let mut len = 4;
        for plane in planes {
            let outside = points[..len].iter().filter(|&&point| plane.distance(point) - margin > 0.0).count();
            if outside == len {
                return &[];
            }
            if outside == 0 {
                continue;
            }
            let mut kept_len = 0;
            let mut push = |point| {
                // A concave corner cannot arise; rounding may repeat a point, which the bound
                // leaves room for.
                if kept_len < kept.len() {
                    kept[kept_len] = point;
                    kept_len += 1;
                }
            };
            let mut previous = points[len - 1];
            let mut previous_distance = plane.distance(previous) - margin;
            for &point in &points[..len] {
                let distance = plane.distance(point) - margin;
                if (distance > 0.0) != (previous_distance > 0.0) {
                    let t = previous_distance / (previous_distance - distance);
                    push(previous + t * (point - previous));
                }
                if distance <= 0.0 {
                    push(point);
                }
                (previous, previous_distance) = (point, distance);
            }
            len = kept_len;
            std::mem::swap(&mut points, &mut kept);
        }
        &points[..len]
    }
}
