//! Exact edges against closed forms and brute force, on maps made of rays: `shaders/lib/edges.wesl`
//! by its twin.

use std::collections::BTreeMap;

use proptest::prelude::*;
use umbrage_shaders::ExactEdges;
use umbrage_shaders::layout::{RUN_TRIANGLES, Split};
use umbrage_shaders::twin::bias::{self, Receiver};
use umbrage_shaders::twin::edges::{Around, Decision, ROUND, Ray, Run, decided, shades, shares as shared};

type Triangle = [[f32; 3]; 3];

/// Metres between depth 0, at y = 50, and depth 1, at y = -50.
const RANGE: f32 = 100.0;

/// A map seen from straight above, texels of `texel` metres, u along x and v along z.
struct Map {
    split: Split,
    triangles: Vec<Triangle>,
    runs: Vec<Run>,
}

impl Map {
    fn of(texel: f32, triangles: &[Triangle]) -> Self {
        let split = Split {
            u_row: [1.0 / texel, 0.0, 0.0, 0.0],
            v_row: [0.0, 0.0, 1.0 / texel, 0.0],
            depth_row: [0.0, -1.0 / RANGE, 0.0, 0.5],
            texel_m: [texel; 2],
            depth_range_m: RANGE,
            size: 1024.0,
            ..Split::default()
        };
        let runs = triangles.chunks(RUN_TRIANGLES as usize).map(Run::in_frame).collect();
        Self { split, triangles: triangles.to_vec(), runs }
    }

    /// The nearest triangle at a place, as depth and number: in f64, by barycentric coordinates.
    fn nearest(&self, x: f64, z: f64) -> Option<(f32, usize)> {
        let hits = self.triangles.iter().enumerate().filter_map(|(i, triangle)| Some((height_at(triangle, x, z)?, i)));
        let (height, triangle) = hits.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(((0.5 - height / f64::from(RANGE)) as f32, triangle))
    }

    /// What lies round a point, ids by `id` of a triangle's number.
    fn around(&self, at: &Receiver, id: impl Fn(usize) -> u32) -> Around {
        let middle = at.texel.map(f32::floor);
        let texel = f64::from(self.split.texel_m[0]);
        let held = ROUND.map(|[du, dv]| {
            let centre = |axis: usize, by: f32| (f64::from(middle[axis] + by) + 0.5) * texel;
            let hit = self.nearest(centre(0, du), centre(1, dv));
            hit.map_or((1.0, 0), |(depth, triangle)| (depth, id(triangle)))
        });
        Around { middle, depths: held.map(|(depth, _)| depth), ids: held.map(|(_, id)| id) }
    }

    fn receiver(&self, point: [f32; 3], normal: [f32; 3]) -> Receiver {
        bias::receiver(&self.split, point, normal, [0.0, 1.0, 0.0])
    }

    /// The decision at a point of a surface, ids changed by `id`.
    fn decide(&self, point: [f32; 3], normal: [f32; 3], id: impl Fn(usize) -> u32) -> Decision {
        let at = self.receiver(point, normal);
        let ray = Ray::to_sun(point, normal, [0.0, 1.0, 0.0]);
        decided(&at, &self.around(&at, id), ray, |id| &self.runs[id as usize - 1])
    }

    /// Whether any triangle but the point's own stands above a point, or may by rounding.
    fn is_dark_by_others(&self, own: &Triangle, [x, y, z]: [f32; 3]) -> bool {
        let others = self.triangles.iter().filter(|other| *other != own);
        let mut heights = others.filter_map(|triangle| height_at(triangle, f64::from(x), f64::from(z)));
        heights.any(|height| height > f64::from(y - UNSURE_M))
    }

    /// Whether anything stands above a point, by all triangles.
    fn is_dark(&self, [x, y, z]: [f32; 3]) -> bool {
        let mut heights = self.triangles.iter().filter_map(|triangle| height_at(triangle, f64::from(x), f64::from(z)));
        heights.any(|height| height > f64::from(y))
    }
}

