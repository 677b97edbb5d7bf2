//! 600 frames of walking, turning and zooming past things that stand still, at 0, 10 and 100 km
//! from the world's origin: exactly stabilised maps show every static texel that a visible point
//! can ask for as the frame before showed it. Equal means: the same texels are empty, and the
//! depths of the others lie no farther apart than the rasteriser's own rounding (see
//! `stillness.rs`): 2^-19 of the range, which is 0.2 mm here.

mod common;

use common::{Gpu, PCF3, World, config, cuboid};
use glam::{DQuat, DVec2, DVec3, IVec2, Vec3};
use umbrage::config::{Crop, ExtentSteps, Preset, Range, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, ShadowPlan, Split, SteppedSun, SunFade, View};
use umbrage_wgpu::FrameOptions;

const FRAMES: u32 = 600;
const SIZE: u32 = 128;
const SPLITS: usize = 4;

/// Depths may differ by this share of the range: 32 steps of an f32 just below 1.
const ROUNDING: f32 = 1.907_348_6e-6;

/// A frame's origin moves in steps of this many metres.
const ORIGIN_STEP: f64 = 1024.0;

/// Boxes on a flat ground around `center`, and points of both.
struct Town {
    center: DVec3,
    boxes: Vec<Aabb>,
    points: Vec<DVec3>,
}

impl Town {
    fn new(center: DVec3) -> Self {
        // A regular scatter that no test tunes: the golden ratio's sequence over the plane.
        let boxes: Vec<Aabb> = (0..70)
            .map(|i| {
                let i = f64::from(i);
                let (x, z) = ((i * 0.754_877_666_2).fract(), (i * 0.569_840_290_998).fract());
                let size = DVec3::new(
                    1.0 + (i * 0.31).fract() * 4.0,
                    1.0 + (i * 0.47).fract() * 9.0,
                    1.0 + (i * 0.23).fract() * 4.0,
                );
                let at = center + DVec3::new(220.0 * x - 110.0, 0.0, 220.0 * z - 110.0);
                Aabb::new(at, at + size)
            })
            .collect();
        let ground = (0..80 * 80).map(|i| {
            let (x, z) = (f64::from(i % 80), f64::from(i / 80));
            center + DVec3::new(3.1 * x - 124.0, 0.0, 3.1 * z - 124.0)
        });
        let points = ground.chain(boxes.iter().flat_map(|b| b.corners())).collect();
        Self { center, boxes, points }
    }

    fn triangles(&self, origin: DVec3) -> Vec<Vec<Vec3>> {
        let relative = |point: DVec3| (point - origin).as_vec3();
        self.boxes.iter().map(|b| cuboid(relative(b.min), relative(b.max))).collect()
    }

    /// Walks 0.15 m and turns 0.003 rad a frame, zooms in by a third and out again.
    fn view(&self, frame: u32) -> View {
        let k = f64::from(frame);
        let zoom = 1.0 - 0.25 * (std::f64::consts::PI * k / f64::from(FRAMES)).sin().powi(2);
        let lens = Frustum::perspective(zoom, 4.0 / 3.0, 0.5, 500.0).expect("a lens");
        let ahead = DQuat::from_rotation_y(0.003 * k) * DVec3::new(0.0, -0.1, -1.0);
        let eye = self.center + DVec3::new(0.0, 1.7, 45.0) + 0.15 * k * DVec3::new(0.4, 0.0, -1.0).normalize();
        View::look_at_upright(eye, eye + ahead, lens).expect("a view")
    }
}

struct Frame {
    plan: ShadowPlan,
    origin: DVec3,
    view: View,
    maps: Vec<Vec<f32>>,
}

/// What a walk came to.
#[derive(Debug, Default)]
struct Tally {
    /// Pairs of frames of one split whose texels were compared.
    still: usize,
    /// Pairs of frames of one split between which a step was taken or the origin moved.
    stepped: usize,
    /// Texels that only one of the maps covers. A tight one covers no more than its casters can
    /// shade.
    outside: usize,
    /// Texels compared, those with something in them, and those that differ.
    texels: usize,
    filled: usize,
    different: usize,
    /// Texels that differ at all, and by how much of the depth range at most.
    rounded: usize,
    widest: f32,
}

