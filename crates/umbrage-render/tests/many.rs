//! Scenes of thousands of objects: what is kept of them from frame to frame shows what a new
//! renderer shows.

mod common;

use common::{Stage, gpu, sun};
use glam::DVec3;
use image::GrayAlphaImage;
use umbrage::{Aabb, Frustum, View};
use umbrage_render::{Frame, Outputs, RenderSettings, Renderer};
use umbrage_scene::procedural::{World, WorldOptions};
use umbrage_scene::{Pose, Scene};

const SIZE: [u32; 2] = [96, 72];

fn forest() -> (Scene, Pose) {
    let options = WorldOptions { trees: Some(5000), ..WorldOptions::default() };
    let scene = World::Forest.build_with(&options, &|_| ()).expect("a forest");
    let pose = scene.pose(0.0).expect("a pose");
    (scene, pose)
}

fn view() -> View {
    let frustum = Frustum::perspective(1.0, 96.0 / 72.0, 0.5, 600.0).expect("a lens");
    View::look_at_upright(DVec3::new(-40.0, 40.0, 60.0), DVec3::new(60.0, 0.0, -140.0), frustum).expect("a view")
}

fn mask(renderer: &mut Renderer, pose: &Pose, moved: Option<&[u32]>) -> GrayAlphaImage {
    let view = view();
    let frame = Frame { moved, ..Stage::frame(pose, &view, sun(DVec3::new(0.6, -0.7, 0.4))) };
    renderer.render(&frame, Outputs { mask: true, ..Outputs::default() }).expect("a frame").mask.expect("a mask")
}

/// A tree far behind the eye, moved into the clearing in the view.
fn with_a_moved_tree(pose: &Pose) -> (Pose, u32) {
    let (behind, near) = (DVec3::new(-350.0, 0.0, 350.0), DVec3::new(8.0, 0.0, -25.0));
    let distance = |index: &usize| pose.objects[*index].world_from_local.translation.distance(behind);
    let trees = (0..pose.objects.len()).filter(|&index| pose.objects[index].instance.is_some());
    let tree = trees.min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a tree");
    let mut moved = pose.clone();
    let object = &mut moved.objects[tree];
    let by = near + DVec3::Y * 3.0 - object.world_from_local.translation.with_y(0.0);
    object.world_from_local.translation += by;
    object.bounds = Aabb::new(object.bounds.min + by, object.bounds.max + by);
    (moved, tree as u32)
}

#[test]
fn what_is_said_to_have_moved_is_what_has() {
    let Some(gpu) = gpu() else { return };
    let (scene, pose) = forest();
    let settings = RenderSettings { size: SIZE, ..RenderSettings::default() };
    let new = || Renderer::new(&gpu, &scene, &settings).expect("a renderer");
    let mut renderer = new();
    let first = mask(&mut renderer, &pose, None);
    let dark = first.pixels().filter(|pixel| pixel.0 == [0, 255]).count();
    assert!((200..6000).contains(&dark), "{dark} pixels are dark");
    renderer.restart();
    assert!(mask(&mut renderer, &pose, Some(&[])) == first, "nothing has moved");

    let (moved, tree) = with_a_moved_tree(&pose);
    let wanted = mask(&mut new(), &moved, None);
    assert!(wanted != first, "the tree that moves is seen");
    renderer.restart();
    assert!(mask(&mut renderer, &moved, Some(&[tree])) == wanted, "its shadow has moved with it");

    // Whoever does not say it gets the old shadow.
    let mut told_nothing = new();
    mask(&mut told_nothing, &pose, None);
    told_nothing.restart();
    assert!(mask(&mut told_nothing, &moved, Some(&[])) != wanted, "the comparison tells them apart");
}

#[test]
fn an_object_that_is_not_there_is_refused() {
    let Some(gpu) = gpu() else { return };
    let (scene, pose) = forest();
    let settings = RenderSettings { size: SIZE, ..RenderSettings::default() };
    let mut renderer = Renderer::new(&gpu, &scene, &settings).expect("a renderer");
    mask(&mut renderer, &pose, None);
    let view = view();
    let beyond = [pose.objects.len() as u32];
    let frame = Frame { moved: Some(&beyond), ..Stage::frame(&pose, &view, sun(DVec3::NEG_Y)) };
    let error = renderer.render(&frame, Outputs { mask: true, ..Outputs::default() }).expect_err("no such object");
    assert!(error.to_string().contains("moved object"), "{error}");
}
