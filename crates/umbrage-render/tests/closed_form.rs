//! Masks against shadows that a formula knows.

mod common;

use common::*;
use glam::{DQuat, DVec2, DVec3, Vec3Swizzles as _};
use umbrage_render::{Outputs, ProbePoint};
use umbrage_scene::{AlphaMode, Material, MorphTarget, Node, Primitive, Skin, Texture, TextureFilter, Wrap};

/// Compares a mask with `occluded(point on the ground, towards the light, growth in metres)` on
/// those pixels that show the ground at y = 0 and nothing before it (`covered(eye, ray)`), leaving
/// out a band of `band` metres around shadow edges.
fn compare(
    mask: &image::GrayAlphaImage,
    view: &umbrage::View,
    to_light: DVec3,
    band: f64,
    covered: impl Fn(DVec3, DVec3) -> bool,
    occluded: impl Fn(DVec3, DVec3, f64) -> bool,
) {
    let (mut lit, mut dark) = (0, 0);
    for pixel in pixels(view, SIZE) {
        let Some(point) = pixel.on_ground(0.0) else { continue };
        if covered(pixel.eye, pixel.ray) || point.xz().abs().max_element() > 29.0 {
            continue;
        }
        let (grown, shrunk) = (occluded(point, to_light, band), occluded(point, to_light, -band));
        if grown != shrunk {
            continue;
        }
        let found = mask.get_pixel(pixel.x, pixel.y).0;
        let expected = if grown { 0 } else { 255 };
        assert_eq!(found, [expected, 255], "pixel {}, {} at {point}", pixel.x, pixel.y);
        if grown { dark += 1 } else { lit += 1 }
    }
    assert!(lit > 2000 && dark > 30, "the comparison saw {lit} lit and {dark} dark pixels");
}

const BOX_MIN: DVec3 = DVec3::new(-2.0, 1.0, -3.0);
const BOX_MAX: DVec3 = DVec3::new(3.0, 4.0, 1.0);

fn two_texels(rendered: &umbrage_render::Rendered) -> f64 {
    2.0 * rendered.stats.splits.iter().map(|split| split.texel_m).fold(0.0, f64::max)
}

#[test]
fn a_box_over_a_plane_throws_the_shadow_that_geometry_says() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 30.0), cuboid(BOX_MIN, BOX_MAX)]), &settings());
    let view = look(DVec3::new(-9.0, 12.0, 16.0), DVec3::new(1.0, 0.0, -1.0));
    for direction in [DVec3::NEG_Y, DVec3::new(0.5, -0.8, 0.3), DVec3::new(-1.0, -0.4, -0.2)] {
        let light = sun(direction);
        let rendered = stage.render(&view, light, Outputs { mask: true, ..Default::default() });
        let band = two_texels(&rendered) / direction.normalize().y.abs();
        compare(
            &rendered.mask.expect("a mask"),
            &view,
            -light.direction(),
            band,
            |eye, ray| meets_box(eye, ray, BOX_MIN - 0.05, BOX_MAX + 0.05),
            |point, to_light, grow| meets_box(point, to_light, BOX_MIN - grow, BOX_MAX + grow),
        );
    }
}

#[test]
fn a_sphere_over_a_plane_throws_the_shadow_that_geometry_says() {
    let Some(gpu) = gpu() else { return };
    let (center, radius) = (DVec3::new(1.0, 4.0, 0.0), 2.5);
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 30.0), sphere(center, radius)]), &settings());
    let view = look(DVec3::new(-8.0, 11.0, 15.0), DVec3::new(0.0, 0.0, 0.0));
    for direction in [DVec3::NEG_Y, DVec3::new(0.4, -0.7, -0.5)] {
        let light = sun(direction);
        let rendered = stage.render(&view, light, Outputs { mask: true, ..Default::default() });
        // Facets lie inside the sphere by at most r (1 − cos(π/64)) in each direction.
        let band = two_texels(&rendered) + 2.0 * radius * (1.0 - (std::f64::consts::PI / 64.0).cos());
        compare(
            &rendered.mask.expect("a mask"),
            &view,
            -light.direction(),
            band,
            |eye, ray| meets_sphere(eye, ray, center, radius + 0.05),
            |point, to_light, grow| meets_sphere(point, to_light, center, radius + grow),
        );
    }
}

