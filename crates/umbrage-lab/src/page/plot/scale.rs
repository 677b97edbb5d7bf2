//! Axes: from values to positions, with readable ticks.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::{Error, Result};

/// Ticks that an axis aims at.
const TICKS: f64 = 6.0;
/// Decades from which on a logarithmic axis labels powers of ten alone.
const WIDE: f64 = 3.2;

/// How values become lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equal lengths.
    Linear,
    /// Equal ratios are equal lengths; positive values only.
    Log,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How values become lengths.
    pub scale: Scale,
    /// Its ends; `None` fits it to the data.
    pub range: Option<(f64, f64)>,
    /// Whether a fitted linear axis reaches down (or up) to zero.
    pub from_zero: bool,
}

impl Axis {
    /// A linear axis fitted to the data.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, from_zero: false }
    }

    /// A logarithmic axis fitted to the data.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// The same axis with given ends. What lies outside is cut off.
    #[must_use]
    pub fn range(self, lo: f64, hi: f64) -> Self {
        Self { range: Some((lo, hi)), ..self }
    }

    /// The same axis with zero on it.
    #[must_use]
    pub fn from_zero(self) -> Self {
        Self { from_zero: true, ..self }
    }

    /// The axis laid over `values`; NaN among them does not count.
    pub(super) fn ruler(&self, title: &str, values: impl Iterator<Item = f64>) -> Result<Ruler> {
        let refuse = |value, remedy| Error::Value { title: title.into(), axis: self.label.clone(), value, remedy };
        let mut lo = f64::INFINITY;
        let mut hi = f64::NEG_INFINITY;
        for value in values.filter(|value| !value.is_nan()) {
            if value.is_infinite() {
                return Err(refuse(value, "give finite values, and NaN where there is none"));
            }
            if self.scale == Scale::Log && value <= 0.0 {
                return Err(refuse(value, "a logarithmic axis takes values above 0: give those, or a linear axis"));
            }
            lo = lo.min(value);
            hi = hi.max(value);
        }
        if let Some((from, to)) = self.range {
            for end in [from, to] {
                if !end.is_finite() || (self.scale == Scale::Log && end <= 0.0) {
                    return Err(refuse(end, "the ends of an axis have to be finite, and above 0 if it is logarithmic"));
                }
            }
            if from >= to {
                return Err(refuse(to, "the ends of an axis have to rise"));
            }
            return Ok(Ruler::new(self.scale, from, to));
        }
        if lo > hi {
            return Err(Error::Empty { title: title.into() });
        }
        Ok(match self.scale {
            Scale::Linear => {
                if self.from_zero {
                    (lo, hi) = (lo.min(0.0), hi.max(0.0));
                }
                if lo == hi {
                    let room = if lo == 0.0 { 1.0 } else { 0.5 * lo.abs() };
                    (lo, hi) = (lo - room, hi + room);
                }
                let step = nice_step((hi - lo) / TICKS);
                Ruler::new(self.scale, (lo / step + 1e-9).floor() * step, (hi / step - 1e-9).ceil() * step)
            }
            Scale::Log => {
                if lo == hi {
                    (lo, hi) = (lo / 2.0, hi * 2.0);
                }
                Ruler::new(self.scale, round_down(lo), round_up(hi))
            }
        })
    }
}

/// 1, 2 or 5 times a power of ten, not less than `step`.
pub(super) fn nice_step(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * decade).find(|&nice| nice >= step * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

fn round_down(value: f64) -> f64 {
    let decade = 10f64.powf((value.log10() + 1e-9).floor());
    [5.0, 2.0].into_iter().map(|m| m * decade).find(|&nice| nice <= value * (1.0 + 1e-9)).unwrap_or(decade)
}

fn round_up(value: f64) -> f64 {
    let decade = 10f64.powf((value.log10() - 1e-9).floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * decade).find(|&nice| nice >= value * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// A value as a reader likes it: up to four figures, thousands apart, powers of ten where it is very large or small.
#[must_use]
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return if value.is_nan() {
            "–".into()
        } else if value > 0.0 {
            "∞".into()
        } else {
            "−∞".into()
        };
    }
    let size = value.abs();
    let sign = if value < 0.0 { "−" } else { "" };
    let mut exponent = size.log10().floor() as i32;
    // Rounding to four figures may reach the next power.
    if (size / 10f64.powi(exponent) * 1000.0).round() >= 10_000.0 {
        exponent += 1;
    }
    if !(-4..7).contains(&exponent) {
        let mantissa = size / 10f64.powi(exponent);
        let power: String = exponent.to_string().chars().map(superscript).collect();
        let mantissa = trimmed(mantissa, 3);
        return if mantissa == "1" { format!("{sign}10{power}") } else { format!("{sign}{mantissa}·10{power}") };
    }
    let text = trimmed(size, (3 - exponent).max(0) as usize);
    let (whole, rest) = text.split_once('.').map_or((text.as_str(), None), |(whole, rest)| (whole, Some(rest)));
    let mut grouped = String::new();
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    match rest {
        Some(rest) => format!("{sign}{grouped}.{rest}"),
        None => format!("{sign}{grouped}"),
    }
}

fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

fn superscript(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0'..='9' => char::from_u32(u32::from('⁰') + u32::from(c) - u32::from('0')).unwrap_or(c),
        other => other,
    }
}

