//! A config for a budget: never above it, never worse for more.

use proptest::prelude::*;
use umbrage::config::{Budget, Filter, Preset};
use umbrage::glam::DVec3;
use umbrage::{Aabb, DirectionalLight, Error, Frustum, Planner, ShadowConfig, View};

/// Bytes of a texel of the balanced preset.
const TEXEL: u64 = 4;

fn bytes(config: &ShadowConfig) -> u64 {
    TEXEL * config.texels()
}

/// The texel of the first split, metres: boxes on a plain, seen from 2 m above it.
fn first_texel(config: &ShadowConfig) -> f64 {
    let lens = Frustum::perspective(60_f64.to_radians(), 4.0 / 3.0, 0.5, 1000.0).expect("a lens");
    let view = View::look_at_upright(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 1.0, -20.0), lens).expect("a view");
    let sun = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a sun");
    let boxes: Vec<Aabb> = (1..200)
        .map(|i| {
            let foot = DVec3::new(f64::from(i % 7) - 3.0, 0.0, -2.0 * f64::from(i));
            Aabb::new(foot, foot + DVec3::new(1.0, 3.0, 1.0))
        })
        .chain([Aabb::new(DVec3::new(-500.0, -1.0, -500.0), DVec3::new(500.0, 0.0, 500.0))])
        .collect();
    let mut planner = Planner::new(config).expect("a planner");
    let plan = planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
    plan.splits[0].texel_size_m(DVec3::new(0.0, 0.0, -2.0)).max_element()
}

proptest! {
    #[test]
    fn any_budget_is_a_valid_config_within_it_or_too_small(bytes_of in prop_oneof![1_u64..4096, 1_u64..1 << 24, 1_u64..1 << 50]) {
        for budget in [Budget::Bytes(bytes_of), Budget::Texels(bytes_of)] {
            match ShadowConfig::for_budget(budget) {
                Ok(config) => {
                    prop_assert_eq!(config.validate(), Ok(()));
                    prop_assert!(config.texels() <= budget.texels(TEXEL));
                }
                Err(Error::BudgetTooSmall { budget: named, least }) => {
                    prop_assert_eq!(named, budget);
                    prop_assert!(least.texels(TEXEL) > budget.texels(TEXEL));
                    prop_assert!(ShadowConfig::for_budget(least).is_ok(), "the least is enough");
                }
                Err(other) => prop_assert!(false, "{other}"),
            }
        }
    }

    #[test]
    fn more_budget_is_never_fewer_texels(less in 64_u64..1 << 26, more in 0_u64..1 << 20) {
        if let Ok(small) = ShadowConfig::for_budget(Budget::Texels(less)) {
            let large = ShadowConfig::for_budget(Budget::Texels(less + more)).expect("more is enough");
            prop_assert!(large.texels() >= small.texels(), "{:?} {:?}", small.map_sizes, large.map_sizes);
        }
    }

    #[test]
    fn every_budget_is_read_as_it_is_written(amount in 1_u64..1 << 52) {
        for budget in [Budget::Bytes(amount), Budget::Texels(amount)] {
            prop_assert_eq!(budget.to_string().parse(), Ok(budget));
        }
    }
}

#[test]
fn texels_grow_at_every_change_of_the_number_of_splits() {
    let mut before = ShadowConfig::for_budget(Budget::Texels(64)).expect("the least");
    for texels in (64..1 << 20).step_by(64).chain((1 << 20..1 << 24).step_by(4096)) {
        let config = ShadowConfig::for_budget(Budget::Texels(texels)).expect("enough");
        assert!(config.texels() >= before.texels(), "{texels}: {:?} after {:?}", config.map_sizes, before.map_sizes);
        assert!(config.splits() >= before.splits(), "{texels}");
        before = config;
    }
}

#[test]
fn more_budget_is_never_a_larger_first_texel() {
    let texels = |mib: f64| {
        first_texel(&ShadowConfig::for_budget(Budget::Bytes((mib * f64::from(1 << 20)) as u64)).expect("enough"))
    };
    let ladder: Vec<f64> = (-6..=40).map(|step| 2_f64.powf(f64::from(step) / 4.0)).map(texels).collect();
    assert!(ladder.windows(2).all(|pair| pair[1] <= pair[0]), "{ladder:?}");
    assert!(ladder[0] > 10.0 * ladder[ladder.len() - 1], "the comparison can say no: {ladder:?}");
}

#[test]
fn sixteen_mebibytes_are_balanced() {
    assert_eq!(ShadowConfig::for_budget(Budget::Bytes(16 << 20)), Ok(Preset::Balanced.config()));
}

#[test]
fn budgets_are_read_and_bad_ones_say_why() {
    for (text, budget) in [
        ("8MB", Budget::Bytes(8_000_000)),
        ("8 MiB", Budget::Bytes(8 << 20)),
        (" 1.5MiB ", Budget::Bytes(3 << 19)),
        ("512kB", Budget::Bytes(512_000)),
        ("2Mtexel", Budget::Texels(2 << 20)),
        ("4096texel", Budget::Texels(4096)),
    ] {
        assert_eq!(text.parse(), Ok(budget), "{text}");
    }
    for (text, culprit) in [
        ("8", "no unit"),
        ("", "no unit"),
        ("8XB", "\"XB\""),
        ("MiB", "not a number"),
        ("-1MiB", "8 PiB"),
        ("0MB", "8 PiB"),
        ("1e30MB", "unit"),
        ("infB", "unit"),
        ("0.2B", "8 PiB"),
    ] {
        let error = text.parse::<Budget>().expect_err(text);
        assert!(matches!(error, Error::InvalidBudget { .. }) && error.to_string().contains(culprit), "{text}: {error}");
    }
    let small = ShadowConfig::for_budget(Budget::Bytes(255)).expect_err("too small").to_string();
    assert!(small.contains("255 B") && small.contains("256 B"), "{small}");
    assert!(bytes(&ShadowConfig::for_budget(Budget::Bytes(256)).expect("one map of 8 by 8")) == 256);
    assert_eq!(Budget::least_edge(&Filter::Pcf2, true), 8);
}
