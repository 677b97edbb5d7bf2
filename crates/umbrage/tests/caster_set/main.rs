//! A set of casters is as good as the list of its boxes: plans are the same bit for bit, whatever
//! was done to it before.

mod model;

use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::config::{Crop, ExtentSteps, Preset, Range, Selection, SplitMetric, SplitScheme, Stability};
use umbrage::{
    Aabb, Caster, CasterSet, DirectionalLight, Error, Frustum, Layers, Light, Motion, PlanInputs, Planner,
    PlannerOptions, PointLight, ShadowConfig, ShadowPlan, SpotLight, View, Warp,
};

use model::*;

/// The boxes of a set in the order of their keys, and those keys: casters or receivers.
fn list(set: &CasterSet, layers: Layers, is_asked: impl Fn(&Caster) -> bool) -> (Vec<u32>, Vec<Aabb>) {
    let mut list: Vec<Caster> = set.iter().map(|(_, caster)| caster).collect();
    list.retain(|caster| caster.layers.meets(layers) && is_asked(caster));
    list.sort_by_key(|caster| caster.key);
    list.iter().map(|caster| (caster.key, caster.bounds)).unzip()
}

/// The plan of a list with the keys of a set.
fn renamed(plan: &ShadowPlan, keys: &[u32]) -> ShadowPlan {
    let mut renamed = plan.clone();
    renamed.caster_indices.iter_mut().for_each(|index| *index = keys[*index as usize]);
    renamed.split_range.clear();
    renamed
}

/// A technique: a config and what a device says.
type Technique = (ShadowConfig, PlannerOptions);

fn planner((config, options): &Technique) -> Planner {
    Planner::with_options(config, *options).expect("valid")
}

/// Plans frames by a set and by lists; says whether any had a caster.
fn compare(technique: &Technique, set: &CasterSet, layers: Layers, views: &[View], light: Light) -> bool {
    let (keys, casters) = list(set, layers, |caster| caster.casts);
    let (_, receivers) = list(set, layers, |caster| caster.receives);
    let [mut by_set, mut by_list] = [(); 2].map(|()| planner(technique));
    let mut any = false;
    for view in views {
        let of_set = PlanInputs { layers, ..PlanInputs::new(view, light, set, set) };
        let of_list = by_list.plan_frame(&PlanInputs::new(view, light, &casters, &receivers));
        let of_set = by_set.plan_frame(&of_set);
        match (of_set, of_list) {
            (Ok(of_set), Ok(of_list)) => {
                assert_eq!(*of_set, renamed(of_list, &keys));
                any |= !of_set.caster_indices.is_empty();
            }
            (of_set, of_list) => assert_eq!(of_set.err(), of_list.err()),
        }
    }
    any
}

fn techniques() -> impl Strategy<Value = Technique> {
    let scheme =
        prop_oneof![Just(SplitScheme::Logarithmic), Just(SplitScheme::Optimal), Just(SplitScheme::practical())];
    let stability = prop_oneof![
        Just(Stability::tight()),
        Just(Stability::Tight { warps: vec![Warp::Lispsm] }),
        Just(Stability::Tight { warps: vec![Warp::Tsm { focus: 0.3 }] }),
        Just(Stability::Exact),
        Just(Stability::Approximate { steps: ExtentSteps::default() }),
    ];
    let range = prop_oneof![2 => Just(Range::Camera), 1 => Just(Range::Visible), 1 => Just(Range::Metres { near: 0.5, far: 90.0 })];
    (1usize..=5, scheme, stability, range, any::<[bool; 3]>()).prop_map(
        |(m, scheme, stability, range, [is_dependent, by_map, depth_clamp])| {
            let has_warps = matches!(&stability, Stability::Tight { warps } if !warps.is_empty());
            let by_map = by_map && !has_warps;
            let config = ShadowConfig {
                map_sizes: vec![256; m],
                scheme,
                range,
                stability,
                crop: if is_dependent { Crop::SceneDependent } else { Crop::SceneIndependent },
                selection: if by_map { Selection::Map } else { Selection::Interval(SplitMetric::ViewDepth) },
                ..Preset::Papers.config()
            };
            (config, PlannerOptions { depth_clamp, ..PlannerOptions::default() })
        },
    )
}

