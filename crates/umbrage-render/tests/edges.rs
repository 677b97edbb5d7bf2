//! Empty scenes, empty views, shadows off, bad input, withheld features.

mod common;

use common::*;
use glam::DVec3;
use umbrage::config::{DepthFormat, Filter, ShadowConfig};
use umbrage_render::{Error, Frame, Gpu, GpuOptions, Outputs, ProbePoint, RenderSettings, Renderer};
use umbrage_scene::{Pose, Scene, Texture};

const ALL: Outputs = Outputs { picture: true, mask: true, maps: true, edges: false };

#[test]
fn an_empty_scene_is_a_picture_of_the_sky() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &Scene::default(), &settings());
    let rendered = stage.render(&look(DVec3::Y, DVec3::ONE), sun(DVec3::NEG_Y), ALL);
    let picture = rendered.picture.expect("a picture");
    assert!(picture.pixels().all(|pixel| pixel.0[3] == 255 && pixel.0[2] > 60), "sky everywhere");
    assert!(rendered.mask.expect("a mask").pixels().all(|pixel| pixel.0 == [0, 0]));
    assert_eq!(rendered.maps.len(), 2);
    assert!(rendered.maps.iter().all(|map| map.dimensions() == (512, 512) && map.pixels().all(|p| p.0 == [255])));
    assert_eq!(rendered.stats.splits.iter().map(|split| split.draws).sum::<u32>(), 0);
    let points = [ProbePoint { position: DVec3::ZERO, normal: DVec3::Y }];
    let view = look(DVec3::Y, DVec3::ONE);
    let answers = stage.renderer.probe(&Stage::frame(&stage.pose, &view, sun(DVec3::NEG_Y)), &points);
    assert_eq!(answers.expect("answers")[0].visibility, 1.0);
}

#[test]
fn nothing_in_view_is_an_empty_mask() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &scene(vec![cuboid(DVec3::splat(-1.0), DVec3::ONE)]), &settings());
    let rendered = stage.render(&look(DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, 9.0)), sun(DVec3::NEG_Y), ALL);
    assert!(rendered.mask.expect("a mask").pixels().all(|pixel| pixel.0 == [0, 0]));
    assert_eq!((rendered.stats.objects_in_view, rendered.stats.view_draws), (0, 0));
}

#[test]
fn without_shadows_everything_that_faces_the_light_is_lit() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(vec![ground(0.0, 30.0), cuboid(DVec3::new(-1.0, 2.0, -1.0), DVec3::new(1.0, 4.0, 1.0))]);
    let mut stage = Stage::new(&gpu, &scene, &settings());
    let view = look(DVec3::new(-6.0, 9.0, 12.0), DVec3::ZERO);
    let light = sun(DVec3::new(0.3, -1.0, 0.4));
    let frame = Frame { shadows_on: false, ..Stage::frame(&stage.pose, &view, light) };
    let rendered = stage.renderer.render(&frame, ALL).expect("a frame");
    let mask = rendered.mask.expect("a mask");
    for pixel in pixels(&view, SIZE) {
        let covered = meets_box(pixel.eye, pixel.ray, DVec3::new(-1.1, 1.9, -1.1), DVec3::new(1.1, 4.1, 1.1));
        if !covered && pixel.on_ground(0.0).is_some_and(|p| p.x.abs().max(p.z.abs()) < 29.0) {
            assert_eq!(mask.get_pixel(pixel.x, pixel.y).0, [255, 255]);
        }
    }
    assert!(mask.pixels().any(|pixel| pixel.0 == [0, 255]), "a side of the box is turned away");
    assert!(rendered.maps.is_empty());
    assert_eq!(rendered.stats.shadow_ms, 0.0);
    let under = [ProbePoint { position: DVec3::new(0.3, 0.0, 0.4), normal: DVec3::Y }];
    assert_eq!(stage.renderer.probe(&frame, &under).expect("answers")[0].visibility, 1.0);
}

