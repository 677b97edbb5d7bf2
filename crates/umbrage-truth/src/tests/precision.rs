//! Decisions that follow the scene's precision, and neither its unit nor its place.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use proptest::prelude::*;
use umbrage::{Frustum, View};
use umbrage_scene::{Material, Mesh, Node, Primitive, Scene, Trs};

use super::scenes::{Shape, Stage};
use crate::{SunDisc, Truth, TruthMask};

const SIZE: [u32; 2] = [256, 192];

/// Way in which a scene is scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ScaledBy {
    /// The file holds other numbers, rounded to `f32`.
    Vertices,
    /// The nodes have a scale.
    Nodes,
}

/// Makes hills, boxes, a sphere, a fence of thin slats, leaves of two single-sided faces, a decal
/// and a lid: shapes that are sensitive to rounding.
fn village(scale: f64, by: ScaledBy, moved: DVec3) -> Stage {
    let mut stage = Stage::default();
    let mut add = |mut shape: Shape, at: DAffine3, single_sided: bool| {
        let mut world_from_local = DAffine3 { matrix3: at.matrix3, translation: moved + scale * at.translation };
        match by {
            ScaledBy::Nodes => world_from_local.matrix3 = at.matrix3 * scale,
            ScaledBy::Vertices => {
                shape.positions.iter_mut().flatten().for_each(|x| *x = (f64::from(*x) * scale) as f32);
            }
        }
        let material = stage.material(Material { double_sided: !single_sided, ..Material::default() });
        stage.add_primitive(shape.with_material(material), world_from_local, true);
    };
    let mut hills = Shape::default();
    for i in 0..=40_u16 {
        for j in 0..=40_u16 {
            let (x, z) = (f32::from(i) - 20.0, f32::from(j) - 20.0);
            hills.positions.push([x, 0.4 * (0.7 * x).sin() * (0.9 * z).cos(), z]);
            if i < 40 && j < 40 {
                let at = u32::from(i) * 41 + u32::from(j);
                hills.indices.extend([at, at + 1, at + 42, at, at + 42, at + 41]);
            }
        }
    }
    add(hills, DAffine3::IDENTITY, false);
    let turned =
        |angle: f64, at: [f64; 3]| DAffine3::from_rotation_translation(DQuat::from_rotation_y(angle), at.into());
    add(Shape::sphere(1.1, 24), turned(0.0, [3.3, 2.0, 1.7]), false);
    add(Shape::cuboid([-0.7, 0.0, -0.9], [0.7, 2.3, 0.9]), turned(0.6, [-3.1, 0.1, 2.2]), false);
    add(Shape::cuboid([-0.1, 0.0, -0.1], [0.1, 5.0, 0.1]), turned(1.0, [0.3, -0.4, -1.2]), false);
    let mut slats = Shape::default();
    for k in 0..12_u8 {
        let x = 0.3 * f32::from(k);
        slats.append(Shape::quad([[x, 0.0, 0.0], [x + 0.1, 0.0, 0.0], [x + 0.1, 1.5, 0.0], [x, 1.5, 0.0]]));
    }
    add(slats, turned(-0.3, [-6.0, 0.3, -2.0]), false);
    // Both faces of each leaf in one mesh, in two meshes, and in two nodes of which one is turned
    // over as exporters turn.
    let leaf = || Shape::quad([[-1.3, 0.7, 1.1], [1.2, 0.9, 1.3], [1.1, 0.8, -1.2], [-1.2, 1.1, -0.9]]);
    let other_face = |mut shape: Shape| {
        shape.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
        shape
    };
    let mut both = leaf();
    both.append(other_face(leaf()));
    add(both, turned(0.2, [6.0, 1.0, -3.0]), true);
    add(leaf(), turned(0.9, [6.3, 2.0, 3.0]), true);
    add(other_face(leaf()), turned(0.9, [6.3, 2.0, 3.0]), true);
    let half_turn = DQuat::from_xyzw(1.0, 0.0, 0.0, f64::from(-4.371_139e-8_f32)).normalize();
    let upright = |shape: &Shape| shape.positions.iter().map(|p| [p[0], -p[1], -p[2]]).collect::<Vec<_>>();
    let under = Shape { positions: upright(&leaf()), indices: other_face(leaf()).indices };
    add(leaf(), turned(0.0, [-7.0, 1.5, 4.0]), true);
    add(under, DAffine3::from_rotation_translation(half_turn, DVec3::new(-7.0, 1.5, 4.0)), true);
    stage
}

