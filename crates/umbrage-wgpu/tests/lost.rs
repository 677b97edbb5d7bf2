//! A device that is lost is told of, by a type of its own.

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{Gpu, SUN, config, plan, with};
use glam::DVec3;
use umbrage::config::Filter;
use umbrage::{Aabb, DirectionalLight, Frustum, Light, View};
use umbrage_wgpu::{CasterPipeline, Error, FrameOptions, Inputs, ShadowConfig, ShadowMaps, Shadows};

#[test]
fn a_lost_device_is_an_error_of_its_own() {
    let Some(gpu) = Gpu::new() else { return };
    let complaints = Arc::new(AtomicUsize::new(0));
    let counted = complaints.clone();
    gpu.device.on_uncaptured_error(Arc::new(move |_| {
        counted.fetch_add(1, Ordering::Relaxed);
    }));

    let view = View::look_at_upright(
        DVec3::new(0.0, 5.0, 9.0),
        DVec3::ZERO,
        Frustum::perspective(1.0, 1.5, 0.1, 100.0).expect("a lens"),
    )
    .expect("a view");
    let lights = [Light::from(DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a sun"))];
    let boxes = [Aabb::new(DVec3::splat(-1.0), DVec3::splat(1.0))];
    let inputs = Inputs { casters: &boxes, receivers: &boxes, image_size: [60, 40], ..Inputs::new(&view, &lights) };
    let mut all = ["filter=pcf3", "filter=evsm4", "generation=multipass"]
        .map(|settings| Shadows::new(&gpu.device, &with(ShadowConfig::default(), settings)).expect("shadows"));
    let mut maps = ShadowMaps::new(&gpu.device, &config(&[64, 32], Filter::Hard, ""), &SUN).expect("maps");
    let plan = plan(DVec3::NEG_Y, DVec3::ZERO, &[64, 32], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    for shadows in &mut all {
        shadows.prepare(&gpu.queue, &inputs).expect("a device that is there");
        shadows.caster_pipeline(&CasterPipeline::default()).expect("a device that is there");
    }
    assert_eq!(maps.prepare(&gpu.queue, &plan, &FrameOptions::default()), Ok(()));

    gpu.device.destroy();
    for shadows in &mut all {
        for _ in 0..2 {
            assert_eq!(shadows.prepare(&gpu.queue, &inputs).err(), Some(Error::DeviceLost));
        }
        assert_eq!(shadows.caster_pipeline(&CasterPipeline::default()).err(), Some(Error::DeviceLost));
    }
    assert_eq!(maps.prepare(&gpu.queue, &plan, &FrameOptions::default()), Err(Error::DeviceLost));
    assert_eq!(Shadows::new(&gpu.device, &ShadowConfig::default()).err(), Some(Error::DeviceLost));
    // What is wrong with a plan is still said first.
    let mut spoilt = plan.clone();
    spoilt.fade_begin = f64::NAN;
    let refused = maps.prepare(&gpu.queue, &spoilt, &FrameOptions::default());
    assert!(matches!(refused, Err(Error::InvalidPlan { .. })), "{refused:?}");
    assert_eq!(complaints.load(Ordering::Relaxed), 0, "nothing is complained of behind the application's back");

    // The others' devices are not concerned.
    let Some(other) = Gpu::new() else { return };
    let mut shadows = Shadows::new(&other.device, &ShadowConfig::default()).expect("shadows");
    shadows.prepare(&other.queue, &inputs).expect("a device that is there");
}
