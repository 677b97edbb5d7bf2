//! Report pages: one HTML file with all its content, without scripts and without external files.
//!
//! A [`Page`] holds [`Section`]s, a section holds blocks in order: [text](Section::text),
//! [figures](Section::figure), [tables](Section::table), [sheets of pictures](Section::sheet).
//! Every text that is passed in is plain and is escaped; in running text and captions ``
//! `backticks` `` set code. Pictures go in as PNG or JPEG bytes, charts as the `<svg>` of
//! [`super::plot`]. Pages are readable on a phone and on a desktop, and light or dark as the
//! reader's system is.

use base64::{Engine, engine::general_purpose::STANDARD};
use maud::{Markup, PreEscaped, html};

use super::plot::dark_style;

const STYLE: &str = include_str!("html.css");

/// Escapes plain text and sets `` `code` `` in it as code. A backtick without its partner stays.
fn running(text: &str) -> Markup {
    let parts: Vec<&str> = text.split('`').collect();
    let last = parts.len() - 1;
    html! {
        @for (i, part) in parts.iter().enumerate() {
            @if i % 2 == 0 { (part) } @else if i < last { code { (part) } } @else { "`" (part) }
        }
    }
}

/// Converts a name to an anchor: lower case letters, digits and hyphens.
fn anchor(name: &str) -> String {
    let words: Vec<String> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    words.join("-")
}

/// A report.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Title of the browser's window, and first heading.
    pub title: String,
    /// Introduction, one paragraph each.
    pub lead: Vec<String>,
    /// Sections in order; each is in the navigation.
    pub sections: Vec<Section>,
    /// Footer that says how the page was made.
    pub footer: String,
}

impl Page {
    /// Writes the text of the file.
    #[must_use]
    pub fn html(&self) -> String {
        let dark = dark_style("svg.plot");
        let style = format!("{STYLE}@media (prefers-color-scheme: dark) {{\n{dark}}}\n");
        let ids: Vec<String> = self.sections.iter().enumerate().map(|(index, section)| section.id(index)).collect();
        let page = html! {
            (PreEscaped("<!doctype html>"))
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(style)) }
                }
                body {
                    main {
                        header {
                            h1 { (self.title) }
                            @for text in &self.lead { p { (running(text)) } }
                        }
                        @if self.sections.len() > 1 {
                            nav { @for (section, id) in self.sections.iter().zip(&ids) { a href={ "#" (id) } { (section.title) } " " } }
                        }
                        @for (section, id) in self.sections.iter().zip(&ids) {
                            section id=(id) { h2 { (section.title) } @for block in &section.blocks { (block) "\n" } }
                        }
                        @if !self.footer.is_empty() { footer { (running(&self.footer)) } }
                    }
                }
            }
        };
        page.into_string()
    }
}

/// A part of a page under a heading.
#[derive(Clone, Debug, Default)]
pub struct Section {
    title: String,
    blocks: Vec<Markup>,
}

