//! A picture that takes its shadows from a mask is the picture that asks for each fragment.

mod common;

use common::{Stage, config, configured, cuboid, gpu, ground, look, quad, scene, sphere, sun};
use glam::DVec3;
use image::RgbaImage;
use umbrage::config::{Filter, LightKind, Look, Range, ShadowConfig};
use umbrage::{Light, SpotLight};
use umbrage_render::{Frame, Outputs, RenderSettings, Samples};
use umbrage_scene::{AlphaMode, Material, Mesh, Node, Primitive, Scene, Texture, TextureFilter, Wrap};

const PICTURE: Outputs = Outputs { picture: true, mask: false, maps: false, edges: false };

/// Boxes, a round thing, leaves of alpha and a pane over a ground.
fn world() -> Scene {
    let mut leaf = Primitive::default();
    quad(&mut leaf, DVec3::new(-2.5, 1.0, -1.0), DVec3::X * 0.8, DVec3::Y * 0.8, DVec3::Z);
    leaf.material = 1;
    let mut pane = Primitive::default();
    quad(&mut pane, DVec3::new(2.0, 1.5, 0.0), DVec3::X * 0.7, DVec3::Y * 0.7, DVec3::Z);
    pane.material = 2;
    let solid =
        [cuboid(DVec3::new(-1.0, 0.0, -2.0), DVec3::new(1.5, 2.0, 1.0)), sphere(DVec3::new(3.0, 1.0, -6.0), 1.0)];
    let mut scene = scene(std::iter::once(ground(0.0, 60.0)).chain(solid).chain([leaf, pane]).collect());
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    scene.materials.push(Material { alpha: mask, double_sided: true, ..Material::default() });
    let blend = Material { alpha: AlphaMode::Blend, base_color: [0.3, 0.5, 1.0, 0.4], ..Material::default() };
    scene.materials.push(Material { double_sided: true, ..blend });
    scene
}

/// [`world`] with a lattice of alpha before it, and a box that glows.
fn lattice() -> Scene {
    let mut scene = world();
    let mut card = Primitive { material: 3, ..Primitive::default() };
    quad(&mut card, DVec3::new(1.0, 1.6, 2.0), DVec3::X * 1.5, DVec3::new(0.0, 1.5, 0.4), DVec3::Z);
    let glowing = Primitive { material: 4, ..cuboid(DVec3::new(4.0, 0.0, -1.0), DVec3::new(5.0, 1.0, 0.0)) };
    for primitive in [card, glowing] {
        scene.nodes.push(Node { mesh: Some(scene.meshes.len()), ..Node::default() });
        scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
    }
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    let leaves = Material { alpha: mask, base_color_texture: Some(0), double_sided: true, ..Material::default() };
    scene.materials.extend([leaves, Material { emissive: [0.3, 0.1, 0.0], ..Material::default() }]);
    let texel = |x: u32, y: u32| [60, 160, 60, if (x / 4 + y / 4).is_multiple_of(2) { 255 } else { 0 }];
    let rgba = (0..32).flat_map(|y| (0..32).flat_map(move |x| texel(x, y))).collect();
    scene.textures.push(Texture { width: 32, height: 32, rgba, wrap: [Wrap::Clamp; 2], filter: TextureFilter::Linear });
    scene
}

/// Share of pixels in which two pictures differ by more than `by` in some channel.
fn differing(a: &RgbaImage, b: &RgbaImage, by: u8) -> f64 {
    let differs = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| (0..4).any(|i| a.0[i].abs_diff(b.0[i]) > by);
    a.pixels().zip(b.pixels()).filter(differs).count() as f64 / f64::from(a.width() * a.height())
}

fn picture(stage: &mut Stage, eye: DVec3, tint: bool) -> RgbaImage {
    let (view, light) = (look(eye, DVec3::new(0.5, 1.0, -2.0)), sun(DVec3::new(0.6, -0.7, -0.4)));
    let pose = stage.pose.clone();
    let frame = Frame { tint, ..Stage::frame(&pose, &view, light) };
    stage.renderer.render(&frame, PICTURE).expect("a frame").picture.expect("a picture")
}