/// The village's view at a scale and a place.
fn view_of_village(scale: f64, moved: DVec3) -> View {
    let frustum = Frustum::perspective(60_f64.to_radians(), 4.0 / 3.0, 0.1 * scale, 1000.0 * scale).unwrap();
    let eye = DVec3::new(5.0, 9.0, 14.0);
    let axes = View::look_at_upright(eye, DVec3::ZERO, frustum).unwrap().world_from_view_rotation();
    // The axes of one view for all: a target far out would turn them by its own rounding.
    let world_from_view = DAffine3 { matrix3: axes, translation: moved + scale * eye };
    View::from_world_from_view(world_from_view.into(), frustum).unwrap()
}

fn village_mask(scale: f64, by: ScaledBy, moved: DVec3) -> TruthMask {
    village(scale, by, moved).mask(&view_of_village(scale, moved), DVec3::new(1.0, -0.8, -0.45), SIZE)
}

/// Returns the number of pixels with different decisions.
fn differences(a: &TruthMask, b: &TruthMask) -> usize {
    let decision = |hit: &Option<crate::Hit>| hit.map(|hit| hit.lit);
    a.hits().iter().zip(b.hits()).filter(|(a, b)| decision(a) != decision(b)).count()
}

/// 0.01 % of the pixels.
const MOST_DIFFERENCES: usize = (SIZE[0] * SIZE[1] / 10_000) as usize;

#[test]
fn a_village_has_light_and_shadow() {
    let stage = village(1.0, ScaledBy::Nodes, DVec3::ZERO);
    let mask = village_mask(1.0, ScaledBy::Nodes, DVec3::ZERO);
    let lit = mask.hits().iter().flatten().filter(|hit| hit.lit).count();
    let dark = mask.hits().iter().flatten().count() - lit;
    assert!(lit > 20_000 && dark > 1_500, "{lit} {dark}");
    // Nothing hangs over the leaves: every hit on one is lit.
    let leaves = 5..stage.pose.objects.len() as u32;
    let on_leaves: Vec<_> = mask.hits().iter().flatten().filter(|hit| leaves.contains(&hit.object)).collect();
    assert!(on_leaves.len() > 500 && on_leaves.iter().all(|hit| hit.lit), "{}", on_leaves.len());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_scaled_scene_keeps_its_decisions(power in prop_oneof![Just(-4.0), Just(4.0), -4.0..4.0], nodes in any::<bool>()) {
        let by = if nodes { ScaledBy::Nodes } else { ScaledBy::Vertices };
        let found = differences(&village_mask(1.0, by, DVec3::ZERO), &village_mask(10_f64.powf(power), by, DVec3::ZERO));
        prop_assert!(found <= MOST_DIFFERENCES, "{found} of {SIZE:?} at 10^{power}, {by:?}");
    }

    #[test]
    fn a_moved_scene_keeps_its_decisions(
        direction in prop::array::uniform3(prop_oneof![-1.0..1.0, Just(0.0), Just(1.0), Just(-1.0)]),
        power in prop_oneof![Just(9.0), 0.0..9.0],
    ) {
        let moved = 10_f64.powf(power) * DVec3::from(direction);
        let found = differences(
            &village_mask(1.0, ScaledBy::Vertices, DVec3::ZERO),
            &village_mask(1.0, ScaledBy::Vertices, moved),
        );
        prop_assert!(found <= MOST_DIFFERENCES, "{found} of {SIZE:?} at {moved}");
    }
}

#[test]
fn a_comparison_of_villages_says_no() {
    let here = village_mask(1.0, ScaledBy::Nodes, DVec3::ZERO);
    let by = DVec3::new(0.02, 0.0, 0.0);
    let aside =
        village(1.0, ScaledBy::Nodes, by).mask(&view_of_village(1.0, DVec3::ZERO), DVec3::new(1.0, -0.8, -0.45), SIZE);
    assert!(differences(&here, &aside) > 10 * MOST_DIFFERENCES, "2 cm aside is another picture");
}

