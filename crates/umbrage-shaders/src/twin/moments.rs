//! `lib/moments.wesl` on the CPU.

use crate::layout::FilterKind;

/// `moments::LEAST_VARIANCE`: least variance of depth, in the z of moments.
pub const LEAST_VARIANCE: f32 = 5e-7;
/// `moments::MOMENT_BIAS`: share of the most spread-out distribution that is mixed into four
/// moments.
pub const MOMENT_BIAS: f32 = 1e-6;

/// `moments::MOST_WARPED_SPREAD`: largest floor of the standard deviation of an exponential, as a
/// share of the exponential.
pub const MOST_WARPED_SPREAD: f32 = 0.05;
/// `moments::PLANE_BIAS`: standard deviations of a sloped receiver's depths within the filter, by
/// which [`hamburger`]'s receiver is moved towards the light.
pub const PLANE_BIAS: f32 = 2.0;

/// `moments::of_depth`: the moments that are stored for a depth `z` in `[-1, 1]`.
#[must_use]
pub fn of_depth(kind: FilterKind, exponents: [f32; 2], z: f32) -> [f32; 4] {
    let warped = (exponents[0] * z).exp();
    let negative = -(-exponents[1] * z).exp();
    match kind {
        FilterKind::Vsm => [z, z * z, 0.0, 0.0],
        FilterKind::Msm => [z, z * z, z * z * z, z * z * z * z],
        FilterKind::Esm => [warped, 0.0, 0.0, 0.0],
        FilterKind::Evsm2 => [warped, warped * warped, 0.0, 0.0],
        _ => [warped, warped * warped, negative, negative * negative],
    }
}

/// `moments::chebyshev`: the largest share of a distribution with these two moments that can lie at
/// `t` or beyond.
#[must_use]
pub fn chebyshev(mean: f32, square: f32, least_variance: f32, t: f32) -> f32 {
    if t <= mean {
        return 1.0;
    }
    let variance = (square - mean * mean).max(least_variance);
    variance / (variance + (t - mean) * (t - mean))
}

/// `moments::hamburger`: the largest share of a distribution on `[-1, 1]` with these four moments
/// that can lie at `t` or beyond.
#[must_use]
pub fn hamburger(moments: [f32; 4], t: f32) -> f32 {
    const WIDEST: [f32; 4] = [0.0, 2.0 / 3.0, 0.0, 2.0 / 3.0];
    let [b1, b2, b3, b4] = std::array::from_fn(|i| moments[i] + (WIDEST[i] - moments[i]) * MOMENT_BIAS);
    let d2 = (b2 - b1 * b1).max(1e-9);
    let l = (b3 - b1 * b2) / d2;
    let d3 = (b4 - b2 * b2 - l * l * d2).max(1e-12);
    let y = t - b1;
    let z = (t * t - b2 - l * y) / d3;
    let c1 = y / d2 - l * z;
    let c0 = 1.0 - c1 * b1 - z * b2;
    let half = 0.5 * (c1 + if c1 >= 0.0 { 1.0 } else { -1.0 } * (c1 * c1 - 4.0 * z * c0).max(0.0).sqrt());
    let not_zero = |x: f32| if x == 0.0 { 1e-12 } else { x };
    let (one, other) = (-c0 / not_zero(half), -half / not_zero(z));
    let (first, second) = (one.min(other), one.max(other));
    if t <= first {
        1.0
    } else if t <= second {
        let weight = (t * second - b1 * (t + second) + b2) / ((t - first) * (second - first).max(1e-9));
        (1.0 - weight).clamp(0.0, 1.0)
    } else {
        let weight = (first * second - b1 * (first + second) + b2) / ((t - first) * (t - second));
        weight.clamp(0.0, 1.0)
    }
}

/// `moments::Spread`: uncertainty of a receiver's z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Standard deviation within a texel.
    pub texel: f32,
    /// Standard deviation of the receiver's plane within the filter.
    pub plane: f32,
    /// Constant bias that was subtracted.
    pub bias: f32,
}

/// `moments::lit_share`: the lit share for a receiver at `t`.
#[must_use]
pub fn lit_share(kind: FilterKind, exponents: [f32; 2], moments: [f32; 4], t: f32, spread: Spread) -> f32 {
    let unbiased = t + spread.bias;
    let warped = (exponents[0] * unbiased).exp();
    let least = |exponent: f32, warped: f32| ((spread.texel * exponent).min(MOST_WARPED_SPREAD) * warped).powi(2);
    let positive = || chebyshev(moments[0], moments[1], least(exponents[0], warped), warped);
    match kind {
        FilterKind::Vsm => chebyshev(moments[0], moments[1], spread.texel.powi(2).max(LEAST_VARIANCE), t),
        FilterKind::Msm => hamburger(moments, t - PLANE_BIAS * spread.plane),
        FilterKind::Esm => (moments[0] / warped).clamp(0.0, 1.0),
        FilterKind::Evsm2 => positive(),
        _ => {
            let negative = -(-exponents[1] * unbiased).exp();
            positive().min(chebyshev(moments[2], moments[3], least(exponents[1], negative), negative))
        }
    }
}

/// `moments::without_bleeding`: lit share with the share `bleeding` of the light removed as a leak.
#[must_use]
pub fn without_bleeding(lit: f32, bleeding: f32) -> f32 {
    ((lit - bleeding) / (1.0 - bleeding)).clamp(0.0, 1.0)
}

/// `moments::blur_reach`: number of texels to each side that a blur reads.
#[must_use]
pub fn blur_reach(radius: f32) -> f32 {
    (radius * radius + 0.5).sqrt().floor()
}

/// `moments::blur_weight`: the weight of the texel `k` texels aside in a blur of half width
/// `radius` texels.
#[must_use]
pub fn blur_weight(k: f32, radius: f32) -> f32 {
    let n = blur_reach(radius);
    let share = (radius * radius + 0.5 - n * n) / (2.0 * n + 1.0);
    let tent = |n: f32| (1.0 - k.abs() / n).max(0.0) / n;
    tent(n) * (1.0 - share) + tent(n + 1.0) * share
}
