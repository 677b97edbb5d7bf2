//! Warped maps on a GPU: their masks are those of the closed form, near and far, from any side.

mod common;

use common::{SIZE, Stage, cuboid, gpu, ground, look, meets_box, pixels, scene, settings, sun};
use glam::DVec3;
use umbrage::{Fit, ShadowSettings, Stabilize, View, Warp};
use umbrage_render::{Outputs, RenderSettings};
use umbrage_wgpu::{DepthFormat, Filter};

/// Two boxes of one size, near and far.
const BOXES: [(DVec3, DVec3); 2] = [
    (DVec3::new(-1.0, 1.0, -2.0), DVec3::new(1.5, 2.0, 1.0)),
    (DVec3::new(4.0, 0.5, -33.0), DVec3::new(9.0, 5.0, -28.0)),
];

fn warped(warps: &[Warp], fit: Fit, filter: Filter, depth_format: DepthFormat) -> RenderSettings {
    let plain = settings();
    RenderSettings {
        shadows: ShadowSettings {
            map_sizes: vec![if warps.len() == 1 { 1024 } else { 512 }; warps.len()],
            stabilize: Stabilize::None,
            fit,
            warps: warps.to_vec(),
            ..plain.shadows
        },
        filter,
        depth_format,
        ..plain
    }
}

/// Pixels of the ground whose decision differs from the ray's, and all of them; how many splits were warped.
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

use glam::Vec3Swizzles as _;

const WARPS: [Warp; 3] = [Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.2 }];

const SUNS: [DVec3; 4] = [
    DVec3::new(0.5, -0.7, 0.35),
    // From behind the eye, from ahead of it, and low from the side.
    DVec3::new(0.1, -0.6, -0.8),
    DVec3::new(-0.1, -0.5, 0.9),
    DVec3::new(1.0, -0.25, 0.1),
];

#[test]
fn single_warped_maps_say_what_rays_say() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-2.0, 5.0, 9.0), DVec3::new(1.0, 0.0, -6.0));
    for light in SUNS {
        let (reference, ..) =
            wrong(&gpu, &warped(&[Warp::None], Fit::Dependent, Filter::Hard, DepthFormat::D32Float), &view, light);
        for warp in WARPS {
            for (fit, filter, format) in [
                (Fit::Dependent, Filter::Hard, DepthFormat::D32Float),
                (Fit::Independent, Filter::Pcf3, DepthFormat::D32Float),
                (Fit::Dependent, Filter::Pcf2, DepthFormat::D16Unorm),
            ] {
                let (wrong, all, _) = wrong(&gpu, &warped(&[warp], fit, filter, format), &view, light);
                assert!(all > 5000, "{all} pixels are looked at");
                // A tenth of a percent of bad pixels would be acne or a lost caster; edges are some 200 pixels long.
                assert!(
                    wrong <= 60.max(2 * reference),
                    "{warp:?} {fit:?} {filter:?} {format:?} under {light}: {wrong} of {all}, plain {reference}"
                );
            }
        }
    }
}

#[test]
fn warped_splits_say_what_rays_say() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-2.0, 5.0, 9.0), DVec3::new(1.0, 0.0, -6.0));
    for light in SUNS {
        for warps in
            [[Warp::Psm; 3], [Warp::Lispsm; 3], [Warp::Tsm { focus: 0.2 }, Warp::Tsm { focus: 0.2 }, Warp::None]]
        {
            let settings = warped(&warps, Fit::Dependent, Filter::Hard, DepthFormat::D32Float);
            let (wrong, all, _) = wrong(&gpu, &settings, &view, light);
            assert!(wrong <= 60, "{warps:?} under {light}: {wrong} of {all}");
        }
    }
}

#[test]
fn the_maps_were_warped() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(-2.0, 5.0, 9.0), DVec3::new(1.0, 0.0, -6.0));
    for warp in WARPS {
        let settings = warped(&[warp], Fit::Dependent, Filter::Hard, DepthFormat::D32Float);
        assert_eq!(wrong(&gpu, &settings, &view, SUNS[0]).2, 1, "{warp:?}");
    }
}

#[test]
fn dueling_frusta_are_no_worse_than_the_plain_map() {
    let Some(gpu) = gpu() else { return };
    // The light comes straight at the eye.
    let view = look(DVec3::new(0.0, 2.0, 12.0), DVec3::new(0.0, 0.5, -6.0));
    for off in [0.0, 0.02] {
        let light = -view.forward().with_y(-0.12) + DVec3::X * off;
        let light = DVec3::new(light.x, -light.y.abs(), light.z);
        let plain = warped(&[Warp::None], Fit::Dependent, Filter::Hard, DepthFormat::D32Float);
        let (reference, ..) = wrong(&gpu, &plain, &view, light);
        for warp in WARPS {
            let settings = warped(&[warp], Fit::Dependent, Filter::Hard, DepthFormat::D32Float);
            let (wrong, all, _) = wrong(&gpu, &settings, &view, light);
            assert!(wrong <= 60.max(2 * reference), "{warp:?}: {wrong} of {all}, plain {reference}");
        }
    }
}