/// A horizontal card of half edge 3 at y = 3 whose texture is opaque where u < ½.
fn half_card(alpha: AlphaMode) -> umbrage_scene::Scene {
    let mut card = Primitive { material: 1, ..Default::default() };
    quad(&mut card, DVec3::Y * 3.0, DVec3::X * 3.0, DVec3::NEG_Z * 3.0, DVec3::Y);
    let mut scene = scene(vec![ground(0.0, 30.0), card]);
    scene.materials.push(Material { alpha, base_color_texture: Some(0), double_sided: true, ..Default::default() });
    let row: Vec<u8> = (0..64_u8).flat_map(|x| [200, 80, 40, if x < 32 { 255 } else { 0 }]).collect();
    scene.textures.push(Texture {
        width: 64,
        height: 1,
        rgba: row,
        wrap: [Wrap::Clamp; 2],
        filter: TextureFilter::Linear,
    });
    scene
}

#[test]
fn a_masked_caster_throws_the_shadow_of_what_is_left_of_it() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-8.0, 11.0, 15.0), DVec3::ZERO);
    let light = sun(DVec3::new(0.3, -1.0, 0.2));
    let covered = |eye: DVec3, ray: DVec3| meets_box(eye, ray, DVec3::new(-3.1, 2.9, -3.1), DVec3::new(3.1, 3.1, 3.1));
    let shades = |point: DVec3, to_light: DVec3, right: f64, grow: f64| {
        let at = point + to_light * (3.0 / to_light.y);
        DVec2::new(-3.0 - grow, -3.0 - grow).cmple(at.xz()).all() && at.x <= right + grow && at.z <= 3.0 + grow
    };
    let mask_of = |alpha| {
        let mut stage = Stage::new(&gpu, &half_card(alpha), &settings());
        let rendered = stage.render(&view, light, Outputs { mask: true, ..Default::default() });
        (two_texels(&rendered), rendered.mask.expect("a mask"))
    };
    // Half a texture texel of 6 m / 64 lies between opaque and transparent.
    let (band, masked) = mask_of(AlphaMode::Mask { cutoff: 0.5 });
    compare(&masked, &view, -light.direction(), band + 0.1, covered, |p, l, grow| shades(p, l, 0.0, grow));
    let (band, opaque) = mask_of(AlphaMode::Opaque);
    compare(&opaque, &view, -light.direction(), band, covered, |p, l, grow| shades(p, l, 3.0, grow));
    let (_, blended) = mask_of(AlphaMode::Blend);
    for pixel in pixels(&view, SIZE) {
        if pixel.on_ground(0.0).is_some_and(|point| point.xz().abs().max_element() < 29.0) {
            assert_eq!(blended.get_pixel(pixel.x, pixel.y).0, [255, 255], "translucent: neither seen nor a caster");
        }
    }
}

#[test]
fn nodes_that_do_not_cast_are_seen_but_throw_nothing() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(vec![ground(0.0, 30.0), cuboid(BOX_MIN, BOX_MAX)]);
    scene.nodes[1].cast_shadow = false;
    let mut stage = Stage::new(&gpu, &scene, &settings());
    let view = look(DVec3::new(-9.0, 12.0, 16.0), DVec3::new(1.0, 0.0, -1.0));
    let rendered = stage.render(&view, sun(DVec3::new(0.5, -0.8, 0.3)), Outputs { mask: true, ..Default::default() });
    let mask = rendered.mask.expect("a mask");
    for pixel in pixels(&view, SIZE) {
        let on_ground = pixel.on_ground(0.0).is_some_and(|p| p.xz().abs().max_element() < 29.0);
        if on_ground && !meets_box(pixel.eye, pixel.ray, BOX_MIN - 0.05, BOX_MAX + 0.05) {
            assert_eq!(mask.get_pixel(pixel.x, pixel.y).0, [255, 255]);
        }
    }
    let dark = mask.pixels().filter(|pixel| pixel.0 == [0, 255]).count();
    assert!(dark > 100, "the box's own dark sides are still seen ({dark} pixels)");
    assert_eq!(
        rendered.stats.splits.iter().map(|split| split.casters).max(),
        Some(0),
        "the ground has nothing below it"
    );
}

