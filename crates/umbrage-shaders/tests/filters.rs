//! The filters' weights, by property; `umbrage-wgpu` runs the same functions on a GPU and compares.

use proptest::prelude::*;
use umbrage_shaders::twin::{DISC_RADIUS, MOST_BLOCKER_M, gradient_noise, half_width, tent_integral, tent_tap, vogel};

/// A sample's place, biased to texel edges and centres.
fn place() -> impl Strategy<Value = f32> {
    prop_oneof![
        0.0f32..1024.0,
        (0u32..2048).prop_map(|half| half as f32 / 2.0),
        (0u32..64).prop_map(|k| 8.0 + k as f32 / 64.0)
    ]
}

/// The weight that a tent's taps give to each texel from `first` on, as a linear sampler spreads
/// them.
fn texel_weights(centre: f32, r: f32, taps: usize) -> (f32, Vec<f32>) {
    let first = (centre - r).floor();
    let mut weights = vec![0.0; 2 * taps];
    for tap in 0..taps {
        let (at, weight) = tent_tap(first + 2.0 * tap as f32, centre, r);
        let second = at - (first + 2.0 * tap as f32 + 0.5);
        assert!((-1e-4..=1.0001).contains(&second), "the tap at {at} leaves its pair of texels");
        weights[2 * tap] += weight * (1.0 - second);
        weights[2 * tap + 1] += weight * second;
    }
    (first, weights)
}

/// Integral of a tent of half width `r` around `centre` over `[a, b]`, by the midpoint rule in f64.
fn tent_over(centre: f64, r: f64, a: f64, b: f64) -> f64 {
    let steps = 4096;
    let width = (b - a) / f64::from(steps);
    (0..steps).map(|i| (1.0 - ((a + (f64::from(i) + 0.5) * width - centre) / r).abs()).max(0.0) / r * width).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn taps_give_each_texel_the_tent_over_it((r, taps) in prop_oneof![
            Just((1.5, 2)),
            Just((2.5, 3)),
            Just((3.5, 4)),
            // Made narrower by a width in metres: some taps have nothing left.
            (1.0f32..=1.5).prop_map(|r| (r, 2)),
            (1.0f32..=2.5).prop_map(|r| (r, 3)),
            (1.0f32..=3.5).prop_map(|r| (r, 4)),
        ], centre in place()) {
        let (first, weights) = texel_weights(centre, r, taps);
        // f32 holds a place near 1000 to 6e-5 of a texel, and a tent's integral is no steeper than
        // 1/r.
        let tolerance = 3e-4;
        prop_assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{weights:?} do not sum to 1");
        for (k, &weight) in weights.iter().enumerate() {
            let left = f64::from(first) + k as f64;
            let exact = tent_over(f64::from(centre), f64::from(r), left, left + 1.0);
            prop_assert!((f64::from(weight) - exact).abs() < tolerance, "texel {k} weighs {weight}, exactly {exact}");
        }
        // What the taps do not touch lies outside the tent.
        prop_assert!(first <= centre - r && first + weights.len() as f32 >= centre + r);
    }

    #[test]
    fn tent_integral_rises_from_0_to_1(r in 0.5f32..4.0, x in -5.0f32..5.0, step in 0.0f32..1.0) {
        prop_assert!(tent_integral(x, r) <= tent_integral(x + step, r) + 1e-6);
        prop_assert!((tent_integral(x, r) + tent_integral(-x, r) - 1.0).abs() < 1e-6);
        prop_assert_eq!(tent_integral(-r - step, r), 0.0);
        prop_assert_eq!(tent_integral(r + step, r), 1.0);
    }
}

#[test]
fn a_centred_tent_of_three_weighs_two_five_two_ninths() {
    // ∫ (1 − x/1.5)/1.5 from 0.5 to 1.5 = (1 − 1/3)²/2 = 2/9; the middle has the rest.
    let (_, weights) = texel_weights(10.5, 1.5, 2);
    for (weight, exact) in weights.iter().zip([2.0 / 9.0, 5.0 / 9.0, 2.0 / 9.0, 0.0]) {
        assert!((weight - exact).abs() < 1e-6, "{weights:?}");
    }
}

#[test]
fn a_disc_stands_evenly_around_its_middle() {
    for turn in [0.0, 1.0, -2.5] {
        let points: Vec<[f32; 2]> = (0..32).map(|i| vogel(i, 32, turn)).collect();
        let mean = |of: fn(&[f32; 2]) -> f32| points.iter().map(of).sum::<f32>() / 32.0;
        assert!(points.iter().all(|p| p[0].hypot(p[1]) <= 1.0));
        assert!(mean(|p| p[0]).abs() < 0.03 && mean(|p| p[1]).abs() < 0.03);
        // A disc's variance per axis is a quarter of its radius squared.
        assert!((mean(|p| p[0] * p[0]) - 0.25).abs() < 0.03 && (mean(|p| p[1] * p[1]) - 0.25).abs() < 0.03);
    }
}

#[test]
fn widths_become_texels_within_their_limits() {
    assert_eq!(half_width(0.0, 0.1, 2.5, 2.5), 2.5);
    assert_eq!(half_width(0.0, 0.1, 3.0, 2.0), 2.0, "nor in a map that keeps less free");
    assert_eq!(half_width(0.4, 0.1, 2.5, 15.0), 2.0);
    assert_eq!(half_width(0.4, 1.0, 2.5, 15.0), 1.0, "never less than a texel");
    assert_eq!(half_width(40.0, 0.1, 2.5, 15.0), 15.0, "never more than the taps reach");
}

/// Rust plans with the numbers that WGSL filters with.
#[test]
fn constants_agree() {
    let text = umbrage_shaders::receiver(0, umbrage_shaders::Maps::default());
    for (name, value) in [("MOST_BLOCKER_M", MOST_BLOCKER_M), ("DISC_RADIUS", DISC_RADIUS)] {
        let declared = format!("const UMBRAGE_KERNEL_{name}: f32 = {value:?};");
        assert!(text.contains(&declared), "{declared} is not in the text");
    }
}

#[test]
fn noise_is_even() {
    let noise: Vec<f32> =
        (0..64).flat_map(|y| (0..64).map(move |x| gradient_noise([x as f32 + 0.5, y as f32 + 0.5]))).collect();
    assert!(noise.iter().all(|n| (0.0..1.0).contains(n)));
    for share in [0.1, 0.5, 0.9] {
        let below = noise.iter().filter(|n| **n < share).count() as f32 / 4096.0;
        assert!((below - share).abs() < 0.02, "{below} below {share}");
    }
}