/// The id of a triangle's run.
fn id_of(triangle: usize) -> u32 {
    1 + triangle as u32 / RUN_TRIANGLES
}

/// The height of a triangle over a place, edges inside.
fn height_at(triangle: &Triangle, x: f64, z: f64) -> Option<f64> {
    let [a, b, c] = triangle.map(|corner| corner.map(f64::from));
    let side = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]) * (z - p[2]) - (q[2] - p[2]) * (x - p[0]);
    let weights = [side(b, c), side(c, a), side(a, b)];
    let area: f64 = weights.iter().sum();
    let inside = weights.iter().all(|w| *w >= 0.0) || weights.iter().all(|w| *w <= 0.0);
    (inside && area != 0.0).then(|| (weights[0] * a[1] + weights[1] * b[1] + weights[2] * c[1]) / area)
}

fn quad([x0, x1]: [f32; 2], [z0, z1]: [f32; 2], y: f32) -> [Triangle; 2] {
    let [a, b, c, d] = [[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]];
    [[a, b, c], [a, c, d]]
}

/// A plate over the ground, its edge at every place within a texel, points as close to it as `f32`
/// tells apart: all decided as they are, whatever the texel.
#[test]
fn a_quads_edge_is_exact_at_every_sub_texel_offset() {
    let up = [0.0, 1.0, 0.0];
    let mut asked = 0;
    for texel in [0.05f32, 0.4, 1.0, 3.0] {
        for step in 0..64u8 {
            let edge = texel * (5.0 + f32::from(step) / 64.0);
            let plate = quad([edge, edge + 9.0 * texel], [-20.0 * texel, 20.0 * texel], 4.0);
            let map = Map::of(texel, &[quad([-200.0, 200.0], [-200.0, 200.0], 0.0), plate].concat());
            let near = 1e-5 * (1.0 + edge);
            for aside in [-1.4 * texel, -0.3 * texel, -near, near, 0.3 * texel, 1.4 * texel] {
                for z in [0.1f32, 0.37, 0.5, 0.93] {
                    let point = [edge + aside, 0.0, z * texel];
                    let truth = map.is_dark(point);
                    assert_eq!(truth, aside > 0.0);
                    let found = map.decide(point, up, id_of);
                    let is_dark = matches!(found, Decision::Covered | Decision::Shaded);
                    assert_eq!(is_dark, truth, "texel {texel}, edge {edge}, aside {aside}: {found:?}");
                    asked += 1;
                }
            }
        }
    }
    assert_eq!(asked, 4 * 64 * 6 * 4);
}

/// Edges of plates under ids that are one too high: what is found is wrong, and is seen to be.
#[test]
fn shifted_ids_are_seen() {
    let up = [0.0, 1.0, 0.0];
    let plate = |edge: f32| quad([edge, edge + 9.0], [-20.0, 20.0], 4.0);
    let (mut right, mut wrong) = (0, 0);
    for step in 0..64u8 {
        let edge = 5.0 + f32::from(step) / 64.0;
        // The plate's run, the ground's, and one that is far away: ids that are one too high name
        // the ground for the plate, and nothing here for the ground.
        let ground: Vec<Triangle> = (0..4u8).flat_map(|i| quad([-60.0, 60.0], [-60.0, 60.0], -f32::from(i))).collect();
        let far: Vec<Triangle> = (0..4u8).flat_map(|i| quad([300.0, 301.0], [0.0, 1.0], f32::from(i))).collect();
        let plates: Vec<Triangle> = (0..4).flat_map(|_| plate(edge)).collect();
        let map = Map::of(1.0, &[plates, ground, far].concat());
        for (aside, z) in [(0.02f32, 0.3f32), (0.3, 0.8), (0.45, 0.5)] {
            let point = [edge + aside, 0.0, z];
            let decide = |id: &dyn Fn(usize) -> u32| map.decide(point, up, id);
            let is_dark = |found| matches!(found, Decision::Covered | Decision::Shaded);
            right += u32::from(is_dark(decide(&id_of)));
            wrong += u32::from(!is_dark(decide(&|triangle| id_of(triangle) + 1)));
        }
    }
    assert_eq!(right, 192, "of 192 dark points");
    assert!(wrong > 60, "{wrong} points went wrong");
}

