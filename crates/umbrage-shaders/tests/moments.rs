//! What moments may say of the depths they were made of, by property.

use proptest::prelude::*;
use umbrage_shaders::layout::FilterKind;
use umbrage_shaders::twin::moments::{Spread, blur_reach, blur_weight, lit_share, of_depth, without_bleeding};

const KINDS: [FilterKind; 5] =
    [FilterKind::Esm, FilterKind::Vsm, FilterKind::Evsm2, FilterKind::Evsm4, FilterKind::Msm];
const FLOATS: [f32; 2] = [40.0, 5.0];
const HALVES: [f32; 2] = [5.5, 5.5];

const SHARP: Spread = Spread { texel: 1e-4, plane: 0.0, bias: 1e-4 };

/// Means over depths with weights, summed as a blur does.
fn moments(kind: FilterKind, exponents: [f32; 2], depths: &[(f32, f32)]) -> [f32; 4] {
    let total: f32 = depths.iter().map(|(_, weight)| weight).sum();
    let mut sum = [0.0; 4];
    for &(z, weight) in depths {
        let of = of_depth(kind, exponents, z);
        (0..4).for_each(|i| sum[i] += of[i] * weight / total);
    }
    sum
}

fn depths() -> impl Strategy<Value = Vec<(f32, f32)>> {
    let z = prop_oneof![4 => -1.0f32..=1.0, 1 => Just(-1.0f32), 1 => Just(1.0f32), 2 => (-8i32..=8).prop_map(|k| k as f32 / 8.0)];
    prop::collection::vec((z, 0.05f32..1.0), 1..9)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Every kind answers with a bound: never darker than what was averaged, but for rounding.
    #[test]
    fn no_kind_is_darker_than_the_truth(depths in depths(), t in -1.0f32..=1.0, half in any::<bool>()) {
        let total: f32 = depths.iter().map(|(_, weight)| weight).sum();
        let lit = |t: f32| depths.iter().filter(|(z, _)| *z >= t).map(|(_, weight)| weight / total).sum::<f32>();
        for kind in KINDS {
            let exponents = if half { HALVES } else { FLOATS };
            let share = lit_share(kind, exponents, moments(kind, exponents, &depths), t, Spread::default());
            prop_assert!((0.0..=1.0).contains(&share), "{kind:?}: {share}");
            // Rounding moves four moments' points by some 0.01 and weights by some hundredths.
            let slack = if kind == FilterKind::Msm { 0.03 } else { 1e-3 };
            prop_assert!(share >= lit(t + 0.02) - slack, "{kind:?}: {share} at {t} of {depths:?}");
        }
    }

    /// A caster before a receiver, some of each in the filter: all kinds know the share
    /// (exponential ones where depth differs enough).
    #[test]
    fn two_planes_give_the_share_of_each(caster in -1.0f32..0.5, gap in 0.2f32..0.5, share in 0.0f32..=1.0) {
        let receiver = caster + gap;
        for kind in KINDS {
            let of = moments(kind, FLOATS, &[(caster, 1.0 - share + 1e-9), (receiver, share)]);
            let lit = lit_share(kind, FLOATS, of, receiver - 1e-4, SHARP);
            // exp(-40 · 0.2) is 3e-4; ESM's bias of 1e-4 is 4e-3.
            prop_assert!((lit - share).abs() < 0.02, "{kind:?}: {lit} instead of {share}");
        }
    }

    /// A lit plane, sloped or not, is lit wherever it is asked, and whatever the filter's width.
    #[test]
    fn planes_do_not_shade_themselves(middle in -0.8f32..0.8, slope in 0.0f32..0.02, radius in 1.0f32..10.0) {
        let depths: Vec<(f32, f32)> =
            (-10..=10).map(|k| (middle + slope * k as f32, blur_weight(k as f32, radius))).collect();
        for kind in KINDS {
            let spread = Spread { texel: 1e-3, plane: slope * radius / 6f32.sqrt(), bias: 1e-3 };
            let lit = lit_share(kind, FLOATS, moments(kind, FLOATS, &depths), middle - 1e-3, spread);
            prop_assert!(lit > 0.95, "{kind:?}: {lit}");
        }
    }

    #[test]
    fn a_blur_s_weights_sum_to_1_and_have_the_tent_s_variance(radius in prop_oneof![1.0f32..16.0, (1u32..16).prop_map(|n| n as f32)]) {
        let weights: Vec<(f64, f64)> =
            (-17..=17).map(|k| (f64::from(k), f64::from(blur_weight(k as f32, radius)))).collect();
        prop_assert!((weights.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-5);
        prop_assert!(weights.iter().all(|(k, w)| *w >= 0.0 && (k.abs() <= f64::from(blur_reach(radius)) || *w == 0.0)));
        // The ramp that a linear sampler makes of a step adds 1/12: r²/6 in all.
        let variance = weights.iter().map(|(k, w)| k * k * w).sum::<f64>() + 1.0 / 12.0;
        prop_assert!((variance / (f64::from(radius).powi(2) / 6.0) - 1.0).abs() < 1e-4, "{variance}");
    }

    #[test]
    fn bleeding_is_cut_and_light_and_shadow_are_kept(lit in 0.0f32..=1.0, bleeding in 0.0f32..0.9) {
        let cut = without_bleeding(lit, bleeding);
        prop_assert!(cut <= lit + 1e-6 && (lit > bleeding || cut == 0.0));
        prop_assert_eq!(without_bleeding(1.0, bleeding), 1.0);
    }
}

/// Two casters behind each other: a quarter of the filter holds a high one, the rest one close to
/// the receiver. All of it is shadow; a variance cannot say so, four moments nearly can.
#[test]
fn more_moments_leak_less() {
    let depths = [(-0.9, 0.25), (0.5, 0.75)];
    let leak = |kind| lit_share(kind, FLOATS, moments(kind, FLOATS, &depths), 0.6, SHARP);
    let (vsm, evsm4, msm) = (leak(FilterKind::Vsm), leak(FilterKind::Evsm4), leak(FilterKind::Msm));
    assert!(vsm > 0.3, "{vsm}");
    assert!(evsm4 < 0.02 && msm < 0.1, "{evsm4} {msm}");
}

/// The floats that hold the largest moments.
#[test]
fn nothing_overflows() {
    for (exponents, most) in [(FLOATS, f32::MAX), (HALVES, 65504.0)] {
        for z in [-1.0, 1.0] {
            for kind in KINDS {
                let stored = of_depth(kind, exponents, z);
                assert!(stored.iter().all(|m| m.abs() < most), "{kind:?} {stored:?}");
            }
        }
    }
}