/// Some frames of a camera about a place: one that walks, turns, stands, and looks along the light.
fn views(at: DVec3, along: DVec3) -> impl Strategy<Value = Vec<View>> {
    let eye = [-50.0..50.0f64, 0.5..20.0, -50.0..50.0].prop_map(move |eye| at + DVec3::from(eye));
    let far = prop_oneof![Just(f64::INFINITY), 60.0..2000.0f64];
    let steps = prop::collection::vec((prop_oneof![Just(0.0), 0.1..4.0f64], -0.5..0.5f64), 0..4);
    (eye, 0.0..std::f64::consts::TAU, -0.6..0.4f64, 0.3..1.8f64, far, steps, prop::bool::weighted(0.15)).prop_map(
        move |(mut eye, mut turn, tilt, fov, far, steps, is_along)| {
            let lens = Frustum::perspective(fov, 1.4, 0.1, far).expect("a lens");
            let mut views = Vec::new();
            for (step, by) in [(0.0, 0.0)].into_iter().chain(steps) {
                turn += by;
                let ahead = match is_along {
                    true => along,
                    false => DQuat::from_euler(EulerRot::YXZ, turn, tilt, 0.0) * DVec3::NEG_Z,
                };
                eye += DVec3::new(ahead.x, 0.0, ahead.z) * step;
                let up = if ahead.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
                views.push(View::look_at(eye, eye + ahead, up, lens).expect("a view"));
            }
            views
        },
    )
}

fn sun() -> impl Strategy<Value = DVec3> {
    let direction = [-1.0..1.0f64, -1.0..-0.05, -1.0..1.0].prop_map(|it| DVec3::from(it).normalize());
    prop_oneof![6 => direction, 1 => Just(DVec3::NEG_Y), 1 => Just(DVec3::new(0.0, -1e-7, 1.0).normalize())]
}

/// Where worlds lie: 100 km from the origin as well as there.
fn place() -> impl Strategy<Value = DVec3> {
    prop_oneof![2 => Just(DVec3::ZERO), 1 => Just(DVec3::new(1e5 + 0.3, -2.0, -7e4)), 1 => Just(DVec3::new(3e6, 0.1, 1e6))]
}

type World = (DVec3, Vec<Edit>, Technique, Vec<View>, DVec3, Layers);

