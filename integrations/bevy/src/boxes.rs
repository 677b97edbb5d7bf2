//! The boxes of all meshes, kept from frame to frame.

use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{InheritedVisibility, NoAutoAabb, NoFrustumCulling, RenderLayers};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_light::{NotShadowCaster, NotShadowReceiver};
use bevy_mesh::Mesh3d;
use bevy_transform::components::GlobalTransform;
use tracing::warn;
use umbrage::{Caster, CasterHandle, CasterSet, Layers, Motion};

/// Metres that a mesh without bounds is taken to reach from its origin along each axis. Lower: maps
/// are tighter where there is such a mesh. Higher: more of it is in them.
const UNBOUNDED_M: f64 = 1000.0;

/// The boxes of all visible meshes that cast or show shadows: what plans are made from.
///
/// Plans call an entity by its index, `Entity::index_u32`.
#[derive(Resource, Debug, Default)]
pub struct MeshBoxes {
    set: CasterSet,
    known: EntityHashMap<Known>,
    /// Of one call.
    fresh: Vec<(Entity, Caster, bool)>,
    has_warned: bool,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    handle: CasterHandle,
    /// Bevy is asked not to cull it.
    is_never_culled: bool,
}

impl MeshBoxes {
    /// The boxes, by the indices of their entities.
    #[must_use]
    pub fn set(&self) -> &CasterSet {
        &self.set
    }

    /// Whether a list of a plan's casters, rising, leaves an entity in a map: it is in the list, or
    /// nobody knows where it is.
    #[must_use]
    pub fn keeps(&self, entity: Entity, casters: &[u32]) -> bool {
        casters.binary_search(&entity.index_u32()).is_ok()
            || self.known.get(&entity).is_none_or(|known| known.is_never_culled)
    }

    fn remove(&mut self, entity: Entity) {
        if let Some(known) = self.known.remove(&entity) {
            let _ = self.set.remove(known.handle);
        }
    }

    /// Takes an entity over as it is now.
    fn update(&mut self, entity: Entity, caster: Caster, is_never_culled: bool) {
        let Some(known) = self.known.get_mut(&entity) else {
            return self.fresh.push((entity, caster, is_never_culled));
        };
        known.is_never_culled = is_never_culled;
        let handle = known.handle;
        let Ok(before) = self.set.get(handle) else { return };
        let has_moved = !contains(before.bounds, caster.bounds);
        let motion = if has_moved { Motion::Moving } else { before.motion };
        let changed = Caster { motion, ..caster };
        let result = if (Caster { bounds: before.bounds, ..changed }) == before {
            self.set.set_bounds(handle, caster.bounds)
        } else {
            self.set.replace(handle, changed)
        };
        if let Err(error) = result {
            self.refuse(entity, &error);
        }
    }

    /// Adds all that came in one call: packed together, or one by one if one is refused.
    fn add_fresh(&mut self) {
        let fresh = std::mem::take(&mut self.fresh);
        match self.set.insert_all(fresh.iter().map(|&(_, caster, _)| caster)) {
            Ok(handles) => {
                for (&(entity, _, is_never_culled), handle) in fresh.iter().zip(handles) {
                    self.known.insert(entity, Known { handle, is_never_culled });
                }
            }
            Err(_) => {
                for &(entity, caster, is_never_culled) in &fresh {
                    match self.set.insert(caster) {
                        Ok(handle) => {
                            self.known.insert(entity, Known { handle, is_never_culled });
                        }
                        Err(error) => self.refuse(entity, &error),
                    }
                }
            }
        }
        self.fresh = fresh;
        self.fresh.clear();
    }

    /// An entity that the planner does not take is left to Bevy: it is in every map that Bevy puts
    /// it in.
    fn refuse(&mut self, entity: Entity, error: &umbrage::Error) {
        self.remove(entity);
        if !self.has_warned {
            warn!("mesh {entity} is not planned for, nor are others like it: {error}");
        }
        self.has_warned = true;
    }
}

/// Whether the kept box, which is rounded outwards, still holds a box, and hardly more.
fn contains(kept: umbrage::Aabb, now: umbrage::Aabb) -> bool {
    const ROUNDING: f64 = 1e-3;
    let (below, above) = (now.min - kept.min, kept.max - now.max);
    below.min(above).min_element() >= 0.0 && below.max(above).max_element() <= ROUNDING
}

/// What a mesh is, for shadows.
type MeshData = (
    Entity,
    &'static GlobalTransform,
    &'static InheritedVisibility,
    Option<&'static Aabb>,
    Option<&'static RenderLayers>,
    Has<NotShadowCaster>,
    Has<NotShadowReceiver>,
    Has<NoFrustumCulling>,
    Has<NoAutoAabb>,
);

