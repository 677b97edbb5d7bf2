//! Exact edges through the renderer: masks against closed forms, and names that come and go.

mod common;

use common::*;
use glam::{DQuat, DVec3};
use image::GrayAlphaImage;
use umbrage::View;
use umbrage::config::{Edges, Filter, Layout, ShadowConfig};
use umbrage_render::{Outputs, RenderSettings};
use umbrage_scene::{Pose, Scene};

const LIGHT: DVec3 = DVec3::new(0.8, -1.0, 0.3);

/// Maps so coarse that a texel is as wide as a pixel or several.
fn coarse(edges: Edges, layout: Layout) -> RenderSettings {
    let filter = Filter::Pcf3 { width_m: None };
    configured(ShadowConfig { map_sizes: vec![24; 2], filter, edges, layout, ..config() })
}

/// Boxes on the ground, one of them by a node that turns and stretches.
fn town() -> (Scene, Vec<[DVec3; 2]>) {
    let boxes = [
        [DVec3::new(-3.0, 0.0, -2.0), DVec3::new(-1.5, 2.0, 1.0)],
        [DVec3::new(0.5, 1.0, -4.0), DVec3::new(1.1, 1.3, 4.0)],
        [DVec3::new(2.0, 0.0, -1.0), DVec3::new(3.0, 1.0, 2.0)],
    ];
    let unit = || cuboid(DVec3::ZERO, DVec3::ONE);
    let whole = |[min, max]: [DVec3; 2]| cuboid(min, max);
    let mut scene = scene(vec![ground(0.0, 60.0), whole(boxes[0]), whole(boxes[1]), unit()]);
    // A quarter turn about y takes x to -z and z to x.
    let [min, max] = boxes[2];
    let size = max - min;
    let turn = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    scene.nodes[3].local = trs(DVec3::new(min.x, min.y, max.z), turn, DVec3::new(size.z, size.y, size.x));
    (scene, boxes.to_vec())
}

fn from_above() -> View {
    look(DVec3::new(-6.0, 9.0, 9.0), DVec3::new(0.5, 0.0, 0.0))
}

/// Pixels of the ground that are decided wrongly, of how many, leaving out those of which a
/// millimetre decides.
fn wrong(mask: &GrayAlphaImage, boxes: &[[DVec3; 2]]) -> [u32; 2] {
    let mut count = [0; 2];
    for pixel in pixels(&from_above(), SIZE) {
        let hit = |start, ray, grown: f64| boxes.iter().any(|[a, b]| meets_box(start, ray, *a - grown, *b + grown));
        let Some(at) = pixel.on_ground(0.0) else { continue };
        if at.x.abs().max(at.z.abs()) > 20.0 || hit(pixel.eye, pixel.ray, 0.05) {
            continue;
        }
        let dark = hit(at, -LIGHT, 1e-3);
        if dark == hit(at, -LIGHT, -1e-3) {
            count[1] += 1;
            count[0] += u32::from((mask.get_pixel(pixel.x, pixel.y).0[0] < 128) != dark);
        }
    }
    count
}

fn mask(stage: &mut Stage) -> GrayAlphaImage {
    stage.renderer.restart();
    stage.mask(&from_above(), sun(LIGHT))
}

#[test]
fn boxes_on_the_ground_throw_the_shadows_that_they_have() {
    let Some(gpu) = gpu() else { return };
    let (scene, boxes) = town();
    let of = |edges, layout| wrong(&mask(&mut Stage::new(&gpu, &scene, &coarse(edges, layout))), &boxes);
    let [sampled, all] = of(Edges::Sampled, Layout::Array);
    for layout in [Layout::Array, Layout::InstancedAtlas, Layout::LayeredArray, Layout::Reused] {
        let [exact, asked] = of(Edges::Exact, layout);
        assert!(asked == all && all > 8000, "{asked} and {all}");
        // What may be left is where a caster passes between nine texels' centres.
        assert!(exact <= 2 && sampled > 20, "{layout:?}: {exact} and sampled {sampled} of {all}");
    }
}

#[test]
fn names_come_and_go_with_objects() {
    let Some(gpu) = gpu() else { return };
    let (scene, boxes) = town();
    let mut stage = Stage::new(&gpu, &scene, &coarse(Edges::Exact, Layout::Array));
    let whole = mask(&mut stage);
    let all: Pose = stage.pose.clone();
    // The first box goes; ids of those that follow are given anew.
    stage.pose.objects.remove(1);
    let without = mask(&mut stage);
    let [wrongly, _] = wrong(&without, &boxes[1..]);
    assert!(wrongly <= 4, "{wrongly}");
    assert!(wrong(&without, &boxes)[0] > 50, "the shadow of what has gone is gone");
    stage.pose = all;
    assert_eq!(mask(&mut stage), whole, "and is there again");
    // A box that moves takes its shadow along.
    stage.pose.objects[2].world_from_local.translation += DVec3::X;
    stage.pose.objects[2].bounds =
        umbrage::Aabb::new(stage.pose.objects[2].bounds.min + DVec3::X, stage.pose.objects[2].bounds.max + DVec3::X);
    let mut moved = boxes.clone();
    moved[1] = boxes[1].map(|corner| corner + DVec3::X);
    let [wrongly, _] = wrong(&mask(&mut stage), &moved);
    assert!(wrongly <= 4, "{wrongly}");
}

#[test]
fn bytes_count_the_ids() {
    let Some(gpu) = gpu() else { return };
    let (scene, _) = town();
    let bytes = |edges| {
        let mut stage = Stage::new(&gpu, &scene, &coarse(edges, Layout::Array));
        stage.render(&from_above(), sun(LIGHT), Outputs { mask: true, ..Default::default() }).stats.bytes
    };
    assert_eq!((bytes(Edges::Sampled), bytes(Edges::Exact)), (2 * 24 * 24 * 4, 2 * 24 * 24 * 8));
}
