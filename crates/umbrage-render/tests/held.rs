//! What stabilised maps hold on to is that of the frames that show shadows.

mod common;

use common::{Stage, config, configured, cuboid, gpu, ground, look, scene, sun};
use glam::DVec3;
use umbrage::Split;
use umbrage::config::{Crop, ExtentSteps, ShadowConfig, Stability};
use umbrage_render::{Frame, Gpu, Outputs};

const SUN: DVec3 = DVec3::new(1.0, -0.6, 0.2);

/// The splits of a camera that turns. Between its frames one under the opposite sun is drawn, with
/// shadows or without, or none.
fn splits(gpu: &Gpu, between: Option<bool>) -> Vec<Vec<Split>> {
    let stability = Stability::Approximate { steps: ExtentSteps::PerDoubling(8) };
    let settings = configured(ShadowConfig { stability, crop: Crop::SceneIndependent, ..config() });
    let primitives = vec![ground(0.0, 60.0), cuboid(DVec3::new(-1.0, 0.0, -12.0), DVec3::new(2.0, 3.0, -9.0))];
    let mut stage = Stage::new(gpu, &scene(primitives), &settings);
    let wanted = Outputs { picture: true, ..Default::default() };
    let mut all = Vec::new();
    for turn in 0..8 {
        let target = DVec3::new(0.4 * f64::from(turn), 1.0, -8.0);
        let view = look(DVec3::new(0.0, 2.5, 4.0), target);
        let frame = Stage::frame(&stage.pose, &view, sun(SUN));
        all.push(stage.renderer.render(&frame, wanted).expect("a picture").stats.plan.splits.clone());
        if let Some(shadows_on) = between {
            let other = Frame { shadows_on, ..Stage::frame(&stage.pose, &view, sun(-SUN)) };
            stage.renderer.render(&other, wanted).expect("a picture");
        }
    }
    all
}

#[test]
fn a_frame_without_shadows_changes_nothing_that_is_held() {
    let Some(gpu) = gpu() else { return };
    let alone = splits(&gpu, None);
    assert_eq!(alone, splits(&gpu, Some(false)));
    // The comparison can say no.
    assert_ne!(alone, splits(&gpu, Some(true)));
}