#[test]
fn a_small_box_has_its_shadow_on_any_ground_at_any_place() {
    // The box's shadow on flat ground under this sun: the box swept by its height along (1, 0,
    // 0.5).
    let sun = DVec3::new(1.0, -1.0, 0.5);
    for (edge, ground) in [(1e-3, 1.0), (1e-3, 1e3), (1e-3, 1e5), (1e-4, 10.0), (1.0, 1e6)] {
        for moved in [DVec3::ZERO, DVec3::new(1e8, 0.0, -1e8), DVec3::splat(5e8)] {
            let mut stage = Stage::default();
            let place = DAffine3::from_translation(moved);
            let floor = stage.add(Shape::floor(ground as f32, 0.0), place);
            let e = edge as f32;
            stage.add(Shape::cuboid([-0.5 * e, 0.0, -0.5 * e], [0.5 * e, e, 0.5 * e]), place);
            let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.1 * edge, 100.0 * edge).unwrap();
            let eye = moved + edge * DVec3::new(2.0, 5.0, 3.0);
            let view = View::look_at_upright(eye, moved, frustum).unwrap();
            let mask = stage.mask(&view, sun, [160, 120]);
            let mut counted = [0; 2];
            for hit in mask.hits().iter().flatten().filter(|hit| hit.object as usize == floor) {
                let p = (hit.position - moved) / edge;
                // Where the light that reaches p enters and leaves the box's slabs, as heights
                // above the ground.
                let slab = |at: f64, slope: f64| {
                    let (a, b) = ((at - 0.5) / slope, (at + 0.5) / slope);
                    (a.min(b), a.max(b))
                };
                let ((x0, x1), (z0, z1)) = (slab(p.x, 1.0), slab(p.z, 0.5));
                let (enter, leave) = (x0.max(z0).max(0.0), x1.min(z1).min(1.0));
                // At 5e8 m a position is known to 6e-8 m.
                let margin = 1e-6 + 4.0 * f64::EPSILON * moved.length() / edge;
                if (leave - enter).abs() > 4.0 * margin {
                    assert_eq!(hit.lit, leave < enter, "{edge} m on {ground} m at {moved}: {p}");
                    counted[usize::from(hit.lit)] += 1;
                }
            }
            assert!(counted[0] > 300 && counted[1] > 3000, "{edge} m on {ground} m at {moved}: {counted:?}");
        }
    }
}

#[test]
fn what_lies_above_a_surface_by_more_than_its_rounding_shades_it() {
    // Over ground whose height 0.1 is a number in f32: 2 ulp are nothing, and a hundred are a gap.
    for scale in [1e-4_f64, 1.0, 1e4] {
        for moved in [0.0, 1e6 * scale] {
            for (ulps, lit) in [(0.0, true), (2.0, true), (100.0, false), (1e5, false)] {
                let mut stage = Stage::default();
                let height = (0.1 * scale) as f32;
                let place = DAffine3::from_translation(DVec3::splat(moved));
                stage.add(Shape::floor(20.0 * scale as f32, height), place);
                let ulp = height.next_up() - height;
                stage.add(Shape::floor(2.0 * scale as f32, height + ulps * ulp), place);
                let truth = stage.truth(DVec3::splat(moved));
                let point = DVec3::new(0.5 * scale, f64::from(height), 0.0) + moved;
                let answer = truth.visibility_at(&[(point, DVec3::Y)], DVec3::NEG_Y).unwrap();
                assert_eq!(answer, [f32::from(u8::from(lit))], "{ulps} ulp at scale {scale}, moved by {moved}");
            }
        }
    }
}

