//! Both methods of Listing 4.1.4 of \[PCSM\] decide alike: map coordinates that fragments make of a
//! position, and those that vertices make for every split.

mod common;

use common::{SIZE, Stage, config, configured, cuboid, gpu, ground, look, scene, sphere, sun};
use glam::DVec3;
use image::GrayAlphaImage;
use umbrage::config::{
    Coordinates, Filter, Layout, LightKind, MomentKind, Moments, Selection, ShadowConfig, Stability, Transition,
};
use umbrage::{SpotLight, Warp};
use umbrage_render::{Frame, Outputs, RenderSettings, Renderer};
use umbrage_scene::{Primitive, Scene};

/// Pixels that two masks decide differently, by more than rounding of a grey, and all that they
/// hit.
fn differences(a: &GrayAlphaImage, b: &GrayAlphaImage) -> (usize, usize) {
    assert_eq!(a.dimensions(), b.dimensions());
    let differ = a.pixels().zip(b.pixels()).filter(|(a, b)| a.0[1] != b.0[1] || a.0[0].abs_diff(b.0[0]) > 2).count();
    (differ, a.pixels().filter(|pixel| pixel.0[1] > 0).count())
}

fn with_splits(splits: usize, coordinates: Coordinates) -> RenderSettings {
    configured(ShadowConfig { map_sizes: vec![512; splits], coordinates, ..config() })
}

/// Rows of boxes and a sphere on a plain of two triangles, each far larger than any map.
fn plain() -> Scene {
    let boxes = (0..40).map(|i| {
        let at = DVec3::new(2.5 * f64::from(i % 8) - 9.0, 0.0, 3.0 - 4.0 * f64::from(i / 8));
        cuboid(at, at + DVec3::new(0.7, 1.2, 0.7))
    });
    scene(boxes.chain([ground(0.0, 400.0), sphere(DVec3::new(3.0, 1.0, -25.0), 1.0)]).collect())
}

/// Rows of pillars that stand on steps, far down a street.
fn street() -> Scene {
    let pillar = |i: usize| {
        let (x, z) = (if i.is_multiple_of(2) { -4.0 } else { 3.0 }, -3.0 * i as f64);
        cuboid(DVec3::new(x, 0.0, z - 0.5), DVec3::new(x + 1.0, 3.0 + 0.25 * i as f64, z + 0.5))
    };
    let step = |i: usize| cuboid(DVec3::new(-2.0, -0.5, -6.0 * i as f64 - 2.0), DVec3::new(2.0, 0.3, -6.0 * i as f64));
    let primitives: Vec<Primitive> = (0..16).map(pillar).chain((0..8).map(step)).chain([ground(0.0, 120.0)]).collect();
    scene(primitives)
}

#[test]
fn vertices_say_what_fragments_say() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(0.6, -0.7, -0.4));
    let view = look(DVec3::new(-2.0, 4.0, 9.0), DVec3::new(1.0, 0.0, -6.0));
    let outputs = Outputs { picture: true, mask: true, ..Outputs::default() };
    for (name, world, splits) in [("plain", plain(), 3), ("street", street(), 4)] {
        let drawn = |stage: &mut Stage, light| {
            let rendered = stage.render(&view, light, outputs);
            (rendered.mask.expect("a mask"), rendered.picture.expect("a picture"))
        };
        let [mut by_fragments, mut by_vertices] = [Coordinates::World, Coordinates::Vertex]
            .map(|coordinates| Stage::new(&gpu, &world, &with_splits(splits, coordinates)));
        let (of_fragments, picture) = drawn(&mut by_fragments, light);
        let (of_vertices, same) = drawn(&mut by_vertices, light);
        let (differ, hit) = differences(&of_fragments, &of_vertices);
        let unlike = picture.pixels().zip(same.pixels()).filter(|(a, b)| a != b).count();
        eprintln!("{name}, {splits} splits: {differ} of {hit} mask pixels and {unlike} picture pixels differ");
        assert!(hit > 5000, "{hit} pixels are hit");
        assert!(differ <= 8, "{name}, {splits} splits: {differ} of {hit} pixels differ");
        assert!(unlike <= 40, "{name}, {splits} splits: {unlike} pixels of the picture differ");
        assert!(of_vertices.pixels().any(|pixel| pixel.0 == [0, 255]), "something is shaded");
        // The comparison can say no: a sun aside.
        let (aside, _) = drawn(&mut by_vertices, sun(DVec3::new(0.9, -0.7, -0.4)));
        let (moved, _) = differences(&of_fragments, &aside);
        eprintln!("{name}: {moved} pixels differ under a sun aside");
        assert!(moved > 80, "{name}: {moved} pixels differ under a sun aside");
    }
}

