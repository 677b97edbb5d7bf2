//! The contact sheet: a row for each technique, a column for each shot, insets where errors differ
//! most, and the truth as last row.

use image::{GenericImage as _, Rgb, RgbImage, imageops};

use super::{inset::Rect, pen::Pen};

/// Approximate largest width in pixels of a sheet of many columns.
const WIDTH: u32 = 2600;
/// Range of the widths of a cell in pixels.
const CELL_WIDTHS: std::ops::RangeInclusive<u32> = 180..=420;
/// Largest width of a label in pixels, beyond which it is cut off.
const LABEL_WIDTH: u32 = 330;
/// Width of an inset as a share of its cell's width.
const INSET_SHARE: f64 = 0.46;
const GAP: u32 = 8;
const TEXT: f32 = 14.0;
const SMALL: f32 = 12.0;

const PAPER: Rgb<u8> = Rgb([255, 255, 255]);
const INK: Rgb<u8> = Rgb([20, 20, 24]);
const FAINT: Rgb<u8> = Rgb([110, 110, 118]);
const BEST: Rgb<u8> = Rgb([0, 120, 60]);
const WARNING: Rgb<u8> = Rgb([180, 60, 0]);
const FRAME: Rgb<u8> = Rgb([255, 205, 0]);

/// Label of a row.
#[derive(Clone, Debug)]
pub struct Label {
    /// First line.
    pub title: String,
    /// Smaller lines below.
    pub lines: Vec<String>,
}

/// A shot: a column of the sheet.
#[derive(Clone, Debug)]
pub struct SheetShot {
    /// Name of the view.
    pub title: String,
    /// Smaller lines below.
    pub lines: Vec<String>,
    /// Warning about the shot, if there is one.
    pub warning: Option<String>,
    /// Cell of each row.
    pub cells: Vec<Cell>,
}

/// A picture and its score.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Picture, as [`framed`] makes it.
    pub picture: RgbImage,
    /// Caption below the picture.
    pub caption: String,
    /// True if no other row is better.
    pub is_best: bool,
}

/// Returns width and height of the cells in pixels, for a sheet of so many shots and pictures of
/// this size.
#[must_use]
pub fn cell_size(shots: usize, picture: [u32; 2]) -> [u32; 2] {
    let shots = u32::try_from(shots.max(1)).unwrap_or(u32::MAX);
    let width = ((WIDTH - LABEL_WIDTH) / shots).clamp(*CELL_WIDTHS.start(), *CELL_WIDTHS.end());
    let height = f64::from(width) * f64::from(picture[1]) / f64::from(picture[0]);
    // Very wide and very high pictures are squeezed into what still can be seen.
    [width, height.round().clamp(f64::from(width) / 4.0, f64::from(width) * 3.0) as u32]
}

/// Scales a picture to a cell's size. The part in `inset` is marked, and enlarged in the corner
/// farthest from it.
#[must_use]
pub fn framed(picture: &RgbImage, cell: [u32; 2], inset: Option<Rect>) -> RgbImage {
    let filter = if picture.width() < cell[0] { imageops::FilterType::Nearest } else { imageops::FilterType::Triangle };
    let mut framed = imageops::resize(picture, cell[0], cell[1], filter);
    let Some(rect) = inset else { return framed };
    let scale = [0, 1].map(|i| f64::from(cell[i]) / f64::from([picture.width(), picture.height()][i]));
    let mark = Rect {
        x: (f64::from(rect.x) * scale[0]) as u32,
        y: (f64::from(rect.y) * scale[1]) as u32,
        width: ((f64::from(rect.width) * scale[0]) as u32).max(3),
        height: ((f64::from(rect.height) * scale[1]) as u32).max(3),
    };
    let size = cell.map(|edge| ((f64::from(edge) * INSET_SHARE) as u32).max(1));
    let part = imageops::crop_imm(picture, rect.x, rect.y, rect.width, rect.height).to_image();
    let enlarged = imageops::resize(&part, size[0], size[1], imageops::FilterType::Nearest);
    let center = [mark.x + mark.width / 2, mark.y + mark.height / 2];
    let at = [0, 1].map(|i| if center[i] * 2 < cell[i] { cell[i] - size[i] } else { 0 });
    imageops::replace(&mut framed, &enlarged, i64::from(at[0]), i64::from(at[1]));
    outline(&mut framed, Rect { x: at[0], y: at[1], width: size[0], height: size[1] }, FRAME);
    outline(&mut framed, mark, FRAME);
    framed
}

/// Draws a frame of two pixels inside the rectangle.
fn outline(picture: &mut RgbImage, rect: Rect, colour: Rgb<u8>) {
    let (right, below) = ((rect.x + rect.width).min(picture.width()), (rect.y + rect.height).min(picture.height()));
    for y in rect.y..below {
        for x in rect.x..right {
            if x < rect.x + 2 || y < rect.y + 2 || x + 2 >= right || y + 2 >= below {
                picture.put_pixel(x, y, colour);
            }
        }
    }
}

