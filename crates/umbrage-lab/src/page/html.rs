//! Report pages: one HTML file with everything inside, no script, nothing fetched.
//!
//! A [`Page`] holds [`Section`]s, a section holds blocks in order: [text](Section::text), [figures](Section::figure),
//! [tables](Section::table), [sheets of pictures](Section::sheet). Every text that comes in is plain and is escaped;
//! in running text and captions `` `backticks` `` set code. Pictures go in as PNG bytes, charts as the `<svg>` of [`super::plot`].
//! Readable on a phone and on a desktop, light or dark as the reader's system is.

use base64::{Engine, engine::general_purpose::STANDARD};

use super::{escape::escape, plot::dark_style};

const STYLE: &str = include_str!("html.css");
/// What every PNG begins with: its signature, the length and the name of its first chunk.
const PNG_HEAD: [u8; 16] = *b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR";

/// Escaped, with `` `code` `` set as code. A backtick without its partner stays.
fn running(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    let mut html = String::new();
    for (i, part) in parts.iter().enumerate() {
        let is_code = i % 2 == 1;
        if is_code && i + 1 < parts.len() {
            html += &format!("<code>{}</code>", escape(part));
        } else {
            if is_code {
                html.push('`');
            }
            html += &escape(part);
        }
    }
    html
}

/// A name as an anchor: lower case letters, digits and hyphens.
fn anchor(name: &str) -> String {
    let words: Vec<String> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    words.join("-")
}

/// A whole report.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// The browser's title and the first heading.
    pub title: String,
    /// What it is about, one paragraph each.
    pub lead: Vec<String>,
    /// In order; each is in the navigation.
    pub sections: Vec<Section>,
    /// How the page came to be.
    pub footer: String,
}

impl Page {
    /// The file's text.
    #[must_use]
    pub fn html(&self) -> String {
        let title = escape(&self.title);
        let lead: String = self.lead.iter().map(|text| format!("<p>{}</p>\n", running(text))).collect();
        let mut nav = String::new();
        let mut body = String::new();
        for (index, section) in self.sections.iter().enumerate() {
            let (heading, id) = (escape(&section.title), section.id(index));
            nav += &format!("<a href=\"#{id}\">{heading}</a>\n");
            body += &format!("<section id=\"{id}\">\n<h2>{heading}</h2>\n{}</section>\n", section.body);
        }
        let nav = if self.sections.len() > 1 { format!("<nav>\n{nav}</nav>\n") } else { String::new() };
        let footer = if self.footer.is_empty() {
            String::new()
        } else {
            format!("<footer>{}</footer>\n", running(&self.footer))
        };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{STYLE}\
             @media (prefers-color-scheme: dark) {{\n{dark}}}\n</style>\n</head>\n<body>\n<main>\n\
             <header>\n<h1>{title}</h1>\n{lead}</header>\n{nav}{body}{footer}</main>\n</body>\n</html>\n",
            dark = dark_style("svg.plot"),
        )
    }
}

/// A part of a page under a heading.
#[derive(Clone, Debug, Default)]
pub struct Section {
    title: String,
    body: String,
}

impl Section {
    /// An empty section.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), body: String::new() }
    }

    /// Its heading.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    fn id(&self, index: usize) -> String {
        format!("s{}-{}", index + 1, anchor(&self.title))
    }

    /// A smaller heading.
    #[must_use]
    pub fn heading(mut self, text: &str) -> Self {
        self.body += &format!("<h3>{}</h3>\n", escape(text));
        self
    }

    /// A paragraph.
    #[must_use]
    pub fn text(mut self, text: &str) -> Self {
        self.body += &format!("<p>{}</p>\n", running(text));
        self
    }

    /// A paragraph of the second rank: conditions, sources.
    #[must_use]
    pub fn note(mut self, text: &str) -> Self {
        self.body += &format!("<p class=\"quiet\">{}</p>\n", running(text));
        self
    }

    /// A list of remarks.
    #[must_use]
    pub fn list(mut self, items: &[String]) -> Self {
        let items: String = items.iter().map(|item| format!("<li>{}</li>\n", running(item))).collect();
        self.body += &format!("<ul>\n{items}</ul>\n");
        self
    }

    /// One figure over the whole width.
    #[must_use]
    pub fn figure(mut self, figure: &Figure) -> Self {
        self.body += &figure.html();
        self
    }

    /// Figures side by side, as many in a row as there is room for.
    #[must_use]
    pub fn figures(mut self, figures: &[Figure]) -> Self {
        let inner: String = figures.iter().map(Figure::html).collect();
        self.body += &format!("<div class=\"beside\">\n{inner}</div>\n");
        self
    }

    /// A table.
    #[must_use]
    pub fn table(mut self, table: &Table) -> Self {
        self.body += &table.html();
        self
    }

    /// Pictures in rows and columns under headings.
    #[must_use]
    pub fn sheet(mut self, sheet: &Sheet) -> Self {
        self.body += &sheet.html();
        self
    }

    /// A long plain text to unfold, such as a report in JSON.
    #[must_use]
    pub fn folded(mut self, summary: &str, text: &str) -> Self {
        self.body += &format!("<details><summary>{}</summary><pre>{}</pre></details>\n", escape(summary), escape(text));
        self
    }
}

