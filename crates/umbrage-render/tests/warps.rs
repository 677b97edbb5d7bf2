//! Warped maps on a GPU: their masks are those of the closed form, near and far, from any side.

mod common;

use common::{SIZE, Stage, config, configured, cuboid, gpu, ground, look, meets_box, pixels, scene, sun};
use glam::{DVec3, Vec3Swizzles as _};
use umbrage::config::{Crop, DepthFormat, Filter, ShadowConfig, Stability};
use umbrage::{View, Warp};
use umbrage_render::{Outputs, RenderSettings};

/// Two boxes of one size, near and far.
const BOXES: [(DVec3, DVec3); 2] = [
    (DVec3::new(-1.0, 1.0, -2.0), DVec3::new(1.5, 2.0, 1.0)),
    (DVec3::new(4.0, 0.5, -33.0), DVec3::new(9.0, 5.0, -28.0)),
];

fn warped(warps: &[Warp], crop: Crop, filter: Filter, depth_format: DepthFormat) -> RenderSettings {
    configured(ShadowConfig {
        map_sizes: vec![if warps.len() == 1 { 1024 } else { 512 }; warps.len()],
        stability: Stability::Tight { warps: warps.to_vec() },
        crop,
        filter,
        depth_format,
        ..config()
    })
}

/// Pixels of the ground whose decision differs from the ray's, and all of them; how many splits
/// were warped.
fn wrong(gpu: &umbrage_render::Gpu, settings: &RenderSettings, view: &View, light: DVec3) -> (usize, usize, usize) {
    let light = sun(light);
    let boxes = BOXES.iter().map(|&(min, max)| cuboid(min, max));
    let primitives = std::iter::once(ground(0.0, 60.0)).chain(boxes).collect();
    let mut stage = Stage::new(gpu, &scene(primitives), settings);
    let rendered = stage.render(view, light, Outputs { mask: true, ..Default::default() });
    let mask = rendered.mask.expect("a mask");
    let (mut wrong, mut all) = (0, 0);
    for pixel in pixels(view, SIZE) {
        let Some(point) = pixel.on_ground(0.0) else { continue };
        let hidden = BOXES.iter().any(|&(min, max)| meets_box(pixel.eye, pixel.ray, min, max));
        if hidden || point.xz().abs().max_element() > 59.0 || view.view_depth(point) > 59.0 {
            continue;
        }
        let shaded = BOXES.iter().any(|&(min, max)| meets_box(point, -light.direction(), min, max));
        all += 1;
        wrong += usize::from(shaded != (mask.get_pixel(pixel.x, pixel.y).0[0] < 128));
    }
    (wrong, all, rendered.stats.splits.iter().filter(|split| split.warped).count())
}

const WARPS: [Warp; 3] = [Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.2 }];

/// From behind the eye, from ahead of it, and low from the side.
const SUNS: [DVec3; 3] = [DVec3::new(0.1, -0.6, -0.8), DVec3::new(-0.1, -0.5, 0.9), DVec3::new(1.0, -0.25, 0.1)];

fn from_eye_height() -> View {
    look(DVec3::new(-2.0, 5.0, 9.0), DVec3::new(1.0, 0.0, -6.0))
}

fn tight(warps: &[Warp]) -> RenderSettings {
    warped(warps, Crop::SceneDependent, Filter::Hard, DepthFormat::D32Float)
}

#[test]
fn single_warped_maps_say_what_rays_say() {
    let Some(gpu) = gpu() else { return };
    let view = from_eye_height();
    for light in SUNS {
        let (reference, ..) = wrong(&gpu, &tight(&[Warp::None]), &view, light);
        for warp in WARPS {
            let (decided, all, warped) = wrong(&gpu, &tight(&[warp]), &view, light);
            assert!(all > 5000, "{all} pixels are looked at");
            // Edges are some 200 pixels long.
            assert!(decided <= 60.max(2 * reference), "{warp:?} under {light}: {decided} of {all}, plain {reference}");
            assert_eq!(warped, 1, "{warp:?} under {light} is a plain map");
        }
    }
}

#[test]
fn filters_formats_and_loose_fits_make_no_acne() {
    let Some(gpu) = gpu() else { return };
    for warp in WARPS {
        let settings = warped(&[warp], Crop::SceneIndependent, Filter::Pcf3 { width_m: None }, DepthFormat::D16Unorm);
        let (decided, all, _) = wrong(&gpu, &settings, &from_eye_height(), SUNS[0]);
        // A map that has to begin at the camera's near plane spends many texels on the first metre
        // and has coarse ones in the distance.
        assert!(decided <= 150, "{warp:?}: {decided} of {all}");
    }
}

#[test]
fn warped_splits_say_what_rays_say() {
    let Some(gpu) = gpu() else { return };
    for light in SUNS {
        for warps in [[Warp::Psm, Warp::Lispsm, Warp::None], [Warp::Tsm { focus: 0.2 }; 3]] {
            let (decided, all, _) = wrong(&gpu, &tight(&warps), &from_eye_height(), light);
            assert!(decided <= 60, "{warps:?} under {light}: {decided} of {all}");
        }
    }
}

#[test]
fn dueling_frusta_are_no_worse_than_the_plain_map() {
    let Some(gpu) = gpu() else { return };
    // The light comes straight at the eye.
    let view = look(DVec3::new(0.0, 2.0, 12.0), DVec3::new(0.0, 0.5, -6.0));
    let light = -view.forward().with_y(0.12) + DVec3::X * 0.02;
    let (reference, ..) = wrong(&gpu, &tight(&[Warp::None]), &view, light);
    for warp in WARPS {
        let (decided, all, _) = wrong(&gpu, &tight(&[warp]), &view, light);
        assert!(decided <= 60.max(2 * reference), "{warp:?}: {decided} of {all}, plain {reference}");
    }
}
