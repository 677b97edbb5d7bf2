//! Masks by kept maps are those by maps that are drawn anew, bit for bit, and next to those by maps
//! of which nothing is kept.

mod common;

use common::{SIZE, Stage, configured, cuboid, gpu, ground, scene, sphere, sun};
use glam::{DAffine3, DVec3};
use image::GrayAlphaImage;
use umbrage::config::{Cache, Filter, Preset, Range, ShadowConfig, Storage};
use umbrage::{Frustum, View};
use umbrage_render::{Gpu, KeptMaps, Outputs, Rendered};
use umbrage_scene::Scene;

const SUN: DVec3 = DVec3::new(0.7, -1.0, 0.4);

fn config(cache: Cache) -> ShadowConfig {
    let range = Range::Metres { near: 0.5, far: 70.0 };
    ShadowConfig { map_sizes: vec![256; 3], range, cache, ..Preset::Papers.config() }
}

/// Boxes and balls on a plain; node 1 is the one that moves. The plain, node 0, casts or not.
fn world(plain_casts: bool) -> Scene {
    let mut primitives = vec![ground(0.0, 80.0), cuboid(DVec3::new(-1.0, 0.0, -6.0), DVec3::new(0.5, 2.0, -5.0))];
    for i in 0..60 {
        let share = |step: u32| f64::from(step * (i + 3) % 101) / 100.0;
        let at = DVec3::new(80.0 * share(37) - 40.0, 0.0, 80.0 * share(61) - 40.0);
        primitives.push(match i % 3 {
            0 => sphere(at + DVec3::Y * 1.5, 1.0 + share(13)),
            _ => cuboid(at, at + DVec3::new(1.0 + share(7), 1.0 + 4.0 * share(23), 1.0 + share(5))),
        });
    }
    let mut world = scene(primitives);
    world.nodes[0].cast_shadow = plain_casts;
    world
}

/// Walks, turns, stands and leaps.
fn view(frame: u32) -> View {
    let t = f64::from(frame);
    let (eye, heading) = match frame {
        0..12 => (DVec3::new(0.4 * t, 1.7, 8.0 - 0.5 * t), 0.02 * t),
        12..24 => (DVec3::new(4.8, 1.7, 2.0), 0.24 + 0.13 * (t - 12.0)),
        24..28 => (DVec3::new(4.8, 1.7, 2.0), 1.8),
        _ => (DVec3::new(-20.0 + 0.02 * t, 1.9, -14.0), 2.5),
    };
    // So wide that a map which begins at the eye is no larger than one that begins at its slice.
    let lens = Frustum::perspective(75_f64.to_radians(), 4.0 / 3.0, 0.5, 200.0).expect("a lens");
    View::look_at_upright(eye, eye + DVec3::new(heading.sin(), -0.12, -heading.cos()), lens).expect("a view")
}

/// What a life of frames comes to.
fn life(gpu: &Gpu, config: ShadowConfig, kept: KeptMaps) -> Vec<Rendered> {
    life_in(gpu, &world(true), config, kept)
}

/// What a life of frames comes to in a world.
fn life_in(gpu: &Gpu, world: &Scene, config: ShadowConfig, kept: KeptMaps) -> Vec<Rendered> {
    let mut stage = Stage::new(gpu, world, &configured(config));
    stage.renderer.set_kept(kept);
    let object = stage.pose.objects.iter().position(|object| object.node == 1).expect("node 1");
    let wanted = Outputs { mask: true, ..Outputs::default() };
    let frame = |frame: u32| {
        if (5..20).contains(&frame) {
            let moved = &mut stage.pose.objects[object];
            let by = DAffine3::from_translation(DVec3::new(0.21, 0.0, -0.13));
            moved.bounds = moved.bounds.transformed(&by);
            moved.world_from_local = by * moved.world_from_local;
        }
        stage.render(&view(frame), sun(SUN), wanted)
    };
    (0..36).map(frame).collect()
}

fn masks(frames: &[Rendered]) -> Vec<&GrayAlphaImage> {
    frames.iter().map(|frame| frame.mask.as_ref().expect("a mask")).collect()
}

/// Pixels that differ, over all frames.
fn differing(a: &[Rendered], b: &[Rendered]) -> usize {
    let pair = |(a, b): (&GrayAlphaImage, &GrayAlphaImage)| a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    masks(a).into_iter().zip(masks(b)).map(pair).sum()
}

fn triangles(frames: &[Rendered]) -> u64 {
    frames.iter().map(|frame| frame.stats.shadow_triangles).sum()
}

#[test]
fn masks_are_those_of_maps_drawn_anew() {
    let Some(gpu) = gpu() else { return };
    let redraws = KeptMaps { redraws: true, ..KeptMaps::default() };
    for (filter, storage) in [
        (Filter::Pcf3 { width_m: None }, Storage::Array),
        (Filter::Pcf5 { width_m: None }, Storage::Atlas),
        (Filter::Hard, Storage::Separate),
        (Filter::ALL.into_iter().find(Filter::is_prefiltered).expect("moments"), Storage::Array),
    ] {
        let mut config = ShadowConfig { filter, ..config(Cache::Kept) };
        config.apply(&[("storage".to_owned(), storage.to_string())]).expect("a storage");
        let kept = life(&gpu, config.clone(), KeptMaps::default());
        let anew = life(&gpu, config, redraws);
        assert_eq!(differing(&kept, &anew), 0, "{filter:?}, {storage}");
        assert!(4 * triangles(&kept) < triangles(&anew), "{} of {}", triangles(&kept), triangles(&anew));
        let standing: u64 = kept[26..28].iter().map(|frame| frame.stats.shadow_triangles).sum();
        let moves: u64 = 2 * 3 * 12;
        assert!(standing <= moves, "{standing} triangles while all stand but the box that waits to be kept");
    }
}

#[test]
fn masks_with_a_small_budget_are_those_of_maps_drawn_anew() {
    let Some(gpu) = gpu() else { return };
    let small = KeptMaps { texels: Some(8_000), redraws: false };
    let kept = life(&gpu, config(Cache::Kept), small);
    let anew = life(&gpu, config(Cache::Kept), KeptMaps { redraws: true, ..small });
    assert_eq!(differing(&kept, &anew), 0);
    let waits = |frame: &&Rendered| (0..3).any(|split| frame.stats.plan.is_handed_on(split));
    assert!(kept.iter().filter(waits).count() > 3, "nobody had to wait");
    // Where splits wait, the picture is another one: the comparison can say no.
    assert!(differing(&kept, &life(&gpu, config(Cache::Kept), KeptMaps::default())) > 0);
}

/// Where the grid is that of maps without a cache (the lens is so wide that maps which begin at the
/// eye are no larger), and where no caster lies below everything (which plans leave out and kept
/// maps do not), masks agree but for the rasteriser's last bits: in 5 pixels here.
#[test]
fn masks_are_next_to_those_without_a_cache() {
    let Some(gpu) = gpu() else { return };
    for (plain_casts, most) in [(false, 20), (true, 150)] {
        let lives = [Cache::Kept, Cache::Off]
            .map(|cache| life_in(&gpu, &world(plain_casts), config(cache), KeptMaps::default()));
        let [kept, off] = &lives;
        let (differing, all) = (differing(kept, off), kept.len() * (SIZE[0] * SIZE[1]) as usize);
        let [few, many] = [triangles(kept), triangles(off)];
        eprintln!("plain casts: {plain_casts}; {differing} of {all} pixels differ; {few} triangles of {many}");
        assert!(differing <= most, "{differing} of {all} pixels differ");
        assert!(3 * few < many, "{few} of {many}");
    }
}
