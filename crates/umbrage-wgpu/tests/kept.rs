//! Kept maps are the maps that are drawn anew, bit for bit, in every frame of a life with walks,
//! turns, leaps, movers and casters that come and go; and they cost what has changed.

mod common;

use std::collections::BTreeMap;

use common::painter::{Painted, Painter};
use common::{Gpu, PCF3, config};
use glam::DVec3;
use umbrage::{Aabb, Caster, CasterHandle, CasterSet, DirectionalLight, Frustum, Light, Motion, SteppedSun, View};
use umbrage_wgpu::{Inputs, ShadowConfig};

const SETTINGS: &str = "shadow-range=0.5..90 cache=kept";

/// Casters by key: their handles, and the boxes that are drawn of them.
struct World {
    set: CasterSet,
    casters: BTreeMap<u32, (CasterHandle, Aabb)>,
    eye: DVec3,
    heading: f64,
    sun: DVec3,
    origin: DVec3,
    view_slot: u32,
}

impl World {
    /// A town of boxes on a plain that throws no shadow.
    fn new() -> Self {
        let mut set = CasterSet::new();
        let ground = Aabb::new(DVec3::new(-120.0, -0.5, -120.0), DVec3::new(120.0, 0.0, 120.0));
        set.insert(Caster { casts: false, ..Caster::new(ground, u32::MAX) }).expect("a box");
        let share = |i: u32, step: u32| f64::from(i.wrapping_mul(step) % 9973) / 9972.0;
        let casters: Vec<Caster> = (0..600u32)
            .map(|i| {
                let at = DVec3::new(200.0 * share(i + 1, 5171) - 100.0, 0.0, 200.0 * share(i + 1, 7919) - 100.0);
                let size = DVec3::new(0.3 + 2.0 * share(i, 313), 0.5 + 5.0 * share(i, 771), 0.3 + 2.0 * share(i, 997));
                Caster::new(Aabb::new(at, at + if i % 40 == 0 { 4.0 * size } else { size }), i)
            })
            .collect();
        let handles = set.insert_all(casters.iter().copied()).expect("boxes");
        let casters = handles.into_iter().zip(casters).map(|(handle, it)| (it.key, (handle, it.bounds))).collect();
        let eye = DVec3::new(3.0, 1.7, -5.0);
        let sun = DVec3::new(0.5, -1.0, 0.35);
        Self { set, casters, eye, heading: 0.3, sun, origin: DVec3::ZERO, view_slot: 0 }
    }

    fn insert(&mut self, key: u32, at: DVec3, motion: Motion) {
        let bounds = Aabb::new(at, at + DVec3::new(1.0, 2.0, 1.0));
        let handle = self.set.insert(Caster { motion, ..Caster::new(bounds, key) }).expect("a box");
        self.casters.insert(key, (handle, bounds));
    }

    fn move_by(&mut self, key: u32, step: DVec3) {
        let (handle, bounds) = self.casters.get_mut(&key).expect("a caster");
        *bounds = Aabb::new(bounds.min + step, bounds.max + step);
        self.set.set_bounds(*handle, *bounds).expect("a box");
    }

    fn remove(&mut self, key: u32) {
        let (handle, _) = self.casters.remove(&key).expect("a caster");
        self.set.remove(handle).expect("it is there");
    }

    fn walk(&mut self, metres: f64) {
        self.eye += metres * DVec3::new(self.heading.sin(), 0.0, self.heading.cos());
    }