fn walk(world: &mut World, town: &Town, settings: &ShadowConfig, frames: u32) -> Tally {
    let mut planner = Planner::new(settings).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a direction");
    let (mut tally, mut before): (Tally, Option<Frame>) = Default::default();
    for k in 0..frames {
        let now = drawn(world, &mut planner, town, &sun, k);
        if let Some(before) = &before {
            for split in 0..SPLITS {
                compare(&mut tally, before, &now, split, &town.points);
            }
        }
        before = Some(now);
    }
    tally
}

fn drawn(world: &mut World, planner: &mut Planner, town: &Town, sun: &DirectionalLight, frame: u32) -> Frame {
    let ground = DVec3::new(130.0, 0.0, 130.0);
    let receivers = [&town.boxes[..], &[Aabb::new(town.center - ground, town.center + ground)]].concat();
    let view = town.view(frame);
    let plan = planner.plan(&view, sun, &town.boxes, &receivers).expect("a plan").clone();
    let origin = (view.eye() / ORIGIN_STEP).round() * ORIGIN_STEP;
    let options = FrameOptions { origin, ..FrameOptions::default() };
    world.draw_listed(&plan, &options, &town.triangles(origin));
    let maps = (0..SPLITS).map(|split| world.texels(split)).collect();
    Frame { plan, origin, view, maps }
}

/// The texels around every point that both frames show through this split: its own and its eight
/// neighbours, as the filters see them.
fn compare(tally: &mut Tally, before: &Frame, now: &Frame, split: usize, points: &[DVec3]) {
    let (old, new) = (&before.plan.splits[split], &now.plan.splits[split]);
    let shift = new.texels_moved_since(old).filter(|_| before.origin == now.origin);
    let Some(shift) = shift else {
        tally.stepped += 1;
        return;
    };
    tally.still += 1;
    let mut seen = vec![false; (SIZE * SIZE) as usize];
    for &point in points.iter().filter(|point| shows(before, old, **point) && shows(now, new, **point)) {
        let at = new.map_from_world(point).truncate().floor();
        for offset in (-1..=1).flat_map(|y| (-1..=1).map(move |x| DVec2::new(f64::from(x), f64::from(y)))) {
            let (here, there) = (index(at + offset), index(at + offset + shift));
            let (Some(here), Some(there)) = (here, there) else {
                tally.outside += 1;
                continue;
            };
            if !std::mem::replace(&mut seen[here], true) {
                let (a, b) = (before.maps[split][there], now.maps[split][here]);
                tally.texels += 1;
                tally.filled += usize::from(b < 1.0);
                tally.rounded += usize::from(a != b);
                tally.widest = tally.widest.max(if (a < 1.0) == (b < 1.0) { (a - b).abs() } else { 1.0 });
                tally.different += usize::from((a < 1.0) != (b < 1.0) || (a - b).abs() > ROUNDING);
            }
        }
    }
}

fn shows(frame: &Frame, split: &Split, point: DVec3) -> bool {
    let (depth, lens) = (frame.view.view_depth(point), frame.view.frustum());
    let at = frame.view.view_from_world_point(point);
    let scale = lens.scale_at(depth);
    (split.coverage.0..=split.coverage.1).contains(&depth)
        && (lens.left * scale..=lens.right * scale).contains(&at.x)
        && (lens.bottom * scale..=lens.top * scale).contains(&at.y)
}

fn index(texel: DVec2) -> Option<usize> {
    let (at, size) = (texel.as_ivec2(), SIZE as i32);
    (at.cmpge(IVec2::ZERO).all() && at.cmplt(IVec2::splat(size)).all()).then(|| (at.y * size + at.x) as usize)
}

fn world() -> Option<World> {
    Some(World::new(Gpu::new()?, &config(&[SIZE; SPLITS], PCF3, "")))
}

fn settings(stability: Stability) -> ShadowConfig {
    ShadowConfig {
        map_sizes: vec![SIZE; SPLITS],
        range: Range::Metres { near: 1.0, far: 110.0 },
        crop: Crop::SceneDependent,
        stability,
        ..Preset::Papers.config()
    }
}

