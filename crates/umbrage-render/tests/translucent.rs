//! Shadows of translucent casters stand still: of a dithered pane no texel of a stabilised map
//! changes while the camera walks and turns.

mod common;

use std::sync::Arc;

use common::{Stage, gpu, ground, quad, scene, settings, sun};
use glam::{DQuat, DVec2, DVec3, IVec2, Vec2};
use image::GrayImage;
use umbrage::config::{ExtentSteps, Look, Range, ShadowConfig, Stability, Translucent};
use umbrage::{Frustum, ShadowPlan, Split, View};
use umbrage_render::{Outputs, RenderSettings};
use umbrage_scene::{AlphaMode, Material, Primitive, Scene};

const FRAMES: u32 = 24;

/// Three leaning panes of alpha ¼, ½ and ¾ over a ground, far from the world's origin.
fn panes(place: DVec3) -> Scene {
    let mut scene = scene(vec![ground(0.0, 60.0)]);
    for (i, alpha) in [0.25, 0.5, 0.75].into_iter().enumerate() {
        let mut pane = Primitive { material: i + 1, ..Primitive::default() };
        let at = DVec3::new(9.0 * i as f64 - 9.0, 4.0, -6.0 * i as f64);
        quad(&mut pane, at, DVec3::X * 3.0, DVec3::new(0.0, 1.5, -2.5), DVec3::new(0.0, 0.86, 0.51));
        let base_color = [1.0, 1.0, 1.0, alpha];
        let alpha = AlphaMode::Blend;
        scene.materials.push(Material { alpha, base_color, double_sided: true, ..Material::default() });
        scene.nodes.push(umbrage_scene::Node { mesh: Some(i + 1), ..Default::default() });
        scene.meshes.push(umbrage_scene::Mesh { primitives: vec![pane], ..Default::default() });
    }
    scene.moved(place)
}

fn view(place: DVec3, frame: u32) -> View {
    let k = f64::from(frame);
    let lens = Frustum::perspective(1.0, 4.0 / 3.0, 0.5, 200.0).expect("a lens");
    let eye = place + DVec3::new(0.0, 6.0, 22.0) + 0.15 * k * DVec3::new(0.4, 0.0, -1.0).normalize();
    let ahead = DQuat::from_rotation_y(0.003 * k) * DVec3::new(0.0, -0.3, -1.0);
    View::look_at_upright(eye, eye + ahead, lens).expect("a view")
}

/// How a frame was planned, and its maps.
type Frame = (Arc<ShadowPlan>, Vec<GrayImage>);

/// What a walk came to.
#[derive(Debug, Default)]
struct Tally {
    /// Maps beside that of the frame before.
    compared: usize,
    /// Those between which the map took a step.
    stepped: usize,
    /// Texels that a pane covers, and does not, inside the panes' outline.
    covered: usize,
    holes: usize,
    /// Texels that are covered in one frame and not in the other.
    changed: usize,
}

/// By how many whole texels a map has moved since the other frame, if it has.
type Moved = fn(&Split, &Split) -> Option<DVec2>;

fn walk(stability: Stability, place: DVec3, moved: Moved) -> Option<Tally> {
    let look = Look { translucent: Translucent::Dithered, ..Look::default() };
    let range = Range::Metres { near: 1.0, far: 60.0 };
    let config = ShadowConfig { map_sizes: vec![256, 128], range, stability, look, ..settings().config };
    let settings = RenderSettings { size: [32, 24], config, ..settings() };
    let mut stage = Stage::new(&gpu()?, &panes(place), &settings);
    let (mut tally, mut before): (Tally, Option<Frame>) = Default::default();
    for k in 0..FRAMES {
        let outputs = Outputs { maps: true, ..Outputs::default() };
        let rendered = stage.render(&view(place, k), sun(DVec3::new(0.3, -1.0, 0.2)), outputs);
        let now = (Arc::clone(&rendered.stats.plan), rendered.maps);
        if let Some(before) = &before {
            (0..2).for_each(|split| compare(&mut tally, before, &now, split, moved));
        }
        before = Some(now);
    }
    Some(tally)
}

/// Every texel that both maps hold, of splits whose lists are the same.
fn compare(tally: &mut Tally, old: &Frame, new: &Frame, split: usize, moved: Moved) {
    if old.0.casters(split) != new.0.casters(split) || new.0.casters(split).is_empty() {
        return;
    }
    tally.compared += 1;
    let Some(shift) = moved(&new.0.splits[split], &old.0.splits[split]) else {
        tally.stepped += 1;
        return;
    };
    let shift = Vec2::new(shift.x as f32, shift.y as f32).as_ivec2();
    let covers = |map: &GrayImage, at: IVec2| {
        let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(IVec2::new(map.width() as i32, map.height() as i32)).all();
        inside.then(|| map.get_pixel(at.x as u32, at.y as u32).0[0] < 255)
    };
    for (x, y, _) in new.1[split].enumerate_pixels() {
        let at = IVec2::new(x as i32, y as i32);
        let (Some(now), Some(then)) = (covers(&new.1[split], at), covers(&old.1[split], at + shift)) else { continue };
        tally.changed += usize::from(now != then);
        tally.covered += usize::from(now);
        // A hole has covered texels within the dither's period to both sides.
        let beside = |side: i32| (1..4).any(|far| covers(&new.1[split], at + IVec2::X * side * far) == Some(true));
        tally.holes += usize::from(!now && beside(-1) && beside(1));
    }
}

#[test]
fn no_texel_of_a_dithered_shadow_changes() {
    for place in [DVec3::ZERO, DVec3::new(9_984.3, 12.7, -470.1), DVec3::new(99_840.0, -31.4, 470.0)] {
        for stability in [Stability::Exact, Stability::Approximate { steps: ExtentSteps::default() }] {
            let Some(tally) = walk(stability.clone(), place, Split::texels_moved_since) else { return };
            eprintln!("{stability:?} at {place}: {tally:?}");
            assert_eq!(tally.changed, 0, "{stability:?} at {place}: {tally:?}");
            assert!(tally.covered > 5_000 && tally.holes > 5_000, "{stability:?} at {place}: {tally:?}");
            let steps = if stability == Stability::Exact { 0 } else { tally.compared / 2 };
            assert!(tally.stepped <= steps, "{stability:?} at {place}: {tally:?}");
        }
    }
}

/// The tally can say no: tight maps take another place within the pattern with every frame, and so
/// does a map of which one only knows to the nearest texel how far it has moved.
#[test]
fn unstabilised_dither_swims() {
    let Some(tally) = walk(Stability::tight(), DVec3::ZERO, Split::texels_moved_since) else { return };
    assert!(tally.compared > 0 && tally.stepped == tally.compared, "{tally:?}");
    let nearest: Moved = |new, old| Some((new.min_texel - old.min_texel).round());
    let Some(tally) = walk(Stability::tight(), DVec3::ZERO, nearest) else { return };
    assert!(tally.changed > tally.covered / 100, "{tally:?}");
}
