//! `lib/edges.wesl` on the CPU: the decision whether the triangles that texels name shade a point.

use super::bias::Receiver;
use crate::ExactEdges;

/// `edges::LEAST_M`: metres along the light within which nothing shades.
pub const LEAST_M: f32 = 0.002;
/// `edges::SLACK_TEXELS`: texels by which a stored depth may lie in front of the receiver's plane
/// before the point is tested, in addition to the receiver's own bias.
pub const SLACK_TEXELS: f32 = 0.25;
/// `edges::STEEPEST`: tangent of the steepest angle at which the receiver's plane is followed.
pub const STEEPEST: f32 = 20.0;
/// `edges::LOST`: share of the numbers involved that `f32` may have lost.
pub const LOST: f32 = 9.536_743e-7;
/// `edges::ROUND`: offsets of the nine texels, the middle one first.
pub const ROUND: [[f32; 2]; 9] =
    [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];

/// `UmbrageRun` with its corners: triangles in a space of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Rows of the affine transform from metres relative to the frame's origin to that space.
    pub rows: [[f32; 4]; 3],
    /// Least corner of a box around the triangles.
    pub min: [f32; 3],
    /// Greatest corner of the box.
    pub max: [f32; 3],
    /// The triangles.
    pub triangles: Vec<[[f32; 3]; 3]>,
}

impl Run {
    /// A run of triangles in the space of the frame.
    #[must_use]
    pub fn in_frame(triangles: &[[[f32; 3]; 3]]) -> Self {
        let corners = || triangles.iter().flatten();
        let ends = |f: fn(f32, f32) -> f32, from: f32| -> [f32; 3] {
            std::array::from_fn(|axis| corners().map(|corner| corner[axis]).fold(from, f))
        };
        Self {
            rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
            min: ends(f32::min, f32::INFINITY),
            max: ends(f32::max, f32::NEG_INFINITY),
            triangles: triangles.to_vec(),
        }
    }
}

/// `edges::Ray`: the ray from a point to the light, and the pixel around the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin in metres from the frame's origin.
    pub origin: [f32; 3],
    /// Unit vector towards the light.
    pub to_light: [f32; 3],
    /// Distance to the light in metres.
    pub length_m: f32,
    /// Change of the position to the next pixel on the right and to the next one below, in metres.
    pub pixel: [[f32; 3]; 2],
}

impl Ray {
    /// The ray from a point without a pixel to a sun.
    #[must_use]
    pub const fn to_sun(origin: [f32; 3], to_light: [f32; 3]) -> Self {
        Self { origin, to_light, length_m: 3e38, pixel: [[0.0; 3]; 2] }
    }
}

/// Contents of the nine texels around a point, in the order of [`ROUND`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// Corner of the middle texel that is nearest to the map's first corner, in texels of the
    /// light's plane: whole numbers.
    pub middle: [f32; 2],
    /// Stored depths.
    pub depths: [f32; 9],
    /// Ids; 0 for no run.
    pub ids: [u32; 9],
}

/// Decision for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// No triangle lies on the ray to the light.
    Lit,
    /// All texels that count contain a surface in front of the point.
    Covered,
    /// A triangle that a texel names shades the point, or some positions of its pixel.
    Shaded,
    /// A caster without an id may shade the point: the filter decides.
    Undecided,
}

/// `edges::decided`: `runs` gives the run of an id that is not 0.
pub fn decided<'a>(at: &Receiver, around: &Around, ray: Ray, runs: impl Fn(u32) -> &'a Run) -> Decision {
    shares(at, around, ray, ExactEdges::default(), runs).0
}

/// `edges::decided` for several positions of a pixel: the decision, and the share of positions that
/// no triangle shades.
pub fn shares<'a>(
    at: &Receiver,
    around: &Around,
    ray: Ray,
    edges: ExactEdges,
    runs: impl Fn(u32) -> &'a Run,
) -> (Decision, f32) {
    let dark = dark_round(at, around);
    if dark == 0 {
        return (Decision::Lit, 1.0);
    }
    let places = edges.places();
    let beyond = [0, 1].map(|axis| at.texel[axis] - around.middle[axis] >= 0.5);
    let four = four_of(beyond);
    let enough = if places.len() > 1 { 511 } else { four };
    if dark & enough == enough {
        return (Decision::Covered, 0.0);
    }
    let (mut without_name, mut lit) = (false, vec![true; places.len()]);
    for (i, &id) in around.ids.iter().enumerate() {
        if id == 0 {
            without_name |= dark & four & (1 << i) != 0;
        } else if !around.ids[..i].contains(&id) {
            let shaded = shaded_places(runs(id), ray, &places);
            lit.iter_mut().zip(shaded).for_each(|(lit, shaded)| *lit &= !shaded);
        }
    }
    let share = lit.iter().filter(|lit| **lit).count() as f32 / places.len() as f32;
    let decision = match () {
        () if without_name && share > 0.0 => Decision::Undecided,
        () if share < 1.0 => Decision::Shaded,
        () => Decision::Lit,
    };
    (decision, share)
}

/// `edges::four_of`: mask of the four texels of [`ROUND`] around a point.
#[must_use]
pub fn four_of(beyond: [bool; 2]) -> u32 {
    let [right, below] = beyond.map(u32::from);
    1 | 1 << (1 + right) | 1 << (3 + below) | 1 << (5 + right + 2 * below)
}

