//! Markdown tables.

/// A table: the headings, then the rows.
#[derive(Clone, Debug, Default)]
pub struct Table(Vec<Vec<String>>);

impl Table {
    /// Makes a table with these headings.
    pub fn new<T: Into<String>>(head: impl IntoIterator<Item = T>) -> Self {
        Self(vec![head.into_iter().map(Into::into).collect()])
    }

    /// Adds a row with as many cells as there are headings.
    pub fn row<T: Into<String>>(&mut self, cells: impl IntoIterator<Item = T>) {
        let cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        debug_assert_eq!(cells.len(), self.0[0].len(), "a row of another length");
        self.0.push(cells);
    }

    /// Writes the Markdown, one line for each row, and an empty line.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            format!("| {} |\n", cells.iter().map(|c| c.replace('|', "\\|")).collect::<Vec<_>>().join(" | "))
        };
        let mut lines = line(&self.0[0]);
        lines.push_str(&format!("|{}\n", "---|".repeat(self.0[0].len())));
        lines.extend(self.0[1..].iter().map(|cells| line(cells)));
        lines.push('\n');
        lines
    }
}

/// Formats a share in per cent, with two digits even for small ones; `None` is a dash.
pub fn percent(share: Option<f64>) -> String {
    match share.map(|share| 100.0 * share) {
        None => "–".into(),
        Some(percent) if percent.abs() < 0.1 => format!("{percent:.3}"),
        Some(percent) => format!("{percent:.2}"),
    }
}

/// Formats a number with so many decimals; `None` is a dash.
pub fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".into(), |value| format!("{value:.digits$}"))
}

/// Formats 12345 as 12,345.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// Formats bytes as MiB.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / f64::from(1 << 20))
}

/// Returns the mean; `None` without values.
pub fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.into_iter().fold((0_u32, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_in_a_paper() {
        assert_eq!(
            (percent(Some(0.0123)), percent(Some(0.00012)), percent(None)),
            ("1.23".into(), "0.012".into(), "–".into())
        );
        assert_eq!((count(999), count(1000), count(1_234_567)), ("999".into(), "1,000".into(), "1,234,567".into()));
        assert_eq!(mean([]), None);
    }

    #[test]
    fn rows_are_lines() {
        let mut table = Table::new(["a", "b|c"]);
        table.row(["1", "2"]);
        assert_eq!(table.markdown(), "| a | b\\|c |\n|---|---|\n| 1 | 2 |\n\n");
    }
}