#[test]
fn the_tint_colours_the_picture_and_not_the_mask() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 30.0)]), &settings());
    let view = look(DVec3::new(0.0, 4.0, 25.0), DVec3::ZERO);
    let plain = stage.render(&view, sun(DVec3::NEG_Y), ALL);
    let frame = Frame { tint: true, ..Stage::frame(&stage.pose, &view, sun(DVec3::NEG_Y)) };
    let tinted = stage.renderer.render(&frame, ALL).expect("a frame");
    assert_eq!(plain.mask, tinted.mask);
    let saturation = |picture: &image::RgbaImage| {
        let [r, g, b, _] = picture.get_pixel(SIZE[0] / 2, SIZE[1] - 5).0.map(i32::from);
        r.max(g).max(b) - r.min(g).min(b)
    };
    let (plain, tinted) = (plain.picture.expect("a picture"), tinted.picture.expect("a picture"));
    assert!(saturation(&tinted) > saturation(&plain) + 20);
}

#[test]
fn fallbacks_and_depth_formats_draw_the_same_shadow() {
    let Some(gpu) = gpu() else { return };
    let bare = Gpu::new(&GpuOptions { withhold: wgpu::Features::all() }).expect("a device without extras");
    assert!(bare.device.features().is_empty());
    let scene = scene(vec![ground(0.0, 30.0), cuboid(DVec3::new(-1.0, 2.0, -1.0), DVec3::new(1.0, 4.0, 1.0))]);
    let view = look(DVec3::new(-6.0, 9.0, 12.0), DVec3::ZERO);
    let light = sun(DVec3::new(0.3, -1.0, 0.4));
    let mut reference = Stage::new(&gpu, &scene, &settings());
    let expected = reference.render(&view, light, ALL);
    let alternatives =
        [(&bare, settings()), (&gpu, configured(ShadowConfig { depth_format: DepthFormat::D16Unorm, ..config() }))];
    for (device, settings) in alternatives {
        let mut stage = Stage::new(device, &scene, &settings);
        let rendered = stage.render(&view, light, ALL);
        let pairs = || expected.mask.iter().flat_map(|m| m.pixels()).zip(rendered.mask.iter().flat_map(|m| m.pixels()));
        let differ = pairs().filter(|(a, b)| a != b).count();
        assert!(pairs().count() == 160 * 120 && differ < 40, "{differ} pixels differ");
        assert!(rendered.stats.frame_ms > 0.0 && rendered.stats.shadow_ms > 0.0);
        assert_eq!(rendered.maps.len(), 2);
    }
    // Without timestamps the CPU's clock is read, and 16-bit maps without depth clip control keep
    // their near planes back.
    let d16 = configured(ShadowConfig { depth_format: DepthFormat::D16Unorm, ..config() });
    for (settings, notes) in [(settings(), 1), (d16, 2)] {
        let said = Stage::new(&bare, &scene, &settings).render(&view, light, ALL).stats.notes;
        assert_eq!(said.len(), notes, "{said:?}");
    }
}

#[test]
fn maps_of_different_sizes_come_out_in_their_own_size() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(vec![ground(0.0, 30.0), cuboid(DVec3::new(-1.0, 2.0, -1.0), DVec3::new(1.0, 4.0, 1.0))]);
    let view = look(DVec3::new(-6.0, 9.0, 12.0), DVec3::ZERO);
    let mixed = ShadowConfig { map_sizes: vec![128, 256, 64], ..config() };
    for depth_format in [DepthFormat::D32Float, DepthFormat::D16Unorm] {
        let mut stage = Stage::new(&gpu, &scene, &configured(ShadowConfig { depth_format, ..mixed.clone() }));
        let rendered = stage.render(&view, sun(DVec3::new(0.3, -1.0, 0.4)), ALL);
        assert_eq!(rendered.maps.iter().map(|map| map.width()).collect::<Vec<_>>(), [128, 256, 64]);
        let drawn = |map: &image::GrayImage| map.pixels().any(|pixel| pixel.0 != [255]);
        for (map, split) in rendered.maps.iter().zip(&rendered.stats.splits) {
            assert_eq!(drawn(map), split.casters > 0, "split {}..{}", split.near, split.far);
        }
        assert!(rendered.maps.iter().any(drawn));
    }
}