    /// The next frame of a life in which everything happens that can happen.
    fn live(&mut self, frame: u32) {
        match frame % 40 {
            0..=11 => self.walk(0.7),
            12..=19 => self.heading += 0.12,
            20 => self.eye = DVec3::new(-40.0 + f64::from(frame), 1.7, 35.0),
            21..=26 => {}
            27 => self.origin = (self.eye / 8.0).round() * 8.0,
            28 => self.sun.x -= 0.08,
            _ => self.walk(0.05),
        }
        let ahead = self.eye + 6.0 * DVec3::new(self.heading.sin(), 0.0, self.heading.cos());
        let ground = DVec3::new(ahead.x, 0.0, ahead.z);
        match frame % 9 {
            0 => self.insert(1000 + frame, ground, Motion::Static),
            4 => self.insert(1000 + frame, ground + DVec3::X, Motion::Moving),
            7 if frame > 20 => self.remove(frame % 600),
            _ => {}
        }
        let moving: Vec<u32> = self.casters.keys().copied().filter(|key| *key >= 1000 && key % 9 == 5).collect();
        moving.into_iter().for_each(|key| self.move_by(key, DVec3::new(0.13, 0.0, 0.07)));
        // A static caster that moves for a while, and then rests.
        if self.casters.contains_key(&1000) && (5..12).contains(&(frame % 80)) {
            self.move_by(1000, DVec3::new(0.05, 0.0, 0.0));
        }
    }

    fn view(&self) -> View {
        let lens = Frustum::perspective(1.0, 4.0 / 3.0, 0.1, 150.0).expect("a lens");
        let target = self.eye + DVec3::new(self.heading.sin(), -0.15, self.heading.cos());
        View::look_at_upright(self.eye, target, lens).expect("a view")
    }

    fn paint(&self, gpu: &Gpu, painter: &mut Painter, redraws: bool, budget: Option<u64>) -> Painted {
        let (view, lights) = (self.view(), [Light::from(DirectionalLight::new(self.sun).expect("a direction"))]);
        let inputs = Inputs {
            set: Some(&self.set),
            origin: self.origin,
            view_slot: self.view_slot,
            kept_texels: budget,
            redraws_kept: redraws,
            ..Inputs::new(&view, &lights)
        };
        let boxes: BTreeMap<u32, Aabb> = self.casters.iter().map(|(key, (_, bounds))| (*key, *bounds)).collect();
        painter.paint(gpu, &inputs, &boxes)
    }
}

fn kept(sizes: &[u32]) -> ShadowConfig {
    config(sizes, PCF3, SETTINGS)
}

/// How often the two differ: texels of maps, and points of the mask.
fn differences(a: &Painted, b: &Painted) -> (usize, usize) {
    assert_eq!(a.handed_on, b.handed_on, "the same splits answer");
    let mut texels = 0;
    for (one, other) in a.maps.iter().zip(&b.maps) {
        assert_eq!(one.len(), other.len());
        texels += one.iter().zip(other).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    }
    let points = a.mask.iter().zip(&b.mask).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    (texels, points)
}

/// A life of frames, kept and drawn anew: how many texels and points differ, and how many splits
/// were handed on.
fn live(gpu: &Gpu, sizes: &[u32], frames: u32, budget: Option<u64>, lies: bool) -> (usize, usize, usize) {
    let mut world = World::new();
    let [mut keeps, mut redraws] = [0, 1].map(|_| Painter::new(gpu, &kept(sizes)));
    let (mut texels, mut points, mut handed_on, mut dark) = (0, 0, 0, 0);
    for frame in 0..frames {
        world.live(frame);
        if lies && frame == 30 {
            // Every caster near the eye is drawn elsewhere, and nobody says so.
            let near = |bounds: &Aabb| bounds.center().distance(world.eye) < 25.0;
            let moved = world.casters.values_mut().filter(|(_, bounds)| near(bounds));
            moved.for_each(|(_, bounds)| bounds.max.y += 0.5);
        }
        let one = world.paint(gpu, &mut keeps, false, budget);
        let other = world.paint(gpu, &mut redraws, true, budget);
        let (more_texels, more_points) = differences(&one, &other);
        (texels, points) = (texels + more_texels, points + more_points);
        handed_on += one.handed_on.iter().filter(|&&it| it).count();
        dark += one.mask.iter().filter(|&&visibility| visibility < 0.5).count();
        assert!(one.maps.iter().flatten().any(|&depth| depth < 1.0), "frame {frame}: maps are empty");
        assert!(one.triangles <= other.triangles, "frame {frame}: {} of {}", one.triangles, other.triangles);
    }
    assert!(dark > 100 * frames as usize / 10, "only {dark} points lie in shadow");
    (texels, points, handed_on)
}

