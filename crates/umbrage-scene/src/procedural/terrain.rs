//! Square ground made of square tiles: flat or hilly, watertight, with smooth normals.

use glam::{DVec2, DVec3, dvec3};

use super::stage::Stage;
use crate::{Mesh, Node, Primitive, Trs};

/// Heights at the posts of a square grid around the origin; between the posts the ground is the
/// mesh's own triangles.
pub(super) struct Terrain {
    edge: f64,
    tiles: usize,
    cells: usize,
    heights: Vec<f64>,
}

/// Look of the ground, and whether it casts shadows.
pub(super) struct Surface<'a> {
    pub(super) material: usize,
    /// Linear colour at a place with a normal, multiplied into the material's.
    pub(super) tint: Option<&'a dyn Fn(DVec3, DVec3) -> [f32; 3]>,
    pub(super) cast_shadow: bool,
}

/// The diagonal that divides a square: from north-west to south-east, or from south-west to
/// north-east.
#[derive(Clone, Copy)]
enum Cut {
    Falling,
    Rising,
}

/// Rounds to a grid of 1/1024 m. Coordinates on it are exact in `f32` relative to a tile and in the
/// world, so tiles meet exactly.
fn on_grid(metres: f64) -> f64 {
    (metres * 1024.0).round() / 1024.0
}

impl Terrain {
    /// Makes `tiles` × `tiles` tiles of `cells` × `cells` squares, `edge` metres in all.
    pub(super) fn new(edge: f64, tiles: usize, cells: usize, height: impl Fn(DVec2) -> f64) -> Self {
        let mut terrain = Self { edge, tiles, cells, heights: Vec::new() };
        let posts = tiles * cells + 1;
        for row in 0..posts {
            for column in 0..posts {
                let place = DVec2::new(terrain.coordinate(column), terrain.coordinate(row));
                terrain.heights.push(on_grid(height(place)));
            }
        }
        terrain
    }

    fn posts(&self) -> usize {
        self.tiles * self.cells + 1
    }

    fn coordinate(&self, post: usize) -> f64 {
        on_grid(self.edge * (post as f64 / (self.posts() - 1) as f64 - 0.5))
    }

    fn post(&self, column: usize, row: usize) -> DVec3 {
        dvec3(self.coordinate(column), self.heights[row * self.posts() + column], self.coordinate(row))
    }

    /// Returns the mean slope around a post, as a normal.
    fn normal(&self, column: usize, row: usize) -> DVec3 {
        let last = self.posts() - 1;
        let (west, east) = (self.post(column.saturating_sub(1), row), self.post((column + 1).min(last), row));
        let (north, south) = (self.post(column, row.saturating_sub(1)), self.post(column, (row + 1).min(last)));
        (south - north).cross(east - west).normalize()
    }

    /// Returns the height of the ground's triangles at a place (x, z), which must lie on the
    /// ground.
    pub(super) fn height_at(&self, place: DVec2) -> f64 {
        let cells = self.posts() - 1;
        let locate = |coordinate: f64| {
            // The posts are at most one grid step from even spacing: the estimate is right or next
            // to right.
            let estimate =
                ((coordinate / self.edge + 0.5) * cells as f64).floor().clamp(0.0, cells as f64 - 1.0) as usize;
            let cell = if coordinate < self.coordinate(estimate) {
                estimate.saturating_sub(1)
            } else if coordinate > self.coordinate(estimate + 1) {
                (estimate + 1).min(cells - 1)
            } else {
                estimate
            };
            let (from, to) = (self.coordinate(cell), self.coordinate(cell + 1));
            (cell, (coordinate - from) / (to - from))
        };
        let ((column, u), (row, v)) = (locate(place.x), locate(place.y));
        let [north_west, north_east, south_west, south_east] = self.corners(column, row);
        match self.cut(column, row) {
            Cut::Falling if u >= v => north_west + (north_east - north_west) * u + (south_east - north_east) * v,
            Cut::Falling => north_west + (south_east - south_west) * u + (south_west - north_west) * v,
            Cut::Rising if u + v <= 1.0 => north_west + (north_east - north_west) * u + (south_west - north_west) * v,
            Cut::Rising => south_east + (south_west - south_east) * (1.0 - u) + (north_east - south_east) * (1.0 - v),
        }
    }

    /// Returns the place on the ground nearest to one that may lie beyond it.
    pub(super) fn nearest(&self, place: DVec2) -> DVec2 {
        place.clamp(DVec2::splat(self.coordinate(0)), DVec2::splat(self.coordinate(self.posts() - 1)))
    }

    /// Returns the heights of a square's corners: north-west, north-east, south-west, south-east.
    fn corners(&self, column: usize, row: usize) -> [f64; 4] {
        let height = |column, row| self.heights[row * self.posts() + column];
        [height(column, row), height(column + 1, row), height(column, row + 1), height(column + 1, row + 1)]
    }

