//! What bad input gets: an error that names the culprit, and nothing half done.

mod common;

use common::{Gpu, plan};
use glam::DVec3;
use umbrage::ShadowPlan;
use umbrage_wgpu::{DepthFormat, Error, Filter, FrameOptions, ShadowMaps, ShadowMapsOptions, Softness};

fn soft(softness: Softness) -> FrameOptions {
    FrameOptions { softness, ..Default::default() }
}

fn options(map_sizes: &[u32], filter: Filter) -> ShadowMapsOptions {
    ShadowMapsOptions {
        map_sizes: map_sizes.to_vec(),
        depth_format: DepthFormat::D32Float,
        filter,
        ..Default::default()
    }
}

#[test]
fn options_that_no_device_can_meet() {
    let Some(gpu) = Gpu::new() else { return };
    let error = |sizes: &[u32], filter| ShadowMaps::new(&gpu.device, &options(sizes, filter)).expect_err("no maps");
    gpu.checked(|| {
        assert_eq!(error(&[], Filter::Pcf3), Error::SplitCount { count: 0, most: 8 });
        assert_eq!(error(&[64; 9], Filter::Pcf3), Error::SplitCount { count: 9, most: 8 });
        assert_eq!(
            error(&[64, 0], Filter::Hard),
            Error::MapTooSmall { split: 1, size: 0, filter: Filter::Hard, least: 1 }
        );
        assert_eq!(error(&[5], Filter::Pcf5), Error::MapTooSmall { split: 0, size: 5, filter: Filter::Pcf5, least: 6 });
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let too_large = error(&[64, limit + 1], Filter::Pcf3);
        assert_eq!(too_large, Error::MapTooLarge { split: 1, size: limit + 1, limit });
        let message = too_large.to_string();
        assert!(message.contains(&(limit + 1).to_string()) && message.contains(&limit.to_string()), "{message}");
        // Larger than any device and any arithmetic.
        assert_eq!(error(&[u32::MAX], Filter::Pcf3), Error::MapTooLarge { split: 0, size: u32::MAX, limit });
    });
}

#[test]
fn the_smallest_maps_work() {
    let Some(gpu) = Gpu::new() else { return };
    for (filter, least) in [(Filter::Hard, 1), (Filter::Pcf2, 3), (Filter::Pcf3, 4), (Filter::Pcf5, 6)] {
        gpu.checked(|| ShadowMaps::new(&gpu.device, &options(&[least], filter)).expect("just large enough"));
    }
}

#[test]
fn bytes_are_those_of_the_texture() {
    let Some(gpu) = Gpu::new() else { return };
    let bytes = |depth_format| {
        let options = ShadowMapsOptions { depth_format, ..options(&[512, 256, 64], Filter::Pcf3) };
        ShadowMaps::new(&gpu.device, &options).expect("valid options").bytes()
    };
    assert_eq!(bytes(DepthFormat::D32Float), 3 * 512 * 512 * 4);
    assert_eq!(bytes(DepthFormat::D16Unorm), 3 * 512 * 512 * 2);
}

