//! Coarser levels of detail of meshes, chosen by the detail that a split of a shadow map can show.

use std::collections::BTreeMap;

use umbrage_scene::{DetailLevel, Object, Scene};

/// Levels of detail, by mesh and level: for each, the levels that are coarser.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coarser(BTreeMap<usize, Vec<DetailLevel>>);

impl Coarser {
    pub fn of(scene: &Scene) -> Self {
        let mut coarser = BTreeMap::new();
        for (&mesh, levels) in &scene.levels {
            coarser.insert(mesh, levels.clone());
            for (rank, level) in levels.iter().enumerate() {
                coarser.entry(level.mesh).or_insert_with(|| levels[rank + 1..].to_vec());
            }
        }
        Self(coarser)
    }

    /// Returns the coarsest mesh of an object whose smallest detail is no larger than `detail_m`
    /// metres in the world.
    pub fn shape(&self, object: &Object, detail_m: f64) -> usize {
        let Some(levels) = self.0.get(&object.mesh).filter(|_| object.skinned.is_none()) else { return object.mesh };
        let m = object.world_from_local.matrix3;
        let scale = m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length());
        let chosen = levels.iter().rev().find(|level| level.detail_m * scale <= detail_m);
        chosen.map_or(object.mesh, |level| level.mesh)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};
    use umbrage::Aabb;

    use super::*;

    #[test]
    fn shapes_are_as_coarse_as_details_allow() {
        let level = |mesh, detail_m| DetailLevel { mesh, detail_m };
        let levels = BTreeMap::from([(0, vec![level(1, 0.5), level(2, 2.0)])]);
        let coarser = Coarser::of(&Scene { levels, ..Scene::default() });
        let object = |mesh, scale: f64| Object {
            node: 0,
            instance: Some(0),
            mesh,
            world_from_local: DAffine3::from_scale(DVec3::splat(scale)),
            skinned: None,
            bounds: Aabb::new(DVec3::ZERO, DVec3::ONE),
            casts: true,
        };
        let shapes = |mesh, scale| [0.1, 0.5, 1.9, 2.0, 9.0].map(|detail| coarser.shape(&object(mesh, scale), detail));
        assert_eq!(shapes(0, 1.0), [0, 1, 1, 2, 2]);
        assert_eq!(shapes(0, 2.0), [0, 0, 1, 1, 2]);
        assert_eq!(shapes(1, 1.0), [1, 1, 1, 2, 2], "never finer than the object's own");
        assert_eq!(shapes(3, 1.0), [3; 5], "a mesh without shapes");
    }
}
