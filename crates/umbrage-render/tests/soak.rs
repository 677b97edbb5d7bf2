//! Memory stays where it is, however many pictures are drawn.
//!
//! `cargo xtask soak` draws 10^4; `UMBRAGE_SOAK_FRAMES` chooses another number. Counted as the
//! process's resident memory, so one test draws everything, each frame in the next of several ways.
#![cfg(target_os = "linux")]

mod common;

use common::{Stage, configured, cuboid, gpu, ground, scene, sphere, sun};
use glam::{DAffine3, DVec3};
use umbrage::config::{Cache, Edges, Filter, Layout, MomentKind, Moments, Preset, ShadowConfig};
use umbrage::{Frustum, View};
use umbrage_render::{Gpu, Outputs, RenderSettings};

/// Frames of a run in CI.
const FRAMES: u32 = 120;

/// Frames until everything that is made once has been made.
const WARM_UP: u32 = 60;

/// MiB that a run may add.
const MOST_MIB: f64 = 20.0;

fn resident_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux says what a process holds");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("its resident memory");
    line.trim().trim_end_matches("kB").trim().parse::<f64>().expect("a number of kB") / 1024.0
}

/// What each frame is drawn with, in turn.
fn ways() -> Vec<ShadowConfig> {
    let small = |config: ShadowConfig| ShadowConfig { map_sizes: vec![128; 3], ..config };
    let papers = || small(Preset::Papers.config());
    vec![
        small(Preset::Balanced.config()),
        ShadowConfig { cache: Cache::Kept, ..papers() },
        ShadowConfig { filter: Filter::Moments(Moments::new(MomentKind::Evsm4)), ..papers() },
        ShadowConfig { edges: Edges::exact(), ..papers() },
        ShadowConfig { layout: Layout::InstancedAtlas, ..papers() },
    ]
}

/// A plain with boxes and balls, one of which moves, drawn in all ways.
struct World {
    stages: Vec<Stage>,
}

impl World {
    fn new(gpu: &Gpu) -> Self {
        let mut primitives = vec![ground(0.0, 80.0)];
        for i in 0..40 {
            let share = |step: u32| f64::from(step * (i + 3) % 101) / 100.0;
            let at = DVec3::new(80.0 * share(37) - 40.0, 0.0, 80.0 * share(61) - 40.0);
            primitives.push(match i % 8 {
                0 => sphere(at + DVec3::Y * 1.5, 1.0 + share(13)),
                _ => cuboid(at, at + DVec3::new(1.0 + share(7), 1.0 + 4.0 * share(23), 1.0 + share(5))),
            });
        }
        let world = scene(primitives);
        let settings = |config| RenderSettings { size: [64, 48], ..configured(config) };
        Self { stages: ways().into_iter().map(|config| Stage::new(gpu, &world, &settings(config))).collect() }
    }

    /// The camera walks in a circle and looks around, the sun moves, and a caster with it.
    fn frame(&mut self, frame: u32) {
        let t = f64::from(frame) / 60.0;
        let count = self.stages.len();
        let stage = &mut self.stages[frame as usize % count];
        let moved = &mut stage.pose.objects[2];
        let by = DAffine3::from_translation(DVec3::new(0.05 * t.cos(), 0.0, 0.05 * t.sin()));
        moved.bounds = moved.bounds.transformed(&by);
        moved.world_from_local = by * moved.world_from_local;
        let lens = Frustum::perspective(1.0 + 0.2 * (0.05 * t).sin(), 4.0 / 3.0, 0.5, 200.0).expect("a lens");
        let eye = DVec3::new(25.0 * (0.1 * t).cos(), 2.5, 25.0 * (0.1 * t).sin());
        let ahead = DVec3::new((0.37 * t).cos(), -0.15, (0.37 * t).sin());
        let view = View::look_at_upright(eye, eye + ahead, lens).expect("a view");
        let light = sun(DVec3::new(0.6 * (0.02 * t).cos(), -1.0, 0.4));
        let wanted = Outputs { picture: frame.is_multiple_of(2), mask: true, ..Outputs::default() };
        let drawn = stage.render(&view, light, wanted);
        assert!(drawn.mask.is_some() && drawn.picture.is_some() == wanted.picture, "frame {frame}");
    }
}

#[test]
fn drawing_takes_no_more_memory_frame_by_frame() {
    // What is held is seen: the count says no where it has to.
    let before = resident_mib();
    let held = vec![1_u8; 24 << 20];
    assert!(resident_mib() - before > MOST_MIB, "{} bytes are held and not seen", held.len());
    drop(held);

    let Some(gpu) = gpu() else { return };
    let frames = std::env::var("UMBRAGE_SOAK_FRAMES").ok().map_or(FRAMES, |it| it.parse().expect("a whole number"));
    let mut world = World::new(&gpu);
    (0..WARM_UP).for_each(|frame| world.frame(frame));
    let before = resident_mib();
    let mut said = before;
    for frame in WARM_UP..WARM_UP + frames {
        world.frame(frame);
        if (frame - WARM_UP).is_multiple_of(1000) {
            let now = resident_mib();
            eprintln!("frame {frame}: {now:.1} MiB, {:+.1}", now - said);
            said = now;
        }
    }
    let grown = resident_mib() - before;
    eprintln!("{grown:.1} MiB in {frames} frames, of {before:.1}");
    assert!(grown < MOST_MIB, "{grown:.1} MiB in {frames} frames");
}