/// A caster that cannot be asked stands before one that can: its texels name nothing, and what lies
/// behind it is not asked in its place.
#[test]
fn what_has_no_name_is_left_to_the_filter() {
    let up = [0.0, 1.0, 0.0];
    let ground = quad([-60.0, 60.0], [-60.0, 60.0], 0.0);
    let plate = quad([5.3, 9.0], [-20.0, 20.0], 4.0);
    let map = Map::of(1.0, &[ground, plate].concat());
    let without_name = |triangle: usize| if triangle >= 2 { 0 } else { 1 };
    assert_eq!(map.decide([5.2, 0.0, 0.5], up, without_name), Decision::Undecided);
    assert_eq!(map.decide([5.2, 0.0, 0.5], up, id_of), Decision::Lit);
    assert_eq!(map.decide([7.5, 0.0, 0.5], up, without_name), Decision::Covered);
    assert_eq!(map.decide([3.2, 0.0, 0.5], up, without_name), Decision::Lit);
}

/// A lamp hangs under a plate: what stands farther away than it shades nothing.
#[test]
fn nothing_beyond_the_light_shades() {
    let run = Run::in_frame(&quad([-2.0, 2.0], [-2.0, 2.0], 4.0));
    let ray = |length_m: f32| Ray { length_m, ..Ray::to_sun([0.3, 0.0, 0.1], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]) };
    assert_eq!([3.9, 4.1, 3e38].map(|length_m| shades(&run, ray(length_m))), [false, true, true]);
}

/// Of several positions of a pixel those are shaded that a triangle stands over.
#[test]
fn positions_of_a_pixel_are_decided_one_by_one() {
    let ground = quad([-60.0, 60.0], [-60.0, 60.0], 0.0);
    let plate = quad([5.3, 9.0], [-20.0, 20.0], 4.0);
    let map = Map::of(1.0, &[ground, plate].concat());
    let mut shares = Vec::new();
    for step in 0..41u8 {
        let point = [5.3 + 0.02 * (f32::from(step) - 20.1), 0.0, 0.5];
        let at = map.receiver(point, [0.0, 1.0, 0.0]);
        let pixel = [[0.4, 0.0, 0.0], [0.0, 0.0, 0.4]];
        let ray = Ray { pixel, ..Ray::to_sun(point, [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]) };
        let edges = ExactEdges { positions: 4, counted: false };
        let (_, share) = shared(&at, &map.around(&at, id_of), ray, edges, |id| &map.runs[id as usize - 1]);
        let outside = edges.places().iter().filter(|place| point[0] + 0.4 * place[0] < 5.3).count();
        assert_eq!(share, outside as f32 / 4.0, "{point:?}");
        shares.push(outside);
    }
    shares.dedup();
    assert_eq!(shares, [4, 3, 2, 1, 0]);
}

fn corner() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(-4.0f32..4.0)
}

fn soup() -> impl Strategy<Value = Vec<Triangle>> {
    prop::collection::vec(prop::array::uniform3(corner()), 1..40)
}

/// A point of a triangle that is not on edge, with its unit normal turned upwards.
fn point_of(triangle: &Triangle, [s, t]: [f32; 2]) -> Option<([f32; 3], [f32; 3])> {
    let [a, b, c] = *triangle;
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    let [u, v] = [b, c].map(|corner| [corner[0] - a[0], corner[1] - a[1], corner[2] - a[2]]);
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
    let sign = if normal[1] < 0.0 { -1.0 } else { 1.0 };
    let normal = normal.map(|x| sign * x / length);
    let point = std::array::from_fn(|axis| a[axis] + s * u[axis] + t * v[axis]);
    (length > 1e-3 && normal[1] > 0.02).then_some((point, normal))
}

