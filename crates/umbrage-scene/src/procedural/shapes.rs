//! Solids: closed surfaces made of triangles that turn counter-clockwise seen from outside.
//!
//! Everything here is a loft, a skin stretched over a row of rings, except boxes and the subdivided
//! cube. Normals are not stored: they follow from the faces when a model is finished, smooth below
//! a crease angle and hard above it.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DVec2, DVec3, dvec3};

use super::maths::{sin_cos, turn};

/// Points and the triangles between them. Points that coincide on one surface are one point.
#[derive(Clone, Debug, Default)]
pub(super) struct Solid {
    pub(super) points: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
}

/// End of a loft.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// The convex polygon of the last ring.
    Flat,
    /// A point.
    Point(DVec3),
}

impl Solid {
    /// Makes a skin over `rings`, which have the same number of points and run counter-clockwise
    /// seen from the last ring.
    pub(super) fn loft(start: End, rings: &[Vec<DVec3>], end: End) -> Self {
        let around = rings[0].len();
        let mut solid = Self::default();
        for ring in rings {
            assert_eq!(ring.len(), around, "rings of one loft have one number of points");
            solid.points.extend(ring);
        }
        let point = |ring: usize, i: usize| (ring * around + i % around) as u32;
        for ring in 1..rings.len() {
            for i in 0..around {
                let (a, b) = (point(ring - 1, i), point(ring - 1, i + 1));
                let (d, c) = (point(ring, i), point(ring, i + 1));
                solid.quad([a, b, c, d]);
            }
        }
        let last = rings.len() - 1;
        let first_ring: Vec<u32> = (0..around).rev().map(|i| point(0, i)).collect();
        let last_ring: Vec<u32> = (0..around).map(|i| point(last, i)).collect();
        solid.close(&first_ring, start);
        solid.close(&last_ring, end);
        solid
    }

