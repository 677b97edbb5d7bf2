//! What a frame costs, without shadows, with Bevy's cascades and with planned ones.

use std::time::Instant;

use bevy::prelude::{Color, Entity};
use umbrage_bevy::umbrage::View;
use umbrage_bevy::umbrage::glam::DMat4;

use crate::scores::{cases, range_of};
use crate::studio::{Shadows, Size, Studio};
use crate::worlds::Stage;
use crate::{Failure, say};

const SIZE: Size = [640, 360];
const MAP_SIZE: usize = 1024;
/// Metres that the camera walks from frame to frame: 1.4 m/s at 60 Hz. A frame that equals the one
/// before would spare the planner its work.
const STEP_M: f64 = 1.4 / 60.0;

struct Runner {
    name: &'static str,
    studio: Studio,
    camera: Entity,
    sun: Entity,
    wall_ms: Vec<f64>,
    cpu_ms: Vec<f64>,
}

impl Runner {
    fn new(stage: &Stage, view: &View, name: &'static str, shadows: Shadows) -> Self {
        let mut studio = Studio::new(SIZE, MAP_SIZE, shadows);
        stage.place(&mut studio, false);
        let sun = studio.spawn_sun(stage.travel(), Color::WHITE, 9_000.0);
        let camera = studio.spawn_camera(view, None);
        Self { name, studio, camera, sun, wall_ms: Vec::new(), cpu_ms: Vec::new() }
    }

    /// Draws a frame from here and keeps what it took.
    fn frame(&mut self, view: &View) -> Result<(), Failure> {
        self.studio.place(self.camera, view);
        let (began, cpu) = (Instant::now(), cpu_ms()?);
        self.studio.frame()?;
        self.wall_ms.push(1e3 * began.elapsed().as_secs_f64());
        self.cpu_ms.push(cpu_ms()? - cpu);
        Ok(())
    }
}

/// Prints times and casters of robots for three cameras.
pub fn print(robots: u32, frames: usize) -> Result<(), Failure> {
    let stage = Stage::new("robot-war", (robots != 160).then_some(robots))?;
    say(format!("{robots} robots, {SIZE:?} pixels, 4 maps of {MAP_SIZE}², medians of {frames} frames in turns"));
    say("| camera | cascades | casters | pairs | CPU ms | wall ms | shadows, CPU ms | shadows, wall ms |");
    say("|---|---|---|---|---|---|---|---|");
    for camera in ["near", "middle", "far"] {
        let view = stage.view(camera, SIZE)?;
        let [_, reaching, planned] = cases(range_of(&view, &stage.pose).1);
        let mut runners: Vec<Runner> = [("none", Shadows::Off), reaching, planned]
            .into_iter()
            .map(|(name, shadows)| Runner::new(&stage, &view, name, shadows))
            .collect();
        for runner in &mut runners {
            runner.studio.picture()?;
        }
        for frame in 0..frames {
            let walked = walked(&view, STEP_M * frame as f64)?;
            for runner in &mut runners {
                runner.frame(&walked)?;
            }
        }
        let without = [median(&runners[0].cpu_ms), median(&runners[0].wall_ms)];
        for runner in &runners {
            let casters = runner.studio.casters(runner.sun, runner.camera);
            let pairs: usize = casters.iter().sum();
            let list: Vec<String> = casters.iter().map(ToString::to_string).collect();
            let (cpu, wall) = (median(&runner.cpu_ms), median(&runner.wall_ms));
            say(format!(
                "| {camera} | {} | {} | {pairs} | {cpu:.1} | {wall:.1} | {:.1} | {:.1} |",
                runner.name,
                list.join(" / "),
                cpu - without[0],
                wall - without[1],
            ));
        }
    }
    Ok(())
}

/// A view whose eye went forward.
fn walked(view: &View, metres: f64) -> Result<View, Failure> {
    let rotation = view.world_from_view_rotation();
    let eye = view.eye() + view.forward() * metres;
    let world_from_view = DMat4::from_translation(eye) * DMat4::from_mat3(rotation);
    Ok(View::from_world_from_view(world_from_view, *view.frustum())?)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// CPU time that all threads of this process have taken, in milliseconds; 0 where there is no
/// `/proc`.
fn cpu_ms() -> Result<f64, Failure> {
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else { return Ok(0.0) };
    let mut nanoseconds = 0.0;
    for thread in threads {
        // A thread may end while it is looked at.
        let Ok(text) = std::fs::read_to_string(thread?.path().join("schedstat")) else { continue };
        nanoseconds += text.split_whitespace().next().unwrap_or("0").parse::<f64>()?;
    }
    Ok(nanoseconds * 1e-6)
}