#[test]
fn only_double_sided_surfaces_are_seen_from_behind_but_all_cast() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-3.0, 14.0, 5.0), DVec3::ZERO);
    let light = sun(DVec3::new(0.9, -1.0, 0.2));
    // A ceiling that faces down: from above one sees its back.
    let seen = |double_sided: bool, mirrored: bool| {
        let mut ceiling = Primitive { material: 1, ..Default::default() };
        quad(&mut ceiling, DVec3::Y * 3.0, DVec3::X * 3.0, DVec3::Z * 3.0, DVec3::NEG_Y);
        let mut scene = scene(vec![ground(0.0, 30.0), ceiling]);
        scene.materials.push(Material { double_sided, ..Default::default() });
        if mirrored {
            // Mirrored in x the same triangles wind the other way, and a viewer is to see the same
            // side as before.
            scene.nodes[1].local.scale.x = -1.0;
        }
        let mask = Stage::new(&gpu, &scene, &settings()).mask(&view, light);
        let corner = |ray: &Pixel| ray.on_ground(3.0).is_some_and(|p| p.xz().abs().max_element() < 2.5);
        let on_card: Vec<u8> =
            pixels(&view, SIZE).filter(corner).map(|pixel| mask.get_pixel(pixel.x, pixel.y).0[0]).collect();
        let lit = on_card.iter().filter(|&&v| v == 255).count();
        let shadow = pixels(&view, SIZE).any(|pixel| {
            let Some(point) = pixel.on_ground(0.0) else { return false };
            point.distance(DVec3::new(5.2, 0.0, 0.6)) < 0.4 && mask.get_pixel(pixel.x, pixel.y).0 == [0, 255]
        });
        (lit as f64 / on_card.len() as f64, shadow)
    };
    for mirrored in [false, true] {
        let (lit, shadow) = seen(true, mirrored);
        assert!(lit > 0.99 && shadow, "double-sided: the card's upper side is lit ({lit}), mirrored {mirrored}");
        let (lit, shadow) = seen(false, mirrored);
        assert!(lit < 0.8 && shadow, "single-sided: the shadowed ground shows through ({lit}), mirrored {mirrored}");
    }
}

/// Something of everything: boxes turned, stretched and mirrored, a sphere, the ground.
fn mixed() -> umbrage_scene::Scene {
    let unit = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
    let mut scene =
        scene(vec![ground(0.0, 30.0), unit.clone(), unit.clone(), unit, sphere(DVec3::new(4.0, 2.0, 3.0), 1.5)]);
    scene.nodes[1].local = trs(DVec3::new(-3.0, 2.0, 0.0), DQuat::from_rotation_y(0.4), DVec3::new(0.5, 2.0, 1.5));
    scene.nodes[2].local = trs(DVec3::new(2.0, 1.5, -4.0), DQuat::from_rotation_x(0.7), DVec3::new(-1.0, 1.0, 2.0));
    scene.nodes[3].local = trs(DVec3::new(-5.0, 4.0, 5.0), DQuat::from_rotation_z(0.3), DVec3::splat(0.7));
    scene
}

#[test]
fn a_hundred_kilometres_away_the_mask_is_the_same() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(0.5, -0.7, 0.35));
    let mask_at = |offset: DVec3| {
        let view = look(DVec3::new(-9.0, 9.0, 14.0) + offset, offset);
        Stage::new(&gpu, &moved(&mixed(), offset), &settings()).mask(&view, light)
    };
    let here = mask_at(DVec3::ZERO);
    for offset in [DVec3::new(100_000.0, 0.0, 0.0), DVec3::new(-60_000.25, 1_000.5, 80_000.125)] {
        let there = mask_at(offset);
        let differ = here.pixels().zip(there.pixels()).filter(|(a, b)| a != b).count();
        let share = differ as f64 / f64::from(SIZE[0] * SIZE[1]);
        assert!(share <= 0.0005, "{differ} pixels differ at {offset}");
    }
}

#[test]
fn probes_at_pixel_centres_say_what_the_mask_says() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(0.5, -0.7, 0.35));
    let view = look(DVec3::new(-9.0, 12.0, 16.0), DVec3::new(1.0, 0.0, -1.0));
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 30.0), cuboid(BOX_MIN, BOX_MAX)]), &settings());
    let mask = stage.mask(&view, light);
    let on_ground: Vec<(Pixel, DVec3)> = pixels(&view, SIZE)
        .filter(|pixel| !meets_box(pixel.eye, pixel.ray, BOX_MIN - 0.05, BOX_MAX + 0.05))
        .filter_map(|pixel| pixel.on_ground(0.0).map(|point| (pixel, point)))
        .filter(|(_, point)| point.xz().abs().max_element() < 29.0)
        .collect();
    let points: Vec<ProbePoint> =
        on_ground.iter().map(|&(_, position)| ProbePoint { position, normal: DVec3::Y * 2.0 }).collect();
    let answers = stage.renderer.probe(&Stage::frame(&stage.pose, &view, light), &points).expect("answers");
    let equal = on_ground
        .iter()
        .zip(&answers)
        .filter(|((pixel, _), answer)| {
            (answer.visibility * 255.0).round() as u8 == mask.get_pixel(pixel.x, pixel.y).0[0]
        })
        .count();
    assert!(points.len() > 5000 && equal as f64 >= 0.999 * points.len() as f64, "{equal} of {}", points.len());
    assert!(answers.iter().any(|answer| answer.visibility == 0.0) && answers.iter().any(|a| a.visibility == 1.0));
    assert!(answers.iter().all(|answer| (0..2).contains(&answer.split)));
}