#[test]
fn bad_sizes_are_named() {
    let Some(gpu) = gpu() else { return };
    let new = |settings: &RenderSettings| Renderer::new(&gpu, &Scene::default(), settings).err().map(|e| e.to_string());
    for size in [[0, 5], [5, 0], [1 << 20, 5], [5, u32::MAX]] {
        let message = new(&RenderSettings { size, ..settings() }).expect("an error");
        assert!(message.contains(&format!("{}x{}", size[0], size[1])), "{message}");
    }
    let of = |map_sizes: &[u32], filter| {
        new(&configured(ShadowConfig { map_sizes: map_sizes.to_vec(), filter, ..config() })).expect("an error")
    };
    let message = of(&[512, 65536], Filter::Hard);
    assert!(message.contains("65536") && message.contains("[1]"), "{message}");
    let message = of(&[], Filter::Hard);
    assert!(message.contains("0 splits"), "{message}");
    assert!(of(&[1], Filter::Pcf5 { width_m: None }).contains("map 0 is 1 texels"));
}

#[test]
fn scenes_that_contradict_themselves_are_refused() {
    let Some(gpu) = gpu() else { return };
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene(vec![ground(0.0, 1.0)]);
        change(&mut scene);
        match Renderer::new(&gpu, &scene, &settings()) {
            Err(Error::Scene { what, .. }) => what,
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("accepted"),
        }
    };
    assert_eq!(refused(&|scene| scene.meshes[0].primitives[0].indices[3] = 4), "mesh");
    assert_eq!(refused(&|scene| scene.meshes[0].primitives[0].indices.truncate(5)), "mesh");
    assert_eq!(refused(&|scene| scene.meshes[0].primitives[0].normals.clear()), "mesh");
    assert_eq!(refused(&|scene| scene.meshes[0].primitives[0].material = 7), "mesh");
    assert_eq!(refused(&|scene| scene.materials[0].base_color_texture = Some(3)), "material");
    let short =
        Texture { width: 4, height: 4, rgba: vec![0; 63], wrap: Default::default(), filter: Default::default() };
    assert_eq!(refused(&|scene| scene.textures.push(short.clone())), "texture");
}

#[test]
fn a_pose_of_another_scene_and_bad_probes_are_refused() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &scene(vec![ground(0.0, 1.0)]), &settings());
    let other: Pose = scene(vec![ground(0.0, 1.0), ground(1.0, 1.0)]).pose(0.0).expect("a pose");
    let view = look(DVec3::Y, DVec3::ZERO);
    let result = stage.renderer.render(&Stage::frame(&other, &view, sun(DVec3::NEG_Y)), ALL);
    assert!(matches!(result, Err(Error::Scene { what: "pose object", index: 1, .. })));
    for (position, normal) in
        [(DVec3::splat(f64::NAN), DVec3::Y), (DVec3::ZERO, DVec3::ZERO), (DVec3::ZERO, DVec3::splat(f64::INFINITY))]
    {
        let points = [ProbePoint { position: DVec3::ZERO, normal: DVec3::Y }, ProbePoint { position, normal }];
        let answers = stage.renderer.probe(&Stage::frame(&stage.pose, &view, sun(DVec3::NEG_Y)), &points);
        assert!(matches!(answers, Err(Error::Probe { index: 1, .. })));
    }
    let none = stage.renderer.probe(&Stage::frame(&stage.pose, &view, sun(DVec3::NEG_Y)), &[]);
    assert!(none.is_ok_and(|answers| answers.is_empty()));
}
