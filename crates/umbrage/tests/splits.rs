//! Split planes against 50-digit vectors, and what they must refuse.

use proptest::prelude::*;
use umbrage::config::SplitScheme;
use umbrage::{Error, split_planes};

fn planes(scheme: &SplitScheme, near: f64, far: f64, m: usize) -> umbrage::Result<Vec<f64>> {
    let mut planes = Vec::new();
    split_planes(scheme, near, far, m, &mut planes).map(|()| planes)
}

fn practical(lambda: f64) -> SplitScheme {
    SplitScheme::Practical { lambda, delta: vec![] }
}

#[test]
fn vectors() {
    let vectors: serde_json::Value =
        serde_json::from_str(include_str!("data/splits.json")).expect("the vectors are JSON");
    let cases = vectors["cases"].as_array().expect("the vectors hold cases");
    assert!(cases.len() > 20, "only {} vectors", cases.len());
    for case in cases {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let expected: Vec<f64> =
            case["planes"].as_array().expect("planes").iter().map(|p| p.as_f64().expect("a plane")).collect();
        let m = number("splits") as usize;
        let got = planes(&practical(number("lambda")), number("near"), number("far"), m).expect("valid input");
        assert_eq!(got.len(), m + 1);
        for (got, expected) in got.iter().zip(&expected) {
            // powf is good to an ulp or two; sums and products add as much again.
            assert!((got - expected).abs() <= 8.0 * f64::EPSILON * expected, "{got} is not {expected} in {case}");
        }
    }
}

#[test]
fn delta_moves_inner_planes_only() {
    let plain = planes(&practical(0.5), 1.0, 800.0, 4).expect("valid");
    let one = SplitScheme::Practical { lambda: 0.5, delta: vec![3.0] };
    let each = SplitScheme::Practical { lambda: 0.5, delta: vec![1.0, -2.0, 3.0] };
    let moved = |scheme| planes(scheme, 1.0, 800.0, 4).expect("valid");
    assert_eq!(moved(&one), [plain[0], plain[1] + 3.0, plain[2] + 3.0, plain[3] + 3.0, plain[4]]);
    assert_eq!(moved(&each), [plain[0], plain[1] + 1.0, plain[2] - 2.0, plain[3] + 3.0, plain[4]]);
}

#[test]
fn planes_that_do_not_rise_are_refused() {
    let delta = SplitScheme::Practical { lambda: 0.5, delta: vec![900.0] };
    let manual = SplitScheme::Manual { planes: vec![10.0, 5.0, 100.0] };
    let beyond = SplitScheme::Manual { planes: vec![10.0, 50.0, 801.0] };
    for (scheme, field) in [(delta, "delta"), (manual, "planes"), (beyond, "planes")] {
        let error = planes(&scheme, 1.0, 800.0, 4).expect_err("these planes do not rise");
        assert!(matches!(error, Error::InvalidSetting { field: f, .. } if f == field), "{error}");
    }
    for (near, far) in
        [(1.0, 1.0), (2.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (1.0, f64::INFINITY), (f64::NAN, 1.0), (1.0, f64::NAN)]
    {
        let error = planes(&SplitScheme::Uniform, near, far, 2).expect_err("not a range");
        assert!(matches!(error, Error::InvalidSetting { field: "shadow-range", .. }), "{error}");
    }
}

proptest! {
    #[test]
    fn practical_lies_between_the_two(near in 1e-3..10.0f64, ratio in 1.001..1e6f64, m in 1usize..=8, lambda in 0.0..=1.0f64) {
        let far = near * ratio;
        let uniform = planes(&SplitScheme::Uniform, near, far, m)?;
        let logarithmic = planes(&SplitScheme::Logarithmic, near, far, m)?;
        let both = planes(&practical(lambda), near, far, m)?;
        prop_assert_eq!(both[0], near);
        prop_assert_eq!(both[m], far);
        for i in 0..=m {
            let room = 1e-12 * far;
            prop_assert!(logarithmic[i] - room <= both[i] && both[i] <= uniform[i] + room);
        }
    }
}
