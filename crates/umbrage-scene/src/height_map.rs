//! Height maps: a grey picture and a scale in metres become terrain.

use std::path::Path;

use glam::{DVec2, DVec3};
use image::{DynamicImage, ImageFormat};
use serde::Deserialize;

use crate::error::read_file;
use crate::picture::decode;
use crate::{Error, Material, Mesh, Node, Primitive, Result, Scene, Trs};

/// Most posts of a height map: 67 million, 8192². Ours: their terrain takes some 3 GiB.
const MOST_POSTS: u64 = 1 << 26;

/// Quads along the edge of a tile. Ours: small enough to be culled, large enough to be drawn fast; positions inside a
/// tile are relative to its middle, so that `f32` is exact to a fraction of a millimetre at 30 m posts.
const TILE_QUADS: usize = 64;

/// What a picture of heights means in metres. Each field takes precedence over the side file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeightMapOptions {
    /// Metres between neighbouring pixels, in x and z; above 0. Needed where there is no side file.
    pub metres_per_post: Option<f64>,
    /// Metres of height for one step of grey; above 0, default 1.
    pub metres_per_unit: Option<f64>,
    /// Height in metres of grey 0; default that of the side file, or 0.
    pub height_offset: Option<f64>,
}

/// The JSON beside a picture, `name.json` for `name.png`. Keys that are not listed are ignored.
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

/// Loads an 8- or 16-bit grey PNG as terrain.
///
/// With W × H pixels, pixel (i, j) stands at x = (i − (W−1)/2)·cell, z = (j − (H−1)/2)·cell and y = grey · metres per
/// unit + offset. Row 0 is north, which is −Z. Each quad is cut along the diagonal from (i, j) to (i+1, j+1). Normals are
/// smooth. The terrain throws shadows; it is cut into tiles of 64 × 64 quads, each a node of its own.
///
/// # Errors
/// [`Error::Read`], or [`Error::HeightMap`] naming the picture or side file: no scale known, a scale that is not above 0,
/// a side file that does not fit the picture, a picture that is not grey, too small or too large.
pub fn load_height_map(path: &Path, options: &HeightMapOptions) -> Result<Scene> {
    let wrong = |reason: String| Error::HeightMap { path: path.to_owned(), reason };
    let bytes = read_file(path)?;
    let picture = decode(&bytes, &[ImageFormat::Png], 4 * MOST_POSTS).map_err(wrong)?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let grey: Vec<u16> = match picture {
        DynamicImage::ImageLuma8(grey) => grey.into_raw().into_iter().map(u16::from).collect(),
        DynamicImage::ImageLuma16(grey) => grey.into_raw(),
        other => {
            let reason = format!("has pixels of the kind {:?}; give a grey PNG of 8 or 16 bits", other.color());
            return Err(wrong(reason));
        }
    };
    if width < 2 || height < 2 {
        return Err(wrong(format!("is {width}×{height} pixels; terrain needs 2×2 or more")));
    }

    let side = side_file(path, [width, height])?;
    let mut notes = Vec::new();
    let scale = scale(path, options, side.as_ref(), &mut notes)?;
    let field = Field { width, height, grey, scale };
    let mut scene = field.build().map_err(wrong)?;
    (scene.name, scene.notes) = (path.display().to_string(), notes);
    scene.validate()?;
    Ok(scene)
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

/// Metres per post in x and z, per step of grey, and at grey 0.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    cell: DVec2,
    unit: f64,
    offset: f64,
}