/// An axis with its ends and ticks, as `plotters` wants it.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    scale: Scale,
    lo: f64,
    hi: f64,
    labelled: Vec<f64>,
    light: Vec<f64>,
}

impl Ruler {
    fn new(scale: Scale, lo: f64, hi: f64) -> Self {
        let inside = |value: &f64| (lo * (1.0 - 1e-9)..=hi * (1.0 + 1e-9)).contains(value);
        let (labelled, light) = match scale {
            Scale::Linear => (multiples(lo, hi, nice_step((hi - lo) / TICKS)), Vec::new()),
            Scale::Log => {
                let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
                let of = |mantissas: &[f64]| -> Vec<f64> {
                    (first..=last)
                        .flat_map(|e| mantissas.iter().map(move |m| m * 10f64.powi(e)))
                        .filter(inside)
                        .collect()
                };
                let decades = (hi / lo).log10();
                let labels = if decades > WIDE {
                    let every = (decades / 8.0).ceil() as usize;
                    of(&[1.0]).into_iter().step_by(every.max(1)).collect()
                } else {
                    of(&[1.0, 2.0, 5.0])
                };
                // A short range may hold none of 1, 2 and 5.
                let labels = if labels.len() < 2 { multiples(lo, hi, nice_step((hi - lo) / TICKS)) } else { labels };
                (labels, of(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]))
            }
        };
        Self { scale, lo, hi, labelled, light }
    }

    /// Where a value lies: 0 at the low end, 1 at the high one.
    pub fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.lo) / (self.hi - self.lo),
            Scale::Log => (value / self.lo).ln() / (self.hi / self.lo).ln(),
        }
    }

    /// The value at a share.
    #[cfg(test)]
    fn value(&self, share: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.lo + share * (self.hi - self.lo),
            Scale::Log => self.lo * (self.hi / self.lo).powf(share),
        }
    }

    /// Labelled ticks: where (as a share) and what, rising.
    pub fn ticks(&self) -> impl Iterator<Item = (f64, String)> {
        self.labelled.iter().map(|&value| (self.share(value), number(value)))
    }

    pub fn labels(&self) -> impl Iterator<Item = String> {
        self.labelled.iter().map(|&value| number(value))
    }
}

fn multiples(lo: f64, hi: f64, step: f64) -> Vec<f64> {
    let slack = 1e-9 * (hi - lo) / step;
    let (first, last) = ((lo / step - slack).ceil() as i64, (hi / step + slack).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

impl Ranged for Ruler {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        limit.0 + (self.share(*value) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { self.light.clone() } else { self.labelled.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.lo..self.hi
    }
}

impl ValueFormatter<f64> for Ruler {
    fn format_ext(&self, value: &f64) -> String {
        number(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ruler(axis: &Axis, values: &[f64]) -> Ruler {
        axis.ruler("test", values.iter().copied()).expect("drawable values")
    }

    #[test]
    fn numbers_are_readable() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-2.5, "−2.5"),
            (1234.0, "1,234"),
            (999_999.0, "999,999"),
            (1_000_000.0, "1,000,000"),
            (0.1 + 0.2, "0.3"),
            (0.00012, "0.00012"),
            (1e-7, "10⁻⁷"),
            (2.5e9, "2.5·10⁹"),
            (0.99999, "1"),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_linear_axis_contains_its_data_and_has_round_ends() {
        let ruler = ruler(&Axis::linear("x"), &[0.13, 0.97]);
        assert!((ruler.lo, ruler.hi) == (0.0, 1.0), "{} to {}", ruler.lo, ruler.hi);
        assert_eq!(ruler.labels().collect::<Vec<_>>(), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
    }

    #[test]
    fn a_logarithmic_axis_labels_powers_or_their_halves() {
        assert_eq!(ruler(&Axis::log("x"), &[1.0, 800.0]).labels().count(), 10);
        let wide = ruler(&Axis::log("x"), &[0.01, 900.0]);
        assert_eq!(wide.labels().collect::<Vec<_>>(), ["0.01", "0.1", "1", "10", "100", "1,000"]);
        assert!(wide.light.len() > 40);
        let short = ruler(&Axis::log("x").range(31.0, 39.0), &[33.0]);
        assert!(short.labels().count() >= 3);
    }

    #[test]
    fn shares_and_values_are_inverse() {
        for axis in [Axis::linear("x").range(-3.0, 12.0), Axis::log("x").range(0.5, 640.0)] {
            let ruler = ruler(&axis, &[]);
            for share in [0.0, 0.25, 0.9, 1.0] {
                assert!((ruler.share(ruler.value(share)) - share).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_cannot_be_shown_is_refused() {
        let refused = |axis: Axis, values: &[f64]| axis.ruler("test", values.iter().copied()).is_err();
        assert!(refused(Axis::log("x"), &[1.0, 0.0]));
        assert!(refused(Axis::log("x"), &[-1.0]));
        assert!(refused(Axis::linear("x"), &[f64::INFINITY]));
        assert!(refused(Axis::linear("x"), &[]));
        assert!(refused(Axis::linear("x"), &[f64::NAN]));
        assert!(refused(Axis::linear("x").range(2.0, 2.0), &[1.0]));
        assert!(refused(Axis::log("x").range(0.0, 2.0), &[1.0]));
        assert!(!refused(Axis::linear("x"), &[f64::NAN, 4.0]));
    }
}
