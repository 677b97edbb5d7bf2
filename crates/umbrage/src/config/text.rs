//! Values as text: numbers, switches, words and lists.

use super::names::unknown;

/// Reads a finite number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("{text:?} is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{value} is not a finite number")) }
}

/// Reads finite numbers separated by commas.
pub(super) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(number).collect()
}

/// Reads a whole number.
pub(super) fn count(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|_| format!("{text:?} is not a whole number"))
}

/// Writes a choice of whole numbers, `1 or 4`, for a message.
pub(super) fn choice(counts: &[u32]) -> String {
    counts.iter().map(u32::to_string).collect::<Vec<_>>().join(" or ")
}

/// Reads `on`, `off`, `true` or `false`.
pub(super) fn switch(text: &str) -> Result<bool, String> {
    match text {
        "on" | "true" => Ok(true),
        "off" | "false" => Ok(false),
        _ => Err(format!("{text:?} is neither on nor off")),
    }
}

/// Checks that a text is one of a list of words.
pub(super) fn one_of(text: &str, words: &[super::Word]) -> Result<(), String> {
    if words.iter().any(|word| word.word == text) { Ok(()) } else { Err(unknown("value", text, words)) }
}

/// Reads two view depths in metres, `N..F`, rising from above 0.
pub(super) fn range(text: &str) -> Result<(f64, f64), String> {
    let (near, far) =
        text.split_once("..").ok_or_else(|| format!("{text:?} is not a range; give N..F in metres, such as 1..800"))?;
    match (number(near)?, number(far)?) {
        (near, _) if near <= 0.0 => Err(format!("near ({near}) is not greater than 0")),
        (near, far) if near >= far => Err(format!("near ({near}) has to be less than far ({far})")),
        range => Ok(range),
    }
}

/// Reads edges of maps in texels.
pub(super) fn map_sizes(text: &str) -> Result<Vec<u32>, String> {
    text.split(',')
        .map(|edge| match count(edge) {
            Ok(edge) if (1..=1 << 16).contains(&edge) => Ok(edge),
            Ok(edge) => Err(format!("{edge} texels; give 1 to 65536")),
            Err(_) => Err(format!("{edge:?} is not a whole number of texels, 1 to 65536")),
        })
        .collect()
}