    /// Adds two triangles for four corners, cut along the shorter diagonal.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        let at = |i: u32| self.points[i as usize];
        // The bias keeps the choice the same where both are equal but for rounding.
        if at(a).distance_squared(at(c)) <= 1.000_001 * at(b).distance_squared(at(d)) {
            self.faces.extend([[a, b, c], [a, c, d]]);
        } else {
            self.faces.extend([[a, b, d], [b, c, d]]);
        }
    }

    fn close(&mut self, ring: &[u32], end: End) {
        match end {
            End::Flat => {
                // A zigzag from side to side keeps the triangles fatter than a fan from one corner
                // would.
                let (mut low, mut high) = (0, ring.len() - 1);
                while high - low >= 2 {
                    self.faces.push([ring[low], ring[low + 1], ring[high]]);
                    low += 1;
                    if high - low >= 2 {
                        self.faces.push([ring[low], ring[high - 1], ring[high]]);
                        high -= 1;
                    }
                }
            }
            End::Point(tip) => {
                let tip_index = self.points.len() as u32;
                self.points.push(tip);
                for (i, &corner) in ring.iter().enumerate() {
                    self.faces.push([corner, ring[(i + 1) % ring.len()], tip_index]);
                }
            }
        }
    }

    /// A box around the origin.
    pub(super) fn cuboid(size: [f64; 3]) -> Self {
        let half = 0.5 * DVec3::from_array(size);
        let ring = |y: f64| rectangle(half.x, half.z).into_iter().map(|p| dvec3(p.x, y, p.y)).collect();
        Self::loft(End::Flat, &[ring(-half.y), ring(half.y)], End::Flat)
    }

    /// A box around the origin whose edges are cut at 45°; 44 triangles.
    pub(super) fn bevelled(size: [f64; 3], bevel: f64) -> Self {
        let half = 0.5 * DVec3::from_array(size);
        let inner = half - DVec3::splat(bevel);
        let ring = |x: f64, z: f64, corner: f64, y: f64| {
            cut_rectangle(x, z, corner).into_iter().map(|p| dvec3(p.x, y, p.y)).collect::<Vec<_>>()
        };
        // The outer rings are octagons whose cut corners have shrunk to the bevel's own corner.
        let end = |y: f64| ring(inner.x, inner.z, 0.0, y);
        let middle = |y: f64| ring(half.x, half.z, bevel, y);
        let mut solid = Self::loft(End::Flat, &[middle(-inner.y), middle(inner.y)], End::Flat);
        solid.faces.truncate(16);
        for (sign, ring_start) in [(-1.0, 0_u32), (1.0, 8_u32)] {
            let cap_start = solid.points.len() as u32;
            // The end ring has its points in pairs; one of each pair is enough.
            solid.points.extend(end(sign * half.y).into_iter().step_by(2));
            for corner in 0..4_u32 {
                let (cut_a, cut_b) = (ring_start + 2 * corner, ring_start + 2 * corner + 1);
                let next = ring_start + (2 * corner + 2) % 8;
                let (tip, next_tip) = (cap_start + corner, cap_start + (corner + 1) % 4);
                let mut faces = vec![[cut_a, cut_b, tip], [cut_b, next, next_tip], [cut_b, next_tip, tip]];
                if sign < 0.0 {
                    faces.iter_mut().for_each(|face| face.swap(1, 2));
                }
                solid.faces.extend(faces);
            }
            let mut cap = vec![[cap_start, cap_start + 1, cap_start + 2], [cap_start, cap_start + 2, cap_start + 3]];
            if sign < 0.0 {
                cap.iter_mut().for_each(|face| face.swap(1, 2));
            }
            solid.faces.extend(cap);
        }
        solid
    }

    /// A straight block on the ground, `[width, depth]` below and above; 28 triangles, 12 if its
    /// vertical edges are not cut.
    pub(super) fn block(below: [f64; 2], above: [f64; 2], height: f64, cut: f64) -> Self {
        Self::stack(&[(0.0, below), (height, above)], cut)
    }

    /// Blocks one on another: cut rectangles of `[width, depth]` at rising heights.
    pub(super) fn stack(levels: &[(f64, [f64; 2])], cut: f64) -> Self {
        let rings: Vec<Vec<DVec3>> = levels
            .iter()
            .map(|&(y, [width, depth])| {
                let (x, z) = (0.5 * width, 0.5 * depth);
                let outline = if cut > 0.0 { cut_rectangle(x, z, cut) } else { rectangle(x, z) };
                outline.into_iter().map(|p| dvec3(p.x, y, p.y)).collect()
            })
            .collect();
        Self::loft(End::Flat, &rings, End::Flat)
    }

    /// A body of revolution about Y. The profile is `[radius, height]` and runs so that the solid
    /// lies to its left (up the outside); ends with radius 0 are points, others are closed flat.
    pub(super) fn lathe(profile: &[[f64; 2]], segments: usize) -> Self {
        let (mut middle, mut start, mut end) = (profile, End::Flat, End::Flat);
        if let [[radius, y], rest @ ..] = middle
            && *radius == 0.0
        {
            (start, middle) = (End::Point(dvec3(0.0, *y, 0.0)), rest);
        }
        if let [rest @ .., [radius, y]] = middle
            && *radius == 0.0
        {
            (end, middle) = (End::Point(dvec3(0.0, *y, 0.0)), rest);
        }
        let rings: Vec<Vec<DVec3>> = middle
            .iter()
            .map(|&[radius, y]| circle(segments).map(|p| dvec3(radius * p.x, y, -radius * p.y)).collect())
            .collect();
        Self::loft(start, &rings, end)
    }

    /// A closed profile turned about Y: a ring. `[radius, height]`, counter-clockwise.
    pub(super) fn hoop(profile: &[[f64; 2]], segments: usize) -> Self {
        let around = profile.len();
        let mut solid = Self::default();
        for direction in circle(segments) {
            solid
                .points
                .extend(profile.iter().map(|&[radius, y]| dvec3(radius * direction.x, y, -radius * direction.y)));
        }
        for segment in 0..segments {
            let (here, there) = (segment * around, (segment + 1) % segments * around);
            for i in 0..around {
                let next = (i + 1) % around;
                solid.quad([here + i, there + i, there + next, here + next].map(|i| i as u32));
            }
        }
        solid
    }

    /// A sector of a hoop with rectangular profile, between two radii, heights and angles in
    /// degrees.
    pub(super) fn sector(radii: [f64; 2], heights: [f64; 2], angles: [f64; 2], segments: usize) -> Self {
        let section = |angle: f64| {
            let (sin, cos) = sin_cos(angle);
            let at = |radius: f64, y: f64| dvec3(radius * cos, y, -radius * sin);
            vec![at(radii[0], heights[0]), at(radii[0], heights[1]), at(radii[1], heights[1]), at(radii[1], heights[0])]
        };
        let rings: Vec<_> =
            (0..=segments).map(|i| section(angles[0] + (angles[1] - angles[0]) * i as f64 / segments as f64)).collect();
        Self::loft(End::Flat, &rings, End::Flat)
    }

    /// A cylinder or truncated cone on the ground; radius 0 makes a tip.
    pub(super) fn cone(below: f64, above: f64, height: f64, segments: usize) -> Self {
        Self::lathe(&[[below, 0.0], [above, height]], segments)
    }

    /// A cylinder between two points.
    pub(super) fn rod(from: DVec3, to: DVec3, radius: f64, segments: usize) -> Self {
        Self::tube(&[(from, radius), (to, radius)], segments)
    }

    /// A ball around the origin.
    pub(super) fn sphere(radius: f64, segments: usize, rings: usize) -> Self {
        let profile: Vec<[f64; 2]> = (0..=rings)
            .map(|i| match i {
                0 => [0.0, -radius],
                i if i == rings => [0.0, radius],
                i => {
                    let (sin, cos) = sin_cos(180.0 * i as f64 / rings as f64);
                    [radius * sin, -radius * cos]
                }
            })
            .collect();
        Self::lathe(&profile, segments)
    }

    /// A round tube along a path of points and radii; a radius of 0 at an end makes a tip.
    pub(super) fn tube(path: &[(DVec3, f64)], segments: usize) -> Self {
        Self::sweep(path, &circle(segments).collect::<Vec<_>>())
    }

    /// A convex outline of size 1 (counter-clockwise, x to the right of the path, y towards its
    /// upper side), scaled and carried along a path without twisting.
    pub(super) fn sweep(path: &[(DVec3, f64)], outline: &[DVec2]) -> Self {
        let count = path.len();
        let tangent = |i: usize| (path[(i + 1).min(count - 1)].0 - path[i.saturating_sub(1)].0).normalize();
        let mut forward = tangent(0);
        let helper = if forward.y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
        let mut side = helper.cross(forward).normalize();
        let (mut rings, mut start, mut end) = (Vec::new(), End::Flat, End::Flat);
        for (i, &(center, radius)) in path.iter().enumerate() {
            forward = tangent(i);
            // Carrying the side along and making it perpendicular again is the frame with the least
            // twist, nearly.
            side = (side - forward * side.dot(forward)).normalize();
            let up = forward.cross(side);
            if radius == 0.0 {
                *(if i == 0 { &mut start } else { &mut end }) = End::Point(center);
            } else {
                rings.push(outline.iter().map(|p| center + radius * (p.x * side + p.y * up)).collect());
            }
        }
        Self::loft(start, &rings, end)
    }

    /// A body drawn in profile: each section is a rounded oval whose long axis runs from one point
    /// of the profile (in the XY plane) to another and whose half thickness along Z is the last
    /// number. Seen from +Z, with the body growing upwards, the first point is on the left.
    pub(super) fn profile(sections: &[([f64; 2], [f64; 2], f64)], segments: usize, squareness: f64) -> Self {
        let rings: Vec<Vec<DVec3>> = sections
            .iter()
            .map(|&(left, right, thickness)| {
                let (left, right) = (DVec2::from_array(left), DVec2::from_array(right));
                let (middle, half) = (0.5 * (left + right), 0.5 * (right - left));
                oval(segments, squareness).map(|p| (middle + half * p.x).extend(-thickness * p.y)).collect()
            })
            .collect();
        Self::loft(End::Flat, &rings, End::Flat)
    }

    /// A thick sheet: `at(u, v)` gives front and back of the sheet at shares 0 to 1 of its width
    /// and height; the front is seen with u to the right and v up.
    pub(super) fn slab(columns: usize, rows: usize, at: impl Fn(f64, f64) -> (DVec3, DVec3)) -> Self {
        let rings: Vec<Vec<DVec3>> = (0..=rows)
            .map(|row| {
                let pair = |column: usize| at(column as f64 / columns as f64, row as f64 / rows as f64);
                let front = (0..=columns).map(|column| pair(column).0);
                front.chain((0..=columns).rev().map(|column| pair(column).1)).collect()
            })
            .collect();
        // The zigzag of a flat end joins front and back in pairs, so a wavy sheet is closed as well
        // as a straight one.
        Self::loft(End::Flat, &rings, End::Flat)
    }

    /// A ball of radius 1 made from a cube with `cells` × `cells` squares a side; 12·cells²
    /// triangles.
    pub(super) fn cube_sphere(cells: i32) -> Self {
        let mut solid = Self::default();
        let mut known = BTreeMap::new();
        for axis in 0..3 {
            for side in [0, cells] {
                let mut corner = |u: i32, v: i32| {
                    let mut at = [0; 3];
                    at[axis] = side;
                    at[(axis + 1) % 3] = u;
                    at[(axis + 2) % 3] = v;
                    *known.entry(at).or_insert_with(|| {
                        // Even angles instead of even steps keep the squares alike.
                        let even =
                            |i: i32| libm::tan((f64::from(i) / f64::from(cells) - 0.5) * std::f64::consts::FRAC_PI_2);
                        solid.points.push(DVec3::from_array(at.map(even)).normalize());
                        solid.points.len() as u32 - 1
                    })
                };
                let mut quads = Vec::new();
                for u in 0..cells {
                    for v in 0..cells {
                        let quad = [corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1)];
                        quads.push(if side == 0 { [quad[0], quad[3], quad[2], quad[1]] } else { quad });
                    }
                }
                quads.into_iter().for_each(|quad| solid.quad(quad));
            }
        }
        solid
    }

    /// Moves every point by a function that keeps the surface from turning inside out.
    #[must_use]
    pub(super) fn bent(mut self, bend: impl Fn(DVec3) -> DVec3) -> Self {
        self.points.iter_mut().for_each(|point| *point = bend(*point));
        self
    }

    /// Transforms the solid. A mirror image keeps its outside outside.
    #[must_use]
    pub(super) fn transformed(mut self, transform: &DAffine3) -> Self {
        self.points.iter_mut().for_each(|point| *point = transform.transform_point3(*point));
        if transform.matrix3.determinant() < 0.0 {
            self.faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        self
    }

    /// Moves the solid by (x, y, z).
    #[must_use]
    pub(super) fn at(self, x: f64, y: f64, z: f64) -> Self {
        self.transformed(&DAffine3::from_translation(dvec3(x, y, z)))
    }

    /// Rotates the solid about the origin.
    #[must_use]
    pub(super) fn turned(self, axis: DVec3, degrees: f64) -> Self {
        self.transformed(&DAffine3::from_quat(turn(axis, degrees)))
    }

    /// Scales the solid about the origin.
    #[must_use]
    pub(super) fn scaled(self, x: f64, y: f64, z: f64) -> Self {
        self.transformed(&DAffine3::from_mat3(DMat3::from_diagonal(dvec3(x, y, z))))
    }

    /// Adds the mirror image in the plane x = 0.
    #[must_use]
    pub(super) fn and_mirrored(self) -> Self {
        let image = self.clone().scaled(-1.0, 1.0, 1.0);
        self.and(image)
    }

    /// Joins two solids. Their surfaces stay apart even where they touch.
    #[must_use]
    pub(super) fn and(mut self, other: Self) -> Self {
        let offset = self.points.len() as u32;
        self.points.extend(other.points);
        self.faces.extend(other.faces.into_iter().map(|face| face.map(|i| i + offset)));
        self
    }

    /// Joins all solids.
    pub(super) fn all(solids: impl IntoIterator<Item = Self>) -> Self {
        solids.into_iter().fold(Self::default(), Self::and)
    }
}