/// Draws the whole sheet. Every shot has a cell for every label.
#[must_use]
pub fn assemble(title: &str, labels: &[Label], shots: &[SheetShot], cell: [u32; 2]) -> RgbImage {
    let (pen, small) = (Pen::new(TEXT), Pen::new(SMALL));
    let widest = labels
        .iter()
        .flat_map(|label| label.lines.iter().map(|line| small.width(line)).chain([pen.width(&label.title)]))
        .max()
        .unwrap_or(0)
        .min(LABEL_WIDTH);
    let left = GAP + widest + GAP;
    let header_lines = shots.iter().map(|shot| shot.lines.len() + usize::from(shot.warning.is_some())).max();
    let top = GAP + 2 * pen.line_height() + header_lines.unwrap_or(0) as u32 * small.line_height() + GAP;
    let row_height = cell[1] + small.line_height() + GAP;
    let width = (left + shots.len() as u32 * (cell[0] + GAP)).max(left + pen.width(title).min(600) + GAP);
    let mut sheet = RgbImage::from_pixel(width, top + labels.len() as u32 * row_height, PAPER);

    pen.draw(&mut sheet, [GAP, GAP], INK, &pen.fitted(title, width - 2 * GAP));
    for (row, label) in labels.iter().enumerate() {
        let mut y = top + row as u32 * row_height;
        pen.draw(&mut sheet, [GAP, y], INK, &pen.fitted(&label.title, widest));
        y += pen.line_height();
        for line in &label.lines {
            small.draw(&mut sheet, [GAP, y], FAINT, &small.fitted(line, widest));
            y += small.line_height();
        }
    }
    for (number, shot) in shots.iter().enumerate() {
        let x = left + number as u32 * (cell[0] + GAP);
        let mut y = GAP + pen.line_height();
        pen.draw(&mut sheet, [x, y], INK, &pen.fitted(&shot.title, cell[0]));
        y += pen.line_height();
        let lines = shot.lines.iter().map(|line| (line, FAINT));
        for (line, colour) in lines.chain(shot.warning.iter().map(|line| (line, WARNING))) {
            small.draw(&mut sheet, [x, y], colour, &small.fitted(line, cell[0]));
            y += small.line_height();
        }
        for (row, of_row) in shot.cells.iter().enumerate() {
            let y = top + row as u32 * row_height;
            sheet.copy_from(&of_row.picture, x, y).expect("the sheet is as large as its cells");
            let colour = if of_row.is_best { BEST } else { INK };
            small.draw(&mut sheet, [x, y + cell[1] + 1], colour, &small.fitted(&of_row.caption, cell[0]));
        }
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn insets_are_marked_and_enlarged_on_the_other_side() {
        let mut picture = RgbImage::from_pixel(200, 100, Rgb([40; 3]));
        let rect = Rect { x: 10, y: 8, width: 25, height: 13 };
        for y in rect.y..rect.y + rect.height {
            for x in rect.x..rect.x + rect.width {
                picture.put_pixel(x, y, Rgb([200, 0, 0]));
            }
        }
        let cell = [200, 100];
        let framed_picture = framed(&picture, cell, Some(rect));
        assert_eq!(framed_picture.dimensions(), (200, 100));
        assert_eq!(*framed_picture.get_pixel(150, 80), Rgb([200, 0, 0]), "the part, enlarged");
        assert_eq!(*framed_picture.get_pixel(10, 8), FRAME);
        assert_eq!(*framed_picture.get_pixel(199, 99), FRAME);
        assert_eq!(*framed_picture.get_pixel(60, 60), Rgb([40; 3]), "the rest is untouched");
        assert_eq!(framed(&picture, cell, None), picture);
    }

    #[test]
    fn cells_keep_the_pictures_shape_and_have_room() {
        assert_eq!(cell_size(1, [800, 600]), [420, 315]);
        assert_eq!(cell_size(100, [800, 600]), [180, 135]);
        assert_eq!(cell_size(8, [16384, 1])[1], cell_size(8, [16384, 1])[0] / 4);
        let label = Label { title: "SSM(64²)".into(), lines: vec!["one line".into(), "another".into()] };
        let cell = Cell { picture: RgbImage::new(180, 135), caption: "E 1 %".into(), is_best: true };
        let shot = SheetShot {
            title: "tiny".into(),
            lines: vec!["own sun".into()],
            warning: Some("too few edges".into()),
            cells: vec![cell.clone(), cell],
        };
        let sheet = assemble("title", &[label.clone(), label], &[shot.clone(), shot], [180, 135]);
        assert!(sheet.width() > 2 * 180 && sheet.height() > 2 * 135);
        assert_eq!(*sheet.get_pixel(sheet.width() - 1, sheet.height() - 1), PAPER);
        assert!(sheet.pixels().any(|&pixel| pixel == Rgb([0; 3])), "the cells are there");
    }
}
