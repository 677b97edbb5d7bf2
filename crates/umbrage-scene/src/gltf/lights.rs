//! Lights of nodes (KHR_lights_punctual).

use gltf::json;
use gltf::json::extensions::scene::khr_lights_punctual::{Light as JsonLight, Type as LightType};
use gltf::json::validation::Checked;

use super::Document;
use crate::error::element;
use crate::{LightKind, Result, SceneLight};

/// Loads the light on a node, with its index in the file.
pub(super) fn load(
    document: &Document<'_>,
    json: &json::Node,
    user: &str,
    node: usize,
) -> Result<Option<(usize, SceneLight)>> {
    let extension = json.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    let Some(extension) = extension else { return Ok(None) };
    let lights: &[JsonLight] = document.root.as_ref();
    let index = extension.light.value();
    if let Some(reason) = document.broken.lights.get(&index) {
        return Err(document.invalid(element("lights", index, ""), reason.as_str()));
    }
    let light = document.get(lights, index, "lights", user)?;
    let name = light.name.clone().or_else(|| json.name.clone()).unwrap_or_default();
    let user = element("lights", index, &name);
    document.finite(&user, "color", &light.color)?;
    document.finite(&user, "intensity", &[light.intensity])?;
    let kind = match light.type_ {
        Checked::Valid(LightType::Directional) => LightKind::Directional,
        Checked::Valid(LightType::Point) => LightKind::Point,
        Checked::Valid(LightType::Spot) => {
            let spot = light.spot.clone().unwrap_or(json::extensions::scene::khr_lights_punctual::Spot {
                inner_cone_angle: 0.0,
                outer_cone_angle: std::f32::consts::FRAC_PI_4,
            });
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            // A little more than a right angle is what rounding makes of π/2.
            if !(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= std::f32::consts::FRAC_PI_2 * 1.000_001) {
                let reason = format!("has cone angles {inner} and {outer}; 0 ≤ inner ≤ outer ≤ π/2 has to hold");
                return Err(document.invalid(user, reason));
            }
            LightKind::Spot { inner: inner.into(), outer: outer.into() }
        }
        Checked::Invalid => return Err(document.invalid(user, "has an unknown type")),
    };
    if let Some(range) = light.range.filter(|range| range.is_nan() || *range <= 0.0) {
        return Err(document.invalid(user, format!("range is {range}; it has to be above 0")));
    }
    let range = light.range.filter(|range| range.is_finite()).map(f64::from);
    let light = SceneLight { name, node, kind, color: light.color, intensity: light.intensity, range };
    Ok(Some((index, light)))
}