fn scale(path: &Path, options: &HeightMapOptions, side: Option<&SideFile>, notes: &mut Vec<String>) -> Result<Scale> {
    let wrong = |reason: String| Error::HeightMap { path: path.to_owned(), reason };
    let cell = |axis: Option<f64>| options.metres_per_post.or(axis);
    let (Some(x), Some(z)) = (cell(side.and_then(|side| side.cell_x_m)), cell(side.and_then(|side| side.cell_y_m)))
    else {
        let side = path.with_extension("json");
        return Err(wrong(format!(
            "no metre scale is known; give --metres-per-post, or cell_x_m and cell_y_m in {}",
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
    if side.is_none() && options.metres_per_unit.is_none() {
        notes.push("a step of the height map's grey was taken for 1 m, as nothing says otherwise".into());
    }
    Ok(Scale { cell: DVec2::new(x, z), unit, offset })
}

/// A grid of heights.
struct Field {
    width: usize,
    height: usize,
    grey: Vec<u16>,
    scale: Scale,
}

impl Field {
    fn y(&self, i: usize, j: usize) -> f64 {
        f64::from(self.grey[j * self.width + i]) * self.scale.unit + self.scale.offset
    }

    /// Where post (i, j) stands in x and z; `i` and `j` may lie between posts.
    fn xz(&self, i: f64, j: f64) -> DVec2 {
        let middle = 0.5 * DVec2::new((self.width - 1) as f64, (self.height - 1) as f64);
        (DVec2::new(i, j) - middle) * self.scale.cell
    }

    /// From central differences, one-sided at the border: the same on both sides of a seam between tiles.
    fn normal(&self, i: usize, j: usize) -> [f32; 3] {
        let (west, east) = (i.saturating_sub(1), (i + 1).min(self.width - 1));
        let (north, south) = (j.saturating_sub(1), (j + 1).min(self.height - 1));
        let slope_x = (self.y(east, j) - self.y(west, j)) / ((east - west) as f64 * self.scale.cell.x);
        let slope_z = (self.y(i, south) - self.y(i, north)) / ((south - north) as f64 * self.scale.cell.y);
        DVec3::new(-slope_x, 1.0, -slope_z).normalize().as_vec3().to_array()
    }

    fn build(&self) -> Result<Scene, String> {
        let farthest = self.xz(0.0, 0.0).abs().max_element().max(self.scale.offset.abs() + 65_535.0 * self.scale.unit);
        // Beyond this even f64 leaves no millimetres, and normals could overflow.
        if farthest > 1e12 {
            return Err(format!("would reach out to {farthest:e} m; 1e12 m is the most"));
        }
        let ground = Material { name: "ground".into(), base_color: [0.36, 0.37, 0.26, 1.0], ..Material::default() };
        let mut scene = Scene { materials: vec![ground], ..Scene::default() };
        for j in (0..self.height - 1).step_by(TILE_QUADS) {
            for i in (0..self.width - 1).step_by(TILE_QUADS) {
                let (last_i, last_j) = ((i + TILE_QUADS).min(self.width - 1), (j + TILE_QUADS).min(self.height - 1));
                let name = format!("tile {},{}", i / TILE_QUADS, j / TILE_QUADS);
                let (primitive, origin) = self.tile([i, j], [last_i, last_j]);
                scene.meshes.push(Mesh { name: name.clone(), primitives: vec![primitive] });
                scene.nodes.push(Node {
                    name,
                    local: Trs { translation: origin, ..Trs::IDENTITY },
                    mesh: Some(scene.meshes.len() - 1),
                    ..Node::default()
                });
            }
        }
        Ok(scene)
    }

    /// The posts from `first` to `last`, both included, relative to their middle.
    fn tile(&self, first: [usize; 2], last: [usize; 2]) -> (Primitive, DVec3) {
        let posts = || (first[1]..=last[1]).flat_map(|j| (first[0]..=last[0]).map(move |i| (i, j)));
        let heights = posts().map(|(i, j)| self.y(i, j));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        let middle = self.xz(0.5 * (first[0] + last[0]) as f64, 0.5 * (first[1] + last[1]) as f64);
        // A whole number of metres keeps whole heights whole.
        let origin = DVec3::new(middle.x, (0.5 * (low + high)).round(), middle.y);
        let positions = posts().map(|(i, j)| {
            let xz = self.xz(i as f64, j as f64);
            (DVec3::new(xz.x, self.y(i, j), xz.y) - origin).as_vec3().to_array()
        });

        let across = (last[0] - first[0] + 1) as u32;
        let (quads_x, quads_z) = (across - 1, (last[1] - first[1]) as u32);
        let quads = (0..quads_z).flat_map(|j| (0..quads_x).map(move |i| j * across + i));
        let indices = quads.flat_map(|corner| {
            let (east, south) = (corner + 1, corner + across);
            [corner, south, south + 1, corner, south + 1, east]
        });
        let primitive = Primitive {
            positions: positions.collect(),
            normals: posts().map(|(i, j)| self.normal(i, j)).collect(),
            indices: indices.collect(),
            ..Primitive::default()
        };
        (primitive, origin)
    }
}
