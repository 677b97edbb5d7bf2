//! Memory stays where it is, however many frames are drawn: Mesa's software driver compiles a
//! shader again for each set of values that its branches hang on alone, and keeps every one of them
//! (docs/notes/memory-of-casters.md).
//!
//! Counted as the process's resident memory, so one test draws everything, one way after the other.
#![cfg(target_os = "linux")]

mod common;

use common::{Gpu, PCF3, World, config, cuboid, ground, plan};
use glam::{DVec3, Vec3};
use umbrage::ShadowConfig;
use umbrage::ShadowPlan;
use umbrage::config::{DepthFormat, Layout};
use umbrage_wgpu::FrameOptions;

/// Frames until everything that is made once has been made.
const WARM_UP: u32 = 100;

/// MiB that a run may add: blocks of the allocator that were not needed before.
const MOST_MIB: f64 = 2.0;

/// A plan of four maps of 64² whose middle walks in a circle.
fn walked(frame: u32) -> ShadowPlan {
    let (sin, cos) = (0.01 * f64::from(frame)).sin_cos();
    let center = DVec3::new(20.0 + 5.0 * sin, 0.0, 5.0 * cos);
    plan(DVec3::new(0.4, -1.0, 0.3), center, &[64; 4], &[1.0, 5.0, 15.0, 40.0, 100.0], &[10.0, 20.0, 50.0, 110.0])
}

/// A ground and boxes on it.
fn casters() -> Vec<Vec3> {
    let boxes = (0..20_u8).flat_map(|i| {
        let at = Vec3::new(f32::from(i % 5) * 9.0, 0.0, f32::from(i / 5) * 9.0 - 18.0);
        cuboid(at, at + Vec3::new(2.0, 1.0 + f32::from(i % 4), 2.0))
    });
    ground(60.0).into_iter().chain(boxes).collect()
}

/// MiB by which the process grows while frames are drawn.
fn growth(gpu: Gpu, asked: &ShadowConfig, frames: u32) -> f64 {
    let mut world = World::new(gpu, asked);
    let casters = casters();
    let mut draw = |frame| {
        let options = FrameOptions { origin: DVec3::new(f64::from(frame % 7), 0.0, 0.0), ..FrameOptions::default() };
        world.draw(&walked(frame), &options, &casters);
        world.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    };
    (0..WARM_UP).for_each(&mut draw);
    let before = resident_mib();
    (WARM_UP..WARM_UP + frames).for_each(&mut draw);
    resident_mib() - before
}

fn resident_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux says what a process holds");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("its resident memory");
    line.trim().trim_end_matches("kB").trim().parse::<f64>().expect("a number of kB") / 1024.0
}

fn asked(layout: Layout, depth_format: DepthFormat) -> ShadowConfig {
    ShadowConfig { layout, depth_format, ..config(&[64; 4], PCF3, "") }
}

#[test]
fn drawing_casters_takes_no_more_memory_frame_by_frame() {
    // What is held is seen: the count says no where it has to.
    let before = resident_mib();
    let held = vec![1_u8; 8 << 20];
    assert!(resident_mib() - before > MOST_MIB, "{} bytes are held and not seen", held.len());
    drop(held);
    let mut grown = Vec::new();
    for (layout, depth_format) in [
        (Layout::Array, DepthFormat::D32Float),
        (Layout::Array, DepthFormat::R32Float),
        (Layout::LayeredArray, DepthFormat::D32Float),
        (Layout::InstancedAtlas, DepthFormat::D32Float),
    ] {
        let Some(gpu) = Gpu::new() else { return };
        let mib = growth(gpu, &asked(layout, depth_format), 500);
        grown.push((layout, depth_format, mib));
    }
    eprintln!("MiB in 500 frames: {grown:?}");
    assert!(grown.iter().all(|&(_, _, mib)| mib < MOST_MIB), "MiB in 500 frames: {grown:?}");
}

#[test]
#[ignore = "run alone: `cargo test -p umbrage-wgpu --test memory -- --ignored`"]
fn ten_thousand_frames_are_flat() {
    let Some(gpu) = Gpu::new() else { return };
    let mib = growth(gpu, &asked(Layout::Array, DepthFormat::D32Float), 10_000);
    eprintln!("{mib:.1} MiB in 10,000 frames");
    assert!(mib < 20.0, "{mib:.1} MiB in 10,000 frames");
}
