//! What is held recovers while the camera stands still.

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use umbrage::config::{ExtentSteps, Preset, SplitScheme, Stability};
use umbrage::{
    Aabb, DirectionalLight, Error, Frustum, Light, Planner, PointLight, ShadowConfig, ShadowPlan, Split, View,
};

/// Frames that a recovery may take.
const FRAMES: usize = 60;

/// A town on a ground of 400 m.
fn town() -> Vec<Aabb> {
    let house = |i: i32| {
        let at = DVec3::new(f64::from(i * 37 % 400) - 200.0, 0.0, f64::from(i * 61 % 400) - 200.0);
        Aabb::new(at, at + DVec3::new(6.0, 4.0 + f64::from(i % 7), 5.0))
    };
    let ground = Aabb::new(DVec3::new(-200.0, 0.0, -200.0), DVec3::new(200.0, 0.0, 200.0));
    (0..60).map(house).chain([ground]).collect()
}

fn view(eye: DVec3, yaw: f64, fov: f64) -> View {
    let ahead = DQuat::from_rotation_y(yaw) * DVec3::new(0.0, -0.1, -1.0);
    let lens = Frustum::perspective(fov, 1.5, 0.1, 1000.0).expect("a lens");
    View::look_at_upright(eye, eye + ahead, lens).expect("a view")
}

fn sun() -> DirectionalLight {
    DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a direction")
}

/// The edge of a texel, both sides taken together.
fn texel(split: &Split) -> f64 {
    split.texel_m.element_product().sqrt()
}

/// By how much the texels of a plan exceed those of another at most, over maps with casters.
fn excess(plan: &ShadowPlan, fresh: &ShadowPlan) -> f64 {
    let pairs = plan.splits.iter().zip(&fresh.splits).filter(|(_, fresh)| !fresh.casters.is_empty());
    pairs.map(|(held, fresh)| texel(held) / texel(fresh)).fold(0.0, f64::max)
}

/// Splits whose maps do not stand still, and by what factor their texels differ at most. A map
/// without casters says nothing: other maps answer for it.
fn changes(a: &ShadowPlan, b: &ShadowPlan) -> (usize, f64) {
    let speak = |(a, b): &(&Split, &Split)| !(a.casters.is_empty() || b.casters.is_empty());
    let changed = a.splits.iter().zip(&b.splits).filter(speak).filter(|(a, b)| b.texels_moved_since(a).is_none());
    changed.fold((0, 1.0), |(count, most), (a, b)| (count + 1, either(texel(a) / texel(b)).max(most)))
}

/// A ratio as one of at least 1.
fn either(ratio: f64) -> f64 {
    ratio.max(1.0 / ratio)
}

/// The step of a recovery from one plan to another in so many frames: 9 %, or the step that takes
/// each map and plane all the way in the rounds that are left. With five planes and more, rounds
/// may go back again.
fn step(from: &ShadowPlan, to: &ShadowPlan, frames: usize) -> f64 {
    let splits = from.splits.len();
    let planes = from.planes.iter().zip(&to.planes).skip(1).map(|(from, to)| either(from / to));
    let texels = from.splits.iter().zip(&to.splits).map(|(from, to)| {
        let ratio = from.texel_m / to.texel_m;
        either(ratio.x).max(either(ratio.y))
    });
    let rounds = frames / splits / if splits >= 5 { 2 } else { 1 };
    planes.chain(texels).fold(1.0, f64::max).powf(1.0 / rounds.max(1) as f64).max(2f64.powf(0.125))
}

#[test]
fn a_walk_of_300_m_leaves_no_coarse_maps_behind() {
    let world = town();
    let mut planner = Planner::new(&Preset::Papers.config()).expect("settings");
    let mut coarse = 0.0;
    for step in 0..=150 {
        let view = view(DVec3::new(0.0, 2.0, 190.0 - 2.0 * f64::from(step)), 0.0, 1.0);
        let fresh = Planner::new(&Preset::Papers.config()).expect("settings");
        let fresh = fresh.clone().plan(&view, &sun(), &world, &world).expect("a plan").clone();
        coarse = excess(planner.plan(&view, &sun(), &world, &world).expect("a plan"), &fresh);
    }
    // The comparison must be able to say no.
    assert!(coarse > 1.5, "{coarse}");
    let last = view(DVec3::new(0.0, 2.0, 190.0 - 2.0 * 150.0), 0.0, 1.0);
    let mut before = planner.plan(&last, &sun(), &world, &world).expect("a plan").clone();
    let mut steps = 0;
    for frame in 0..FRAMES {
        let now = planner.plan(&last, &sun(), &world, &world).expect("a plan").clone();
        let (count, ratio) = changes(&before, &now);
        assert!(count <= 1 && ratio < 1.2, "frame {frame}: {count} maps change, by {ratio}");
        steps += count;
        before = now;
    }
    let fresh = Planner::new(&Preset::Papers.config()).expect("settings").plan(&last, &sun(), &world, &world).cloned();
    let left = excess(&before, &fresh.expect("a plan"));
    assert!(left <= 1.1 && steps > 4, "{left} after {steps} steps");
    // And then nothing moves any more.
    for _ in 0..FRAMES {
        assert_eq!(&before, planner.plan(&last, &sun(), &world, &world).expect("a plan"));
    }
}

