//! A text that is made for what is used answers as the one that has everything, bit for bit, and refuses the rest.

mod common;

use common::{ASK, Ask, Gpu, PCF3, PCF5, SUN, World, ask, config, cuboid, ground, plan};
use glam::{DVec3, DVec4, Vec3};
use umbrage::config::Filter;
use umbrage::{Bands, Selection, ShadowPlan};
use umbrage_wgpu::{Error, FrameOptions, ShadowMaps};

const SIZES: [u32; 3] = [128; 3];

fn planned(selection: Selection, bands: Bands) -> ShadowPlan {
    let mut plan =
        plan(DVec3::new(0.4, -1.0, 0.2), DVec3::ZERO, &SIZES, &[1.0, 12.0, 30.0, 90.0], &[40.0, 60.0, 100.0]);
    for split in &mut plan.splits {
        split.blend_begin = split.near + 0.5 * (split.far - split.near);
    }
    plan.view_depth_plane = DVec4::new(1.0, 0.0, 0.2, 25.0);
    plan.blend = 0.2;
    plan.selection = selection;
    plan.radial_eye = (bands == Bands::Radial).then_some(DVec3::new(-25.0, 2.0, 0.0));
    plan
}

fn asks() -> Vec<Ask> {
    let steps = || (-40..40).map(|i| 0.731 * i as f32);
    let level = steps().flat_map(|x| steps().map(move |z| ask(Vec3::new(x, 0.0, z), Vec3::Y)));
    let wall = steps().flat_map(|x| steps().map(move |z| ask(Vec3::new(x, 0.1 * z.abs(), 3.0), Vec3::NEG_Z)));
    level.chain(wall).collect()
}

#[test]
fn what_is_fixed_answers_as_what_is_not() {
    let wide_pcss = Filter::Pcss { sun_degrees: 5.73, rotated: false };
    for (filter, selection, bands, settings) in [
        (Filter::Hard, Selection::Depth, Bands::Planar, "transition=hard"),
        (Filter::Pcf2, Selection::Map, Bands::Planar, "selection=map"),
        (PCF3, Selection::Depth, Bands::Planar, ""),
        (PCF5, Selection::Depth, Bands::Radial, "bands=radial transition=dither bias=slope"),
        (wide_pcss, Selection::Map, Bands::Planar, "selection=map transition=dither"),
    ] {
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &config(&SIZES, filter, settings));
        let boxes: Vec<Vec3> = (-3..4)
            .flat_map(|i| cuboid(Vec3::new(6.0 * i as f32, 0.0, -25.0), Vec3::new(6.0 * i as f32 + 1.5, 3.0, 25.0)))
            .chain(ground(100.0))
            .collect();
        world.draw(&planned(selection, bands), &FrameOptions::default(), &boxes);
        let fixed: Vec<[u32; 8]> = bytemuck::cast_slice(&world.ask(&asks())).to_vec();
        let everything = umbrage_shaders::receiver(1, umbrage_shaders::Maps::default()) + ASK;
        let open: Vec<[u32; 8]> = world.gpu.compute(&everything, &asks(), Some(&world.maps));
        let differing = open.iter().zip(&fixed).filter(|(open, fixed)| open != fixed).count();
        assert_eq!(differing, 0, "{filter:?} of {}", open.len());
        let lit = open.iter().filter(|answer| f32::from_bits(answer[0]) > 0.5).count();
        assert!((open.len() / 20..open.len() * 19 / 20).contains(&lit), "{filter:?}: {lit} lit of {}", open.len());
    }
}

#[test]
fn what_the_text_does_not_have_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let mut warped = planned(Selection::Depth, Bands::Planar);
    warped.splits[1].warp = Some(warped.splits[1].shadow_from_world());
    let by_map = planned(Selection::Map, Bands::Planar);
    let radial = planned(Selection::Depth, Bands::Radial);
    let planar = planned(Selection::Depth, Bands::Planar);
    for (setting, settings, plan) in [
        ("selection", "", &by_map),
        ("selection", "selection=map", &planar),
        ("bands", "", &radial),
        ("bands", "bands=radial", &planar),
        ("warp", "", &warped),
    ] {
        let mut maps = ShadowMaps::new(&gpu.device, &config(&SIZES, PCF3, settings), &SUN).expect("valid");
        let error = maps.prepare(&gpu.queue, plan, &FrameOptions::default()).expect_err(setting);
        assert_eq!(error, Error::PlanOfOtherConfig { setting });
        assert!(error.to_string().contains(setting), "{error}");
    }
    let mut maps = ShadowMaps::new(&gpu.device, &config(&SIZES, PCF3, "warp=lispsm"), &SUN).expect("valid");
    // Where a warp has nothing to gain, a split is plain.
    assert_eq!(maps.prepare(&gpu.queue, &warped, &FrameOptions::default()), Ok(()));
    assert_eq!(maps.prepare(&gpu.queue, &planar, &FrameOptions::default()), Ok(()));
}