impl Section {
    /// Makes an empty section.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), blocks: Vec::new() }
    }

    /// Returns the heading.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    fn id(&self, index: usize) -> String {
        format!("s{}-{}", index + 1, anchor(&self.title))
    }

    fn with(mut self, block: Markup) -> Self {
        self.blocks.push(block);
        self
    }

    /// Adds a smaller heading.
    #[must_use]
    pub fn heading(self, text: &str) -> Self {
        self.with(html! { h3 { (text) } })
    }

    /// Adds a paragraph.
    #[must_use]
    pub fn text(self, text: &str) -> Self {
        self.with(html! { p { (running(text)) } })
    }

    /// Adds a secondary paragraph: conditions, sources.
    #[must_use]
    pub fn note(self, text: &str) -> Self {
        self.with(html! { p.quiet { (running(text)) } })
    }

    /// Adds a list of remarks.
    #[must_use]
    pub fn list(self, items: &[String]) -> Self {
        self.with(html! { ul { @for item in items { li { (running(item)) } } } })
    }

    /// Adds one figure over the whole width.
    #[must_use]
    pub fn figure(self, figure: &Figure) -> Self {
        self.with(figure.html())
    }

    /// Adds figures side by side, as many in a row as there is room for.
    #[must_use]
    pub fn figures(self, figures: &[Figure]) -> Self {
        self.with(html! { div.beside { @for figure in figures { (figure.html()) } } })
    }

    /// Adds small figures side by side: maps, masks.
    #[must_use]
    pub fn small_figures(self, figures: &[Figure]) -> Self {
        self.with(html! { div.beside.small { @for figure in figures { (figure.html()) } } })
    }

    /// Adds a table.
    #[must_use]
    pub fn table(self, table: &Table) -> Self {
        self.with(table.html())
    }

    /// Adds pictures in rows and columns under headings.
    #[must_use]
    pub fn sheet(self, sheet: &Sheet) -> Self {
        self.with(sheet.html())
    }

    /// Adds a long plain text that can be unfolded, such as a report in JSON.
    #[must_use]
    pub fn folded(self, summary: &str, text: &str) -> Self {
        self.with(html! { details { summary { (summary) } pre { (text) } } })
    }
}

/// A picture or chart with its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    content: Markup,
    caption: String,
    /// Width in pixels at which a chart is drawn; pictures fill their column.
    width: Option<u32>,
}

impl Figure {
    /// Makes a figure of a chart or diagram of [`super::plot`]: an `<svg>` element, which is
    /// inserted unchanged.
    #[must_use]
    pub fn svg(svg: String, caption: impl Into<String>) -> Self {
        let width =
            svg.split_once(" width=\"").and_then(|(_, rest)| rest.split_once('"')).and_then(|(w, _)| w.parse().ok());
        Self { content: PreEscaped(svg), caption: caption.into(), width }
    }

    /// Makes a figure of a picture (PNG or JPEG). `alt` is the text for readers who cannot see it.
    #[must_use]
    pub fn picture(file: &[u8], alt: &str, caption: impl Into<String>) -> Self {
        Self { content: picture(file, alt, false), caption: caption.into(), width: None }
    }

    /// Makes a figure of a picture whose pixels stay squares when it is enlarged: masks, insets.
    #[must_use]
    pub fn pixels(file: &[u8], alt: &str, caption: impl Into<String>) -> Self {
        Self { content: picture(file, alt, true), caption: caption.into(), width: None }
    }

    fn html(&self) -> Markup {
        let caption = html! { @if !self.caption.is_empty() { figcaption { (running(&self.caption)) } } };
        match self.width {
            // A chart may grow by a quarter where there is room; on a narrow screen it scrolls
            // rather than shrink beyond reading.
            Some(width) => html! {
                figure.chart style={ "max-width:" (width + width / 4 + 42) "px" } { div.scroll { (self.content) } (caption) }
            },
            None => html! { figure { (self.content) (caption) } },
        }
    }
}

/// Writes an `<img>` with the picture inside. The size is read from the file, so that the page does
/// not jump.
fn picture(file: &[u8], alt: &str, pixelated: bool) -> Markup {
    let reader = image::ImageReader::new(std::io::Cursor::new(file)).with_guessed_format().ok();
    let kind = reader.as_ref().and_then(|reader| reader.format()).map_or("image/png", |format| format.to_mime_type());
    let size = reader.and_then(|reader| reader.into_dimensions().ok());
    let source = format!("data:{kind};base64,{}", STANDARD.encode(file));
    html! { img.pixels[pixelated] loading="lazy" width=[size.map(|size| size.0)] height=[size.map(|size| size.1)] alt=(alt) src=(source); }
}

/// Pictures in a grid, as a contact sheet. Rows and columns have names.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Headings of the columns.
    pub columns: Vec<String>,
    /// Name of each row, and its pictures from left to right.
    pub rows: Vec<(String, Vec<Figure>)>,
}

