//! A picture that takes its shadows from a mask is the picture that asks for each fragment.

mod common;

use common::{Stage, config, configured, cuboid, gpu, ground, look, quad, scene, sphere, sun};
use glam::DVec3;
use image::RgbaImage;
use umbrage::config::{Filter, Look, ShadowConfig};
use umbrage_render::{Frame, Outputs, RenderSettings, Samples};
use umbrage_scene::{AlphaMode, Material, Primitive, Scene};

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

#[test]
fn a_resized_picture_has_a_mask_of_its_size() {
    let Some(gpu) = gpu() else { return };
    let settings = RenderSettings { samples: Samples::One, ..configured(config()) };
    let mut stage = Stage::new(&gpu, &world(), &settings);
    let eye = DVec3::new(-2.0, 4.0, 9.0);
    let before = picture(&mut stage, eye, false);
    let size = settings.size;
    stage.renderer.resize([size[0] / 2, size[1] / 2]).expect("a smaller picture");
    picture(&mut stage, eye, false);
    stage.renderer.resize(size).expect("the picture of before");
    let after = picture(&mut stage, eye, false);
    assert_eq!(differing(&before, &after, 0), 0.0);
}