#[test]
fn faces_in_two_nodes_that_were_meant_to_coincide_count_as_one() {
    // An upward face by its vertices, and its other face by nodes, as files in f32 have them.
    let f32ed = |x: f64| f64::from(x as f32);
    let single = Material::default();
    for unit in [1e-3, 1.0, 1e3] {
        for height in [0.1, 0.3, 0.7, 1.1, 13.3] {
            let mut scene = Scene { materials: vec![single.clone()], ..Scene::default() };
            let mut add = |shape: Shape| {
                let normals = vec![[0.0, 1.0, 0.0]; shape.positions.len()];
                let primitive = Primitive { normals, ..shape.with_material(0) };
                scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
            };
            add(Shape::floor((2.0 * unit) as f32, (height * unit) as f32));
            let mut down = Shape::floor((2.0 * unit) as f32, 0.0);
            down.indices = vec![0, 2, 1, 0, 3, 2];
            add(down);
            let node = |parent, y: f64, mesh| Node {
                parent,
                local: Trs { translation: DVec3::new(0.0, y, 0.0), ..Trs::IDENTITY },
                mesh,
                ..Node::default()
            };
            let third = height / 3.0;
            for lower in [
                vec![node(None, f32ed(height * unit), Some(1))],
                vec![node(None, height * unit, Some(1))],
                vec![node(None, f32ed(third * unit), None), node(Some(1), f32ed((height - third) * unit), Some(1))],
            ] {
                let mut scene = scene.clone();
                scene.nodes.push(node(None, 0.0, Some(0)));
                scene.nodes.extend(lower);
                for moved in [DVec3::ZERO, DVec3::splat(1e7 * unit)] {
                    let scene = scene.clone().moved(moved);
                    let pose = scene.pose(0.0).unwrap();
                    let frustum = Frustum::perspective(1.0, 1.0, 0.1 * unit, 100.0 * unit).unwrap();
                    let eye = moved + unit * DVec3::new(0.3, height + 3.0, 0.2);
                    let view = View::look_at_upright(eye, moved, frustum).unwrap();
                    let truth = Truth::build(&scene, &pose, eye).unwrap();
                    let sun = DVec3::new(0.7, -1.0, 0.2);
                    let mask = truth.mask(&view, sun, [32, 32], &|_| {}).unwrap();
                    let hits: Vec<_> = mask.hits().iter().flatten().collect();
                    assert!(hits.len() > 100 && hits.iter().all(|hit| hit.lit), "{height} in {unit} m at {moved}");
                    let soft = truth.soft(&mask, &SunDisc::new(0.1, 16), &|_| {}).unwrap();
                    assert!(soft.visibility().iter().flatten().all(|&share| share == 1.0));
                }
            }
        }
    }
}

#[test]
fn a_turn_that_two_objects_share_takes_no_shadow() {
    // Z up in the files, as tools write it: the root's quaternion is rounded to f32, which tilts 5
    // km of ground by 0.1 mm. But it tilts the box of 1 mm as well, which has a turn of its own
    // besides.
    let up = DQuat::from_xyzw(f64::from(-0.703_107_f32), 0.0, 0.0, f64::from(0.711_1_f32)).normalize();
    let edge = 1e-3_f32;
    let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
    let ground = Shape::quad([[-5e3, -5e3, 0.0], [5e3, -5e3, 0.0], [5e3, 5e3, 0.0], [-5e3, 5e3, 0.0]]);
    for shape in [ground, Shape::cuboid([-0.5 * edge, -0.5 * edge, 0.0], [0.5 * edge, 0.5 * edge, edge])] {
        let normals = vec![[0.0, 0.0, 1.0]; shape.positions.len()];
        let primitive = Primitive { normals, ..shape.with_material(0) };
        scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
    }
    let at = DVec3::new(3000.0, 2000.0, 0.0);
    let yaw = DQuat::from_rotation_z(0.4);
    let child = |local, mesh| Node { parent: Some(0), local, mesh: Some(mesh), ..Node::default() };
    scene.nodes.push(Node { local: Trs { rotation: up, ..Trs::IDENTITY }, ..Node::default() });
    scene.nodes.push(child(Trs::IDENTITY, 0));
    scene.nodes.push(child(Trs { translation: at, rotation: yaw, ..Trs::IDENTITY }, 1));
    let pose = scene.pose(0.0).unwrap();
    let foot = up * at;
    let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 1e-4, 0.1).unwrap();
    let view = View::look_at_upright(foot + DVec3::new(0.002, 0.005, 0.003), foot, frustum).unwrap();
    let truth = Truth::build(&scene, &pose, view.eye()).unwrap();
    let mask = truth.mask(&view, DVec3::new(1.0, -1.0, 0.5), [160, 120], &|_| {}).unwrap();
    let on_ground: Vec<_> = mask.hits().iter().flatten().filter(|hit| hit.object == 0).collect();
    let dark = on_ground.iter().filter(|hit| !hit.lit).count();
    assert!(dark > 300 && on_ground.len() - dark > 3000, "{dark} of {}", on_ground.len());
}