impl Sheet {
    fn html(&self) -> Markup {
        html! {
            div.scroll {
                table.sheet {
                    thead { tr { td {} @for name in &self.columns { th scope="col" { (name) } } } }
                    tbody {
                        @for (name, figures) in &self.rows {
                            tr { th scope="row" { (name) } @for figure in figures { td { (figure.html()) } } }
                        }
                    }
                }
            }
        }
    }
}

/// Choice of the value that stands out in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Best {
    /// The lowest value, for errors, times, bytes.
    Lowest,
    /// The highest value, for qualities.
    Highest,
}

/// A column of a [`Table`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    title: String,
    numeric: bool,
    best: Option<Best>,
}

impl Column {
    /// Makes a column of words, aligned to the left.
    #[must_use]
    pub fn text(title: impl Into<String>) -> Self {
        Self { title: title.into(), numeric: false, best: None }
    }

    /// Makes a column of numbers, aligned to the right. The title includes their unit.
    #[must_use]
    pub fn number(title: impl Into<String>) -> Self {
        Self { title: title.into(), numeric: true, best: None }
    }

    /// Makes a column of numbers of which the best one (as it is shown) stands out.
    #[must_use]
    pub fn best(title: impl Into<String>, best: Best) -> Self {
        Self { best: Some(best), ..Self::number(title) }
    }
}

/// Content of a table's cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number shown with this many decimals. NaN and infinity are shown as missing.
    Number(f64, usize),
    /// A value that was not measured.
    Missing,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl Cell {
    fn shown(&self) -> Markup {
        match self {
            Self::Text(text) => running(text),
            Self::Number(value, decimals) if value.is_finite() => {
                let text = format!("{value:.decimals$}");
                // "-0.00" is a rounding, not a result.
                let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
                html! { (if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }) }
            }
            Self::Number(..) | Self::Missing => html! { "–" },
        }
    }

    /// Returns the number as it is shown, so that equal-looking numbers are equally good.
    fn value(&self) -> Option<f64> {
        match self {
            Self::Number(value, decimals) if value.is_finite() => format!("{value:.decimals$}").parse().ok(),
            _ => None,
        }
    }
}

