//! The planner alone: no GPU, a text report of where shadow maps lie. For engines that draw maps
//! themselves.
//!
//! `cargo run -p umbrage --example plan_report`

use std::error::Error;
use std::fmt::Write as _;

use glam::DVec3;
use umbrage::config::{Preset, ShadowConfig};
use umbrage::{Aabb, DirectionalLight, Frustum, PlanInputs, Planner, View};

/// Size of the image in pixels.
const IMAGE_SIZE: [u32; 2] = [1920, 1080];

/// A street of houses on a plain, as boxes in world metres.
fn street() -> (Vec<Aabb>, Vec<Aabb>) {
    let mut houses = Vec::new();
    for number in 0..40 {
        let along = -8.0 * f64::from(number / 2);
        let side = if number % 2 == 0 { -12.0 } else { 6.0 };
        let height = 4.0 + f64::from(number % 5);
        let corner = DVec3::new(side, 0.0, along);
        houses.push(Aabb::new(corner, corner + DVec3::new(6.0, height, 6.0)));
    }
    let plain = Aabb::new(DVec3::new(-200.0, -0.1, -300.0), DVec3::new(200.0, 0.0, 100.0));
    // Houses cast shadows; the plain shows them, and so do the houses.
    let receivers = houses.iter().copied().chain([plain]).collect();
    (houses, receivers)
}

/// Plans one frame and returns a text report of the plan.
///
/// # Errors
/// The planner's errors; none occur for this scene.
pub fn report() -> Result<String, Box<dyn Error>> {
    let config = ShadowConfig { map_sizes: vec![2048, 1024, 1024], ..Preset::Papers.config() };
    config.validate()?;

    let lens = Frustum::perspective(60f64.to_radians(), 16.0 / 9.0, 0.1, 1000.0)?;
    let view = View::look_at(DVec3::new(0.0, 1.7, 20.0), DVec3::new(0.0, 3.0, -40.0), DVec3::Y, lens)?;
    let sun = DirectionalLight::new(DVec3::new(0.5, -0.8, -0.3))?;
    let (casters, receivers) = street();

    // One planner serves all frames of a view: it holds what keeps shadows still.
    let mut planner = Planner::new(&config)?;
    let inputs = PlanInputs { image_size: IMAGE_SIZE, ..PlanInputs::new(&view, sun, &casters, &receivers) };
    let plan = planner.plan_frame(&inputs)?;

    let mut text = String::from("split    view depth        map    texel  casters\n");
    for (index, split) in plan.splits.iter().enumerate() {
        let (near, far) = (split.near, split.far);
        let (size, texel_cm) = (split.size, 100.0 * split.texel_m.max_element());
        let casters = plan.casters(index).len();
        writeln!(text, "{index:>5}  {near:>6.1}..{far:>6.1} m  {size:>5}²  {texel_cm:>4.1} cm  {casters:>4} of 40")?;
    }

    // What a shader of your own needs of a split: its matrix from the world, for your depth
    // convention.
    let first = &plan.splits[0];
    let feet = DVec3::new(-6.0, 0.0, 0.0);
    let place = first.map_from_world(feet);
    writeln!(text, "\n{feet} lies at texel {:.1}, {:.1} of split 0, at depth {:.4}:", place.x, place.y, place.z)?;
    writeln!(text, "{:.4}", first.shadow_from_world().project_point3(feet))?;
    Ok(text)
}

#[allow(clippy::print_stdout, reason = "the report is what the example is for")]
#[allow(dead_code, reason = "a test calls `report`")]
fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
