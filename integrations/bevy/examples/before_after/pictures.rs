//! Pictures without and with planned cascades.

use std::path::Path;

use bevy::camera::Viewport;
use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder};
use bevy::prelude::{Color, Quat, UVec2, Vec3};
use umbrage_bevy::umbrage::View;

use crate::scores::range_of;
use crate::studio::{Picture, Shadows, Size, Studio};
use crate::worlds::Stage;
use crate::{Failure, say};

const SIZE: Size = [640, 360];
const MAP_SIZE: usize = 1024;
/// Illuminance of the sun that is alone, lux.
const DAYLIGHT: f32 = 9_000.0;

/// Bevy's cascades to the end of what the view shows, and planned ones.
pub fn pair(stage: &Stage, view: &View) -> [Shadows; 2] {
    let maximum_distance = range_of(view, &stage.pose).1 as f32;
    let config: CascadeShadowConfig = CascadeShadowConfigBuilder { maximum_distance, ..Default::default() }.into();
    [Shadows::Bevys(config), Shadows::Planned]
}

/// Draws every picture whose name contains `wanted`.
pub fn draw(folder: &Path, wanted: &str) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)?;
    let save = |name: &str, draw: &mut dyn FnMut() -> Result<Picture, Failure>| -> Result<(), Failure> {
        if name.contains(wanted) {
            let path = folder.join(format!("{name}.png"));
            image::DynamicImage::from(draw()?).to_rgb8().save(&path)?;
            say(path.display());
        }
        Ok(())
    };
    for (world, count) in [("robot-war", None), ("chessboard", None), ("city-blocks", Some(400))] {
        let stage = Stage::new(world, count)?;
        for camera in ["near", "middle", "far", "dueling"] {
            let view = stage.view(camera, SIZE)?;
            let drawn = |shadows| alone(&stage, &view, shadows);
            save(&format!("{world}-{camera}"), &mut || both(pair(&stage, &view), drawn))?;
        }
    }
    let stage = Stage::new("robot-war", None)?;
    let pair = pair(&stage, &stage.view("middle", SIZE)?);
    save("split-screen", &mut || both(pair.clone(), |shadows| split_screen(&stage, shadows)))?;
    save("two-suns", &mut || both(pair.clone(), |shadows| two_suns(&stage, shadows)))?;
    save("moving-sun", &mut || both(pair.clone(), |shadows| moving_sun(&stage, shadows)))
}

/// Two cases beside each other.
fn both(pair: [Shadows; 2], draw: impl Fn(Shadows) -> Result<Picture, Failure>) -> Result<Picture, Failure> {
    let [left, right] = pair.map(draw);
    Ok(beside(&left?, &right?))
}

/// One camera, one sun.
pub fn alone(stage: &Stage, view: &View, shadows: Shadows) -> Result<Picture, Failure> {
    let mut studio = Studio::new(SIZE, MAP_SIZE, shadows);
    stage.place(&mut studio, false);
    studio.spawn_sun(stage.travel(), Color::WHITE, DAYLIGHT);
    studio.spawn_camera(view, None);
    studio.picture()
}

/// Two cameras, each with a half of the picture.
fn split_screen(stage: &Stage, shadows: Shadows) -> Result<Picture, Failure> {
    let mut studio = Studio::new(SIZE, MAP_SIZE, shadows);
    stage.place(&mut studio, false);
    studio.spawn_sun(stage.travel(), Color::WHITE, DAYLIGHT);
    let half = UVec2::new(SIZE[0] / 2, SIZE[1]);
    for (number, camera) in ["near", "far"].into_iter().enumerate() {
        let corner = UVec2::new(number as u32 * half.x, 0);
        let part = Viewport { physical_position: corner, physical_size: half, ..Default::default() };
        let view = stage.view(camera, half.to_array())?;
        studio.spawn_camera(&view, Some(part));
    }
    studio.picture()
}

/// A warm and a cool sun.
fn two_suns(stage: &Stage, shadows: Shadows) -> Result<Picture, Failure> {
    let mut studio = Studio::new(SIZE, MAP_SIZE, shadows);
    stage.place(&mut studio, false);
    let other = Quat::from_rotation_y(1.7) * stage.travel();
    studio.spawn_sun(stage.travel(), Color::srgb(1.0, 0.75, 0.5), 0.6 * DAYLIGHT);
    studio.spawn_sun(other, Color::srgb(0.5, 0.7, 1.0), 0.6 * DAYLIGHT);
    studio.spawn_camera(&stage.view("near", SIZE)?, None);
    studio.picture()
}

/// The sun goes over the sky, and each row shows it later, in the app of the row before.
fn moving_sun(stage: &Stage, shadows: Shadows) -> Result<Picture, Failure> {
    const ROWS: u32 = 4;
    let mut studio = Studio::new(SIZE, MAP_SIZE, shadows);
    stage.place(&mut studio, false);
    let sun = studio.spawn_sun(stage.travel(), Color::WHITE, DAYLIGHT);
    studio.spawn_camera(&stage.view("near", SIZE)?, None);
    let mut rows = Picture::new(SIZE[0], ROWS * SIZE[1]);
    for row in 0..ROWS {
        let angle = (0.25 + 0.2 * row as f32) * std::f32::consts::PI;
        studio.turn(sun, -Vec3::new(angle.cos(), angle.sin(), 0.35));
        image::imageops::replace(&mut rows, &studio.picture()?, 0, i64::from(row * SIZE[1]));
    }
    Ok(rows)
}

/// Two pictures with a gap between them.
fn beside(left: &Picture, right: &Picture) -> Picture {
    const GAP: u32 = 4;
    let mut both = Picture::from_pixel(left.width() + GAP + right.width(), left.height(), image::Rgba([255; 4]));
    image::imageops::replace(&mut both, left, 0, 0);
    image::imageops::replace(&mut both, right, i64::from(left.width() + GAP), 0);
    both
}