#[test]
fn no_static_texel_changes_while_step_and_origin_stand() {
    let Some(mut world) = world() else { return };
    // At 100 km the path crosses a kilometre's border, so that the origin moves once.
    for place in [DVec3::ZERO, DVec3::new(7_071.3, 12.7, -7_071.1), DVec3::new(99_840.0, -31.4, 470.0)] {
        let town = Town::new(place);
        let tally = walk(&mut world, &town, &settings(Stability::Exact), FRAMES);
        eprintln!("exact at {place}: {tally:?}");
        assert_eq!((tally.different, tally.outside), (0, 0), "{tally:?} at {place}");
        assert!(tally.filled > 50_000 && tally.texels > 2_000_000, "{tally:?}");
        // A third of zoom, in and out again, is less than a step; there is the origin's.
        assert!(tally.stepped <= SPLITS, "{tally:?}");
    }
}

#[test]
fn nor_does_one_of_an_approximate_map_between_its_steps() {
    let Some(mut world) = world() else { return };
    let town = Town::new(DVec3::new(7_071.3, 12.7, -7_071.1));
    // While it turns and zooms a map takes a step of 9 % every tenth frame at most, a finer one
    // every fifth.
    for (steps, frames) in [(ExtentSteps::PerDoubling(8), 10), (ExtentSteps::default(), 5)] {
        let tally = walk(&mut world, &town, &settings(Stability::Approximate { steps }), FRAMES);
        eprintln!("approximate, {steps:?}: {tally:?}");
        assert_eq!(tally.different, 0, "{tally:?}");
        assert!(tally.filled > 50_000 && tally.texels > 2_000_000, "{tally:?}");
        assert!(frames * tally.stepped <= tally.still + tally.stepped, "{tally:?}");
    }
}

/// A sun that moves in steps leaves every map alone between two of them, and there are as many
/// steps as its way is long.
#[test]
fn between_steps_of_the_sun_no_static_texel_changes() {
    let Some(mut world) = world() else { return };
    // No kilometre's border lies on the way.
    for place in [DVec3::ZERO, DVec3::new(7_071.3, 12.7, -7_071.1), DVec3::new(70_711.3, -31.4, -70_710.9)] {
        let (tally, steps) = walk_under_stepped_sun(&mut world, &Town::new(place));
        eprintln!("stepped sun at {place}: {steps} steps, {tally:?}");
        assert_eq!(tally.different, 0, "{tally:?} at {place}");
        // 0.06 rad in steps of 0.01, each taken up to a frame late.
        assert!((4..=6).contains(&steps) && tally.texels > 500_000, "{steps} steps, {tally:?} at {place}");
    }
}

/// The texels of 150 frames, as many as go by before the zoom takes a step of its own, and the
/// steps that the sun took.
fn walk_under_stepped_sun(world: &mut World, town: &Town) -> (Tally, usize) {
    let mut planner = Planner::new(&settings(Stability::Exact)).expect("valid");
    let mut stepped = SteppedSun::new(0.01, 8.0).expect("valid");
    let (mut tally, mut steps, mut before): (Tally, usize, Option<(Frame, SunFade)>) = Default::default();
    for k in 0..150 {
        let sun = DQuat::from_rotation_z(0.0004 * f64::from(k)) * DVec3::new(0.3, -1.0, 0.2);
        let fade = stepped.follow(&DirectionalLight::new(sun).expect("a direction"), 1.0).expect("a time");
        // The maps of the sun that is left are drawn as they were before the fade, so those of the
        // other are looked at.
        let now = drawn(world, &mut planner, town, &fade.to, k);
        if let Some((before, old)) = &before {
            let taken = old.to != fade.to;
            steps += usize::from(taken);
            let mut of_pair = Tally::default();
            for split in 0..SPLITS {
                compare(&mut of_pair, before, &now, split, &town.points);
            }
            assert_eq!(of_pair.stepped, if taken { SPLITS } else { 0 }, "frame {k}: {of_pair:?}");
            (tally.texels, tally.different) = (tally.texels + of_pair.texels, tally.different + of_pair.different);
        }
        before = Some((now, fade));
    }
    (tally, steps)
}

/// The tally can say no.
#[test]
fn unstabilised_texels_change_all_the_time() {
    let Some(mut world) = world() else { return };
    let town = Town::new(DVec3::ZERO);
    let tally = walk(&mut world, &town, &settings(Stability::tight()), 20);
    assert_eq!((tally.still, tally.stepped), (0, 19 * SPLITS), "{tally:?}");
}
