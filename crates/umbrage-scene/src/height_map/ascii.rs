//! Heights from ESRI ASCII grids (.asc): a header of names and numbers, then rows of heights, the
//! northern one first.

use std::path::Path;

use glam::DVec2;

use super::raster::{Metres, Raster, check_size};

/// Largest cell that may be in degrees, where the file gives no unit: some 5 km on the ground.
const LARGEST_DEGREES: f64 = 0.05;

/// Numbers of a header.
#[derive(Default)]
struct Header {
    columns: Option<f64>,
    rows: Option<f64>,
    west: f64,
    south: f64,
    cell: [Option<f64>; 2],
    missing: Option<f64>,
}

/// Reads the grid of a file. The units of its posts are in a .prj beside it, if anywhere.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Raster, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| format!("is not text: {error}"))?;
    let mut words =
        text.lines().enumerate().flat_map(|(line, text)| text.split_ascii_whitespace().map(move |w| (line + 1, w)));
    let mut header = Header::default();
    let mut first = None;
    while let Some((line, word)) = words.next() {
        if word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.')) {
            first = Some((line, word));
            break;
        }
        let (_, value) = words.next().ok_or_else(|| format!("line {line}: {word} has no value"))?;
        let value: f64 = value.parse().map_err(|_| format!("line {line}: {word} is {value}; it has to be a number"))?;
        match word.to_ascii_lowercase().as_str() {
            "ncols" => header.columns = Some(value),
            "nrows" => header.rows = Some(value),
            "xllcorner" | "xllcenter" => header.west = value,
            "yllcorner" | "yllcenter" => header.south = value,
            "cellsize" => header.cell = [Some(value); 2],
            "dx" => header.cell[0] = Some(value),
            "dy" => header.cell[1] = Some(value),
            "nodata_value" | "nodata" => header.missing = Some(value),
            _ => return Err(format!("line {line}: {word} is not known in the header of an ASCII grid")),
        }
    }
    let count = |value: Option<f64>, name: &str| match value {
        Some(value) if value >= 1.0 && value.fract() == 0.0 && value < 1e9 => Ok(value as usize),
        Some(value) => Err(format!("{name} is {value}; it has to be a whole number above 0")),
        None => Err(format!("its header has no {name}; an ASCII grid begins with ncols and nrows")),
    };
    let (width, height) = (count(header.columns, "ncols")?, count(header.rows, "nrows")?);
    check_size(width, height, bytes.len())?;

    // Two bytes for each value at least, so a header that promises too much reserves nothing.
    let mut values = Vec::with_capacity((width * height).min(bytes.len() / 2 + 1));
    for (line, word) in first.into_iter().chain(words) {
        let value: f64 = word.parse().map_err(|_| format!("line {line}: {word} is not a height"))?;
        let is_missing = header.missing == Some(value) || !value.is_finite();
        values.push(if is_missing { f32::NAN } else { value as f32 });
    }
    if values.len() != width * height {
        return Err(format!("has {} heights, but its header promises {width}×{height}", values.len()));
    }
    let mut notes = Vec::new();
    let cell = cell(&header, path, &mut notes);
    Ok(Raster { width, height, values, metres: Some(Metres::PLAIN), cell, notes })
}

/// Returns the metres between posts, if the unit is metres.
fn cell(header: &Header, path: &Path, notes: &mut Vec<String>) -> Option<DVec2> {
    let cell = DVec2::new(header.cell[0]?, header.cell[1]?);
    if !(cell.is_finite() && cell.min_element() > 0.0) {
        return None;
    }
    let degrees = |notes: &mut Vec<String>| {
        notes.push(format!("the height map's posts are {} degrees apart, not metres", cell.x));
        None
    };
    // Anything but a text beside it is no projection.
    match crate::error::read_file(&path.with_extension("prj")).ok().and_then(|bytes| String::from_utf8(bytes).ok()) {
        Some(projection) if projection.contains("PROJC") || projection.contains("Projection") => {
            Some(cell * linear_unit(&projection).unwrap_or(1.0))
        }
        Some(projection) if projection.contains("GEOG") => degrees(notes),
        _ if cell.max_element() <= LARGEST_DEGREES && header.west.abs() <= 360.0 && header.south.abs() <= 90.0 => {
            degrees(notes)
        }
        _ => {
            notes.push(format!(
                "nothing says in which unit the height map's posts are {} apart; taken for metres",
                cell.x
            ));
            Some(cell)
        }
    }
}

/// Returns the metres of the unit of a projection, which is the last unit that its text (WKT)
/// names.
fn linear_unit(projection: &str) -> Option<f64> {
    let (_, unit) = projection.rsplit_once("UNIT[")?;
    let (_, number) = unit.split_once(',')?;
    let end = number.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E' | ' ')))?;
    number[..end].trim().parse().ok().filter(|metres: &f64| *metres > 0.0 && metres.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_projections() {
        let text = r#"PROJCS["NAD83 / New York Long Island (ftUS)",GEOGCS["NAD83",UNIT["Degree",0.0174532925]],UNIT["Foot_US",0.3048006096012192]]"#;
        assert_eq!(linear_unit(text), Some(0.304_800_609_601_219_2));
        assert_eq!(linear_unit(r#"PROJCS["UTM",UNIT["Meter",1.0]]"#), Some(1.0));
        assert_eq!(linear_unit("PROJCS"), None);
    }

    #[test]
    fn grids_that_are_none() {
        let refused = |text: &str| read(text.as_bytes(), Path::new("/nonexistent/a.asc")).expect_err("it is none");
        assert!(refused("").contains("ncols"));
        assert!(refused("ncols 2\nnrows two\n1 2").contains("line 2"));
        assert!(refused("ncols 2\nnrows 2\ncellsize 1\n1 2 3").contains("3 heights"));
        assert!(refused("ncols 2\nnrows 2\ncellsize 1\n1 2\n3 x").contains("line 5"));
        assert!(refused("ncols 2000000\nnrows 2000000\ncellsize 1\n1 2").contains("most"));
        assert!(refused("width 2\n").contains("width"));
    }
}
