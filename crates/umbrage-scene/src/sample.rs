//! Values of animated properties between keys. Source: glTF 2.0 specification, appendix C
//! (interpolation).

use glam::{DQuat, DVec3, DVec4};

use crate::{Channel, Interpolation, Keys, Trs};

/// A point between two keys.
struct Between {
    /// Index of the key before.
    from: usize,
    /// Index of the key after; equal to `from` outside the keys.
    to: usize,
    /// Share of the way between the keys, 0 to 1.
    share: f64,
    /// Seconds between the keys.
    seconds: f64,
}

impl Between {
    fn at(times: &[f32], time: f64) -> Self {
        let after = times.partition_point(|&t| f64::from(t) <= time);
        if after == 0 || after == times.len() {
            let only = after.saturating_sub(1);
            return Self { from: only, to: only, share: 0.0, seconds: 0.0 };
        }
        let (start, end) = (f64::from(times[after - 1]), f64::from(times[after]));
        let seconds = end - start;
        Self { from: after - 1, to: after, share: (time - start) / seconds, seconds }
    }

    /// Interpolates by a cubic Hermite spline over values with in-tangent, value and out-tangent
    /// per key.
    fn spline(&self, value: impl Fn(usize) -> DVec4) -> DVec4 {
        if self.from == self.to {
            return value(3 * self.from + 1);
        }
        let (t, t2, t3) = (self.share, self.share.powi(2), self.share.powi(3));
        let (start, end) = (value(3 * self.from + 1), value(3 * self.to + 1));
        let (leaving, arriving) = (value(3 * self.from + 2), value(3 * self.to));
        start * (2.0 * t3 - 3.0 * t2 + 1.0)
            + leaving * (self.seconds * (t3 - 2.0 * t2 + t))
            + end * (3.0 * t2 - 2.0 * t3)
            + arriving * (self.seconds * (t3 - t2))
    }
}

impl Channel {
    /// Writes the channel's value at `time` (seconds, within the clip) into `local` or `weights`.
    /// Before the first key the value is that of the first key, behind the last that of the last.
    pub(crate) fn apply(&self, time: f64, local: &mut Trs, weights: &mut Vec<f64>) {
        match &self.values {
            Keys::Translation(keys) => local.translation = self.vector(keys, time),
            Keys::Scale(keys) => local.scale = self.vector(keys, time),
            Keys::Rotation(keys) => local.rotation = self.rotation(keys, time),
            Keys::Weights { per_key, values } => {
                let between = Between::at(&self.times, time);
                *weights =
                    (0..*per_key).map(|k| self.weight(|i| f64::from(values[i * per_key + k]), &between)).collect();
            }
        }
    }

    fn weight(&self, key: impl Fn(usize) -> f64, between: &Between) -> f64 {
        match self.interpolation {
            Interpolation::Step => key(between.from),
            Interpolation::Linear => key(between.from) + (key(between.to) - key(between.from)) * between.share,
            Interpolation::CubicSpline => between.spline(|i| DVec4::splat(key(i))).x,
        }
    }

    fn vector(&self, keys: &[[f32; 3]], time: f64) -> DVec3 {
        let between = Between::at(&self.times, time);
        let key = |i: usize| DVec3::from(keys[i].map(f64::from));
        match self.interpolation {
            Interpolation::Step => key(between.from),
            Interpolation::Linear => key(between.from).lerp(key(between.to), between.share),
            Interpolation::CubicSpline => between.spline(|i| key(i).extend(0.0)).truncate(),
        }
    }

    /// Interpolates unit quaternions. The result is NaN where the keys have no length, which
    /// [`crate::Poser::pose`] reports.
    fn rotation(&self, keys: &[[f32; 4]], time: f64) -> DQuat {
        let between = Between::at(&self.times, time);
        let key = |i: usize| DVec4::from(keys[i].map(f64::from));
        let unit = |v: DVec4| DQuat::from_vec4(v / v.length());
        match self.interpolation {
            Interpolation::Step => unit(key(between.from)),
            Interpolation::Linear => unit(key(between.from)).slerp(unit(key(between.to)), between.share),
            Interpolation::CubicSpline => unit(between.spline(key)),
        }
    }
}