#[test]
fn a_mask_draws_the_picture_that_fragments_draw() {
    let Some(gpu) = gpu() else { return };
    let world = world();
    let look_of = Look { colour: [0.2, 0.1, 0.4], ..Look::default() };
    for filter in [Filter::Pcf2, Filter::Pcf5 { width_m: None }] {
        let with = |through_mask| {
            let settings = configured(ShadowConfig { filter, look: look_of, ..config() });
            Stage::new(&gpu, &world, &RenderSettings { samples: Samples::One, through_mask, ..settings })
        };
        let [mut ours, mut theirs] = [true, false].map(with);
        for eye in [DVec3::new(-2.0, 4.0, 9.0), DVec3::new(6.0, 1.0, 3.0)] {
            let [a, b] = [&mut ours, &mut theirs].map(|stage| picture(stage, eye, false));
            // Positions from depth and positions from vertices differ by rounding.
            let differ = differing(&a, &b, 2);
            assert!(differ <= 0.002, "{filter:?} from {eye}: {differ} of the pixels differ");
            // The comparison can say no: to another eye, and to the picture without shadows.
            let moved = picture(&mut theirs, eye + DVec3::X, false);
            assert!(differing(&a, &moved, 2) > 0.02);
            // Tints tell which split answered, which a mask does not know.
            let [a, b] = [&mut ours, &mut theirs].map(|stage| picture(stage, eye, true));
            assert_eq!(differing(&a, &b, 0), 0.0);
        }
    }
}

/// Each sample of a pixel has the shadow of the surface that it shows: at silhouettes, at the edges
/// of leaves, and behind what is translucent.
#[test]
fn masks_of_samples_draw_the_picture_that_fragments_draw() {
    let Some(gpu) = gpu() else { return };
    let scene = lattice();
    let look_of = Look { colour: [0.2, 0.1, 0.4], ..Look::default() };
    let spot = SpotLight::new(DVec3::new(-4.0, 6.0, 4.0), DVec3::new(0.6, -0.7, -0.6), 0.9, 40.0);
    let spot: Light = spot.expect("a spot light").into();
    let sun: Light = sun(DVec3::new(0.6, -0.7, -0.4)).into();
    let cases = [
        (LightKind::Directional, sun, Filter::Pcf2),
        (LightKind::Directional, sun, Filter::Pcf5 { width_m: None }),
        (LightKind::Spot, spot, Filter::Pcf3 { width_m: None }),
    ];
    for (kind, light, filter) in cases {
        let with = |through_mask| {
            let config = ShadowConfig { filter, look: look_of, range: Range::Visible, ..config() };
            let settings = RenderSettings { lights: vec![kind.into()], ..configured(config) };
            Stage::new(&gpu, &scene, &RenderSettings { samples: Samples::Four, through_mask, ..settings })
        };
        let [mut ours, mut theirs] = [true, false].map(with);
        let picture = |stage: &mut Stage, eye: DVec3| {
            let view = look(eye, DVec3::new(0.5, 1.0, -2.0));
            let frame = Frame { light: light.into(), ..Stage::frame(&stage.pose, &view, common::sun(DVec3::NEG_Y)) };
            let rendered = stage.renderer.render(&frame, PICTURE).expect("a frame");
            (rendered.picture.expect("a picture"), rendered.stats.view_counts)
        };
        for eye in [DVec3::new(-2.0, 4.0, 9.0), DVec3::new(6.0, 1.0, 3.0)] {
            let [(a, through), (b, asking)] = [&mut ours, &mut theirs].map(|stage| picture(stage, eye));
            // Nothing is compared with itself.
            let is_software = gpu.adapter_info.device_type == wgpu::DeviceType::Cpu;
            assert!(!is_software || through.is_none() || through != asking, "the picture has no mask");
            let differ = differing(&a, &b, 2);
            assert!(differ <= 0.002, "{kind:?} and {filter:?} from {eye}: {differ} of the pixels differ");
            let (moved, _) = picture(&mut theirs, eye + DVec3::X * 0.01);
            assert!(differing(&a, &moved, 2) > 0.004, "the comparison sees a step of a centimetre");
        }
    }
}

#[test]
fn a_resized_picture_has_a_mask_of_its_size() {
    let Some(gpu) = gpu() else { return };
    for samples in [Samples::One, Samples::Four] {
        let settings = RenderSettings { samples, ..configured(config()) };
        let mut stage = Stage::new(&gpu, &world(), &settings);
        let eye = DVec3::new(-2.0, 4.0, 9.0);
        let before = picture(&mut stage, eye, false);
        let size = settings.size;
        stage.renderer.resize([size[0] / 2, size[1] / 2]).expect("a smaller picture");
        picture(&mut stage, eye, false);
        stage.renderer.resize(size).expect("the picture of before");
        let after = picture(&mut stage, eye, false);
        assert_eq!(differing(&before, &after, 0), 0.0, "{samples:?}");
    }
}