/// Unit vectors around a circle, counter-clockwise. Seen from above, that is (x, ·, −y) in the
/// world.
fn circle(segments: usize) -> impl Iterator<Item = DVec2> {
    (0..segments).map(move |i| {
        let (sin, cos) = sin_cos(360.0 * i as f64 / segments as f64);
        DVec2::new(cos, sin)
    })
}

/// A circle whose shape moves towards a square: 0 round, 1 nearly a square.
fn oval(segments: usize, squareness: f64) -> impl Iterator<Item = DVec2> {
    circle(segments).map(move |p| {
        let stretch = 1.0 / p.x.abs().max(p.y.abs());
        p * (1.0 + squareness * (stretch - 1.0))
    })
}

fn rectangle(x: f64, z: f64) -> Vec<DVec2> {
    vec![DVec2::new(x, z), DVec2::new(x, -z), DVec2::new(-x, -z), DVec2::new(-x, z)]
}

fn cut_rectangle(x: f64, z: f64, cut: f64) -> Vec<DVec2> {
    vec![
        DVec2::new(x - cut, z),
        DVec2::new(x, z - cut),
        DVec2::new(x, cut - z),
        DVec2::new(x - cut, -z),
        DVec2::new(cut - x, -z),
        DVec2::new(-x, cut - z),
        DVec2::new(-x, z - cut),
        DVec2::new(cut - x, z),
    ]
}

