//! A text that is made for what is used answers as the one that has everything, bit for bit, and refuses the rest.

mod common;

use common::{Ask, Gpu, World, ask, cuboid, ground, plan};
use glam::{DVec3, DVec4, Vec3};
use umbrage::{Bands, Selection, ShadowPlan};
use umbrage_wgpu::{
    Error, Filter, Fixed, FrameOptions, LightSlot, ReceiverBias, ShadowMapsOptions, Softness, Transition,
};

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

/// All answers of maps that were made so, as bits.
fn answers(gpu: Gpu, options: &ShadowMapsOptions, frame: &FrameOptions, plan: &ShadowPlan) -> Vec<[u32; 8]> {
    let mut world = World::new(gpu, options);
    let boxes: Vec<Vec3> = (-3..4)
        .flat_map(|i| cuboid(Vec3::new(6.0 * i as f32, 0.0, -25.0), Vec3::new(6.0 * i as f32 + 1.5, 3.0, 25.0)))
        .chain(ground(100.0))
        .collect();
    world.draw(plan, frame, &boxes);
    bytemuck::cast_slice(&world.ask(&asks())).to_vec()
}

#[test]
fn what_is_fixed_answers_as_what_is_not() {
    for (filter, selection, bands, transition, bias) in [
        (Filter::Hard, Selection::Depth, Bands::Planar, Transition::Hard, ReceiverBias::Plane),
        (Filter::Pcf2, Selection::Map, Bands::Planar, Transition::Blend, ReceiverBias::Plane),
        (Filter::Pcf3, Selection::Depth, Bands::Planar, Transition::Blend, ReceiverBias::Plane),
        (Filter::Pcf5, Selection::Depth, Bands::Radial, Transition::Dither, ReceiverBias::Slope),
        (Filter::Pcss, Selection::Map, Bands::Planar, Transition::Dither, ReceiverBias::Plane),
        (Filter::Msm, Selection::Depth, Bands::Planar, Transition::Blend, ReceiverBias::Slope),
    ] {
        let plan = planned(selection, bands);
        let softness = Softness { sun_angle: 0.1, ..Softness::default() };
        let frame = FrameOptions { transition, bias, softness, ..FrameOptions::default() };
        let open = ShadowMapsOptions { map_sizes: SIZES.to_vec(), filter, ..ShadowMapsOptions::default() };
        let fixed = ShadowMapsOptions {
            lights: vec![LightSlot::Sun],
            fixed: Fixed {
                selection: Some(selection),
                bands: Some(bands),
                warped: Some(false),
                transition: Some(transition),
                bias: Some(bias),
            },
            ..open.clone()
        };
        let Some((one, other)) = Gpu::new().zip(Gpu::new()) else { return };
        let (open, fixed) = (answers(one, &open, &frame, &plan), answers(other, &fixed, &frame, &plan));
        let differing = open.iter().zip(&fixed).filter(|(open, fixed)| open != fixed).count();
        assert_eq!(differing, 0, "{filter:?} of {}", open.len());
        let lit = open.iter().filter(|answer| f32::from_bits(answer[0]) > 0.5).count();
        assert!((open.len() / 20..open.len() * 19 / 20).contains(&lit), "{filter:?}: {lit} lit of {}", open.len());
    }
}

#[test]
fn what_the_text_does_not_have_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let fixed = Fixed {
        selection: Some(Selection::Depth),
        bands: Some(Bands::Planar),
        warped: Some(true),
        transition: Some(Transition::Blend),
        bias: Some(ReceiverBias::Plane),
    };
    let options = ShadowMapsOptions { map_sizes: SIZES.to_vec(), ..ShadowMapsOptions::default() };
    for (name, fixed, frame, plan) in [
        ("selection", Fixed { warped: None, ..fixed }, FrameOptions::default(), planned(Selection::Map, Bands::Planar)),
        ("bands", Fixed { warped: None, ..fixed }, FrameOptions::default(), planned(Selection::Depth, Bands::Radial)),
        ("warped", fixed, FrameOptions::default(), planned(Selection::Depth, Bands::Planar)),
        (
            "transition",
            Fixed { warped: None, ..fixed },
            FrameOptions { transition: Transition::Hard, ..FrameOptions::default() },
            planned(Selection::Depth, Bands::Planar),
        ),
        (
            "bias",
            Fixed { warped: None, ..fixed },
            FrameOptions { bias: ReceiverBias::Slope, ..FrameOptions::default() },
            planned(Selection::Depth, Bands::Planar),
        ),
    ] {
        let mut maps = umbrage_wgpu::ShadowMaps::new(&gpu.device, &ShadowMapsOptions { fixed, ..options.clone() })
            .expect("valid options");
        let error = maps.prepare(&gpu.queue, &plan, &frame).expect_err(name);
        let Error::ConflictingOptions { first, second, .. } = &error else { panic!("{error}") };
        assert!(first.starts_with(name) && second.starts_with(name), "{error}");
        assert!(error.to_string().contains("ShadowMapsOptions::fixed"), "{error}");
    }
}
