#![doc = include_str!("../README.md")]

mod boxes;
mod camera;
mod cascade;
mod config;
mod error;
mod lights;
mod shared;
mod systems;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_camera::CameraUpdateSystems;
use bevy_camera::visibility::VisibilitySystems;
use bevy_ecs::prelude::*;
use bevy_light::SimulationLightSystems;
use bevy_transform::TransformSystems;
use umbrage::{ShadowConfig, ShadowPlan};

pub use boxes::MeshBoxes;
pub use config::{Ignored, for_bevy, most_cascades};
pub use error::Error;
pub use umbrage;

use lights::LightState;

/// Plans the cascades of all directional lights that cast shadows.
///
/// ```no_run
/// # use bevy_app::App;
/// use umbrage_bevy::UmbrageShadowsPlugin;
///
/// # let mut app = App::new();
/// app.add_plugins(UmbrageShadowsPlugin::default());
/// ```
#[derive(Clone, Debug, Default)]
pub struct UmbrageShadowsPlugin {
    /// How lights without [`LightShadows`] are planned: the first value of [`UmbrageShadows`].
    pub config: ShadowConfig,
}

/// How lights without [`LightShadows`] are planned. May be changed at any time.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct UmbrageShadows(pub ShadowConfig);

/// How a light is planned, on its entity.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct LightShadows(pub ShadowConfig);

/// A light, by this on its entity, keeps Bevy's own cascades.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct BevyCascades;

/// When the systems run, in `PostUpdate`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UmbrageSystems {
    /// Gives lights back the `CascadeShadowConfig` that the application gave them. Bevy then builds
    /// its own cascades from it, which stay if the planner refuses.
    Restore,
    /// Takes over the boxes of meshes, plans, and writes `Cascades` and `CascadeShadowConfig`.
    Plan,
    /// Takes out of `CascadesVisibleEntities` what casts no shadow that is seen.
    Cull,
}

/// What was planned for each light in this frame.
#[derive(Resource, Debug, Default)]
pub struct PlannedLights {
    lights: bevy_ecs::entity::EntityHashMap<LightState>,
    eyes: Vec<lights::Eye>,
}

impl PlannedLights {
    /// The plan of a light for a camera. `None`: the light has Bevy's own cascades, or none.
    #[must_use]
    pub fn plan(&self, light: Entity, camera: Entity) -> Option<&ShadowPlan> {
        let state = self.lights.get(&light).filter(|state| state.is_planned)?;
        state.views.get(&camera).map(|view| &view.plan)
    }

    /// Why a light has Bevy's own cascades, if the planner refused it in this frame.
    #[must_use]
    pub fn refusal(&self, light: Entity) -> Option<&Error> {
        self.lights.get(&light)?.told.as_ref()
    }
}

impl Plugin for UmbrageShadowsPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(UmbrageShadows(self.config.clone()))
            .init_resource::<MeshBoxes>()
            .init_resource::<PlannedLights>()
            .configure_sets(
                PostUpdate,
                (
                    UmbrageSystems::Restore.before(SimulationLightSystems::UpdateDirectionalLightCascades),
                    UmbrageSystems::Plan
                        .after(SimulationLightSystems::UpdateDirectionalLightCascades)
                        .after(TransformSystems::Propagate)
                        .after(CameraUpdateSystems)
                        .after(VisibilitySystems::CalculateBounds)
                        .after(VisibilitySystems::VisibilityPropagate)
                        .before(SimulationLightSystems::UpdateLightFrusta),
                    UmbrageSystems::Cull.after(SimulationLightSystems::CheckLightVisibility),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    systems::restore_configs.in_set(UmbrageSystems::Restore),
                    (boxes::track_meshes, systems::plan_cascades).chain().in_set(UmbrageSystems::Plan),
                    systems::cull_casters.in_set(UmbrageSystems::Cull),
                ),
            );
    }
}
