//! Worlds of any number of objects: forest, city, and more robots than the paper has.

pub(super) mod buildings;
pub(super) mod city;
pub(super) mod forest;
mod options;
pub(super) mod robots;
pub(super) mod trees;

pub use options::WorldOptions;

use super::stage::Stage;
use crate::{DetailLevel, Mesh, Node, Trs};

/// Callback that is given the share of a world that is built, from 0 to 1.
pub type Watch<'a> = &'a dyn Fn(f32);

/// A mesh with its coarser levels of detail, finest first, each with the size in metres of the
/// smallest detail that it shows.
pub(super) struct Levels(pub(super) Vec<(Mesh, f64)>);

impl Levels {
    /// Stores all levels and returns the index of the finest.
    pub(super) fn store(self, stage: &mut Stage) -> usize {
        let mut stored = self.0.into_iter().map(|(mesh, detail_m)| DetailLevel { mesh: stage.mesh(mesh), detail_m });
        let finest = stored.next().expect("there is a finest shape").mesh;
        let coarser: Vec<DetailLevel> = stored.collect();
        stage.scene.levels.insert(finest, coarser);
        finest
    }
}

/// Places of objects that share meshes: a node for each mesh, with an instance for each place.
pub(super) struct Crowd {
    name: &'static str,
    meshes: Vec<usize>,
    places: Vec<Vec<Trs>>,
}

impl Crowd {
    /// Makes an empty crowd.
    pub(super) fn new(name: &'static str, meshes: Vec<usize>) -> Self {
        let places = vec![Vec::new(); meshes.len()];
        Self { name, meshes, places }
    }

    /// Adds an instance of the `kind`-th mesh.
    pub(super) fn add(&mut self, kind: usize, place: Trs) {
        self.places[kind].push(place);
    }

    /// Returns the number of meshes.
    pub(super) fn kinds(&self) -> usize {
        self.meshes.len()
    }

    /// Adds all instances to the stage.
    pub(super) fn place(self, stage: &mut Stage) {
        for (kind, (mesh, mut instances)) in self.meshes.into_iter().zip(self.places).enumerate() {
            if instances.is_empty() {
                continue;
            }
            instances.shrink_to_fit();
            let name = format!("{} {kind}", self.name);
            stage.node(Node { name, mesh: Some(mesh), instances, ..Node::default() });
        }
    }
}