#[test]
fn kept_maps_are_the_maps_drawn_anew() {
    let Some(gpu) = Gpu::new() else { return };
    assert_eq!(live(&gpu, &[256, 256, 256], 120, None, false), (0, 0, 0));
}

#[test]
fn kept_maps_of_unequal_and_odd_sizes_are_the_maps_drawn_anew() {
    let Some(gpu) = Gpu::new() else { return };
    assert_eq!(live(&gpu, &[200, 96, 313], 60, None, false), (0, 0, 0));
}

/// With a budget that never suffices for a leap, coarser splits answer for a while.
#[test]
fn a_small_budget_blurs_and_stays_right() {
    let Some(gpu) = Gpu::new() else { return };
    let (texels, points, handed_on) = live(&gpu, &[256, 256, 256], 100, Some(9_000), false);
    assert_eq!((texels, points), (0, 0));
    assert!(handed_on > 20, "{handed_on} splits had to wait");
}

/// Views that take turns draw over what is kept of each other. A frame that is refused changes
/// nothing.
#[test]
fn views_that_take_turns_and_refused_frames_stay_right() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new();
    let [mut keeps, mut redraws] = [0, 1].map(|_| Painter::new(&gpu, &kept(&[256; 3])));
    for frame in 0..16 {
        world.view_slot = frame % 2;
        world.eye = DVec3::new(3.0 + 40.0 * f64::from(frame % 2), 1.7, -5.0 + 0.4 * f64::from(frame));
        world.remove(frame);
        let one = world.paint(&gpu, &mut keeps, false, None);
        let other = world.paint(&gpu, &mut redraws, true, None);
        assert_eq!(differences(&one, &other), (0, 0), "frame {frame}");
    }
    let (view, lights) = (world.view(), [Light::from(DirectionalLight::new(world.sun).expect("a direction"))]);
    let nowhere = DVec3::new(f64::NAN, 0.0, 0.0);
    let refused = Inputs { set: Some(&world.set), origin: nowhere, ..Inputs::new(&view, &lights) };
    keeps.shadows.prepare(&gpu.queue, &refused).expect_err("an origin that is none");
    assert_eq!(world.paint(&gpu, &mut keeps, false, None).triangles, 0, "all is there still");
}

/// The comparison has to be able to say no.
#[test]
fn a_missed_change_is_seen() {
    let Some(gpu) = Gpu::new() else { return };
    let (texels, points, _) = live(&gpu, &[256, 256, 256], 40, None, true);
    assert!(texels > 100 && points > 0, "{texels} texels, {points} points");
}

/// Casters' triangles in maps, in all frames of a walk after the first, kept and not.
fn triangles(gpu: &Gpu, frames: u32, mut step: impl FnMut(&mut World)) -> (u64, u64) {
    let mut world = World::new();
    let mut keeps = Painter::new(gpu, &kept(&[512; 3]));
    let mut off = Painter::new(gpu, &config(&[512; 3], PCF3, "shadow-range=0.5..90"));
    let (mut kept, mut uncached) = (0, 0);
    for frame in 0..frames {
        step(&mut world);
        let triangles = [&mut keeps, &mut off].map(|painter| world.paint(gpu, painter, false, None).triangles);
        if frame > 0 {
            (kept, uncached) = (kept + triangles[0], uncached + triangles[1]);
        }
    }
    (kept, uncached)
}