fn world() -> impl Strategy<Value = World> {
    let layers = prop_oneof![3 => Just(Layers::ALL), 1 => any::<u32>().prop_map(Layers::from_bits)];
    (place(), sun()).prop_flat_map(move |(at, sun)| {
        let edits = prop::collection::vec(edit(at), 1..40);
        (Just(at), edits, techniques(), views(at, sun), Just(sun), layers.clone())
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn a_plan_of_a_set_is_that_of_the_list_of_its_boxes((_, edits, technique, views, sun, layers) in world()) {
        let mut tracked = Tracked::default();
        edits.iter().for_each(|edit| tracked.apply(edit));
        tracked.check();
        let sun = DirectionalLight::new(sun).expect("a direction");
        compare(&technique, &tracked.set, layers, &views, sun.into());
    }

    #[test]
    fn so_is_that_of_a_lamp((at, edits, technique, views, axis, layers) in world(), range in 1.0..200.0f64) {
        let mut tracked = Tracked::default();
        edits.iter().for_each(|edit| tracked.apply(edit));
        let (config, options) = technique;
        let is_warped = matches!(config.stability, Stability::Tight { .. });
        let technique = (ShadowConfig {
            scheme: SplitScheme::Logarithmic,
            selection: Selection::Interval(SplitMetric::ViewDepth),
            range: Range::Camera,
            stability: if is_warped { Stability::tight() } else { config.stability },
            ..config
        }, options);
        let lamp = at + DVec3::new(3.0, 6.0, 1.0);
        let lights: [Light; 2] = [
            PointLight::new(lamp, range).expect("a lamp").into(),
            SpotLight::new(lamp, axis, 0.7, range).expect("a lamp").into(),
        ];
        for light in lights {
            compare(&technique, &tracked.set, layers, &views, light);
        }
    }

    #[test]
    fn edits_between_frames_are_seen((_, edits, technique, views, sun, layers) in world()) {
        let mut tracked = Tracked::default();
        let sun = DirectionalLight::new(sun).expect("a direction");
        let [mut by_set, mut by_list] = [(); 2].map(|()| planner(&technique));
        for (frame, edit) in edits.iter().enumerate() {
            tracked.apply(edit);
            let view = &views[frame / 3 % views.len()];
            let (keys, casters) = list(&tracked.set, layers, |caster| caster.casts);
            let (_, receivers) = list(&tracked.set, layers, |caster| caster.receives);
            let inputs = PlanInputs { layers, ..PlanInputs::new(view, sun, &tracked.set, &tracked.set) };
            let of_list = by_list.plan_frame(&PlanInputs::new(view, sun, &casters, &receivers));
            match (by_set.plan_frame(&inputs), of_list) {
                (Ok(of_set), Ok(of_list)) => prop_assert_eq!(of_set, &renamed(of_list, &keys)),
                (of_set, of_list) => prop_assert_eq!(of_set.err(), of_list.err()),
            }
        }
    }
}

/// A wood: `count` trees, `per_km2` to the square kilometre, and a mover for every hundred.
fn wood(count: u32, per_km2: f64) -> impl Iterator<Item = Caster> {
    let edge = 1000.0 * (f64::from(count) / per_km2).sqrt();
    (0..count).map(move |i| {
        let (x, z) = ((f64::from(i) * 0.754_877_666_2).fract(), (f64::from(i) * 0.569_840_290_998).fract());
        let (at, size) = (DVec3::new(edge * x, 0.1, edge * z), 3.0 + f64::from(i % 7));
        let motion = if i % 100 == 0 { Motion::Moving } else { Motion::Static };
        Caster { motion, ..Caster::new(Aabb::new(at, at + DVec3::new(size, 2.0 * size, size)), i) }
    })
}

fn walk(edge: f64, frames: u32) -> Vec<View> {
    let lens = Frustum::perspective(1.0, 1.5, 0.1, 800.0).expect("a lens");
    let view = |i: u32| {
        let (turn, eye) = (0.1 * f64::from(i), DVec3::new(0.5 * edge, 8.0, 0.4 * edge + 3.0 * f64::from(i)));
        View::look_at_upright(eye, eye + DVec3::new(turn.cos(), -0.1, turn.sin()), lens).expect("a view")
    };
    (0..frames).map(view).collect()
}

#[test]
fn thousands_in_several_runs_are_planned_like_their_list() {
    let mut set = CasterSet::new();
    set.insert_all(wood(40_000, 10_000.0)).expect("valid");
    let ground = Aabb::new(DVec3::new(-500.0, 0.0, -500.0), DVec3::new(3000.0, 0.0, 3000.0));
    set.insert(Caster::new(ground, 40_000)).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("a sun");
    let approximate = Stability::Approximate { steps: ExtentSteps::default() };
    for stability in [Stability::tight(), Stability::Exact, approximate] {
        for scheme in [SplitScheme::Logarithmic, SplitScheme::Optimal] {
            let config = ShadowConfig {
                crop: Crop::SceneDependent,
                scheme,
                stability: stability.clone(),
                ..Preset::Papers.config()
            };
            let technique = (config, PlannerOptions::default());
            assert!(compare(&technique, &set, Layers::ALL, &walk(2000.0, 4), sun.into()), "something casts");
        }
    }
    let technique = (ShadowConfig::default(), PlannerOptions::default());
    assert!(compare(&technique, &set, Layers::ALL, &walk(2000.0, 4), sun.into()), "something casts");
}

#[test]
fn a_set_that_misses_a_caster_is_found_out() {
    let mut set = CasterSet::new();
    let handles = set.insert_all(wood(2000, 10_000.0)).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("a sun");
    let settings = Preset::Papers.config();
    let (keys, casters) = list(&set, Layers::ALL, |_| true);
    let view = &walk(450.0, 1)[0];
    let of_list = Planner::new(&settings).expect("valid").plan(view, &sun, &casters, &casters).expect("valid").clone();
    let drawn = *of_list.caster_indices.first().expect("something casts");
    set.remove(handles[drawn as usize]).expect("there");
    let mut planner = Planner::new(&settings).expect("valid");
    assert_ne!(*planner.plan(view, &sun, &set, &set).expect("valid"), renamed(&of_list, &keys));
}

#[test]
fn a_static_caster_takes_32_bytes() {
    for (count, per_km2) in [(100_000, 10_000.0), (100_000, 1000.0), (60_000, 100.0)] {
        let mut set = CasterSet::new();
        set.insert_all(wood(count, per_km2).map(|it| Caster { motion: Motion::Static, ..it })).expect("valid");
        let each = set.memory() as f64 / f64::from(count);
        assert!(each <= 32.0, "{each} B at {per_km2} to the square kilometre");
        // One by one they are packed in batches.
        let mut slowly = CasterSet::new();
        for caster in wood(count, per_km2) {
            slowly.insert(Caster { motion: Motion::Static, ..caster }).expect("valid");
        }
        slowly.pack();
        let each = slowly.memory() as f64 / f64::from(count);
        assert!(each <= 40.0, "{each} B, added one by one");
        assert_eq!(slowly.len(), set.len());
    }
}

#[test]
fn what_a_plan_looks_at_follows_from_what_is_in_view() {
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("a sun");
    let settings = ShadowConfig { range: Range::Metres { near: 0.5, far: 300.0 }, ..Preset::Papers.config() };
    let visited = |count: u32| {
        let mut set = CasterSet::new();
        set.insert_all(wood(count, 10_000.0)).expect("valid");
        let edge = 1000.0 * (f64::from(count) / 10_000.0).sqrt();
        let mut planner = Planner::new(&settings).expect("valid");
        for view in walk(edge, 3) {
            planner.plan(&view, &sun, &set, &set).expect("valid");
        }
        let visited = planner.visited();
        (visited.nodes + visited.boxes) as f64
    };
    let (few, many) = (visited(60_000), visited(240_000));
    assert!(many < 1.5 * few, "{few} nodes and boxes of 60,000, {many} of 240,000");
    assert!(many < 24_000.0, "{many} nodes and boxes of 240,000");
}

#[test]
fn a_box_that_is_none_is_named_and_harms_nobody() {
    let mut set = CasterSet::new();
    let handles = set.insert_all(wood(1000, 10_000.0)).expect("valid");
    let (before, revision) = (set.iter().collect::<Vec<_>>(), set.clone());
    let nan = Aabb::new(DVec3::splat(f64::NAN), DVec3::ONE);
    let error = set.set_bounds(handles[7], nan).expect_err("NaN");
    assert!(
        matches!(error, Error::InvalidCaster { handle: Some(handle), key: 7, .. } if handle == handles[7]),
        "{error}"
    );
    let text = error.to_string();
    assert!(text.contains(&handles[7].to_string()) && text.contains("key 7"), "{text}");
    for bad in [nan, Aabb::EMPTY, Aabb::new(DVec3::ZERO, DVec3::splat(1e13))] {
        assert!(matches!(set.insert(Caster::new(bad, 1)), Err(Error::InvalidCaster { handle: None, key: 1, .. })));
        let replaced = set.replace(handles[0], Caster::new(bad, 1));
        assert!(matches!(replaced, Err(Error::InvalidCaster { handle: Some(_), .. })));
        let some = wood(3, 10_000.0).chain([Caster::new(bad, 5)]);
        assert!(matches!(set.insert_all(some), Err(Error::InvalidCaster { key: 5, .. })));
    }
    assert_eq!(set.iter().collect::<Vec<_>>(), before);
    assert_eq!(set.len(), revision.len());
}

#[test]
fn a_removed_handle_is_refused_by_everything() {
    let mut set = CasterSet::new();
    let caster = Caster::new(Aabb::new(DVec3::ZERO, DVec3::ONE), 3);
    let gone = set.insert(caster).expect("valid");
    set.remove(gone).expect("there");
    let other = set.insert(caster).expect("valid");
    assert_ne!(gone, other);
    let refused = Err(Error::RemovedCaster { handle: gone });
    assert_eq!(set.remove(gone), refused);
    assert_eq!(set.set_bounds(gone, caster.bounds), refused);
    assert_eq!(set.replace(gone, caster), refused);
    assert_eq!(set.set_motion(gone, Motion::Moving), refused);
    assert_eq!(set.bounds(gone).map(|_| ()), refused);
    assert!(!set.contains(gone) && set.contains(other));
    set.clear();
    assert!(set.is_empty() && !set.contains(other));
}

#[test]
fn layers_are_counted_from_0_to_31() {
    assert_eq!(Layers::one(31).map(Layers::bits), Ok(1 << 31));
    for layer in [32, 33, 64, u32::MAX] {
        assert_eq!(Layers::one(layer), Err(Error::NoSuchLayer { layer }));
    }
    assert!(!Layers::NONE.meets(Layers::ALL));
    assert_eq!((Layers::default() | Layers::from_bits(6)).bits(), 7);
}

#[test]
fn casters_that_share_a_key_are_drawn_once() {
    let mut set = CasterSet::new();
    let at = |x: f64| Aabb::new(DVec3::new(x, 0.0, 5.0), DVec3::new(x + 1.0, 2.0, 6.0));
    for (x, key) in [(0.0, 9), (2.0, 4), (4.0, 9)] {
        set.insert(Caster::new(at(x), key)).expect("valid");
    }
    set.insert(Caster::new(Aabb::new(DVec3::new(-50.0, 0.0, -50.0), DVec3::new(50.0, 0.0, 50.0)), 0)).expect("valid");
    let lens = Frustum::perspective(1.0, 1.5, 0.1, 100.0).expect("a lens");
    let view = View::look_at_upright(DVec3::new(2.0, 3.0, -4.0), DVec3::new(2.0, 1.0, 5.0), lens).expect("a view");
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a sun");
    let settings = ShadowConfig { map_sizes: vec![512], ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("valid");
    assert_eq!(planner.plan(&view, &sun, &set, &set).expect("valid").casters(0), [4, 9]);
}

#[test]
fn a_frame_in_which_nothing_changes_looks_at_nothing() {
    let mut set = CasterSet::new();
    let handles = set.insert_all(wood(3000, 10_000.0)).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("a sun");
    let views = walk(540.0, 2);
    for config in [ShadowConfig::default(), Preset::Papers.config()] {
        let mut planner = Planner::new(&config).expect("valid");
        // What is held recovers for a second.
        for _ in 0..70 {
            planner.plan(&views[0], &sun, &set, &set).expect("valid");
        }
        assert_eq!(planner.visited(), umbrage::Visited::default());
        let before = planner.plan(&views[0], &sun, &set, &set).expect("valid").clone();
        let mut fresh = Planner::new(&config).expect("valid");
        fresh.set_held(planner.held().clone());
        assert_eq!(*fresh.plan(&views[0], &sun, &set, &set).expect("valid"), before);
        // Whatever changes is looked at.
        planner.plan(&views[1], &sun, &set, &set).expect("valid");
        assert_ne!(planner.visited(), umbrage::Visited::default());
        planner.plan(&views[0], &sun, &set, &set).expect("valid");
        set.set_bounds(handles[5], Aabb::new(DVec3::ZERO, DVec3::ONE)).expect("there");
        planner.plan(&views[0], &sun, &set, &set).expect("valid");
        assert_ne!(planner.visited(), umbrage::Visited::default());
    }
}

#[test]
fn steady_frames_with_movers_allocate_nothing() {
    let mut set = CasterSet::new();
    let casters: Vec<Caster> = wood(20_000, 10_000.0).collect();
    let handles = set.insert_all(casters.iter().copied()).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("a sun");
    let views = walk(1400.0, 40);
    for config in [ShadowConfig::default(), Preset::Papers.config()] {
        let mut planner = Planner::new(&config).expect("valid");
        let mut frame = |set: &mut CasterSet, i: usize| {
            let by = DVec3::X * (0.1 * (i as f64).sin());
            for (caster, &handle) in casters.iter().zip(&handles).filter(|(it, _)| it.motion == Motion::Moving) {
                let Aabb { min, max } = caster.bounds;
                set.set_bounds(handle, Aabb::new(min + by, max + by)).expect("there");
            }
            planner.plan(&views[i], &sun, &*set, &*set).expect("valid");
        };
        (0..40).for_each(|i| frame(&mut set, i));
        let again = allocation_counter::measure(|| (0..40).for_each(|i| frame(&mut set, i)));
        assert_eq!(again.count_total, 0, "{again:?}");
    }
}