/// A box without thickness from -1 to 1: as one mesh, or with each wall an object that is turned
/// into its place.
fn closed_box(scale: f64, as_objects: bool, moved: DVec3) -> Stage {
    let mut stage = Stage::default();
    let place = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(scale)), translation: moved };
    if !as_objects {
        stage.add(Shape::cuboid([-1.0; 3], [1.0; 3]), place);
        return stage;
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    let turns = (0..4).map(|k| DQuat::from_rotation_x(f64::from(k) * quarter));
    for turn in turns.chain([DQuat::from_rotation_z(quarter), DQuat::from_rotation_z(-quarter)]) {
        stage.add(Shape::floor(1.0, -1.0), place * DAffine3::from_quat(turn));
    }
    stage
}

#[test]
fn a_closed_box_without_thickness_is_dark() {
    let mut suns = vec![DVec3::NEG_Y, DVec3::X, DVec3::new(1.0, -1.0, 0.0), DVec3::new(-1.0, -1.0, 1.0)];
    suns.extend([DVec3::new(1.0, -1e-3, 1e-3), DVec3::new(1e-4, -1.0, 1e-5), DVec3::new(0.3, 0.9, -0.7)]);
    for (scale, moved) in [(1.0, DVec3::ZERO), (1e-4, DVec3::ZERO), (1e4, DVec3::ZERO), (1.0, DVec3::splat(1e6))] {
        for as_objects in [false, true] {
            let stage = closed_box(scale, as_objects, moved);
            let perspective = Frustum::perspective(1.8, 1.0, 1e-5 * scale, 100.0 * scale).unwrap();
            let mut views = Vec::new();
            for (eye, target) in [
                (DVec3::new(0.3, 0.4, -0.2), DVec3::splat(-1.0)),
                // Along a crease, and from a ten-thousandth beside it.
                (DVec3::new(0.0, -0.9999, -0.9999), DVec3::new(1.0, -1.0, -1.0)),
                (DVec3::splat(0.5), DVec3::splat(-0.5)),
                (DVec3::ZERO, DVec3::X),
            ] {
                views.push(View::look_at_upright(moved + scale * eye, moved + scale * target, perspective).unwrap());
            }
            // Pixel centres on the creases themselves: 33 of them from -1 to 1.
            let step = 2.0 * scale / 32.0;
            let frustum = Frustum::orthographic(33.0 * step, 33.0 * step, -0.5 * scale, 10.0 * scale).unwrap();
            for axis in [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z] {
                views.push(View::look_at_upright(moved, moved + scale * axis, frustum).unwrap());
            }
            for view in views {
                for &sun in &suns {
                    let mask = stage.mask(&view, sun, [33, 33]);
                    let seen = mask.hits().iter().flatten().count();
                    // A wall that light or eye run along may face either way: its turn is rounded.
                    let faces = |hit: &&crate::Hit| {
                        let sight = match view.frustum().projection {
                            umbrage::Projection::Perspective => hit.position - view.eye(),
                            umbrage::Projection::Orthographic => view.forward(),
                        };
                        hit.normal.dot(-sun) > 1e-9 && hit.normal.dot(sight.normalize()) < -1e-9
                    };
                    let lit: Vec<_> = mask.hits().iter().flatten().filter(|hit| hit.lit).filter(faces).collect();
                    assert!(seen >= 31 * 31, "{seen}, scale {scale}, objects {as_objects}, {view:?}");
                    assert!(lit.is_empty(), "scale {scale}, objects {as_objects}, sun {sun}, {view:?}: {lit:?}");
                }
            }
        }
    }
}

#[test]
fn the_outside_of_a_box_has_no_dark_dots() {
    // Every face of a convex body that looks at the light is lit, its edges included.
    for scale in [1e-4, 1.0, 1e4] {
        let stage = closed_box(scale, false, DVec3::ZERO);
        let step = 2.0 * scale / 32.0;
        let frustum = Frustum::orthographic(33.0 * step, 33.0 * step, 0.0, 10.0 * scale).unwrap();
        for axis in [DVec3::Y, DVec3::X, DVec3::new(0.0, 1.0, 1.0)] {
            let view = View::look_at_upright(3.0 * scale * axis, DVec3::ZERO, frustum).unwrap();
            for sun in [DVec3::new(1.0, -1.0, -0.3), DVec3::new(-1.0, -1.0, -1.0), DVec3::new(-0.01, -1.0, -1.0)] {
                for hit in stage.mask(&view, sun, [33, 33]).hits().iter().flatten() {
                    assert_eq!(hit.lit, hit.normal.dot(-sun) > 0.0, "scale {scale}, sun {sun}: {hit:?}");
                }
            }
        }
    }
}
