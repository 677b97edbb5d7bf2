//! Figures that other documents quote from the results.
//!
//! `cargo xtask results` writes them into the documents with the page, and a test compares them, so
//! that a quoted figure cannot outlive its build.

use std::{fs, path::Path};

use anyhow::{Context, Result, bail};

use super::{
    kept::{Comparison, Scores},
    render::Figures,
    table::percent,
};

/// A figure's place in a document.
struct Quote {
    file: &'static str,
    /// The text before the number, which the document has once.
    after: &'static str,
    figure: fn(&Presets<'_>) -> Result<String>,
}

/// Sentences and cells with one figure each.
const QUOTES: [Quote; 9] = [
    Quote { file: "README.md", after: "with the defaults, ", figure: |p| p.walking("balanced") },
    Quote { file: "README.md", after: "16 MiB of maps | **", figure: |p| p.error("balanced") },
    Quote { file: "README.md", after: "; preset `exact` **", figure: |p| p.error("exact") },
    Quote { file: "README.md", after: "; the papers' settings ", figure: |p| p.error("papers") },
    Quote { file: "README.md", after: "walking and turning | **", figure: |p| p.walking("balanced") },
    Quote { file: "README.md", after: " % and ", figure: |p| p.turning("balanced") },
    Quote { file: "README.md", after: "in the worst view of five scenes | **", figure: |p| p.worst_acne_or_leak() },
    Quote { file: "docs/release-notes-0.2.md", after: "that contains a point: ", figure: |p| p.error("balanced") },
    Quote { file: "docs/release-notes-0.2.md", after: "instead of ", figure: |p| p.error("papers") },
];

/// Documents with a table of presets, the last three cells of whose rows are E, walking and
/// turning.
const TABLES: [&str; 2] = ["README.md", "book/src/presets.md"];

/// Writes all quoted figures into the documents below `root`.
pub fn write(root: &Path, figures: &Figures) -> Result<()> {
    for (file, text) in updated(root, figures)? {
        fs::write(root.join(file), text).with_context(|| format!("cannot write {file}"))?;
    }
    Ok(())
}

/// Returns the documents that quote figures, with the figures of these results.
pub fn updated(root: &Path, figures: &Figures) -> Result<Vec<(&'static str, String)>> {
    let presets = Presets::of(figures)?;
    let mut documents: Vec<(&'static str, String)> = Vec::new();
    for file in TABLES {
        documents.push((file, with_rows(&read(root, file)?, file, &presets)?));
    }
    for quote in QUOTES {
        let at = match documents.iter().position(|(file, _)| *file == quote.file) {
            Some(at) => at,
            None => {
                documents.push((quote.file, read(root, quote.file)?));
                documents.len() - 1
            }
        };
        documents[at].1 = with_figure(&documents[at].1, &quote, &(quote.figure)(&presets)?)?;
    }
    Ok(documents)
}

fn read(root: &Path, file: &str) -> Result<String> {
    fs::read_to_string(root.join(file)).with_context(|| format!("cannot read {file}"))
}

/// Replaces the number behind a quote's text.
fn with_figure(text: &str, quote: &Quote, figure: &str) -> Result<String> {
    let Quote { file, after, .. } = quote;
    let [before, rest] = text.split(after).collect::<Vec<_>>()[..] else {
        bail!(
            "{file} does not have \"{after}\" once; change the list in xtask/src/results/quoted.rs with the document"
        );
    };
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    if end == 0 {
        bail!("{file}: no number follows \"{after}\"");
    }
    Ok([before, after, figure, &rest[end..]].concat())
}

/// Replaces the last three cells of each preset's row.
fn with_rows(text: &str, file: &str, presets: &Presets<'_>) -> Result<String> {
    let mut left: Vec<&str> = presets.names().collect();
    let mut lines = Vec::new();
    for line in text.lines() {
        let name = left.iter().position(|name| line.starts_with(&format!("| `{name}`")));
        lines.push(match name.map(|at| left.remove(at)) {
            None => line.to_owned(),
            Some(name) => {
                let cells: Vec<&str> = line.trim_end_matches(" |").split(" | ").collect();
                let told = cells.len().saturating_sub(3);
                let figures = [presets.error(name)?, presets.walking(name)?, presets.turning(name)?];
                format!("{} | {} |", cells[..told].join(" | "), figures.join(" | "))
            }
        });
    }
    if !left.is_empty() {
        bail!("{file} has no row of {}", left.join(", "));
    }
    Ok(lines.join("\n") + "\n")
}

/// Results of the presets, by name.
struct Presets<'f> {
    still: &'f Comparison,
    walking: &'f Comparison,
    turning: &'f Comparison,
    suns: [&'f Comparison; 2],
}

impl<'f> Presets<'f> {
    fn of(figures: &'f Figures) -> Result<Self> {
        Ok(Self {
            still: figures.comparison("presets")?,
            walking: figures.comparison("presets-walking")?,
            turning: figures.comparison("presets-turning")?,
            suns: [figures.comparison("suns")?, figures.comparison("suns-city")?],
        })
    }

    fn names(&self) -> impl Iterator<Item = &'f str> {
        self.still.techniques.iter().map(|technique| technique.label.as_str())
    }

    /// Returns a preset's mean E in per cent.
    fn error(&self, name: &str) -> Result<String> {
        let technique = self.still.techniques.iter().find(|technique| technique.label == name);
        Ok(percent(technique.with_context(|| format!("no results of the preset {name}"))?.mean.e))
    }

    /// Returns a preset's F_edge of a camera that walks, in per cent.
    fn walking(&self, name: &str) -> Result<String> {
        flips(self.walking, name)
    }

    /// Returns a preset's F_edge of a camera that turns, in per cent.
    fn turning(&self, name: &str) -> Result<String> {
        flips(self.turning, name)
    }

    /// Returns the larger of acne and leaks in the worst view of the default, in per cent of the
    /// pixels away from shadow edges.
    fn worst_acne_or_leak(&self) -> Result<String> {
        let views = self.suns.iter().flat_map(|of| &of.views);
        let scores = views.filter_map(|view| view.scores.first());
        let worst = scores.filter_map(away_from_edges).reduce(f64::max);
        Ok(percent(Some(worst.context("no view of the jobs suns and suns-city has scores")?)))
    }
}

fn flips(of: &Comparison, name: &str) -> Result<String> {
    let technique = of.techniques.iter().find(|technique| technique.label == name);
    Ok(percent(technique.with_context(|| format!("no walk of the preset {name}"))?.mean.flicker_per_edge))
}

/// Returns the larger of acne and leaks as a share of the pixels away from edges.
fn away_from_edges(scores: &Scores) -> Option<f64> {
    let beyond = scores.beyond_edges.filter(|&beyond| beyond > 0.0)?;
    Some(scores.acne?.max(scores.leak?) / beyond)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        results::{file_of, jobs::JOBS, kept_folder},
        run::root,
    };

