//! A receiver's text that is made for what is used answers as one that has more, bit for bit, and
//! plans of other choices are refused.

mod common;

use common::{Ask, Gpu, World, ask, config, cuboid, ground, plan};
use glam::{DVec3, DVec4, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{LightKind, Selection, SplitMetric};
use umbrage_wgpu::{Error, Filter, FrameOptions, ShadowConfig, ShadowMaps};

const SIZES: [u32; 3] = [128; 3];

const RADIAL: Selection = Selection::Interval(SplitMetric::Distance);

fn planned(selection: Selection) -> ShadowPlan {
    let mut plan =
        plan(DVec3::new(0.4, -1.0, 0.2), DVec3::ZERO, &SIZES, &[1.0, 12.0, 30.0, 90.0], &[40.0, 60.0, 100.0]);
    for split in &mut plan.splits {
        split.blend_begin = split.near + 0.5 * (split.far - split.near);
    }
    plan.view_depth_plane = DVec4::new(1.0, 0.0, 0.2, 25.0);
    plan.blend = 0.2;
    plan.selection = selection;
    plan.eye = DVec3::new(-25.0, 2.0, 0.0);
    plan
}

fn asks() -> Vec<Ask> {
    let steps = || (-40..40).map(|i| 0.731 * i as f32);
    let level = steps().flat_map(|x| steps().map(move |z| ask(Vec3::new(x, 0.0, z), Vec3::Y)));
    let wall = steps().flat_map(|x| steps().map(move |z| ask(Vec3::new(x, 0.1 * z.abs(), 3.0), Vec3::NEG_Z)));
    level.chain(wall).collect()
}

/// All answers of maps that were made for these lights, as bits.
fn answers(gpu: Gpu, config: &ShadowConfig, lights: &[LightKind], plan: &ShadowPlan) -> Vec<[u32; 8]> {
    let mut world = World::of_lights(gpu, config, lights);
    let boxes: Vec<Vec3> = (-3..4)
        .flat_map(|i| cuboid(Vec3::new(6.0 * i as f32, 0.0, -25.0), Vec3::new(6.0 * i as f32 + 1.5, 3.0, 25.0)))
        .chain(ground(100.0))
        .collect();
    world.draw(plan, &FrameOptions::default(), &boxes);
    bytemuck::cast_slice(&world.ask(&asks())).to_vec()
}

#[test]
fn a_text_for_suns_answers_as_a_text_for_any_single_light() {
    for (filter, selection, settings) in [
        ("hard", Selection::VIEW_DEPTH, "transition=hard"),
        ("pcf2", Selection::Map, "selection=map blend=0.2"),
        ("pcf3", Selection::VIEW_DEPTH, "blend=0.2"),
        ("pcf5", RADIAL, "bands=radial transition=dither bias=slope"),
    ] {
        let plan = planned(selection);
        let filter: Filter = filter.parse().expect("a filter");
        let config = config(&SIZES, filter, settings);
        let Some((one, other)) = Gpu::new().zip(Gpu::new()) else { return };
        let sun = answers(one, &config, &[LightKind::Directional], &plan);
        let any = answers(other, &config, &[LightKind::Spot], &plan);
        let differing = sun.iter().zip(&any).filter(|(sun, any)| sun != any).count();
        assert_eq!(differing, 0, "{filter:?} of {}", sun.len());
        let lit = sun.iter().filter(|answer| f32::from_bits(answer[0]) > 0.5).count();
        assert!((sun.len() / 20..sun.len() * 19 / 20).contains(&lit), "{filter:?}: {lit} lit of {}", sun.len());
    }
}

#[test]
fn a_text_holds_less_where_less_is_chosen() {
    let Some(gpu) = Gpu::new() else { return };
    let lines = |settings: &str, lights: &[LightKind]| {
        let config = config(&SIZES, Filter::Pcf2, settings);
        let maps = ShadowMaps::new(&gpu.device, &config, lights).expect("valid config");
        maps.receiver_wgsl(0).lines().count()
    };
    let least = lines("transition=hard", &[LightKind::Directional]);
    assert!(least < lines("blend=0.1", &[LightKind::Directional]));
    assert!(lines("transition=hard filter=hard", &[LightKind::Directional]) < least);
    assert!(least < lines("transition=hard", &[LightKind::Spot]));
}

#[test]
fn a_plan_of_other_choices_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let config = config(&SIZES, Filter::Pcf3 { width_m: None }, "");
    let mut maps = ShadowMaps::new(&gpu.device, &config, &common::SUN).expect("valid config");
    for (name, plan) in [("selection", planned(Selection::Map)), ("bands", planned(RADIAL))] {
        let error = maps.prepare(&gpu.queue, &plan, &FrameOptions::default()).expect_err(name);
        assert!(matches!(error, Error::PlanOfOtherConfig { setting, .. } if setting == name), "{error}");
    }
    let right = planned(Selection::VIEW_DEPTH);
    assert_eq!(maps.prepare(&gpu.queue, &right, &FrameOptions::default()), Ok(()));
}