/// `edges::dark_round`: mask of those of the nine texels that contain a surface in front of the
/// receiver's plane.
#[must_use]
pub fn dark_round(at: &Receiver, around: &Around) -> u32 {
    let slope: [f32; 2] = std::array::from_fn(|axis| {
        let most = STEEPEST * at.texel_m[axis] / at.range_m;
        at.slope[axis].clamp(-most, most)
    });
    let slack = (SLACK_TEXELS * at.texel_m[0].max(at.texel_m[1]) + LEAST_M) / at.range_m;
    let mut dark = 0;
    for (i, step) in ROUND.iter().enumerate() {
        let offset: [f32; 2] = std::array::from_fn(|axis| around.middle[axis] + step[axis] + 0.5 - at.texel[axis]);
        let plane = at.level(offset) + slope[0] * offset[0] + slope[1] * offset[1] - slack;
        dark |= u32::from(around.depths[i] < at.as_stored(plane)) << i;
    }
    dark
}

/// `edges::lit_past` of one position: returns whether a run of triangles shades a point.
#[must_use]
pub fn shades(run: &Run, ray: Ray) -> bool {
    shaded_places(run, ray, &[[0.0; 2]])[0]
}

/// `edges::lit_past`: returns for each position of a pixel whether a run of triangles shades it.
fn shaded_places(run: &Run, ray: Ray, places: &[[f32; 2]]) -> Vec<bool> {
    let own = |v: [f32; 3]| run.rows.map(|[x, y, z, _]| dot([x, y, z], v));
    let origin = run.rows.map(|[x, y, z, w]| dot([x, y, z], ray.origin) + w);
    let (to_light, pixel) = (own(ray.to_light), ray.pixel.map(own));
    let lost = LOST * (largest(ray.origin) * length(to_light) + largest(origin));
    let several = if places.len() > 1 { 0.5 } else { 0.0 };
    let by = [0, 1, 2].map(|axis| several * (pixel[0][axis].abs() + pixel[1][axis].abs()) + lost);
    if !meets_box(run, origin, to_light, by, ray.length_m) {
        return vec![false; places.len()];
    }
    let axis = dominant(to_light);
    let along = turned(to_light, axis);
    let shear = [along[0] / along[2], along[1] / along[2]];
    let shaded = |[right, below]: &[f32; 2]| {
        let aside = turned([0, 1, 2].map(|axis| right * pixel[0][axis] + below * pixel[1][axis]), axis);
        run.triangles.iter().any(|corners| {
            let corners = corners.map(|corner| minus(turned(minus(corner, origin), axis), aside));
            is_before(corners, shear, along[2], [ray.length_m, lost])
        })
    };
    places.iter().map(shaded).collect()
}

fn meets_box(run: &Run, origin: [f32; 3], direction: [f32; 3], by: [f32; 3], length_m: f32) -> bool {
    let (mut enters, mut leaves) = (0.0f32, length_m);
    for axis in 0..3 {
        let inverse = 1.0 / if direction[axis].abs() < 1e-20 { 1e-20 } else { direction[axis] };
        let one = (run.min[axis] - by[axis] - origin[axis]) * inverse;
        let other = (run.max[axis] + by[axis] - origin[axis]) * inverse;
        (enters, leaves) = (enters.max(one.min(other)), leaves.min(one.max(other)));
    }
    enters <= leaves
}

fn is_before([a, b, c]: [[f32; 3]; 3], shear: [f32; 2], along: f32, [length_m, lost]: [f32; 2]) -> bool {
    let [p, q, r] = [a, b, c].map(|corner| [corner[0] - shear[0] * corner[2], corner[1] - shear[1] * corner[2]]);
    let weights = [r[0] * q[1] - r[1] * q[0], p[0] * r[1] - p[1] * r[0], q[0] * p[1] - q[1] * p[0]];
    let twice_area: f32 = weights.iter().sum();
    let is_under = weights.iter().all(|weight| *weight >= 0.0) || weights.iter().all(|weight| *weight <= 0.0);
    if !is_under || twice_area == 0.0 {
        return false;
    }
    let metres = dot(weights, [a[2], b[2], c[2]]) / (twice_area * along);
    if metres <= LEAST_M || metres >= length_m {
        return false;
    }
    let normal = cross(minus(b, a), minus(c, a));
    let reach = length(a).max(length(b)).max(length(c));
    dot(normal, a).abs() > (lost + LOST * reach) * length(normal)
}

fn dominant(v: [f32; 3]) -> usize {
    let [x, y, z] = v.map(f32::abs);
    match () {
        () if x >= y && x >= z => 0,
        () if y >= z => 1,
        () => 2,
    }
}

fn turned([x, y, z]: [f32; 3], axis: usize) -> [f32; 3] {
    match axis {
        0 => [y, z, x],
        1 => [z, x, y],
        _ => [x, y, z],
    }
}

fn largest(v: [f32; 3]) -> f32 {
    v.into_iter().fold(0.0, |most, x| x.abs().max(most))
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f32; 3]) -> f32 {
    dot(a, a).sqrt()
}
