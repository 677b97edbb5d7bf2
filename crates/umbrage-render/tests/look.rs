//! Translucent casters and contact shadows.

mod common;

use common::{Stage, config, configured, gpu, ground, look, quad, scene, sun};
use glam::DVec3;
use umbrage::config::{Filter, Look, ShadowConfig, Translucent};
use umbrage_scene::{AlphaMode, Material, Primitive, Scene};

/// A pane four metres above the ground and its material.
fn pane(alpha: f32) -> Scene {
    let mut pane = Primitive::default();
    quad(&mut pane, DVec3::Y * 4.0, DVec3::X * 3.0, DVec3::NEG_Z * 3.0, DVec3::Y);
    pane.material = 1;
    let mut scene = scene(vec![ground(0.0, 40.0), pane]);
    let base_color = [1.0, 1.0, 1.0, alpha];
    scene.materials.push(Material { alpha: AlphaMode::Blend, base_color, double_sided: true, ..Material::default() });
    scene
}

/// Mean visibility of the ground under the middle of the pane.
fn light_below(scene: &Scene, translucent: Translucent, eye: DVec3) -> Option<f64> {
    let look_of = Look { translucent, ..Look::default() };
    let filter = Filter::Pcf5 { width_m: None };
    let settings = configured(ShadowConfig { filter, look: look_of, ..config() });
    let mut stage = Stage::new(&gpu()?, scene, &settings);
    let view = look(eye, DVec3::ZERO);
    let mask = stage.mask(&view, sun(DVec3::NEG_Y));
    let below = common::pixels(&view, settings.size)
        .filter(|pixel| pixel.on_ground(0.0).is_some_and(|at| at.x.abs() < 2.0 && at.z.abs() < 2.0));
    let (sum, count) = below.fold((0.0, 0.0), |(sum, count), pixel| {
        (sum + f64::from(mask.get_pixel(pixel.x, pixel.y).0[0]) / 255.0, count + 1.0)
    });
    assert!(count > 100.0, "{count} pixels show what the pane shades");
    Some(sum / count)
}

#[test]
fn a_translucent_pane_keeps_back_what_its_alpha_says() {
    let eye = DVec3::new(0.0, 2.0, 7.0);
    for alpha in [0.25, 0.5, 0.9] {
        let Some(light) = light_below(&pane(alpha), Translucent::Dithered, eye) else { return };
        assert!((light - (1.0 - f64::from(alpha))).abs() < 0.05, "alpha {alpha} lets {light} of the light through");
    }
    assert_eq!(light_below(&pane(0.9), Translucent::None, eye), Some(1.0));
}

#[test]
fn contact_shadows_find_what_a_map_cannot() {
    // A step of 4 cm under a grazing sun, in texels of two metres; and the bare ground, which stays
    // lit.
    let mut step = Primitive::default();
    quad(&mut step, DVec3::new(0.0, 0.02, 0.0), DVec3::X * 3.0, DVec3::Y * 0.02, DVec3::Z);
    let view = look(DVec3::new(0.0, 1.2, 2.0), DVec3::new(0.0, 0.0, 0.0));
    let from_behind = sun(DVec3::new(0.0, -0.3, 1.0));
    let dark = |scene: &Scene, contact: bool| {
        let look_of = Look { contact, ..Look::default() };
        let filter = Filter::Pcf3 { width_m: None };
        let settings = configured(ShadowConfig { map_sizes: vec![24], filter, look: look_of, ..config() });
        let mut stage = Stage::new(&gpu()?, scene, &settings);
        let mask = stage.mask(&view, from_behind);
        let shaded = common::pixels(&view, settings.size).filter(|pixel| {
            // What the step shades reaches 4 cm / 0.3 before it.
            let at = pixel.on_ground(0.0).is_some_and(|at| at.x.abs() < 2.5 && at.z > 0.01 && at.z < 0.11);
            at && mask.get_pixel(pixel.x, pixel.y).0[0] < 128
        });
        Some(shaded.count())
    };
    let both = scene(vec![ground(0.0, 40.0), step]);
    let Some(by_map) = dark(&both, false) else { return };
    let with_contact = dark(&both, true).unwrap_or(0);
    assert!(with_contact > 2 * by_map + 100, "{by_map} pixels by the map, {with_contact} with contact shadows");
    assert_eq!(dark(&scene(vec![ground(0.0, 40.0)]), true), Some(0), "flat ground");
}