/// A round outline for [`Solid::sweep`] with ribs as deep as `depth` of the radius.
pub(super) fn ribbed(ribs: usize, steps_per_rib: usize, depth: f64) -> Vec<DVec2> {
    circle(ribs * steps_per_rib)
        .enumerate()
        .map(|(i, p)| p * (1.0 - depth * (0.5 - 0.5 * sin_cos(360.0 * i as f64 / steps_per_rib as f64).1)))
        .collect()
}

/// The outline of a beam for [`Solid::sweep`]: a rectangle of half sizes `x`, `y` with cut corners.
pub(super) fn beam(x: f64, y: f64, cut: f64) -> Vec<DVec2> {
    cut_rectangle(x, y, cut).into_iter().map(|p| DVec2::new(p.x, -p.y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(solid: &Solid) -> f64 {
        let at = |i: u32| solid.points[i as usize];
        solid.faces.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum()
    }

    /// Returns whether every edge is walked once in each direction.
    fn is_closed(solid: &Solid) -> bool {
        let mut balance = BTreeMap::new();
        for face in &solid.faces {
            for k in 0..3 {
                let (from, to) = (face[k], face[(k + 1) % 3]);
                *balance.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        balance.values().all(|&sum| sum == 0)
    }

    #[test]
    fn solids_are_closed_and_as_large_as_geometry_says() {
        use std::f64::consts::PI;
        let disc = |segments: usize, radius: f64| {
            // A regular polygon's area.
            0.5 * segments as f64 * radius * radius * (2.0 * PI / segments as f64).sin()
        };
        let cases = [
            ("box", Solid::cuboid([1.0, 2.0, 3.0]), 6.0),
            // A box less twelve triangular prisms, plus what they take twice at the corners.
            ("bevelled", Solid::bevelled([2.0, 2.0, 2.0], 0.5), 8.0 - 12.0 * 0.125 - 8.0 * 5.0 / 48.0),
            ("block", Solid::block([2.0, 1.0], [2.0, 1.0], 3.0, 0.0), 6.0),
            ("cut block", Solid::block([2.0, 2.0], [2.0, 2.0], 1.0, 0.5), 3.5),
            ("cylinder", Solid::cone(2.0, 2.0, 3.0, 9), 3.0 * disc(9, 2.0)),
            ("cone", Solid::cone(2.0, 0.0, 3.0, 9), disc(9, 2.0)),
            ("rod", Solid::rod(dvec3(1.0, 2.0, 3.0), dvec3(1.0, 4.0, 3.0), 0.5, 7), 2.0 * disc(7, 0.5)),
            ("hoop", Solid::hoop(&[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], 12), disc(12, 2.0) - disc(12, 1.0)),
            ("sector", Solid::sector([1.0, 2.0], [0.0, 1.0], [0.0, 90.0], 3), 0.25 * (disc(12, 2.0) - disc(12, 1.0))),
            ("slab", Solid::slab(4, 3, |u, v| (dvec3(u, v, 0.1), dvec3(u, v, 0.0))), 0.1),
        ];
        for (name, solid, expected) in cases {
            assert!(is_closed(&solid), "{name}");
            assert!((volume(&solid) - expected).abs() < 1e-9, "{name}: {} m³, not {expected}", volume(&solid));
            let mirrored = solid.scaled(-1.0, 1.0, 1.0);
            assert!((volume(&mirrored) - expected).abs() < 1e-9, "mirrored {name} stays outside out");
        }
        for (name, ball) in [("sphere", Solid::sphere(1.0, 48, 32)), ("cube sphere", Solid::cube_sphere(16))] {
            assert!(is_closed(&ball), "{name}");
            let share = volume(&ball) / (4.0 / 3.0 * PI);
            assert!((0.98..1.0).contains(&share), "{name} fills {share} of its ball");
        }
    }

    #[test]
    fn an_open_solid_is_noticed() {
        let mut open = Solid::cuboid([1.0; 3]);
        open.faces.pop();
        assert!(!is_closed(&open));
    }

    #[test]
    fn triangles_are_as_many_as_promised() {
        assert_eq!(Solid::cuboid([1.0; 3]).faces.len(), 12);
        assert_eq!(Solid::bevelled([1.0; 3], 0.1).faces.len(), 44);
        assert_eq!(Solid::block([1.0; 2], [1.0; 2], 1.0, 0.1).faces.len(), 28);
        assert_eq!(Solid::cube_sphere(5).faces.len(), 12 * 25);
    }
}
