//! Counts the light that leaks into closed rooms, under suns from every side.
//! `cargo run -p umbrage-tests --example closed_rooms -- EDGE STEP EDGES FOLDER`: the maps' edge,
//! degrees from sun to sun, `sampled` or `exact` edges, and where masks with light are written.
#![expect(clippy::print_stdout, reason = "an example that prints what it counted")]

use umbrage::ShadowConfig;
use umbrage::config::Edges;
use umbrage_tests::closed::{Light, Rooms, VIEWS, Walls, closed_room, sun};
use umbrage_tests::stage::gpu;

const SIZE: [u32; 2] = [320, 240];

fn main() {
    let Some(gpu) = gpu() else { return };
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let edge = arguments.first().and_then(|edge| edge.parse().ok()).unwrap_or(1024);
    let step: usize = arguments.get(1).and_then(|step| step.parse().ok()).unwrap_or(36);
    let edges = arguments.get(2).and_then(|edges| edges.parse().ok()).unwrap_or(Edges::Sampled);
    let config = ShadowConfig { map_sizes: vec![edge; 4], edges, ..ShadowConfig::default() };
    let thick = [0.01, 0.02, 0.05, 0.2].into_iter().flat_map(|by| [Walls::Shell(by), Walls::Slabs(by)]);
    for walls in [Walls::Thin].into_iter().chain(thick) {
        let scene = closed_room(walls);
        let mut rooms = Rooms::new(gpu, &scene, &config, SIZE);
        let mut sum = Light::default();
        for (i, bearing) in (0..360).step_by(step).enumerate() {
            // None along a wall, and one of five heights each.
            let (height, bearing) = ([62.0, 35.0, 12.0, 80.0, 48.0][i % 5], bearing as f64 + 17.0);
            for (number, view) in VIEWS.into_iter().enumerate() {
                let (light, mask) = rooms.light(view, sun(height, bearing));
                sum.pixels += light.pixels;
                sum.more_than_2_percent += light.more_than_2_percent;
                sum.more_than_half += light.more_than_half;
                sum.brightest = sum.brightest.max(light.brightest);
                if light.more_than_2_percent > 0 {
                    println!("  {walls:?}, sun {height} up at {bearing}, view {number}: {light:?}");
                    if let Some(folder) = arguments.get(3) {
                        let name =
                            format!("{folder}/{walls:?}-{height}-{bearing}-{number}.png").replace(['(', ')'], "-");
                        mask.save(name).expect("the folder can be written to");
                    }
                }
            }
        }
        println!("{walls:?}: {sum:?}");
    }
}
