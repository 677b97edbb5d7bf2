//! Terrain from a grid of heights: tiles of triangles.

use glam::{DVec2, DVec3};

use super::Scale;
use super::raster::Raster;
use crate::{Material, Mesh, Node, Primitive, Scene, Trs};

/// Number of quads along the edge of a tile. Ours: small enough to be culled, large enough to be
/// drawn fast. Positions inside a tile are relative to its middle, so that `f32` is exact to a
/// fraction of a millimetre at 30 m posts.
const TILE_QUADS: usize = 64;

/// A grid of heights in metres.
pub(super) struct Field {
    pub(super) raster: Raster,
    pub(super) scale: Scale,
}

impl Field {
    fn width(&self) -> usize {
        self.raster.width
    }

    fn height(&self) -> usize {
        self.raster.height
    }

    /// Returns the height of a post in metres; NaN where there is no data.
    fn y(&self, i: usize, j: usize) -> f64 {
        let value = self.raster.values[j * self.width() + i];
        self.scale.metres.height(value) * self.scale.unit + self.scale.offset
    }

    /// Returns the position of post (i, j) in x and z, in metres; `i` and `j` may lie between
    /// posts.
    fn xz(&self, i: f64, j: f64) -> DVec2 {
        let middle = 0.5 * DVec2::new((self.width() - 1) as f64, (self.height() - 1) as f64);
        (DVec2::new(i, j) - middle) * self.scale.cell
    }

    /// Computes a normal from central differences, one-sided at the border and beside posts without
    /// data. It is the same on both sides of a seam between tiles.
    fn normal(&self, i: usize, j: usize) -> [f32; 3] {
        let here = self.y(i, j);
        let slope = |[before, after]: [(usize, usize); 2], cell: f64| {
            let at = |post: (usize, usize)| {
                let y = self.y(post.0, post.1);
                let steps = if post == (i, j) { 0.0 } else { 1.0 };
                if y.is_nan() { (here, 0.0) } else { (y, steps) }
            };
            let ((from, back), (to, forth)) = (at(before), at(after));
            if back + forth == 0.0 { 0.0 } else { (to - from) / ((back + forth) * cell) }
        };
        let (west, east) = (i.saturating_sub(1), (i + 1).min(self.width() - 1));
        let (north, south) = (j.saturating_sub(1), (j + 1).min(self.height() - 1));
        let slope_x = slope([(west, j), (east, j)], self.scale.cell.x);
        let slope_z = slope([(i, north), (i, south)], self.scale.cell.y);
        DVec3::new(-slope_x, 1.0, -slope_z).normalize().as_vec3().to_array()
    }

    /// Builds the terrain. The error says what is wrong with the heights.
    pub(super) fn build(&self) -> Result<Scene, String> {
        let heights = self.raster.values.iter().filter(|value| !value.is_nan());
        let heights = heights.map(|&value| self.scale.metres.height(value) * self.scale.unit + self.scale.offset);
        let farthest = heights.fold(self.xz(0.0, 0.0).abs().max_element(), |farthest, y| farthest.max(y.abs()));
        // Beyond this even f64 leaves no millimetres, and normals could overflow.
        if farthest > 1e12 {
            return Err(format!("would reach out to {farthest:e} m; 1e12 m is the most"));
        }
        let ground = Material { name: "ground".into(), base_color: [0.36, 0.37, 0.26, 1.0], ..Material::default() };
        let mut scene = Scene { materials: vec![ground], ..Scene::default() };
        for j in (0..self.height() - 1).step_by(TILE_QUADS) {
            for i in (0..self.width() - 1).step_by(TILE_QUADS) {
                let (last_i, last_j) =
                    ((i + TILE_QUADS).min(self.width() - 1), (j + TILE_QUADS).min(self.height() - 1));
                let name = format!("tile {},{}", i / TILE_QUADS, j / TILE_QUADS);
                let Some((primitive, origin)) = self.tile([i, j], [last_i, last_j]) else { continue };
                scene.meshes.push(Mesh { name: name.clone(), primitives: vec![primitive], ..Mesh::default() });
                scene.nodes.push(Node {
                    name,
                    local: Trs { translation: origin, ..Trs::IDENTITY },
                    mesh: Some(scene.meshes.len() - 1),
                    ..Node::default()
                });
            }
        }
        if scene.meshes.is_empty() {
            return Err("has no four neighbouring posts with data".into());
        }
        Ok(scene)
    }

    /// Builds the tile of the posts from `first` to `last`, both included, relative to their
    /// middle. Quads with a corner without data are left out; a tile without any quad is `None`.
    fn tile(&self, first: [usize; 2], last: [usize; 2]) -> Option<(Primitive, DVec3)> {
        let across = last[0] - first[0] + 1;
        let local = |i: usize, j: usize| (j - first[1]) * across + (i - first[0]);
        let quads = (first[1]..last[1]).flat_map(|j| (first[0]..last[0]).map(move |i| (i, j)));
        let has_data = |i: usize, j: usize| !self.raster.values[j * self.width() + i].is_nan();
        let whole = quads
            .filter(|&(i, j)| has_data(i, j) && has_data(i + 1, j) && has_data(i, j + 1) && has_data(i + 1, j + 1));
        let whole: Vec<(usize, usize)> = whole.collect();
        let mut index_of = vec![None; across * (last[1] - first[1] + 1)];
        for &(i, j) in &whole {
            for corner in [local(i, j), local(i + 1, j), local(i, j + 1), local(i + 1, j + 1)] {
                index_of[corner] = Some(0);
            }
        }
        index_of.iter_mut().flatten().zip(0..).for_each(|(index, count)| *index = count);

        let posts = || {
            let all = (first[1]..=last[1]).flat_map(|j| (first[0]..=last[0]).map(move |i| (i, j)));
            all.filter(|&(i, j)| index_of[local(i, j)].is_some())
        };
        let heights = posts().map(|(i, j)| self.y(i, j));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        let middle = self.xz(0.5 * (first[0] + last[0]) as f64, 0.5 * (first[1] + last[1]) as f64);
        // A whole number of metres keeps whole heights whole.
        let origin = DVec3::new(middle.x, (0.5 * (low + high)).round(), middle.y);
        let positions = posts().map(|(i, j)| {
            let xz = self.xz(i as f64, j as f64);
            (DVec3::new(xz.x, self.y(i, j), xz.y) - origin).as_vec3().to_array()
        });
        let index = |i: usize, j: usize| index_of[local(i, j)].unwrap_or_default();
        let indices = whole.iter().flat_map(|&(i, j)| {
            let [corner, east, south, both] = [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)];
            [corner, south, both, corner, both, east]
        });
        let primitive = Primitive {
            positions: positions.collect(),
            normals: posts().map(|(i, j)| self.normal(i, j)).collect(),
            indices: indices.collect(),
            ..Primitive::default()
        };
        (!whole.is_empty()).then_some((primitive, origin))
    }
}