type HasChanged = Or<(
    Changed<Mesh3d>,
    Changed<GlobalTransform>,
    Changed<InheritedVisibility>,
    Changed<Aabb>,
    Changed<RenderLayers>,
    Added<NotShadowCaster>,
    Added<NotShadowReceiver>,
    Added<NoFrustumCulling>,
    Added<NoAutoAabb>,
)>;

/// Entities that have lost something.
#[derive(SystemParam)]
pub(crate) struct Lost<'w, 's> {
    meshes: RemovedComponents<'w, 's, Mesh3d>,
    boxes: RemovedComponents<'w, 's, Aabb>,
    layers: RemovedComponents<'w, 's, RenderLayers>,
    not_casters: RemovedComponents<'w, 's, NotShadowCaster>,
    not_receivers: RemovedComponents<'w, 's, NotShadowReceiver>,
    not_culled: RemovedComponents<'w, 's, NoFrustumCulling>,
    not_boxed: RemovedComponents<'w, 's, NoAutoAabb>,
}

impl Lost<'_, '_> {
    /// Writes each of them once.
    fn read_into(&mut self, entities: &mut Vec<Entity>) {
        entities.clear();
        entities.extend(self.meshes.read().chain(self.boxes.read()).chain(self.layers.read()));
        entities.extend(self.not_casters.read().chain(self.not_receivers.read()));
        entities.extend(self.not_culled.read().chain(self.not_boxed.read()));
        entities.sort_unstable();
        entities.dedup();
    }
}

/// Takes over what has changed of meshes since the last frame.
pub(crate) fn track_meshes(
    mut boxes: ResMut<MeshBoxes>,
    changed: Query<MeshData, (With<Mesh3d>, HasChanged)>,
    meshes: Query<MeshData, With<Mesh3d>>,
    mut lost: Lost,
    mut entities: Local<Vec<Entity>>,
) {
    lost.read_into(&mut entities);
    for &entity in &*entities {
        boxes.remove(entity);
    }
    for mesh in entities.iter().filter_map(|&entity| meshes.get(entity).ok()) {
        take(&mut boxes, mesh);
    }
    boxes.add_fresh();
    for mesh in &changed {
        take(&mut boxes, mesh);
    }
    boxes.add_fresh();
}

fn take(
    boxes: &mut MeshBoxes,
    (entity, transform, visibility, aabb, layers, is_no_caster, is_no_receiver, is_never_culled, has_own_box):
        bevy_ecs::query::QueryItem<'_, '_, MeshData>,
) {
    let bounds = match aabb {
        Some(aabb) => {
            let mesh = umbrage::Aabb::from([aabb.min().to_array(), aabb.max().to_array()]);
            mesh.transformed(transform.to_matrix().to_cols_array_2d())
        }
        None if is_never_culled || has_own_box => {
            let origin = transform.translation().to_array().map(f64::from);
            umbrage::Aabb::from([origin.map(|at| at - UNBOUNDED_M), origin.map(|at| at + UNBOUNDED_M)])
        }
        // Its mesh is not loaded: it is not drawn either.
        None => return boxes.remove(entity),
    };
    if !visibility.get() || (is_no_caster && is_no_receiver) {
        return boxes.remove(entity);
    }
    let caster = Caster {
        layers: layers_of(layers),
        casts: !is_no_caster,
        receives: !is_no_receiver,
        ..Caster::new(bounds, entity.index_u32())
    };
    boxes.update(entity, caster, is_never_culled || aabb.is_none());
}

/// Bevy's layers as the planner's: its last one stands for Bevy's from 31 on.
pub(crate) fn layers_of(layers: Option<&RenderLayers>) -> Layers {
    let bits = layers.unwrap_or_default().bits();
    let first = bits.first().copied().unwrap_or_default();
    let last = (first >> 31 != 0 || bits.iter().skip(1).any(|&block| block != 0)).into();
    Layers::from_bits((first as u32 & !(1 << 31)) | u32::checked_shl(last, 31).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_from_31_on_share_the_last() {
        let of = |layers: &[usize]| layers_of(Some(&RenderLayers::from_layers(layers))).bits();
        assert_eq!(layers_of(None).bits(), 1);
        assert_eq!(of(&[]), 0);
        assert_eq!(of(&[0, 3]), 0b1001);
        assert_eq!(of(&[31]), 1 << 31);
        assert_eq!(of(&[32, 2]), (1 << 31) | 4);
        assert_eq!(of(&[200]), 1 << 31);
    }

    #[test]
    fn a_kept_box_holds_what_it_was_rounded_from_and_nothing_that_moved() {
        let unit = umbrage::Aabb::from([[0.0; 3], [1.0; 3]]);
        let grown = umbrage::Aabb::from([[-6e-5; 3], [1.0 + 6e-5; 3]]);
        assert!(contains(grown, unit));
        assert!(!contains(grown, umbrage::Aabb::from([[0.1; 3], [1.1; 3]])));
        assert!(!contains(grown, umbrage::Aabb::from([[0.1; 3], [0.9; 3]])));
    }
}