#[test]
fn standing_costs_nothing_walking_and_turning_little() {
    let Some(gpu) = Gpu::new() else { return };
    let (standing, _) = triangles(&gpu, 100, |_| {});
    assert_eq!(standing, 0, "triangles while standing");
    let (walking, all) = triangles(&gpu, 600, |world| world.walk(1.4 / 60.0));
    eprintln!("walking: {walking} of {all} triangles, {:.2} %", 100.0 * walking as f64 / all as f64);
    assert!(20 * walking <= all, "{walking} of {all} triangles walking");
    let (turning, all) = triangles(&gpu, 240, |world| world.heading += 90f64.to_radians() / 60.0);
    eprintln!("turning: {turning} of {all} triangles, {:.2} %", 100.0 * turning as f64 / all as f64);
    assert!(100 * turning <= 15 * all, "{turning} of {all} triangles turning");
}

/// Frames of a fade.
const FADE: f64 = 10.0;

/// The most that a point's visibility changes from one frame to the next while the sun makes three
/// steps over kept maps with a budget, and the frames in which some of the shown maps waited.
fn sun_steps(gpu: &Gpu, waits: bool) -> (f32, usize) {
    let mut world = World::new();
    let mut painters = [0, 1].map(|_| Painter::new(gpu, &kept(&[256; 3])));
    let mut stepped = SteppedSun::new(0.04, FADE).expect("a step");
    let (mut before, mut jump, mut blurred): (Option<Vec<f32>>, f32, usize) = (None, 0.0, 0);
    let (mut shown, mut is_filled, mut steps) = (None, true, 0);
    for frame in 0..160 {
        let sun = DirectionalLight::new(DVec3::new(0.5 - 0.0012 * f64::from(frame), -1.0, 0.35)).expect("a sun");
        let fade = match waits {
            true => stepped.follow_filled(&sun, 1.0, is_filled).expect("a time"),
            false => stepped.follow(&sun, 1.0).expect("a time"),
        };
        if shown.is_some_and(|to| to != fade.to) {
            painters.swap(0, 1);
            steps += 1;
        }
        shown = Some(fade.to);
        let mut paint = |painter: usize, sun: DirectionalLight| {
            world.sun = sun.direction();
            // The first maps are there at once.
            world.paint(gpu, &mut painters[painter], false, (frame > 0).then_some(9_000))
        };
        let to = paint(1, fade.to);
        is_filled = !to.handed_on.contains(&true);
        let mut mask = to.mask;
        if fade.is_fading() {
            let from = paint(0, fade.from);
            assert!(from.triangles == 0 && !from.handed_on.contains(&true), "the maps before stand");
            let mix = |(to, from): (&f32, &f32)| fade.mix(f64::from(*from), f64::from(*to)) as f32;
            mask = mask.iter().zip(&from.mask).map(mix).collect();
        }
        blurred += usize::from(!is_filled && fade.weight > 0.0);
        if let Some(before) = before {
            jump = mask.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(jump, f32::max);
        }
        before = Some(mask);
    }
    assert!(steps >= 3, "{steps} steps");
    (jump, blurred)
}

#[test]
fn a_step_of_the_sun_is_faded_in_once_its_maps_are_filled() {
    let Some(gpu) = Gpu::new() else { return };
    let (jump, blurred) = sun_steps(&gpu, true);
    assert_eq!(blurred, 0, "frames that show maps of which some wait");
    assert!(jump > 0.0 && f64::from(jump) <= 1.0 / FADE + 1e-5, "a jump by {jump}");
}

/// The test can say no: without waiting, finer maps take over from coarser ones in the fade.
#[test]
fn a_step_that_does_not_wait_is_seen() {
    let Some(gpu) = Gpu::new() else { return };
    let (jump, blurred) = sun_steps(&gpu, false);
    assert!(blurred > 0 && f64::from(jump) > 1.5 / FADE, "a jump by {jump}, {blurred} frames");
}
