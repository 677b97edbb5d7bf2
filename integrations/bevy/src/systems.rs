//! The systems.

use bevy_camera::visibility::{CascadesVisibleEntities, InheritedVisibility, RenderLayers};
use bevy_camera::{Camera, Camera3d, Projection};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryItem;
use bevy_light::{
    CascadeShadowConfig, Cascades, DirectionalLight, DirectionalLightShadowMap, ShadowFilteringMethod, VolumetricLight,
};
use bevy_transform::components::GlobalTransform;
use tracing::{error, warn};
use umbrage::glam::DVec3;

use crate::boxes::{MeshBoxes, layers_of};
use crate::camera::PlannerView;
use crate::cascade::ReceiverOffset;
use crate::lights::{Eye, LightFrame, LightState, copy, equal};
use crate::{BevyCascades, Error, LightShadows, PlannedLights, UmbrageShadows};

/// Gives lights back their own configs, for Bevy to build cascades by.
pub(crate) fn restore_configs(mut planned: ResMut<PlannedLights>, mut lights: Query<&mut CascadeShadowConfig>) {
    for (&light, state) in &mut planned.lights {
        let was_planned = std::mem::take(&mut state.is_planned);
        let Ok(mut config) = lights.get_mut(light) else { continue };
        // Otherwise the application has written another one since.
        if was_planned && equal(&state.written, &config) {
            copy(&state.own, config.bypass_change_detection());
        }
    }
}

type CameraData = (
    Entity,
    &'static Camera,
    &'static Projection,
    &'static GlobalTransform,
    Option<&'static RenderLayers>,
    Option<&'static ShadowFilteringMethod>,
);

type LightData = (
    Entity,
    &'static DirectionalLight,
    &'static GlobalTransform,
    &'static InheritedVisibility,
    Option<&'static RenderLayers>,
    Option<&'static LightShadows>,
    Has<BevyCascades>,
    Has<VolumetricLight>,
    &'static mut CascadeShadowConfig,
    &'static mut Cascades,
);

/// What all lights are planned by.
#[derive(bevy_ecs::system::SystemParam)]
pub(crate) struct Common<'w> {
    usual: Res<'w, UmbrageShadows>,
    maps: Res<'w, DirectionalLightShadowMap>,
    boxes: Res<'w, MeshBoxes>,
}

/// Writes planned cascades over Bevy's. Cameras and lights that are not planned keep Bevy's: the
/// renderer needs an entry for every camera.
pub(crate) fn plan_cascades(
    common: Common,
    mut planned: ResMut<PlannedLights>,
    cameras: Query<CameraData, With<Camera3d>>,
    mut lights: Query<LightData>,
) {
    let PlannedLights { lights: states, eyes } = &mut *planned;
    states.retain(|&light, _| lights.contains(light));
    for light in &mut lights {
        let (entity, sun, _, visibility, _, _, is_bevys, ..) = light;
        if is_bevys || !sun.shadow_maps_enabled || !visibility.get() {
            states.remove(&entity);
            continue;
        }
        let state = states.entry(entity).or_default();
        let told = state.told.take();
        let result = plan_light(&common, &cameras, light, state, eyes);
        for ignored in state.ignored.drain(..) {
            warn!("light {entity}: {} has no effect: {}", ignored.setting, ignored.instead);
        }
        state.told = result.err();
        if let Some(now) = &state.told
            && told.as_ref() != Some(now)
        {
            error!("light {entity} keeps Bevy's own cascades: {now}");
        }
    }
}

fn plan_light(
    common: &Common,
    cameras: &Query<CameraData, With<Camera3d>>,
    light: QueryItem<'_, '_, LightData>,
    state: &mut LightState,
    eyes: &mut Vec<Eye>,
) -> Result<(), Error> {
    let (_, sun, transform, _, layers, shadows, _, is_volumetric, mut config, mut cascades) = light;
    copy(&config, &mut state.own);
    if is_volumetric {
        return Err(Error::Volumetric);
    }
    let unlayered = RenderLayers::default();
    let own_layers = layers.unwrap_or(&unlayered);
    eyes.clear();
    for (camera, lens, projection, place, seen_layers, method) in cameras {
        if !lens.is_active || !own_layers.intersects(seen_layers.unwrap_or(&unlayered)) {
            continue;
        }
        eyes.push(Eye {
            camera,
            seen: PlannerView::new(camera, (lens, projection, place))?,
            layers: layers_of(seen_layers),
            method: method.copied().unwrap_or_default(),
        });
    }
    // In the same order in every frame, for the same planes.
    eyes.sort_unstable_by_key(|eye| eye.camera);
    if eyes.is_empty() {
        state.views.clear();
        return Ok(());
    }
    let travel = DVec3::from_array(transform.forward().as_vec3().to_array().map(f64::from));
    let frame = LightFrame {
        sun: umbrage::DirectionalLight::new(travel)?,
        offset: ReceiverOffset::of(sun),
        layers: layers_of(layers),
        boxes: &common.boxes,
    };
    let asked = shadows.map_or(&common.usual.0, |shadows| &shadows.0);
    let map_size = u32::try_from(common.maps.size).unwrap_or(u32::MAX);
    state.plan((asked, map_size), &frame, eyes)?;
    state.write(frame.offset, &mut config, &mut cascades);
    Ok(())
}

/// Takes casters out of Bevy's lists that cast no shadow on anything that is seen through the map.
pub(crate) fn cull_casters(
    planned: Res<PlannedLights>,
    boxes: Res<MeshBoxes>,
    mut lights: Query<(Entity, &mut CascadesVisibleEntities)>,
) {
    for (light, mut visible) in &mut lights {
        let Some(state) = planned.lights.get(&light).filter(|state| state.is_planned) else { continue };
        for (camera, lists) in &mut visible.entities {
            let Some(view) = state.views.get(camera) else { continue };
            for (split, list) in lists.iter_mut().enumerate().take(view.plan.splits.len()) {
                let casters = view.plan.casters(split);
                list.entities.retain(|&entity| boxes.keeps(entity, casters));
            }
        }
    }
}
