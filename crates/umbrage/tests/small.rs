//! Casters whose whole shadow is under half a texel: what leaving them out changes, and what not.

use glam::DVec3;
use proptest::prelude::*;
use umbrage::config::{Crop, ExtentSteps, Preset, Selection, SplitMetric, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, ShadowPlan, Split, View};

fn config() -> impl Strategy<Value = ShadowConfig> {
    let stability = prop_oneof![
        Just(Stability::tight()),
        Just(Stability::Exact),
        Just(Stability::Approximate { steps: ExtentSteps::default() }),
    ];
    let selection = prop_oneof![Just(Selection::Interval(SplitMetric::ViewDepth)), Just(Selection::Map)];
    (1usize..=4, stability, selection, any::<bool>()).prop_map(|(splits, stability, selection, tight)| ShadowConfig {
        map_sizes: vec![64; splits],
        stability,
        selection,
        crop: if tight { Crop::SceneDependent } else { Crop::SceneIndependent },
        ..Preset::Papers.config()
    })
}

/// Boxes from a millimetre to some metres on a ground.
fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let size = || (-3.0..0.8f64).prop_map(|exponent| 10f64.powf(exponent));
    let one = ([-20.0..20.0f64, 0.0..4.0, -20.0..20.0], [size(), size(), size()])
        .prop_map(|(at, size)| Aabb::new(DVec3::from(at), DVec3::from(at) + DVec3::from(size)));
    prop::collection::vec(one, 4..60).prop_map(|mut boxes| {
        boxes.push(Aabb::new(DVec3::new(-30.0, -1.0, -30.0), DVec3::new(30.0, 0.0, 30.0)));
        boxes
    })
}

fn sun() -> impl Strategy<Value = DirectionalLight> {
    [-1.0..1.0f64, -1.0..-0.1, -1.0..1.0]
        .prop_map(|direction| DirectionalLight::new(DVec3::from(direction)).expect("a sun"))
}

/// Two frames, so that what is held counts too.
fn plans(config: &ShadowConfig, sun: &DirectionalLight, boxes: &[Aabb]) -> Vec<ShadowPlan> {
    let mut planner = Planner::new(config).expect("a config");
    let lens = Frustum::perspective(1.0, 1.5, 0.1, 200.0).expect("a lens");
    [DVec3::new(3.0, 4.0, 18.0), DVec3::new(3.2, 4.0, 17.5)]
        .map(|eye| {
            let view = View::look_at_upright(eye, DVec3::new(0.0, 0.5, 0.0), lens).expect("a view");
            planner.plan(&view, sun, boxes, boxes).expect("a plan").clone()
        })
        .into()
}

/// How many texels a box's shadow is long along either axis of a map, by its corners.
fn texels(split: &Split, bounds: &Aabb) -> [f64; 2] {
    let corners = (0..8).map(|corner| {
        let side = |bit: usize, axis: usize| if corner >> bit & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        split.map_from_world(DVec3::new(side(0, 0), side(1, 1), side(2, 2)))
    });
    let (lo, hi) =
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), corner| (lo.min(corner), hi.max(corner)));
    [hi.x - lo.x, hi.y - lo.y]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Maps lie where they lay; a list loses what is under half a texel both ways and nothing else.
    /// So a map changes in one texel for each caster that is left out, at most, and its answers
    /// within the filter's reach of those.
    #[test]
    fn lists_lose_what_is_small_and_nothing_else(config in config(), sun in sun(), boxes in boxes()) {
        let all = plans(&config, &sun, &boxes);
        let fewer = plans(&ShadowConfig { drop_small_casters: true, ..config.clone() }, &sun, &boxes);
        for (all, fewer) in all.iter().zip(&fewer) {
            prop_assert!(all.dropped_casters.iter().all(|&dropped| dropped == 0));
            prop_assert_eq!(&all.planes, &fewer.planes);
            prop_assert_eq!(all.dropped_casters.len(), all.splits.len());
            for (index, (with, without)) in all.splits.iter().zip(&fewer.splits).enumerate() {
                let mut alike = without.clone();
                alike.casters = with.casters.clone();
                prop_assert_eq!(with, &alike);
                let kept = |caster: u32| -> Result<bool, TestCaseError> {
                    let size = texels(with, &boxes[caster as usize]);
                    // A box that is just as long may go either way.
                    prop_assume!(size.iter().all(|texels| (texels - 0.5).abs() > 1e-6));
                    Ok(size.iter().any(|texels| *texels > 0.5))
                };
                let mut expected = Vec::new();
                for caster in all.casters(index) {
                    if kept(*caster)? {
                        expected.push(*caster);
                    }
                }
                prop_assert_eq!(fewer.casters(index), &expected[..], "split {}", index);
                let dropped = all.casters(index).len() - expected.len();
                prop_assert_eq!(fewer.dropped_casters[index] as usize, dropped);
            }
            let listed = |caster: u32| (0..fewer.splits.len()).any(|split| fewer.casters(split).contains(&caster));
            for (caster, range) in fewer.split_range.iter().enumerate() {
                prop_assert_eq!(range.is_some(), listed(caster as u32));
            }
        }
    }
}

/// The property above has something to look at.
#[test]
fn some_are_small_and_some_are_not() {
    let config = ShadowConfig { map_sizes: vec![64; 3], drop_small_casters: true, ..Preset::Papers.config() };
    let boxes: Vec<Aabb> = (0..40)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 8) - 4.0, 0.5, f64::from(i / 8) * 3.0 - 8.0);
            Aabb::new(at, at + DVec3::splat(if i % 2 == 0 { 0.005 } else { 1.0 }))
        })
        .collect();
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a sun");
    let plan = plans(&config, &sun, &boxes).remove(1);
    assert!(plan.dropped_casters.iter().any(|&dropped| dropped > 0), "{:?}", plan.dropped_casters);
    assert!(plan.splits.iter().any(|split| !split.casters.is_empty()));
    let large = |index: &u32| index % 2 == 1;
    assert!((0..plan.splits.len()).all(|split| plan.casters(split).iter().all(large)));
}
