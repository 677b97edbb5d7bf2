//! Summary of repeated measurements in three numbers.

use serde::Serialize;

/// Median, mean and standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Middle value, or the mean of the two in the middle.
    pub median: f64,
    /// Mean of the values.
    pub mean: f64,
    /// Sample standard deviation, with n − 1; 0 for one measurement.
    pub deviation: f64,
}

impl Summary {
    /// Summarises measurements; `None` without values.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        let mean = sorted.iter().sum::<f64>() / n as f64;
        let squares: f64 = sorted.iter().map(|value| (value - mean) * (value - mean)).sum();
        Some(Self {
            median: 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
            mean,
            deviation: if n > 1 { (squares / (n - 1) as f64).sqrt() } else { 0.0 },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_samples() {
        assert_eq!(Summary::of(&[]), None);
        assert_eq!(Summary::of(&[3.0]), Some(Summary { median: 3.0, mean: 3.0, deviation: 0.0 }));
        let four = Summary::of(&[4.0, 1.0, 3.0, 100.0]).expect("four values");
        assert_eq!((four.median, four.mean), (3.5, 27.0));
        let deviation = ((23f64.powi(2) + 26f64.powi(2) + 24f64.powi(2) + 73f64.powi(2)) / 3.0).sqrt();
        assert!((four.deviation - deviation).abs() < 1e-12, "{four:?}");
    }
}