#[test]
fn probes_off_screen_are_answered_where_a_map_reaches_and_lit_where_none_does() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(0.0, -1.0, 0.01));
    let view = look(DVec3::new(0.0, 3.0, 10.0), DVec3::new(0.0, 2.0, 0.0));
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 30.0), cuboid(BOX_MIN, BOX_MAX)]), &settings());
    let up = |x, y, z| ProbePoint { position: DVec3::new(x, y, z), normal: DVec3::Y };
    let down = |x, y, z| ProbePoint { normal: DVec3::NEG_Y, ..up(x, y, z) };
    let points = [
        up(0.0, 0.0, -1.0),    // in view, under the box
        up(9_000.0, 0.0, 0.0), // far outside
        down(9_000.0, 0.0, 0.0),
        down(0.0, 0.0, -1.0),
        up(0.0, 0.0, 5_000.0), // behind the eye
    ];
    let answers = stage.renderer.probe(&Stage::frame(&stage.pose, &view, light), &points).expect("answers");
    assert_eq!(answers[0].visibility, 0.0);
    assert!(answers[0].split >= 0);
    assert_eq!((answers[1].visibility, answers[1].split), (1.0, -1));
    assert_eq!((answers[2].visibility, answers[2].split), (0.0, -1), "turned away");
    assert_eq!(answers[3].visibility, 0.0);
    assert_eq!((answers[4].visibility, answers[4].split), (1.0, -1));
}

#[test]
fn two_triangles_of_forty_kilometres_are_lit_by_a_low_sun_right_up_to_the_eye() {
    let Some(gpu) = gpu() else { return };
    // 2 degrees up: a geometric normal that is off by 2 degrees would turn away from it.
    let light = sun(DVec3::new(-1.0, -(2_f64.to_radians().tan()), 0.3));
    for offset in [DVec3::ZERO, DVec3::new(511.0, 0.0, -511.0), DVec3::new(-60_000.25, 1_000.5, 80_000.125)] {
        let scene = moved(&scene(vec![ground(0.0, 20_000.0)]), offset);
        // Off the diagonal, with the eye a hand above the ground.
        let eye = DVec3::new(300.0, 0.6, 120.0);
        let mask = Stage::new(&gpu, &scene, &settings())
            .mask(&look(eye + offset, eye + DVec3::new(1.0, -0.45, -0.7) + offset), light);
        let seen = mask.pixels().filter(|pixel| pixel.0[1] == 255).count();
        let dark = mask.pixels().filter(|pixel| pixel.0 == [0, 255]).count();
        assert!(seen > 15_000 && dark == 0, "{dark} of {seen} pixels are dark at {offset}");
    }
}

#[test]
fn a_skinned_mesh_is_drawn_and_casts_where_its_joints_put_it() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-9.0, 12.0, 16.0), DVec3::new(1.0, 0.0, -1.0));
    let light = sun(DVec3::new(0.5, -0.8, 0.3));
    let turn = DQuat::from_rotation_y(0.6);
    let place = trs(DVec3::new(1.0, 2.5, -1.0), turn, DVec3::ONE);
    let unit = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
    let mut rigid = scene(vec![ground(0.0, 30.0), unit.clone()]);
    rigid.nodes[1].local = place;

    let mut bound = unit;
    bound.joints = vec![[0; 4]; bound.positions.len()];
    bound.weights = vec![[1.0, 0.0, 0.0, 0.0]; bound.positions.len()];
    let mut skinned = scene(vec![ground(0.0, 30.0), bound]);
    skinned.nodes.push(Node { local: place, ..Default::default() });
    skinned.skins.push(Skin { joints: vec![2], inverse_bind: vec![glam::Mat4::IDENTITY] });
    skinned.nodes[1].skin = Some(0);

    let expected = Stage::new(&gpu, &rigid, &settings()).mask(&view, light);
    let mut stage = Stage::new(&gpu, &skinned, &settings());
    assert_eq!(stage.pose.skinned.len(), 1);
    let found = stage.mask(&view, light);
    let differ = expected.pixels().zip(found.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ <= 10, "{differ} pixels differ");

    // And after it has moved, from the same renderer.
    skinned.nodes[2].local.translation.x += 3.0;
    rigid.nodes[1].local.translation.x += 3.0;
    stage.pose = skinned.pose(0.0).expect("a pose");
    let expected = Stage::new(&gpu, &rigid, &settings()).mask(&view, light);
    let moved = stage.mask(&view, light);
    let differ = expected.pixels().zip(moved.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ <= 10 && moved != found, "{differ} pixels differ");
}

