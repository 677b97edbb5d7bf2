//! How long the truth of a scene takes and how much memory: `cargo run --release -p umbrage-truth
//! --example time_truth -- SCENE [--eye x,y,z --target x,y,z --sun x,y,z] [--soft SAMPLES] [-o
//! MASK]`.
//!
//! The scene is loaded before the clock starts; posing, building and tracing are timed. Peak memory
//! is the whole process's, scene included, as Linux counts it.
#![expect(clippy::print_stdout, reason = "an example that prints what it measured")]

use std::error::Error;
use std::time::Instant;

use glam::DVec3;
use umbrage::{Frustum, View};
use umbrage_scene::{OpenOptions, invented_sun, invented_view, open};
use umbrage_truth::{SunDisc, Truth};

const SIZE: [u32; 2] = [800, 600];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let vector = |name: &str| -> Result<Option<DVec3>, Box<dyn Error>> {
        let Some(text) = option(name) else { return Ok(None) };
        let numbers: Vec<f64> = text.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let xyz: [f64; 3] = numbers.try_into().map_err(|_| format!("{name} wants x,y,z"))?;
        Ok(Some(DVec3::from(xyz)))
    };
    let spec = arguments.first().ok_or("name a scene")?;
    let scene = open(spec, &OpenOptions::default())?;
    println!("{spec} loaded; peak memory so far {}", peak_memory());

    let start = Instant::now();
    let pose = scene.pose(0.0)?;
    let fov_y = 60_f64.to_radians();
    let view = match (vector("--eye")?, vector("--target")?) {
        (Some(eye), Some(target)) => {
            let frustum = Frustum::perspective(fov_y, f64::from(SIZE[0]) / f64::from(SIZE[1]), 0.5, f64::INFINITY)?;
            View::look_at_upright(eye, target, frustum)?
        }
        _ => invented_view(&pose, fov_y, f64::from(SIZE[0]) / f64::from(SIZE[1]), None, None)?,
    };
    let sun = vector("--sun")?.unwrap_or(invented_sun());
    let posed = start.elapsed();
    let truth = Truth::build(&scene, &pose, view.eye())?;
    let built = start.elapsed();
    let mask = truth.mask(&view, sun, SIZE, &|_| {})?;
    let traced = start.elapsed();

    let hits = mask.hits().iter().flatten().count();
    let lit = mask.hits().iter().flatten().filter(|hit| hit.lit).count();
    println!("{} triangles, {} bytes kept, {} threads", truth.triangle_count(), truth.bytes(), rayon_threads());
    println!("{hits} pixels hit, {lit} lit");
    println!("pose {posed:.2?}, build {:.2?}, trace {:.2?}, all {traced:.2?}", built - posed, traced - built);
    if let Some(samples) = option("--soft") {
        let start = Instant::now();
        truth.soft(&mask, &SunDisc::new(0.53_f64.to_radians(), samples.parse()?), &|_| {})?;
        println!("soft, {samples} directions a pixel: {:.2?}", start.elapsed());
    }
    println!("peak memory {}", peak_memory());
    if let Some(path) = option("-o") {
        mask.to_image().save(path)?;
    }
    Ok(())
}

fn rayon_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")).map_or("unknown".into(), |line| line.trim().into())
}
