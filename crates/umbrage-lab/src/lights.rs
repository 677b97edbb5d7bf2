//! Lights of a request: their choice, their names and their reports.

use umbrage::{DirectionalLight, Light};
use umbrage_render::{Lamp, MOST_LAMPS};
use umbrage_scene::{CameraPath, LightKind, Pose, Scene};

use crate::{
    choose::{named, several},
    failure::{Failure, Result},
    report::LightReport,
    scene_request::{LightChoice, SceneRequest},
};

/// A light with a name for display.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedLight {
    /// Name of the light: the scene's, its number, or how it was given.
    pub name: String,
    /// The light.
    pub lamp: Lamp,
}

impl NamedLight {
    /// Returns the part of a report that describes the light itself.
    #[must_use]
    pub fn report(&self) -> LightReport {
        let light = self.lamp.light;
        let (kind, direction, outer_angle) = match light {
            Light::Directional(sun) => ("directional", Some(sun.direction()), None),
            Light::Spot(spot) => ("spot", Some(spot.direction()), Some(spot.outer_angle().to_degrees())),
            Light::Point(_) => ("point", None, None),
        };
        LightReport {
            name: self.name.clone(),
            kind,
            direction: direction.map(|direction| direction.to_array()),
            position: light.position().map(|position| position.to_array()),
            range_m: light.position().map(|_| light.range()),
            outer_angle,
            planes_m: Vec::new(),
            splits: Vec::new(),
        }
    }
}

/// Returns the kinds of lights that maps have to be made for.
#[must_use]
pub fn kinds(lights: &[NamedLight]) -> Vec<umbrage::config::LightKind> {
    lights.iter().map(|light| light.lamp.light.into()).collect()
}

/// Returns the lights that a request asks for, at least one.
///
/// # Errors
/// [`Failure::Input`] with the option or the light at fault.
pub fn chosen(
    request: &SceneRequest,
    scene: &Scene,
    pose: &Pose,
    path: Option<&CameraPath>,
    notes: &mut Vec<String>,
) -> Result<Vec<NamedLight>> {
    let sun = |name: &str, direction| -> Result<Vec<NamedLight>> {
        Ok(vec![NamedLight { name: name.to_owned(), lamp: DirectionalLight::new(direction)?.into() }])
    };
    match &request.light {
        LightChoice::Given(direction) => return sun("--sun", *direction),
        LightChoice::Named(wanted) => {
            let indices = indices(wanted, scene)?;
            if indices.len() > MOST_LAMPS {
                return Err(Failure::input(format!(
                    "--light {wanted}: {} lights, but at most {MOST_LAMPS} can cast shadows at once; name those",
                    indices.len()
                )));
            }
            return indices.into_iter().map(|index| of_scene(scene, pose, index)).collect();
        }
        LightChoice::Default => {}
    }
    if let Some(to_light) = path.and_then(|path| path.sun_direction_to_light) {
        return sun("the path's sun", -to_light);
    }
    if let Some(index) = scene.lights.iter().position(|light| light.kind == LightKind::Directional) {
        return Ok(vec![of_scene(scene, pose, index)?]);
    }
    let direction = umbrage_scene::invented_sun();
    let others = if scene.lights.is_empty() { "" } else { " (--light takes its spot and point lights)" };
    notes.push(format!(
        "the scene has no directional light and no --sun was given: invented one that travels {:.3},{:.3},{:.3}{others}",
        direction.x, direction.y, direction.z
    ));
    sun("invented", direction)
}

/// Returns the lights that `--light` names: one by its name, whatever characters it has; `all`; or
/// several between commas.
fn indices(wanted: &str, scene: &Scene) -> Result<Vec<usize>> {
    let names: Vec<&str> = scene.lights.iter().map(|light| light.name.as_str()).collect();
    if wanted != "all" || names.contains(&wanted) {
        return several("--light", "light", wanted, &names);
    }
    if names.is_empty() {
        return Err(Failure::input("--light all: the scene has no light"));
    }
    Ok((0..names.len()).collect())
}

fn of_scene(scene: &Scene, pose: &Pose, index: usize) -> Result<NamedLight> {
    let light = &scene.lights[index];
    let brightest = light.color.iter().copied().fold(0.0, f32::max);
    let mut lamp = Lamp::from(umbrage_scene::scene_light(scene, pose, index)?);
    if light.kind != LightKind::Directional && brightest > 0.0 {
        lamp.color = glam::Vec3::from(light.color) / brightest;
    }
    if let LightKind::Spot { inner, .. } = light.kind {
        lamp.inner_angle = inner;
    }
    Ok(NamedLight { name: named(&light.name, index), lamp })
}
