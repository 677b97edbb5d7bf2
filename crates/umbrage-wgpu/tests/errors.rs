//! What bad input gets: an error that names the culprit, and nothing half done.

mod common;

use common::{DISC, Gpu, PCF3, PCF5, PCSS, SUN, VSM, config, plan, with};
use glam::DVec3;
use umbrage::ShadowPlan;
use umbrage::config::{Filter, Preset, ShadowConfig};
use umbrage_wgpu::{Error, FrameOptions, ShadowMaps};

#[test]
fn configs_that_no_device_can_meet() {
    let Some(gpu) = Gpu::new() else { return };
    let error = |map_sizes: &[u32], filter| {
        let asked = ShadowConfig { map_sizes: map_sizes.to_vec(), filter, ..Preset::Papers.config() };
        ShadowMaps::new(&gpu.device, &asked, &SUN).expect_err("no maps")
    };
    gpu.checked(|| {
        for (sizes, filter, culprit) in [
            (&[][..], PCF3, "0 splits"),
            (&[64; 9], PCF3, "9 splits"),
            (&[64, 0], Filter::Hard, "map 1 is 0 texels"),
            (&[5], PCF5, "map 0 is 5 texels"),
            (&[u32::MAX], PCF3, "4294967295"),
        ] {
            let found = error(sizes, filter);
            assert!(matches!(found, Error::Config(_)) && found.to_string().contains(culprit), "{sizes:?}: {found}");
        }
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let too_large = error(&[64, limit + 1], PCF3);
        assert_eq!(too_large, Error::MapTooLarge { split: 1, size: limit + 1, limit });
        let message = too_large.to_string();
        assert!(message.contains(&(limit + 1).to_string()) && message.contains(&limit.to_string()), "{message}");
    });
}

#[test]
fn the_smallest_maps_work() {
    let Some(gpu) = Gpu::new() else { return };
    for (filter, least) in [(Filter::Hard, 6), (Filter::Pcf2, 7), (PCF3, 8), (PCF5, 10), (PCSS, 37)] {
        let new = |size| {
            ShadowMaps::new(
                &gpu.device,
                &ShadowConfig { map_sizes: vec![size], filter, ..Preset::Papers.config() },
                &SUN,
            )
        };
        gpu.checked(|| new(least).expect("just large enough"));
        assert!(matches!(new(least - 1), Err(Error::Config(_))), "{filter:?}");
    }
}

#[test]
fn a_config_that_needs_other_maps_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let asked = config(&[64, 32], PCF3, "");
    let mut maps = ShadowMaps::new(&gpu.device, &asked, &SUN).expect("valid");
    assert_eq!(maps.set_config(&with(asked.clone(), "filter-width=0.5 shadow-strength=0.5")), Ok(()));
    assert_eq!(maps.set_config(&with(asked.clone(), "storage=atlas")), Err(Error::NeedsNewMaps { setting: "storage" }));
    let mut dark = asked.clone();
    dark.look.strength = 2.0;
    assert!(matches!(maps.set_config(&dark), Err(Error::Config(_))));
    assert_eq!(maps.config().look.strength, 0.5, "what was refused changes nothing");
}

#[test]
fn bytes_are_those_of_the_texture() {
    let Some(gpu) = Gpu::new() else { return };
    let bytes = |settings: &str| {
        let asked = config(&[512, 256, 64], PCF3, settings);
        ShadowMaps::new(&gpu.device, &asked, &SUN).expect("valid").bytes()
    };
    assert_eq!(bytes("depth-format=d32f"), 3 * 512 * 512 * 4);
    assert_eq!(bytes("depth-format=d16"), 3 * 512 * 512 * 2);
}

#[test]
fn plans_and_frames_that_make_no_sense() {
    let Some(gpu) = Gpu::new() else { return };
    let mut maps = ShadowMaps::new(&gpu.device, &config(&[64, 32], Filter::Hard, ""), &SUN).expect("valid");
    let good = plan(DVec3::NEG_Y, DVec3::ZERO, &[64, 32], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    assert_eq!(maps.prepare(&gpu.queue, &good, &FrameOptions::default()), Ok(()));

    let other = plan(DVec3::NEG_Y, DVec3::ZERO, &[64, 64], &[1.0, 10.0, 50.0], &[20.0, 100.0]);
    let mismatch = Error::PlanMismatch { plan: vec![64, 64], maps: vec![64, 32] };
    assert_eq!(maps.prepare(&gpu.queue, &other, &FrameOptions::default()), Err(mismatch));
    let empty = Error::PlanMismatch { plan: vec![], maps: vec![64, 32] };
    assert_eq!(maps.prepare(&gpu.queue, &ShadowPlan::default(), &FrameOptions::default()), Err(empty));

    type Spoil = fn(&mut ShadowPlan);
    let spoiled: [(&str, Spoil); 18] = [
        ("view_depth_plane", |p| p.view_depth_plane.w = f64::NAN),
        ("eye", |p| p.eye = DVec3::NAN),
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
        ("near", |p| p.splits[1].near = f64::NAN),
        ("filter_radius_texels", |p| p.splits[1].filter_radius_texels = f64::NAN),
        ("planes", |p| p.planes[1] = f64::NAN),
        ("blend", |p| p.blend = f64::NAN),
        ("blend", |p| p.blend = -0.5),
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
    for filter in [PCF3, DISC, VSM] {
        let asked = config(&[256, 128], filter, "");
        let mut maps = ShadowMaps::new(&gpu.device, &asked, &SUN).expect("valid");
        let mut prepare = |width: f64| {
            maps.set_config(&with(asked.clone(), &format!("filter-width={width}"))).expect("a width");
            maps.prepare(&gpu.queue, &good, &FrameOptions::default())
        };
        assert!(prepare(1.99 * widest).is_ok(), "{filter:?}");
        match prepare(2.01 * widest) {
            Err(Error::FilterTooWide { map_m, .. }) => assert!(map_m == widest),
            other => panic!("{filter:?}: {other:?}"),
        }
    }
}