#[test]
fn a_morphed_mesh_is_drawn_and_casts_in_the_shape_that_its_weights_give_it() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-9.0, 12.0, 16.0), DVec3::new(1.0, 0.0, -1.0));
    let light = sun(DVec3::new(0.5, -0.8, 0.3));
    // As it is, and mirrored: then the other side of each triangle is its front.
    for scale in [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)] {
        let place = trs(DVec3::new(1.0, 2.5, -1.0), DQuat::from_rotation_y(0.6), scale);
        let mut rigid = scene(vec![ground(0.0, 30.0), cuboid(DVec3::splat(-1.0), DVec3::splat(1.0))]);
        rigid.nodes[1].local = place;
        // Lower by 2 m, and two targets that bring it back.
        let mut low = cuboid(DVec3::new(-1.0, -3.0, -1.0), DVec3::new(1.0, -1.0, 1.0));
        let lift =
            |height: f32| MorphTarget { positions: vec![[0.0, height, 0.0]; low.positions.len()], normals: Vec::new() };
        low.targets = vec![lift(1.0), lift(6.0)];
        let mut morphed = scene(vec![ground(0.0, 30.0), low]);
        morphed.meshes[1].weights = vec![0.5, 0.25];
        morphed.nodes[1].local = place;

        let expected = Stage::new(&gpu, &rigid, &settings()).mask(&view, light);
        let mut stage = Stage::new(&gpu, &morphed, &settings());
        let found = stage.mask(&view, light);
        let differ = expected.pixels().zip(found.pixels()).filter(|(a, b)| a != b).count();
        assert!(differ <= 10, "{differ} pixels differ at {scale}");

        // And with other weights, from the same renderer.
        morphed.nodes[1].weights = vec![1.5, 0.25];
        rigid.nodes[1].local.translation.y += 1.0;
        stage.pose = morphed.pose(0.0).expect("a pose");
        let expected = Stage::new(&gpu, &rigid, &settings()).mask(&view, light);
        let moved = stage.mask(&view, light);
        let differ = expected.pixels().zip(moved.pixels()).filter(|(a, b)| a != b).count();
        assert!(differ <= 10 && moved != found, "{differ} pixels differ at {scale}");
    }
}

#[test]
fn translucent_surfaces_tint_what_is_behind_them() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-8.0, 11.0, 15.0), DVec3::ZERO);
    let light = sun(DVec3::new(0.3, -1.0, 0.2));
    let center = |scene: &umbrage_scene::Scene| {
        let outputs = Outputs { picture: true, ..Default::default() };
        let picture = Stage::new(&gpu, scene, &settings()).render(&view, light, outputs).picture.expect("a picture");
        // Where the ray goes through the card at (-1.5, 3, 0): its opaque half.
        let at = pixels(&view, SIZE)
            .filter_map(|pixel| {
                pixel.on_ground(3.0).map(|p| (p.distance(DVec3::new(-1.5, 3.0, 0.0)), pixel.x, pixel.y))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("the card is in view");
        picture.get_pixel(at.1, at.2).0.map(i32::from)
    };
    let mut half = half_card(AlphaMode::Blend);
    half.materials[1].base_color = [1.0, 1.0, 1.0, 0.5];
    let (through, solid) = (center(&half), center(&half_card(AlphaMode::Opaque)));
    let bare = center(&scene(vec![ground(0.0, 30.0)]));
    for channel in 0..3 {
        let (low, high) = (solid[channel].min(bare[channel]), solid[channel].max(bare[channel]));
        assert!((low..=high).contains(&through[channel]), "{solid:?} {through:?} {bare:?}");
    }
    assert!(through[2] > solid[2] + 10 && through[2] < bare[2] - 10, "{solid:?} {through:?} {bare:?}");
}