/// A walk through the town and a turn, by the default: maps follow by 9 % a frame.
#[test]
fn the_default_follows_a_walk_in_steps_of_9_per_cent() {
    let walk = Walk { at: [0.0, 2.0, 150.0], yaw: 0.0, legs: vec![([0.0, 0.0, -1.4], 0.004, 0.0, 80)] };
    let (plans, fresh) = stand(&ShadowConfig::default(), &walk, FRAMES + 20).expect("plans");
    let (mut steps, mut largest) = (0, 1.0f64);
    for (frame, count, ratio) in changing(&plans) {
        assert!(count <= 1 && ratio < 1.0906, "frame {frame}: {count} maps change, by {ratio}");
        (steps, largest) = (steps + count, largest.max(ratio));
    }
    // A comparison that finds nothing says nothing.
    assert!(steps >= 3 && largest > 1.02, "{steps} steps of {largest} at most");
    assert!(excess(&plans[0], &fresh) > 1.1 && excess(&plans[FRAMES], &fresh) <= 1.1);
    assert!(plans[FRAMES..].windows(2).all(|pair| pair[0] == pair[1]), "and then they stand");
}

/// Maps that stand exactly still.
fn still() -> impl Strategy<Value = ShadowConfig> {
    let scheme = prop_oneof![
        2 => Just(SplitScheme::practical()),
        1 => Just(SplitScheme::Logarithmic),
        1 => Just(SplitScheme::Optimal),
    ];
    let of_papers = (1usize..=8, scheme).prop_map(|(m, scheme)| ShadowConfig {
        map_sizes: vec![512; m],
        scheme,
        ..Preset::Papers.config()
    });
    prop_oneof![4 => of_papers, 1 => Just(Preset::Papers.config()), 2 => Just(Preset::Still.config())]
}

/// Maps that stand almost still: by every preset that has such, and in other steps.
fn almost_still() -> impl Strategy<Value = ShadowConfig> {
    let steps = prop_oneof![
        2 => Just(None),
        1 => Just(Some(ExtentSteps::default())),
        1 => Just(Some(ExtentSteps::PerDoubling(4))),
        1 => Just(Some(ExtentSteps::Levels(64))),
    ];
    let presets = prop::sample::select(vec![Preset::Balanced, Preset::Fast, Preset::Exact, Preset::Papers]);
    (presets, steps).prop_map(|(preset, steps)| {
        let config = preset.config();
        match (steps, config.stability == Stability::Exact) {
            (Some(steps), _) => ShadowConfig { stability: Stability::Approximate { steps }, ..config },
            (None, true) => ShadowConfig { stability: Preset::Balanced.config().stability, ..config },
            (None, false) => config,
        }
    })
}

/// A walk of some legs: metres, radians, and radians of the lens a frame, and how many frames.
#[derive(Clone, Debug)]
struct Walk {
    at: [f64; 3],
    yaw: f64,
    legs: Vec<([f64; 3], f64, f64, u32)>,
}

fn walk() -> impl Strategy<Value = Walk> {
    let leg = ([-2.0..2.0f64, 0.0..0.01, -2.0..2.0], -0.05..0.05f64, -0.01..0.01f64, 5..60u32);
    ([-180.0..180.0f64, 1.0..20.0, -180.0..180.0], -3.0..3.0f64, prop::collection::vec(leg, 1..4))
        .prop_map(|(at, yaw, legs)| Walk { at, yaw, legs })
}

/// Plans along a walk and for some frames at its end: those plans, and that of a new planner there.
fn stand(config: &ShadowConfig, walk: &Walk, frames: usize) -> Result<(Vec<ShadowPlan>, ShadowPlan), Error> {
    let world = town();
    let mut planner = Planner::new(config)?;
    let (mut eye, mut yaw, mut fov) = (DVec3::from(walk.at), walk.yaw, 1.0);
    for &(step, turn, zoom, frames) in &walk.legs {
        for _ in 0..frames {
            (eye, yaw, fov) = (eye + DVec3::from(step), yaw + turn, (fov + zoom).clamp(0.3, 1.6));
            planner.plan(&view(eye, yaw, fov), &sun(), &world, &world)?;
        }
    }
    let last = view(eye, yaw, fov);
    let plan = |planner: &mut Planner| planner.plan(&last, &sun(), &world, &world).cloned();
    let plans = (0..frames).map(|_| plan(&mut planner)).collect::<Result<_, _>>()?;
    Ok((plans, plan(&mut Planner::new(config)?)?))
}

