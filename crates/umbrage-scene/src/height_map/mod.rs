//! Height maps: a grid of heights and a scale in metres become terrain.

mod ascii;
mod geotiff;
mod pixels;
mod raster;
mod terrain;

use std::path::Path;

use glam::DVec2;
use serde::Deserialize;
use umbrage::config::Word;

use crate::error::read_file;
use crate::{Error, Result, Scene};
use raster::{Metres, Raster};
use terrain::Field;

/// Scale of a height map in metres. Each field takes precedence over the side file, and the side
/// file over the map itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeightMapOptions {
    /// Metres between neighbouring posts, in x and z; above 0. Required if neither map nor side
    /// file gives it.
    pub metres_per_post: Option<f64>,
    /// Metres of height for one step of grey, or for each metre of a map in metres; above 0,
    /// default 1.
    pub metres_per_unit: Option<f64>,
    /// Height in metres of grey 0 or of 0 m; by default that of the side file, or 0.
    pub height_offset: Option<f64>,
    /// Encoding of heights in a picture; recognised if it is `None`.
    pub encoding: Option<HeightEncoding>,
}

/// Encoding of heights in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeightEncoding {
    /// Heights as grey, the same in all colours.
    Grey,
    /// Heights in metres as 24 bits of colour: red · 256 + green + blue / 256 − 32768.
    Terrarium,
    /// Heights in metres as 24 bits of colour: (red · 65536 + green · 256 + blue) / 10 − 10000.
    Mapbox,
}

impl HeightEncoding {
    /// All encodings, in the order of [`HeightEncoding::WORDS`].
    pub const ALL: [Self; 3] = [Self::Grey, Self::Terrarium, Self::Mapbox];

    /// The word of each encoding on the command line.
    pub const WORDS: &'static [Word] = &[
        Word { word: "grey", help: "Grey" },
        Word { word: "terrarium", help: "Metres in colours: red · 256 + green + blue / 256 − 32768" },
        Word { word: "mapbox", help: "Metres in colours: (red · 65536 + green · 256 + blue) / 10 − 10000" },
    ];
}

impl std::str::FromStr for HeightEncoding {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let named = Self::WORDS.iter().zip(Self::ALL).find(|(word, _)| word.word == text);
        named.map(|(_, encoding)| encoding).ok_or_else(|| {
            let words: Vec<&str> = Self::WORDS.iter().map(|word| word.word).collect();
            format!("{text:?} is not a known height encoding; give one of {}", words.join(", "))
        })
    }
}

/// JSON beside a map, `name.json` for `name.png`. Other keys are ignored.
#[derive(Debug, Default, Deserialize)]
struct SideFile {
    width: Option<u64>,
    height: Option<u64>,
    cell_x_m: Option<f64>,
    cell_y_m: Option<f64>,
    offset: Option<f64>,
    height_m: Option<String>,
    row0: Option<String>,
}

/// Loads a height map as terrain: a PNG or WebP (grey of 8 or 16 bits, alone or in colours with or
/// without alpha or in a palette; Terrarium or Mapbox colours), a GeoTIFF (.tif) or an ESRI ASCII
/// grid (.asc).
///
/// With W × H posts, post (i, j) stands at x = (i − (W−1)/2)·cell, z = (j − (H−1)/2)·cell and y =
/// value · metres per unit + offset. Row 0 is north, which is −Z. Each quad is cut along the
/// diagonal from (i, j) to (i+1, j+1); quads with a corner without data are left out. Normals are
/// smooth. The terrain casts shadows; it is cut into tiles of 64 × 64 quads, each a node of its
/// own.
///
/// # Errors
/// [`Error::Read`], [`Error::NotAFile`], or [`Error::HeightMap`] naming the map or side file: no
/// scale known, a scale that is not above 0, a side file that does not fit the map, colours that do
/// not encode heights, a map that is too small or too large.
pub fn load_height_map(path: &Path, options: &HeightMapOptions) -> Result<Scene> {
    load(path, &read_file(path)?, options, &|size| side_file(path, size))
}

/// Loads a height map from memory, without a side file. `name` stands for the file, and its
/// extension chooses the format.
///
/// # Errors
/// As [`load_height_map`].
pub fn load_height_map_slice(name: &str, bytes: &[u8], options: &HeightMapOptions) -> Result<Scene> {
    load(Path::new(name), bytes, options, &|_| Ok(None))
}

/// Reads the side file of a map with this number of posts across and down.
type Side<'a> = &'a dyn Fn([usize; 2]) -> Result<Option<SideFile>>;