    /// Chooses the cut that follows the ground's contour lines, so that the crest of a bench is not
    /// jagged.
    fn cut(&self, column: usize, row: usize) -> Cut {
        let [north_west, north_east, south_west, south_east] = self.corners(column, row);
        if (north_west - south_east).abs() <= (north_east - south_west).abs() { Cut::Falling } else { Cut::Rising }
    }

    /// Returns the lowest ground on a circle and in its middle, where a wide object has to stand so
    /// as not to float.
    pub(super) fn lowest_around(&self, place: DVec2, radius: f64) -> f64 {
        (0..12)
            .map(|i| {
                let (sin, cos) = super::maths::sin_cos(30.0 * f64::from(i));
                self.height_at(place + radius * DVec2::new(cos, sin))
            })
            .fold(self.height_at(place), f64::min)
    }

    /// Returns the place (x, z) with the ground's height.
    pub(super) fn on_ground(&self, place: DVec2) -> DVec3 {
        dvec3(place.x, self.height_at(place), place.y)
    }

    fn tile(&self, tile_column: usize, tile_row: usize, surface: &Surface) -> (Mesh, DVec3) {
        let (first_column, first_row) = (tile_column * self.cells, tile_row * self.cells);
        let origin = {
            let (west, east) = (self.coordinate(first_column), self.coordinate(first_column + self.cells));
            let (north, south) = (self.coordinate(first_row), self.coordinate(first_row + self.cells));
            let middle = self.post(first_column + self.cells / 2, first_row + self.cells / 2);
            dvec3(on_grid(0.5 * (west + east)), middle.y, on_grid(0.5 * (north + south)))
        };
        let mut primitive = Primitive { material: surface.material, ..Primitive::default() };
        let across = self.cells as u32 + 1;
        for row in first_row..=first_row + self.cells {
            for column in first_column..=first_column + self.cells {
                primitive.positions.push((self.post(column, row) - origin).as_vec3().to_array());
                let normal = self.normal(column, row);
                primitive.normals.push(normal.as_vec3().to_array());
                if let Some(tint) = surface.tint {
                    let [red, green, blue] = tint(self.post(column, row), normal);
                    primitive.colors.push([red, green, blue, 1.0]);
                }
            }
        }
        for row in 0..across - 1 {
            for column in 0..across - 1 {
                let north_west = row * across + column;
                let (north_east, south_west) = (north_west + 1, north_west + across);
                let south_east = south_west + 1;
                let triangles = match self.cut(first_column + column as usize, first_row + row as usize) {
                    Cut::Falling => [[north_west, south_west, south_east], [north_west, south_east, north_east]],
                    Cut::Rising => [[north_west, south_west, north_east], [north_east, south_west, south_east]],
                };
                primitive.indices.extend(triangles.as_flattened());
            }
        }
        (
            Mesh { name: format!("ground {tile_column} {tile_row}"), primitives: vec![primitive], weights: Vec::new() },
            origin,
        )
    }

    /// Adds the tiles to the stage.
    pub(super) fn place(&self, stage: &mut Stage, surface: &Surface) {
        for row in 0..self.tiles {
            for column in 0..self.tiles {
                let (mesh, origin) = self.tile(column, row, surface);
                let name = mesh.name.clone();
                let mesh = Some(stage.mesh(mesh));
                let local = Trs { translation: origin, ..Trs::IDENTITY };
                stage.node(Node { name, mesh, local, cast_shadow: surface.cast_shadow, ..Node::default() });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BARE: Surface = Surface { material: 0, tint: None, cast_shadow: true };

    fn wavy() -> Terrain {
        Terrain::new(1000.0, 3, 7, |place| 20.0 * (place.x * 0.01).sin() + 10.0 * (place.y * 0.02).cos())
    }

    #[test]
    fn the_ground_is_as_high_as_its_triangles() {
        let terrain = wavy();
        for row in 0..terrain.tiles {
            for column in 0..terrain.tiles {
                let (mesh, origin) = terrain.tile(column, row, &BARE);
                let primitive = &mesh.primitives[0];
                let at = |i: u32| origin + glam::Vec3::from_array(primitive.positions[i as usize]).as_dvec3();
                for triangle in primitive.indices.chunks_exact(3) {
                    let [a, b, c] = [at(triangle[0]), at(triangle[1]), at(triangle[2])];
                    assert!((b - a).cross(c - a).y > 0.0, "the ground faces up");
                    let inside = 0.2 * a + 0.3 * b + 0.5 * c;
                    let height = terrain.height_at(DVec2::new(inside.x, inside.z));
                    assert!((height - inside.y).abs() < 1e-9, "{height} at {inside}");
                }
            }
        }
    }

    #[test]
    fn tiles_meet_exactly() {
        let terrain = wavy();
        let world = |column, row| {
            let (mesh, origin) = terrain.tile(column, row, &BARE);
            let place = |p: &[f32; 3]| origin + glam::Vec3::from_array(*p).as_dvec3();
            mesh.primitives[0].positions.iter().map(place).collect::<Vec<_>>()
        };
        let (west, east) = (world(0, 0), world(1, 0));
        for row in 0..8 {
            assert_eq!(west[row * 8 + 7], east[row * 8], "row {row}");
        }
    }
}