/// A picture or chart with its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    content: String,
    caption: String,
    /// Pixels across at which a chart is drawn; pictures fill their column.
    width: Option<u32>,
}

impl Figure {
    /// A chart or diagram of [`super::plot`]: an `<svg>` element, taken as it is.
    #[must_use]
    pub fn svg(svg: String, caption: impl Into<String>) -> Self {
        let width =
            svg.split_once(" width=\"").and_then(|(_, rest)| rest.split_once('"')).and_then(|(w, _)| w.parse().ok());
        Self { content: svg, caption: caption.into(), width }
    }

    /// A picture; `alt` is what is said where it cannot be seen.
    #[must_use]
    pub fn png(png: &[u8], alt: &str, caption: impl Into<String>) -> Self {
        Self { content: picture(png, alt, ""), caption: caption.into(), width: None }
    }

    /// A picture whose pixels stay squares when it is enlarged: masks, insets.
    #[must_use]
    pub fn pixels(png: &[u8], alt: &str, caption: impl Into<String>) -> Self {
        Self { content: picture(png, alt, " class=\"pixels\""), caption: caption.into(), width: None }
    }

    fn html(&self) -> String {
        let caption = if self.caption.is_empty() {
            String::new()
        } else {
            format!("<figcaption>{}</figcaption>", running(&self.caption))
        };
        match self.width {
            // A chart may grow by a quarter where there is room; on a narrow screen it scrolls rather than shrink beyond reading.
            Some(width) => format!(
                "<figure class=\"chart\" style=\"max-width:{}px\"><div class=\"scroll\">{}</div>{caption}</figure>\n",
                width + width / 4 + 42,
                self.content
            ),
            None => format!("<figure>{}{caption}</figure>\n", self.content),
        }
    }
}

/// An `<img>` with the picture inside. Its size is read from the file, so that the page does not jump.
fn picture(png: &[u8], alt: &str, attributes: &str) -> String {
    let number = |at: usize| png.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_be_bytes);
    let size = match (png.starts_with(&PNG_HEAD), number(16), number(20)) {
        (true, Some(width), Some(height)) => format!(" width=\"{width}\" height=\"{height}\""),
        _ => String::new(),
    };
    format!(
        "<img loading=\"lazy\"{attributes}{size} alt=\"{}\" src=\"data:image/png;base64,{}\">",
        escape(alt),
        STANDARD.encode(png)
    )
}

/// Pictures in a grid, as a contact sheet: rows and columns have names.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Above the columns.
    pub columns: Vec<String>,
    /// Each row's name, and its pictures from left to right.
    pub rows: Vec<(String, Vec<Figure>)>,
}

impl Sheet {
    fn html(&self) -> String {
        let head: String = self.columns.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
        let mut rows = String::new();
        for (name, figures) in &self.rows {
            let cells: String = figures.iter().map(|figure| format!("<td>{}</td>", figure.html())).collect();
            rows += &format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", escape(name));
        }
        format!(
            "<div class=\"scroll\"><table class=\"sheet\">\n<thead><tr><td></td>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n\
             </table></div>\n"
        )
    }
}

/// Which value of a column stands out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Best {
    /// Errors, times, bytes.
    Lowest,
    /// Qualities.
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
    /// Words, to the left.
    #[must_use]
    pub fn text(title: impl Into<String>) -> Self {
        Self { title: title.into(), numeric: false, best: None }
    }

    /// Numbers, to the right. The title says their unit.
    #[must_use]
    pub fn number(title: impl Into<String>) -> Self {
        Self { title: title.into(), numeric: true, best: None }
    }

    /// Numbers, of which the best one (as it is shown) stands out.
    #[must_use]
    pub fn best(title: impl Into<String>, best: Best) -> Self {
        Self { best: Some(best), ..Self::number(title) }
    }
}

/// What a table's cell holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number shown with so many decimals. NaN and infinity are shown as missing.
    Number(f64, usize),
    /// Nothing was measured.
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
    fn shown(&self) -> String {
        match self {
            Self::Text(text) => running(text),
            Self::Number(value, decimals) if value.is_finite() => {
                let text = format!("{value:.decimals$}");
                // "-0.00" is a rounding, not a result.
                let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
                if zero { text.trim_start_matches('-').into() } else { text.replace('-', "−") }
            }
            Self::Number(..) | Self::Missing => "–".into(),
        }
    }

    /// The number as it is shown, so that what looks equal is equally good.
    fn value(&self) -> Option<f64> {
        match self {
            Self::Number(value, decimals) if value.is_finite() => format!("{value:.decimals$}").parse().ok(),
            _ => None,
        }
    }
}

