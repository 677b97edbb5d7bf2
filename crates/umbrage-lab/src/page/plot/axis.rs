//! Axes, and readable numbers.

use super::{Error, Result};

/// Mapping of values to lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear: equal differences are equal lengths.
    Linear,
    /// Logarithmic: equal ratios are equal lengths. Values must be positive.
    Log,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name of the quantity, with its unit.
    pub label: String,
    /// Mapping of values to lengths.
    pub scale: Scale,
    /// Ends of the axis; `None` fits them to the data.
    pub range: Option<(f64, f64)>,
    /// True if a fitted linear axis reaches down (or up) to zero.
    pub from_zero: bool,
}

impl Axis {
    /// Makes a linear axis fitted to the data.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, from_zero: false }
    }

    /// Makes a logarithmic axis fitted to the data.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// Sets the ends. Data beyond them are cut off.
    #[must_use]
    pub fn range(self, lo: f64, hi: f64) -> Self {
        Self { range: Some((lo, hi)), ..self }
    }

    /// Extends the axis to zero.
    #[must_use]
    pub fn from_zero(self) -> Self {
        Self { from_zero: true, ..self }
    }

    /// Refuses values that the axis cannot show; NaN is ignored. Returns whether there is any
    /// value.
    pub(super) fn check(&self, title: &str, values: impl Iterator<Item = f64>) -> Result<bool> {
        let refuse = |value, remedy| Error::Value { title: title.into(), axis: self.label.clone(), value, remedy };
        let mut any = false;
        for value in values.filter(|value| !value.is_nan()) {
            if value.is_infinite() {
                return Err(refuse(value, "give finite values, and NaN where there is none"));
            }
            if self.scale == Scale::Log && value <= 0.0 {
                return Err(refuse(value, "a logarithmic axis takes values above 0: give those, or a linear axis"));
            }
            any = true;
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
        }
        Ok(any)
    }
}

/// Returns 1, 2 or 5 times a power of ten, not less than `step`.
pub(super) fn nice_step(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * decade).find(|&nice| nice >= step * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// Formats a value readably: up to four figures, thousands apart, powers of ten where it is very
/// large or small.
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn what_cannot_be_shown_is_refused() {
        let refused = |axis: Axis, values: &[f64]| axis.check("test", values.iter().copied()).is_err();
        assert!(refused(Axis::log("x"), &[1.0, 0.0]));
        assert!(refused(Axis::log("x"), &[-1.0]));
        assert!(refused(Axis::linear("x"), &[f64::INFINITY]));
        assert_eq!(Axis::linear("x").check("test", [f64::NAN].into_iter()), Ok(false));
        assert!(refused(Axis::linear("x").range(2.0, 2.0), &[1.0]));
        assert!(refused(Axis::log("x").range(0.0, 2.0), &[1.0]));
        assert!(!refused(Axis::linear("x"), &[f64::NAN, 4.0]));
    }
}