    #[test]
    fn documents_quote_the_kept_figures() {
        if !file_of(&kept_folder(), &JOBS[0]).exists() {
            return;
        }
        let figures = Figures::read(&kept_folder()).unwrap_or_else(|error| panic!("{error:#}"));
        for (file, expected) in updated(&root(), &figures).unwrap_or_else(|error| panic!("{error:#}")) {
            let there = fs::read_to_string(root().join(file)).expect("a document");
            assert!(there == expected, "{file} is stale; `cargo xtask results --render` writes its figures");
        }
    }

    #[test]
    fn a_number_is_replaced_and_nothing_else() {
        let quote = Quote { file: "a.md", after: "it is **", figure: |_| Ok(String::new()) };
        let changed =
            with_figure("First 1.0, then it is **0.25 %**, not 3.", &quote, "0.3").expect("the text is there");
        assert_eq!(changed, "First 1.0, then it is **0.3 %**, not 3.");
        for text in ["nothing", "it is **1** and it is **2**", "it is **no number"] {
            let error = with_figure(text, &quote, "0.3").expect_err(text).to_string();
            assert!(error.contains("a.md") && error.contains("it is **"), "{error}");
        }
    }

    #[test]
    fn rows_of_presets_get_their_figures_and_a_missing_row_is_refused() {
        let figures = Figures::read(&root().join("xtask/example-results")).unwrap_or_else(|error| panic!("{error:#}"));
        let presets = Presets::of(&figures).expect("results of presets");
        let names: Vec<&str> = presets.names().collect();
        let rows: String = names.iter().map(|name| format!("| `{name}` | use | 9 | 8 | 7 |\n")).collect();
        let text = format!("| preset | for | E |\n|---|---|---|\n{rows}| `else` | 1 | 2 | 3 | 4 |\n");
        let changed = with_rows(&text, "a.md", &presets).expect("all rows are there");
        for (name, line) in names.iter().zip(changed.lines().skip(2)) {
            let expected = [presets.error(name), presets.walking(name), presets.turning(name)];
            let expected = expected.map(|figure| figure.expect("a figure")).join(" | ");
            assert_eq!(line, format!("| `{name}` | use | {expected} |"));
        }
        assert!(changed.ends_with("| `else` | 1 | 2 | 3 | 4 |\n"), "{changed}");
        let without = text.replace(&format!("| `{}`", names[1]), "| other");
        let error = with_rows(&without, "a.md", &presets).expect_err("a row is missing").to_string();
        assert!(error.contains(names[1]), "{error}");
    }
}