/// A table. Columns with a [`Best`] emphasise their best values.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Caption above the table.
    pub caption: String,
    /// Columns from left to right.
    pub columns: Vec<Column>,
    /// Rows from top to bottom. A short row ends in missing cells; surplus cells are not shown.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// Makes a table without rows.
    #[must_use]
    pub fn new(caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { caption: caption.into(), columns, rows: Vec::new() }
    }

    /// Adds a row.
    #[must_use]
    pub fn row(mut self, cells: Vec<Cell>) -> Self {
        self.rows.push(cells);
        self
    }

    /// Returns the best value of a column; `None` if all are equally good, as nothing stands out
    /// then.
    fn best_of(&self, index: usize) -> Option<f64> {
        let best = self.columns[index].best?;
        let values: Vec<f64> = self.rows.iter().filter_map(|row| row.get(index)?.value()).collect();
        let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (lowest < highest).then_some(if best == Best::Lowest { lowest } else { highest })
    }

    fn html(&self) -> Markup {
        let best: Vec<Option<f64>> = (0..self.columns.len()).map(|index| self.best_of(index)).collect();
        let is_best = |index: usize, cell: &Cell| best[index].is_some() && cell.value() == best[index];
        html! {
            div.scroll {
                table {
                    @if !self.caption.is_empty() { caption { (running(&self.caption)) } }
                    thead {
                        tr { @for column in &self.columns { th.n[column.numeric] scope="col" { (running(&column.title)) } } }
                    }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (index, column) in self.columns.iter().enumerate() {
                                    @let cell = row.get(index).unwrap_or(&Cell::Missing);
                                    td.n[column.numeric] {
                                        @if is_best(index, cell) { strong { (cell.shown()) } } @else { (cell.shown()) }
                                    }
                                }
                            }
                            "\n"
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_becomes_markup() {
        let evil = "<script>alert('x')</script> & \"q\" `<b>`";
        let figure = Figure::picture(&[1, 2, 3], evil, evil);
        let sheet = Sheet { columns: vec![evil.into()], rows: vec![(evil.into(), vec![figure.clone()])] };
        let section = Section::new(evil)
            .heading(evil)
            .text(evil)
            .note(evil)
            .list(&[evil.into()])
            .figure(&figure)
            .sheet(&sheet)
            .table(&Table::new(evil, vec![Column::text(evil)]).row(vec![evil.into()]))
            .folded(evil, evil);
        let page = Page { title: evil.into(), lead: vec![evil.into()], sections: vec![section], footer: evil.into() };
        let html = page.html();
        assert!(!html.contains("<script") && !html.contains("<b>") && !html.contains("\"q\""), "{html}");
        assert!(html.contains("<code>&lt;b&gt;</code>"));
    }

    #[test]
    fn a_page_fetches_nothing() {
        let page = Page { title: "t".into(), sections: vec![Section::new("s").text("x")], ..Page::default() };
        let html = page.html();
        for word in ["http:", "https:", "src=\"/", "@import", "url("] {
            assert!(!html.contains(word), "{word} in the page");
        }
    }

    #[test]
    fn an_unpaired_backtick_stays() {
        assert_eq!(running("a `b` c").into_string(), "a <code>b</code> c");
        assert_eq!(running("a ` c").into_string(), "a ` c");
        assert_eq!(running("`b`").into_string(), "<code>b</code>");
    }

    #[test]
    fn the_best_of_a_column_stands_out_as_shown() {
        let table = Table::new("", vec![Column::text("who"), Column::best("E, %", Best::Lowest)])
            .row(vec!["a".into(), Cell::Number(1.204, 2)])
            .row(vec!["b".into(), Cell::Number(1.199, 2)])
            .row(vec!["c".into(), Cell::Number(3.0, 2)])
            .row(vec!["d".into(), Cell::Number(f64::NAN, 2)])
            .row(vec!["e".into()]);
        let html = table.html().into_string();
        assert_eq!(html.matches("<strong>1.20</strong>").count(), 2, "{html}");
        assert_eq!(html.matches("<strong>").count(), 2);
        assert_eq!(html.matches('–').count(), 2);
        let highest = Table::new("", vec![Column::best("q", Best::Highest)])
            .row(vec![Cell::Number(1.0, 0)])
            .row(vec![Cell::Number(2.0, 0)]);
        assert!(highest.html().into_string().contains("<strong>2</strong>"));
        let equal = Table::new("", vec![Column::best("q", Best::Highest)])
            .row(vec![Cell::Number(2.0, 0)])
            .row(vec![Cell::Number(2.0, 0)]);
        assert!(!equal.html().into_string().contains("<strong>"), "nothing stands out among equals");
    }

    #[test]
    fn small_negative_numbers_do_not_show_as_minus_zero() {
        assert_eq!(Cell::Number(-0.001, 2).shown().into_string(), "0.00");
        assert_eq!(Cell::Number(-1.5, 1).shown().into_string(), "−1.5");
    }

    #[test]
    fn a_picture_says_its_size_and_kind() {
        let mut png = std::io::Cursor::new(Vec::new());
        image::RgbImage::new(8, 6).write_to(&mut png, image::ImageFormat::Png).expect("a picture");
        let html = picture(&png.into_inner(), "a", false).into_string();
        assert!(
            html.contains("width=\"8\" height=\"6\"") && html.contains("data:image/png;base64,iVBORw0KGgo"),
            "{html}"
        );
        let broken = picture(&[1, 2, 3], "a", false).into_string();
        assert!(!broken.contains("width"), "{broken}");
    }

    #[test]
    fn sections_of_one_name_have_anchors_of_their_own() {
        let page = Page { sections: vec![Section::new("A b!"), Section::new("A b!")], ..Page::default() };
        let html = page.html();
        assert!(html.contains("id=\"s1-a-b\"") && html.contains("id=\"s2-a-b\"") && html.contains("href=\"#s2-a-b\""));
    }
}
