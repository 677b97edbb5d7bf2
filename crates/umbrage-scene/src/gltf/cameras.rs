//! Cameras of nodes.

use gltf::json;
use gltf::json::camera::Type as CameraType;
use gltf::json::validation::Checked;

use super::Document;
use crate::error::element;
use crate::{Lens, Result, SceneCamera};

/// Loads the camera on a node, with its index in the file.
pub(super) fn load(
    document: &Document<'_>,
    json: &json::Node,
    user: &str,
    node: usize,
) -> Result<Option<(usize, SceneCamera)>> {
    let Some(index) = json.camera else { return Ok(None) };
    if let Some(reason) = document.broken.cameras.get(&index.value()) {
        return Err(document.invalid(element("cameras", index.value(), ""), reason.as_str()));
    }
    let camera = document.get(&document.root.cameras, index.value(), "cameras", user)?;
    let name = camera.name.clone().or_else(|| json.name.clone()).unwrap_or_default();
    let user = element("cameras", index.value(), &name);
    let need = |is_true: bool, field: &str, value: f32, expected: &str| {
        if is_true {
            Ok(())
        } else {
            Err(document.invalid(&user, format!("{field} is {value}; it has to be {expected}")))
        }
    };
    let lens = match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(CameraType::Perspective), Some(p), _) => {
            need(p.yfov > 0.0 && p.yfov < std::f32::consts::PI, "yfov", p.yfov, "between 0 and π")?;
            need(p.znear > 0.0 && p.znear.is_finite(), "znear", p.znear, "a finite number above 0")?;
            if let Some(zfar) = p.zfar {
                need(zfar > p.znear && zfar.is_finite(), "zfar", zfar, "above znear")?;
            }
            if let Some(aspect) = p.aspect_ratio {
                need(aspect > 0.0 && aspect.is_finite(), "aspectRatio", aspect, "a finite number above 0")?;
            }
            Lens::Perspective {
                yfov: p.yfov.into(),
                aspect: p.aspect_ratio.map(f64::from),
                znear: p.znear.into(),
                zfar: p.zfar.map(f64::from),
            }
        }
        (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
            // A negative magnification mirrors the picture; the specification advises against it
            // and nobody needs it.
            need(o.xmag.abs() > 0.0 && o.xmag.is_finite(), "xmag", o.xmag, "a finite number other than 0")?;
            need(o.ymag.abs() > 0.0 && o.ymag.is_finite(), "ymag", o.ymag, "a finite number other than 0")?;
            need(o.znear >= 0.0 && o.znear.is_finite(), "znear", o.znear, "a finite number of 0 or more")?;
            need(o.zfar > o.znear && o.zfar.is_finite(), "zfar", o.zfar, "above znear")?;
            Lens::Orthographic {
                xmag: o.xmag.abs().into(),
                ymag: o.ymag.abs().into(),
                znear: o.znear.into(),
                zfar: o.zfar.into(),
            }
        }
        _ => return Err(document.invalid(user, "has no parameters for its type of projection")),
    };
    Ok(Some((index.value(), SceneCamera { name, node, lens })))
}