/// A table; columns with a [`Best`] emphasise their best values.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Above it.
    pub caption: String,
    /// Left to right.
    pub columns: Vec<Column>,
    /// Top to bottom; a short row ends in missing cells, what is too long is not shown.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new(caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { caption: caption.into(), columns, rows: Vec::new() }
    }

    /// The same table with one more row.
    #[must_use]
    pub fn row(mut self, cells: Vec<Cell>) -> Self {
        self.rows.push(cells);
        self
    }

    /// The best value of a column; none where all are equally good, as nothing stands out then.
    fn best_of(&self, index: usize) -> Option<f64> {
        let best = self.columns[index].best?;
        let values: Vec<f64> = self.rows.iter().filter_map(|row| row.get(index)?.value()).collect();
        let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (lowest < highest).then_some(if best == Best::Lowest { lowest } else { highest })
    }

    fn html(&self) -> String {
        let class = |column: &Column| if column.numeric { " class=\"n\"" } else { "" };
        let head: String = self
            .columns
            .iter()
            .map(|column| format!("<th scope=\"col\"{}>{}</th>", class(column), running(&column.title)))
            .collect();
        let best: Vec<Option<f64>> = (0..self.columns.len()).map(|index| self.best_of(index)).collect();
        let mut rows = String::new();
        for row in &self.rows {
            rows += "<tr>";
            for (index, column) in self.columns.iter().enumerate() {
                let cell = row.get(index).unwrap_or(&Cell::Missing);
                let shown = cell.shown();
                let is_best = best[index].is_some() && cell.value() == best[index];
                let shown = if is_best { format!("<strong>{shown}</strong>") } else { shown };
                rows += &format!("<td{}>{shown}</td>", class(column));
            }
            rows += "</tr>\n";
        }
        let caption = if self.caption.is_empty() {
            String::new()
        } else {
            format!("<caption>{}</caption>\n", running(&self.caption))
        };
        format!(
            "<div class=\"scroll\"><table>\n{caption}<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_becomes_markup() {
        let evil = "<script>alert('x')</script> & \"q\" `<b>`";
        let figure = Figure::png(&[1, 2, 3], evil, evil);
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
        assert_eq!(running("a `b` c"), "a <code>b</code> c");
        assert_eq!(running("a ` c"), "a ` c");
        assert_eq!(running("`b`"), "<code>b</code>");
    }

    #[test]
    fn the_best_of_a_column_stands_out_as_shown() {
        let table = Table::new("", vec![Column::text("who"), Column::best("E, %", Best::Lowest)])
            .row(vec!["a".into(), Cell::Number(1.204, 2)])
            .row(vec!["b".into(), Cell::Number(1.199, 2)])
            .row(vec!["c".into(), Cell::Number(3.0, 2)])
            .row(vec!["d".into(), Cell::Number(f64::NAN, 2)])
            .row(vec!["e".into()]);
        let html = table.html();
        assert_eq!(html.matches("<strong>1.20</strong>").count(), 2, "{html}");
        assert_eq!(html.matches("<strong>").count(), 2);
        assert_eq!(html.matches('–').count(), 2);
        let highest = Table::new("", vec![Column::best("q", Best::Highest)])
            .row(vec![Cell::Number(1.0, 0)])
            .row(vec![Cell::Number(2.0, 0)]);
        assert!(highest.html().contains("<strong>2</strong>"));
        let equal = Table::new("", vec![Column::best("q", Best::Highest)])
            .row(vec![Cell::Number(2.0, 0)])
            .row(vec![Cell::Number(2.0, 0)]);
        assert!(!equal.html().contains("<strong>"), "nothing stands out among equals");
    }

    #[test]
    fn small_negative_numbers_do_not_show_as_minus_zero() {
        assert_eq!(Cell::Number(-0.001, 2).shown(), "0.00");
        assert_eq!(Cell::Number(-1.5, 1).shown(), "−1.5");
    }

    #[test]
    fn a_picture_says_its_size() {
        let mut png = PNG_HEAD.to_vec();
        png.extend([0, 0, 3, 32, 0, 0, 2, 88, 8, 2, 0, 0, 0]);
        let html = picture(&png, "a", "");
        assert!(
            html.contains("width=\"800\" height=\"600\"") && html.contains("data:image/png;base64,iVBORw0KGgo"),
            "{html}"
        );
    }

    #[test]
    fn sections_of_one_name_have_anchors_of_their_own() {
        let page = Page { sections: vec![Section::new("A b!"), Section::new("A b!")], ..Page::default() };
        let html = page.html();
        assert!(html.contains("id=\"s1-a-b\"") && html.contains("id=\"s2-a-b\"") && html.contains("href=\"#s2-a-b\""));
    }
}
