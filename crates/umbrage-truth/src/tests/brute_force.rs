//! The tree beside all triangles, on random soups that are mostly awkward.

use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use umbrage_scene::{AlphaMode, Material, Primitive};

use super::scenes::{Shape, Stage};

/// A number that likes 0, ±1 and extremes.
fn awkward() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0,
        1 => Just(0.0),
        1 => Just(1.0),
        1 => Just(-1.0),
        1 => -1e-3..1e-3,
        1 => -1e6..1e6,
    ]
}

fn point() -> impl Strategy<Value = DVec3> {
    (awkward(), awkward(), awkward()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// A triangle: any, small and far, flat along an axis, a needle, a line, a point.
fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
    (point(), point(), point(), 0..8_u8, 0..3_usize).prop_map(|(a, b, c, kind, axis)| {
        let flat = |mut p: DVec3| {
            p[axis] = a[axis];
            p
        };
        match kind {
            0 => [a, flat(b), flat(c)],
            1 => [a * 1e3, a * 1e3 + b, a * 1e3 + c],
            2 => [a, b, a + (b - a) * 0.3],
            3 => [a, b, b],
            4 => [a, a, a],
            5 => [a, a + b * 1e-3, a + c * 1e-3],
            _ => [a, b, c],
        }
    })
}

/// Four kinds of primitives of some triangles each.
fn soup() -> impl Strategy<Value = Stage> {
    (prop::collection::vec((triangle(), 0..4_usize), 1..150), prop_oneof![Just(0.0), Just(1e5), -1e3..1e3]).prop_map(
        |(triangles, offset)| {
            let mut stage = Stage::default();
            let masked = AlphaMode::Mask { cutoff: 0.5 };
            for (kind, (alpha, double_sided)) in
                [(AlphaMode::Opaque, true), (AlphaMode::Opaque, false), (masked, true), (AlphaMode::Opaque, true)]
                    .into_iter()
                    .enumerate()
            {
                let mut shape = Shape::default();
                for (corners, _) in triangles.iter().filter(|(_, of)| *of == kind) {
                    shape.append(Shape {
                        positions: corners.map(|c| c.as_vec3().to_array()).to_vec(),
                        indices: vec![0, 1, 2],
                    });
                }
                let material = stage.material(Material { alpha, double_sided, ..Material::default() });
                let vertices = shape.positions.len();
                let primitive = Primitive {
                    // Alpha falls across each triangle, so the test cuts it in two.
                    colors: (0..vertices).map(|i| [1.0, 1.0, 1.0, (i % 3) as f32 * 0.5]).collect(),
                    ..shape.with_material(material)
                };
                let place = DAffine3::from_translation(DVec3::new(offset, 0.0, -offset));
                stage.add_primitive(primitive, place, kind != 3);
            }
            stage
        },
    )
}

/// Choice of a ray: from a random point in a random or axis-parallel direction, or at a corner, an
/// edge or the middle of a random triangle.
fn aim() -> impl Strategy<Value = (DVec3, DVec3, usize, u8)> {
    (point(), point(), any::<prop::sample::Index>(), 0..8_u8).prop_map(|(a, b, i, kind)| (a, b, i.index(1 << 20), kind))
}

fn ray(stage: &Stage, (from, other, which, kind): (DVec3, DVec3, usize, u8)) -> (DVec3, DVec3) {
    let place = stage.pose.objects[0].world_from_local;
    let all: Vec<[DVec3; 3]> = stage
        .scene
        .meshes
        .iter()
        .flat_map(|mesh| mesh.primitives[0].positions.chunks_exact(3))
        .map(|c| [c[0], c[1], c[2]].map(|p| place.transform_point3(DVec3::from(p.map(f64::from)))))
        .collect();
    let [a, b, c] = all[which % all.len()];
    let from = place.transform_point3(from);
    let (from, direction) = match kind {
        0 => (from, a - from),
        1 => (from, (a + b) * 0.5 - from),
        2 => (from, (a + b + c) / 3.0 - from),
        // Along an axis, through a corner or in the plane of a flat triangle.
        3 => (a + DVec3::Y * 20.0, DVec3::NEG_Y),
        4 => (a - DVec3::X * 1e4, DVec3::X),
        5 => (a + DVec3::new(0.0, -0.0, 7.0), DVec3::new(0.0, -0.0, -1.0)),
        6 => (a, other),
        _ => (from, other),
    };
    (from, direction.try_normalize().unwrap_or(DVec3::Y))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_tree_loses_nothing(stage in soup(), aims in prop::collection::vec(aim(), 30), near in point()) {
        let truth = stage.truth(near);
        let mut stack = Vec::new();
        for aim in aims {
            let (from, direction) = ray(&stage, aim);
            let other = aim.1;
            for range in [(0.0, f64::INFINITY), (0.1, 1e3), (1.0, 5.0)] {
                let by_tree = truth.first_hit(from, direction, range, &mut stack);
                let by_all = truth.first_hit_by_brute_force(from, direction, range);
                prop_assert_eq!(by_tree, by_all, "from {} along {}", from, direction);
                if let Some(hit) = by_tree {
                    prop_assert!((hit.normal.length() - 1.0).abs() < 1e-12 && hit.normal.dot(direction) <= 0.0);
                    prop_assert!((range.0..=range.1).contains(&hit.depth));
                }
            }
            let mut seen = vec![truth.probed(from, DVec3::X)];
            if let Some(hit) = truth.first_hit(from, direction, (0.0, f64::INFINITY), &mut stack) {
                seen.push(truth.seen(from, direction, &hit));
            }
            for seen in seen {
                for distance in [f64::INFINITY, 3.0] {
                    for to_light in [direction, other.try_normalize().unwrap_or(DVec3::Z)] {
                        let by_tree = truth.sees_light(&seen, to_light, distance, &mut stack);
                        let by_all = truth.sees_light_by_brute_force(&seen, to_light, distance);
                        prop_assert_eq!(by_tree, by_all, "{:?} along {}", seen, to_light);
                    }
                }
            }
        }
    }
}

/// Möller and Trumbore's test, an independent one: away from edges both have to agree.
fn moller_trumbore(corners: [DVec3; 3], from: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let s = from - corners[0];
    let u = s.dot(p) / determinant;
    let q = s.cross(ab);
    let v = direction.dot(q) / determinant;
    let inside = u.min(v).min(1.0 - u - v);
    (determinant != 0.0).then_some((ac.dot(q) / determinant, inside))
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 100_000, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn two_triangle_tests_agree(a in point(), b in point(), c in point(), from in point(), to in point()) {
        let corners = [a, b, c];
        let direction = (to - from).try_normalize().unwrap_or(DVec3::X);
        // Neither test is asked about what lies within rounding: an edge-on triangle, or a ray
        // along its rim.
        let area = (b - a).cross(c - a);
        let steep = area.normalize_or_zero().dot(direction).abs();
        let longest = (b - a).length().max((c - a).length()).max((c - b).length());
        prop_assume!(steep > 1e-3 && area.length() > 1e-3 * longest * longest);
        let ray = crate::trace::Ray::new(from, direction, f64::NEG_INFINITY, f64::INFINITY);
        let ours = ray.meets(&corners, f64::INFINITY);
        let (t, inside) = moller_trumbore(corners, from, direction).expect("not edge-on");
        let scale = 1e-9 * (1.0 + from.length() / longest);
        prop_assume!(inside.abs() > scale);
        prop_assert_eq!(ours.is_some(), inside > 0.0, "{}", inside);
        if let Some(ours) = ours {
            prop_assert!((ours.t - t).abs() <= 1e-9 * (from.length() + longest + t.abs()));
        }
    }
}

#[test]
fn a_flat_triangle_far_away_holds_rays_along_an_axis() {
    // An origin whose f64 cannot tell a nanometre: found by the property above when the box walk
    // blurred by that alone.
    for far in [4.7e8_f32, -4.7e8, 1e5, 0.0] {
        let mut stage = Stage::default();
        let shape = Shape {
            positions: vec![[-1.0, far, 0.0], [1.0, far, 0.0], [0.0, far * 1.000_001, 0.0]],
            indices: vec![0, 1, 2],
        };
        stage.add(shape, DAffine3::IDENTITY);
        let truth = stage.truth(DVec3::ZERO);
        let from = DVec3::new(0.0, f64::from(far), 7.0);
        let range = (0.0, f64::INFINITY);
        for direction in [DVec3::new(0.0, -0.0, -1.0), DVec3::new(-0.0, 0.0, -1.0)] {
            let hit = truth.first_hit(from, direction, range, &mut Vec::new());
            assert_eq!(hit, truth.first_hit_by_brute_force(from, direction, range));
            assert_eq!(hit.is_some(), far != 0.0, "{far}");
        }
    }
}