#[test]
fn plans_and_frames_that_make_no_sense() {
    let Some(gpu) = Gpu::new() else { return };
    let mut maps = ShadowMaps::new(&gpu.device, &options(&[64, 32], Filter::Hard)).expect("valid options");
    let good = plan(DVec3::NEG_Y, DVec3::ZERO, &[64, 32], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    assert_eq!(maps.prepare(&gpu.queue, &good, &FrameOptions::default()), Ok(()));

    let other = plan(DVec3::NEG_Y, DVec3::ZERO, &[64, 64], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    let mismatch = Error::PlanMismatch { plan: vec![64, 64], maps: vec![64, 32] };
    assert_eq!(maps.prepare(&gpu.queue, &other, &FrameOptions::default()), Err(mismatch));
    let empty = Error::PlanMismatch { plan: vec![], maps: vec![64, 32] };
    assert_eq!(maps.prepare(&gpu.queue, &ShadowPlan::default(), &FrameOptions::default()), Err(empty));

    type Spoil = fn(&mut ShadowPlan);
    let spoiled: [(&str, Spoil); 13] = [
        ("view_depth_plane", |p| p.view_depth_plane.w = f64::NAN),
        ("radial_eye", |p| p.radial_eye = Some(DVec3::NAN)),
        ("light_direction", |p| p.light_direction = DVec3::ZERO),
        ("fade_begin", |p| p.fade_begin = f64::INFINITY),
        ("u_axis", |p| p.splits[1].u_axis *= 2.0),
        ("v_axis", |p| p.splits[1].v_axis.x = f64::NAN),
        ("depth_axis", |p| p.splits[1].depth_axis = DVec3::ZERO),
        ("texel_m", |p| p.splits[1].texel_m.y = 0.0),
        ("texel_m", |p| p.splits[1].texel_m.x = f64::NAN),
        ("min_texel", |p| p.splits[1].min_texel.x = f64::INFINITY),
        ("depth_far", |p| p.splits[1].depth_far = p.splits[1].depth_near),
        ("far", |p| p.splits[1].far = f64::NAN),
        ("blend_begin", |p| p.splits[1].blend_begin = p.splits[1].far + 1.0),
    ];
    for (name, spoil) in spoiled {
        let mut bad = good.clone();
        spoil(&mut bad);
        match maps.prepare(&gpu.queue, &bad, &FrameOptions::default()) {
            Err(Error::InvalidSplit { split: 1, field, .. } | Error::InvalidPlan { field, .. }) => {
                assert_eq!(field, name)
            }
            other => panic!("{name}: {other:?}"),
        }
    }

    for (name, frame) in [
        ("origin", FrameOptions { origin: DVec3::new(0.0, f64::NAN, 0.0), ..Default::default() }),
        ("origin", FrameOptions { origin: DVec3::new(f64::INFINITY, 0.0, 0.0), ..Default::default() }),
        ("strength", FrameOptions { strength: f32::NAN, ..Default::default() }),
        ("strength", FrameOptions { strength: 1.5, ..Default::default() }),
        ("width_m", soft(Softness { width_m: Some(0.0), ..Default::default() })),
        ("width_m", soft(Softness { width_m: Some(-1.0), ..Default::default() })),
        ("width_m", soft(Softness { width_m: Some(f32::NAN), ..Default::default() })),
        ("width_m", soft(Softness { width_m: Some(f32::INFINITY), ..Default::default() })),
        ("sun_angle", soft(Softness { sun_angle: -0.01, ..Default::default() })),
        ("sun_angle", soft(Softness { sun_angle: f32::NAN, ..Default::default() })),
        ("sun_angle", soft(Softness { sun_angle: 2.0, ..Default::default() })),
    ] {
        match maps.prepare(&gpu.queue, &good, &frame) {
            Err(Error::InvalidFrameOption { field, .. }) => assert_eq!(field, name),
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn a_filter_wider_than_every_map_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let good = plan(DVec3::NEG_Y, DVec3::ZERO, &[256, 128], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    let widest = good.splits.iter().map(|s| s.texel_m.max_element() * f64::from(s.size)).fold(0.0, f64::max);
    for filter in [Filter::Pcf3, Filter::Disc, Filter::Vsm, Filter::Hard] {
        let mut maps = ShadowMaps::new(&gpu.device, &options(&[256, 128], filter)).expect("valid");
        let mut prepare = |width: f64| {
            let frame = soft(Softness { width_m: Some(width as f32), ..Default::default() });
            maps.prepare(&gpu.queue, &good, &frame)
        };
        assert!(prepare(1.99 * widest).is_ok(), "{filter:?}");
        match prepare(2.01 * widest) {
            // One texel has no width.
            Ok(()) => assert_eq!(filter, Filter::Hard),
            Err(Error::FilterTooWide { map_m, .. }) => assert!(map_m == widest && filter != Filter::Hard),
            Err(other) => panic!("{filter:?}: {other}"),
        }
    }
}