#[test]
fn so_they_do_with_every_way_to_choose_and_to_filter() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(0.6, -0.7, -0.4));
    let view = look(DVec3::new(-2.0, 4.0, 9.0), DVec3::new(1.0, 0.0, -6.0));
    let world = street();
    let blend = Transition::Blend { share: 0.2 };
    let vsm = Filter::Moments(Moments::new(MomentKind::Vsm));
    for (filter, selection, stability, transition, layout) in [
        (Filter::Pcf5 { width_m: None }, Selection::Map, Stability::Exact, blend, Layout::Array),
        (vsm, Selection::VIEW_DEPTH, Stability::tight(), blend, Layout::Array),
        (Filter::Hard, Selection::VIEW_DEPTH, Stability::Exact, Transition::Hard, Layout::Reused),
    ] {
        let [of_fragments, of_vertices] = [Coordinates::World, Coordinates::Vertex].map(|coordinates| {
            let plain = with_splits(3, coordinates).config;
            let stability = stability.clone();
            let settings = configured(ShadowConfig { selection, stability, transition, filter, layout, ..plain });
            Stage::new(&gpu, &world, &settings).mask(&view, light)
        });
        let (differ, hit) = differences(&of_fragments, &of_vertices);
        eprintln!("{filter:?}, {selection:?}, {layout:?}: {differ} of {hit} pixels differ");
        assert!(differ <= 8, "{filter:?}, {selection:?}, {layout:?}: {differ} of {hit} pixels differ");
        assert_eq!(of_vertices.dimensions(), (SIZE[0], SIZE[1]));
    }
}

#[test]
fn what_cannot_be_interpolated_is_refused() {
    let Some(gpu) = gpu() else { return };
    let world = scene(vec![ground(0.0, 10.0)]);
    let refused =
        |settings: &RenderSettings| Renderer::new(&gpu, &world, settings).err().map(|error| error.to_string());
    let says = |message: Option<String>, culprit: &str| {
        let message = message.expect("an error");
        assert!(message.contains("coordinates split") && message.contains(culprit), "{message}");
    };
    says(refused(&with_splits(5, Coordinates::Vertex)), "splits 5");
    assert_eq!(refused(&with_splits(5, Coordinates::World)), None);
    let plain = with_splits(1, Coordinates::Vertex);
    let stability = Stability::Tight { warps: vec![Warp::Lispsm] };
    says(refused(&configured(ShadowConfig { stability, ..plain.config.clone() })), "warp lispsm");
    let of = |lights: &[LightKind]| RenderSettings {
        lights: lights.iter().map(|&light| light.into()).collect(),
        ..plain.clone()
    };
    says(refused(&of(&[LightKind::Directional; 2])), "several lights");
    says(refused(&of(&[LightKind::Point])), "spot or point");
    says(refused(&of(&[LightKind::Spot])), "spot or point");

    let mut stage = Stage::new(&gpu, &world, &plain);
    let view = look(DVec3::new(0.0, 3.0, 6.0), DVec3::ZERO);
    let spot = SpotLight::new(DVec3::Y * 5.0, DVec3::NEG_Y, 0.6, 20.0).expect("a spot light");
    let frame = Frame {
        pose: &stage.pose,
        moved: None,
        view: &view,
        light: umbrage::Light::Spot(spot).into(),
        more_lights: &[],
        shadows_on: true,
        tint: false,
    };
    let error = stage.renderer.render(&frame, Outputs { mask: true, ..Default::default() }).expect_err("no sun");
    assert!(error.to_string().contains("LightKind::Spot"), "{error}");
}