/// Metres that rounding may move a hit by on a surface that is nearly edge-on.
const UNSURE_M: f32 = 1e-3;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    /// An id never darkens a point that is lit: whatever the texels name, a triangle that is hit
    /// stands in the way.
    #[test]
    fn an_id_never_darkens_a_lit_point(
        triangles in soup(),
        of in any::<prop::sample::Index>(),
        inside in prop::array::uniform2(0.0f32..1.0),
        texel in 0.02f32..2.0,
    ) {
        let map = Map::of(texel, &triangles);
        let own = of.get(&triangles);
        if let Some((point, normal)) = point_of(own, inside) {
            let found = map.decide(point, normal, id_of);
            if found == Decision::Shaded {
                prop_assert!(map.is_dark_by_others(own, point), "{point:?}");
            }
        }
    }

    /// Where every triangle that shades a point is named, the point is dark; where texels are fine
    /// enough this is all of them.
    #[test]
    fn what_is_named_and_in_the_way_is_found(
        triangles in soup(),
        of in any::<prop::sample::Index>(),
        inside in prop::array::uniform2(0.0f32..1.0),
        texel in 0.02f32..2.0,
    ) {
        let map = Map::of(texel, &triangles);
        if let Some((point, normal)) = point_of(of.get(&triangles), inside) {
            let at = map.receiver(point, normal);
            let named = map.around(&at, id_of).ids;
            let shading: Vec<usize> = (0..triangles.len())
                .filter(|&i| {
                    let height = height_at(&triangles[i], f64::from(point[0]), f64::from(point[2]));
                    height.is_some_and(|height| height > f64::from(point[1] + 0.1))
                })
                .collect();
            let found = map.decide(point, normal, id_of);
            let doubtful = !matches!(found, Decision::Covered | Decision::Shaded);
            // All nine texels lit: nobody was asked.
            let asked = umbrage_shaders::twin::edges::dark_round(&at, &map.around(&at, id_of)) != 0;
            if doubtful && asked {
                let one = shading.iter().find(|&&i| named.contains(&id_of(i)));
                // A triangle seen from its edge covers no point for sure.
                let sure = one.is_some_and(|&i| {
                    let nudged = [[1e-3, 0.0], [-1e-3, 0.0], [0.0, 1e-3], [0.0, -1e-3]];
                    nudged.iter().all(|[dx, dz]| {
                        height_at(&triangles[i], f64::from(point[0]) + dx, f64::from(point[2]) + dz)
                            .is_some_and(|height| height > f64::from(point[1] + 0.05))
                    })
                });
                prop_assert!(!sure, "{point:?} is {found:?} under {one:?}");
            }
        }
    }
}

/// Of many random points, how many each way is decided: the property above was not asked of
/// nothing.
#[test]
fn soups_are_decided_in_every_way() {
    let mut state = 7u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    let mut false_dark = 0;
    for _ in 0..4000 {
        let mut corner = || [8.0 * next() - 4.0, 8.0 * next() - 4.0, 8.0 * next() - 4.0];
        let triangles: Vec<Triangle> = (0..24).map(|_| [corner(), corner(), corner()]).collect();
        let map = Map::of(0.3, &triangles);
        let Some((point, normal)) = point_of(&triangles[0], [0.3, 0.4]) else { continue };
        let found = map.decide(point, normal, id_of);
        let name = match found {
            Decision::Lit => "lit",
            Decision::Covered => "covered",
            Decision::Shaded => "shaded",
            Decision::Undecided => "undecided",
        };
        *counts.entry(name).or_default() += 1;
        false_dark += u32::from(found == Decision::Shaded && !map.is_dark_by_others(&triangles[0], point));
    }
    assert_eq!(false_dark, 0);
    assert!(["lit", "covered", "shaded"].iter().all(|name| counts.get(name).is_some_and(|&n| n > 50)), "{counts:?}");
}