/// Frames in which a standing camera's maps change, and how many of them at once.
fn changing(plans: &[ShadowPlan]) -> impl Iterator<Item = (usize, usize, f64)> {
    plans.windows(2).enumerate().map(|(frame, pair)| {
        let (count, ratio) = changes(&pair[0], &pair[1]);
        (frame, count, ratio)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any walk, turn and zoom, then 60 frames of one view.
    #[test]
    fn still_maps_recover_one_step_of_one_split_a_frame(config in still(), walk in walk()) {
        let (plans, fresh) = stand(&config, &walk, FRAMES + 1)?;
        let mut most = 1.0f64;
        for (frame, count, ratio) in changing(&plans) {
            prop_assert!(count <= 1, "frame {}: {} maps change", frame, count);
            // Where planes had to wait, the rounds that are left take larger steps. A map may have
            // to hold more than its slice: one of 600 walks had a step of 10.4 instead of 9.1 %.
            most = most.max(1.02 * step(&plans[frame], &fresh, 50usize.saturating_sub(frame)));
            prop_assert!(ratio <= most, "frame {}: a step of {}, of {} at most", frame, ratio, most);
            // Steps are 9 %, and larger where 60 frames would not do: four maps have ten steps
            // each.
            prop_assert!(config.splits() > 4 || ratio < 2.0, "frame {}: {}", frame, ratio);
        }
        let left = excess(&plans[FRAMES], &fresh);
        prop_assert!(left <= 1.1, "{} times a fresh planner's texels, planes {:?} for {:?}", left, plans[FRAMES].planes, fresh.planes);
    }

    /// Maps that stand almost still are fitted to what their slices show, which changes at once
    /// where a plane passes something. They grow and shrink all the same, one in a frame.
    #[test]
    fn almost_still_maps_recover_one_step_of_one_split_a_frame(config in almost_still(), walk in walk()) {
        let (plans, fresh) = stand(&config, &walk, FRAMES + 20)?;
        for (frame, count, ratio) in changing(&plans) {
            prop_assert!(count <= 1, "frame {}: {} maps change", frame, count);
            // A step of 9 % is not enough within 60 frames where a map shows a wall alone that the
            // sun runs along: 2.1 was the largest one of 2,500 walks.
            prop_assert!(ratio < 4.0, "frame {}: a step of {}", frame, ratio);
        }
        let left = excess(&plans[FRAMES], &fresh);
        prop_assert!(left <= 1.1, "{} times a fresh planner's texels, planes {:?} for {:?}", left, plans[FRAMES].planes, fresh.planes);
        prop_assert!(plans[FRAMES..].windows(2).all(|pair| pair[0] == pair[1]), "it stands");
    }

    /// Without stabilisation nothing is held, so there is nothing to recover from.
    #[test]
    fn tight_maps_are_those_of_a_new_planner(walk in walk()) {
        let (plans, fresh) = stand(&Preset::Sharp.config(), &walk, 3)?;
        prop_assert!(plans.iter().all(|plan| *plan == fresh));
    }

    /// The maps of a lamp recover too.
    #[test]
    fn lamps_recover(splits in 1usize..=8, walk in 1.0..40.0f64, yaw in -3.0..3.0f64) {
        let world = town();
        let settings = ShadowConfig { map_sizes: vec![256; splits], ..Preset::Papers.config() };
        let lamp: Light = PointLight::new(DVec3::new(3.0, 12.0, 5.0), 90.0)?.into();
        let mut planner = Planner::new(&settings)?;
        let mut last = view(DVec3::Y * 3.0, yaw, 1.0);
        for step in 0..=40 {
            last = view(DVec3::new(0.025 * walk * f64::from(step), 3.0, 0.0), yaw, 1.0);
            planner.plan(&last, &lamp, &world, &world)?;
        }
        for _ in 0..FRAMES {
            planner.plan(&last, &lamp, &world, &world)?;
        }
        let plan = planner.plan(&last, &lamp, &world, &world)?.clone();
        let left = excess(&plan, Planner::new(&settings)?.plan(&last, &lamp, &world, &world)?);
        prop_assert!(left <= 1.1, "{} times a fresh planner's texels", left);
    }
}
