//! Wrong pixels against rays.

use std::path::Path;

use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder};
use bevy::prelude::{ClearColor, Color};
use umbrage_bevy::umbrage::View;
use umbrage_scene::Pose;
use umbrage_truth::Truth;

use crate::judge::{Judge, Verdict};
use crate::studio::{Shadows, Size, Studio};
use crate::worlds::Stage;
use crate::{Failure, say};

/// Pixels of a judged picture.
const SIZE: Size = [960, 540];

/// The cases that are compared, by name, for shadows that end `far` metres from the camera.
pub fn cases(far: f64) -> [(&'static str, Shadows); 3] {
    let reaching = CascadeShadowConfigBuilder { maximum_distance: far as f32, ..Default::default() }.build();
    [
        ("Bevy, default", Shadows::Bevys(CascadeShadowConfig::default())),
        ("Bevy, to the far plane", Shadows::Bevys(reaching)),
        ("planned", Shadows::Planned),
    ]
}

/// The range in which points are judged: the camera's, as far as the scene goes.
pub fn range_of(view: &View, pose: &Pose) -> (f64, f64) {
    let corners = pose.bounds.map(|bounds| bounds.corners()).into_iter().flatten();
    let deepest = corners.map(|corner| view.view_depth(corner)).fold(f64::NEG_INFINITY, f64::max);
    (view.frustum().near, view.frustum().far.min(deepest))
}

/// What a case answers, with the casters of its lists.
pub struct Answer {
    pub verdict: Verdict,
    pub casters: Vec<usize>,
    pub bounds: Vec<f32>,
}

/// Draws the mask of a view and judges it.
pub fn answer(
    (stage, view, judge): (&Stage, &View, &Judge),
    size: Size,
    map_size: usize,
    shadows: Shadows,
) -> Result<Answer, Failure> {
    let mut studio = Studio::new(size, map_size, shadows);
    studio.app.insert_resource(ClearColor(Color::NONE));
    stage.place(&mut studio, true);
    let sun = studio.spawn_sun(stage.travel(), Color::WHITE, 10_000.0);
    let camera = studio.spawn_camera(view, None);
    let picture = studio.picture()?;
    let (casters, bounds) = (studio.casters(sun, camera), studio.bounds(sun));
    Ok(Answer { verdict: judge.judge(&picture, &bounds)?, casters, bounds })
}

/// Prints a table of the views whose name contains `wanted`, and writes where pixels are wrong.
pub fn print(folder: &Path, wanted: &str) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)?;
    say("| world, camera | maps | cascades | casters | E | false shadow | false light | D px | seams |");
    say("|---|---|---|---|---|---|---|---|---|");
    for (world, count) in [("robot-war", None), ("chessboard", None), ("city-blocks", Some(400))] {
        let stage = Stage::new(world, count)?;
        for camera in ["near", "middle", "far"] {
            if !format!("{world}-{camera}").contains(wanted) {
                continue;
            }
            let view = stage.view(camera, SIZE)?;
            let range = range_of(&view, &stage.pose);
            let truth = Truth::build(&stage.scene, &stage.pose, view.eye())?;
            let judge = Judge::new(&stage, &truth, &view, SIZE, range)?;
            for map_size in [1024, 2048] {
                for (name, shadows) in cases(range.1) {
                    let answer = answer((&stage, &view, &judge), SIZE, map_size, shadows)?;
                    say(row(&format!("{world}, {camera}"), map_size, name, &answer));
                    let name = name.replace([',', ' '], "-");
                    answer.verdict.picture.save(folder.join(format!("{world}-{camera}-{map_size}-{name}.png")))?;
                }
            }
        }
    }
    Ok(())
}

fn row(view: &str, map_size: usize, name: &str, answer: &Answer) -> String {
    let Answer { verdict, casters, bounds } = answer;
    let casters: Vec<String> = casters.iter().map(ToString::to_string).collect();
    let bounds: Vec<String> = bounds.iter().map(|bound| format!("{bound:.0}")).collect();
    let per_cent = |share: f64| format!("{:.2} %", 100.0 * share);
    format!(
        "| {view} | 4 × {map_size}² | {name} ({} m) | {} | {} | {} | {} | {} | {} |",
        bounds.join(" / "),
        casters.join(" / "),
        per_cent(verdict.wrong.rate()),
        per_cent(verdict.wrong.false_shadow_rate()),
        per_cent(verdict.wrong.false_light_rate()),
        verdict.edges.as_ref().map_or("–".into(), |edges| format!("{:.2}", edges.mean)),
        verdict.seams.ratio().filter(|_| verdict.seams.counts()).map_or("–".into(), |ratio| format!("{ratio:.2}")),
    )
}