fn load(path: &Path, bytes: &[u8], options: &HeightMapOptions, side: Side<'_>) -> Result<Scene> {
    let wrong = |reason: String| Error::HeightMap { path: path.to_owned(), reason };
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let raster = match extension.as_str() {
        "asc" => ascii::read(bytes, path),
        _ if is_tiff(bytes) => geotiff::read(bytes),
        _ => pixels::read(bytes, options.encoding),
    };
    let mut raster = raster.map_err(wrong)?;
    let side = side([raster.width, raster.height])?;
    let scale = scale(path, options, side.as_ref(), &mut raster)?;
    let holes = raster.values.iter().filter(|value| value.is_nan()).count();
    if holes > 0 {
        raster.notes.push(format!("{holes} posts of the height map have no data; the quads around them are left out"));
    }
    let notes = std::mem::take(&mut raster.notes);
    let mut scene = Field { raster, scale }.build().map_err(wrong)?;
    (scene.name, scene.notes) = (path.display().to_string(), notes);
    scene.validate()?;
    Ok(scene)
}

/// Returns whether bytes begin as a TIFF does, in either byte order, or as one of more than 4 GiB.
fn is_tiff(bytes: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|start| bytes.starts_with(*start))
}

/// Reads and checks the side file, if there is one.
fn side_file(picture: &Path, size: [usize; 2]) -> Result<Option<SideFile>> {
    let path = picture.with_extension("json");
    let bytes = match read_file(&path) {
        Ok(bytes) => bytes,
        Err(Error::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    let wrong = |reason: String| Err(Error::HeightMap { path: path.clone(), reason });
    let side: SideFile = match serde_json::from_slice(&bytes) {
        Ok(side) => side,
        Err(error) => return wrong(format!("the side file is not what it should be: {error}")),
    };
    for (name, said, is) in [("width", side.width, size[0]), ("height", side.height, size[1])] {
        if said.is_some_and(|said| said != is as u64) {
            return wrong(format!("{name} is {}, but the picture's is {is}", said.unwrap_or_default()));
        }
    }
    if let Some(formula) = side.height_m.as_deref().filter(|formula| *formula != "pixel + offset") {
        return wrong(format!("height_m is \"{formula}\"; only \"pixel + offset\" is understood"));
    }
    if let Some(row) = side.row0.as_deref().filter(|row| *row != "north") {
        return wrong(format!("row0 is \"{row}\"; only \"north\" is understood"));
    }
    Ok(Some(side))
}

/// Metres per post in x and z, and the conversion from values of the map to metres with the options
/// applied.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    cell: DVec2,
    metres: Metres,
    unit: f64,
    offset: f64,
}

fn scale(path: &Path, options: &HeightMapOptions, side: Option<&SideFile>, raster: &mut Raster) -> Result<Scale> {
    let wrong = |reason: String| Error::HeightMap { path: path.to_owned(), reason };
    let cell = |said: Option<f64>, own: Option<f64>| options.metres_per_post.or(said).or(own);
    let (said_x, said_z) = (side.and_then(|side| side.cell_x_m), side.and_then(|side| side.cell_y_m));
    let own = raster.cell;
    let (Some(x), Some(z)) = (cell(said_x, own.map(|cell| cell.x)), cell(said_z, own.map(|cell| cell.y))) else {
        let side = path.with_extension("json");
        let known: String = raster.notes.iter().map(|note| format!("{note}; ")).collect();
        return Err(wrong(format!(
            "no metre scale is known; {known}give --metres-per-post, or cell_x_m and cell_y_m in {}",
            side.display()
        )));
    };
    let unit = options.metres_per_unit.unwrap_or(1.0);
    for (name, value) in [("metres per post (x)", x), ("metres per post (z)", z), ("metres per unit", unit)] {
        // Subnormal lengths would not survive being written as f32.
        if !(value > 0.0 && (value as f32).is_normal()) {
            return Err(wrong(format!("{name} is {value}; it has to be a finite number above 0")));
        }
    }
    let side_offset = side.and_then(|side| side.offset);
    let offset = options.height_offset.or(side_offset).unwrap_or(0.0);
    if !offset.is_finite() {
        return Err(wrong(format!("the height offset is {offset}; it has to be a finite number of metres")));
    }
    if raster.metres.is_none() && side.is_none() && options.metres_per_unit.is_none() {
        raster.notes.push("a step of the height map's grey was taken for 1 m, as nothing says otherwise".into());
    }
    Ok(Scale { cell: DVec2::new(x, z), metres: raster.metres.unwrap_or(Metres::PLAIN), unit, offset })
}
