//! Materials and the textures of their base colour.

use std::collections::BTreeMap;

use gltf::json;
use gltf::json::material::AlphaMode as JsonAlpha;
use gltf::json::validation::Checked;
use serde::Deserialize;

use super::Document;
use super::textures::Textures;
use crate::error::element;
use crate::{AlphaMode, Error, Material, Result, Texture};

/// Set of texture coordinates of a material, and their transform (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TextureCoordinates {
    /// Number of the set: n of `TEXCOORD_n`.
    pub(super) set: u32,
    offset: [f64; 2],
    rotation: f64,
    scale: [f64; 2],
}

impl TextureCoordinates {
    /// Applies translation × rotation × scale as in KHR_texture_transform. Its rotation is
    /// counter-clockwise with v down.
    pub(super) fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        if self.offset == [0.0; 2] && self.rotation == 0.0 && self.scale == [1.0; 2] {
            return [u, v];
        }
        let (sin, cos) = self.rotation.sin_cos();
        let (x, y) = (f64::from(u) * self.scale[0], f64::from(v) * self.scale[1]);
        [(cos * x + sin * y + self.offset[0]) as f32, (cos * y - sin * x + self.offset[1]) as f32]
    }
}

/// KHR_materials_pbrSpecularGlossiness, as far as it affects base colour.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SpecularGlossiness {
    #[serde(default = "white")]
    diffuse_factor: [f32; 4],
    diffuse_texture: Option<json::texture::Info>,
}

fn white() -> [f32; 4] {
    [1.0; 4]
}

/// All materials, the textures that they use, and the texture coordinates of each material.
type Loaded = (Vec<Material>, Vec<Texture>, Vec<Option<TextureCoordinates>>);

pub(super) fn load(document: &Document<'_>) -> Result<Loaded> {
    let mut users = BTreeMap::new();
    let mut base_colors = Vec::with_capacity(document.root.materials.len());
    for (index, json) in document.root.materials.iter().enumerate() {
        let user = element("materials", index, json.name.as_deref().unwrap_or_default());
        let (color, info) = base_color(document, json, &user)?;
        if let Some(info) = &info {
            users.entry(info.index.value()).or_insert_with(|| user.clone());
        }
        base_colors.push((user, color, info));
    }
    let textures = Textures::load(document, &users)?;
    let (mut materials, mut coordinates) = (Vec::new(), Vec::new());
    for (json, (user, color, info)) in document.root.materials.iter().zip(base_colors) {
        let mut material = load_one(document, json, &user, color)?;
        let mut source = None;
        if let Some(info) = info {
            material.base_color_texture = texture(document, &textures, info.index.value(), &material, &user)?;
            if material.base_color_texture.is_some() {
                source = Some(texture_coordinates(document, &info, &user)?);
            }
        }
        materials.push(material);
        coordinates.push(source);
    }
    Ok((materials, textures.list, coordinates))
}

/// Loads the texture of a material. An unreadable one is left out, unless an alpha mask depends on
/// it.
fn texture(
    document: &Document<'_>,
    textures: &Textures,
    index: usize,
    material: &Material,
    user: &str,
) -> Result<Option<usize>> {
    let error = match textures.places.get(&index) {
        Some(Ok(place)) => return Ok(Some(*place)),
        Some(Err(error)) => error,
        None => return Ok(None),
    };
    if matches!(material.alpha, AlphaMode::Mask { .. }) {
        return Err(Error::Image {
            file: document.file.to_owned(),
            element: user.to_owned(),
            reason: format!("its alpha mask needs textures[{index}], which cannot be read: {}", document.said(error)),
        });
    }
    // By the picture, so that the same fault of many is one line.
    match error {
        Error::Image { element, reason, .. } => {
            document.notes.add(format!("{element} of {user}"), format!("its texture is left out: {reason}"));
        }
        error => document.notes.add(user, format!("textures[{index}] is left out: {}", document.said(error))),
    }
    Ok(None)
}

/// Returns the linear RGBA of a material, and the source of its texture.
fn base_color(
    document: &Document<'_>,
    json: &json::Material,
    user: &str,
) -> Result<([f32; 4], Option<json::texture::Info>)> {
    let extension = json.extensions.as_ref().and_then(|e| e.others.get("KHR_materials_pbrSpecularGlossiness"));
    if let Some(value) = extension {
        let old = SpecularGlossiness::deserialize(value)
            .map_err(|error| document.invalid(user, format!("KHR_materials_pbrSpecularGlossiness: {error}")))?;
        return Ok((old.diffuse_factor, old.diffuse_texture));
    }
    let pbr = &json.pbr_metallic_roughness;
    Ok((pbr.base_color_factor.0, pbr.base_color_texture.clone()))
}

/// Loads a material without its texture.
fn load_one(document: &Document<'_>, json: &json::Material, user: &str, base_color: [f32; 4]) -> Result<Material> {
    let name = json.name.clone().unwrap_or_default();
    let extension = |name: &str| json.extensions.as_ref().and_then(|extensions| extensions.others.get(name));
    document.finite(user, "the base colour", &base_color)?;

    let mut emissive = json.emissive_factor.0;
    if let Some(strength) = extension("KHR_materials_emissive_strength").and_then(|e| e.get("emissiveStrength")) {
        let strength =
            strength.as_f64().ok_or_else(|| document.invalid(user, "emissiveStrength has to be a number"))?;
        emissive = emissive.map(|c| c * strength as f32);
    }
    document.finite(user, "emissiveFactor", &emissive)?;
    let textured_glow = json.emissive_texture.is_some() && emissive != [0.0; 3];

    let cutoff = json.alpha_cutoff.unwrap_or_default().0;
    document.finite(user, "alphaCutoff", &[cutoff])?;
    let alpha = match json.alpha_mode {
        Checked::Valid(JsonAlpha::Opaque) => AlphaMode::Opaque,
        Checked::Valid(JsonAlpha::Mask) => AlphaMode::Mask { cutoff },
        Checked::Valid(JsonAlpha::Blend) => AlphaMode::Blend,
        Checked::Invalid => return Err(document.invalid(user, "has an unknown alphaMode")),
    };
    let double_sided = json.double_sided;

    if textured_glow {
        // Without its texture the whole surface would glow.
        emissive = [0.0; 3];
        document.notes.add(user, "its emissive texture is left out, and its emission with it");
    }
    Ok(Material { name, base_color, base_color_texture: None, alpha, double_sided, emissive })
}

fn texture_coordinates(document: &Document<'_>, info: &json::texture::Info, user: &str) -> Result<TextureCoordinates> {
    let plain = TextureCoordinates { set: info.tex_coord, offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] };
    let Some(transform) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) else {
        return Ok(plain);
    };
    let (offset, rotation, scale) = (transform.offset.0, transform.rotation.0, transform.scale.0);
    document.finite(user, "KHR_texture_transform", &[offset[0], offset[1], rotation, scale[0], scale[1]])?;
    Ok(TextureCoordinates {
        set: transform.tex_coord.unwrap_or(plain.set),
        offset: offset.map(f64::from),
        rotation: f64::from(rotation),
        scale: scale.map(f64::from),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_transform_turns_as_the_extension_says() {
        // The extension's own example: offset (0, 1), rotation π/2, scale (0.5, 0.5) takes (u, v)
        // to (v, −u)/2 + (0, 1).
        let transform =
            TextureCoordinates { set: 0, offset: [0.0, 1.0], rotation: std::f64::consts::FRAC_PI_2, scale: [0.5, 0.5] };
        let [u, v] = transform.apply([1.0, 0.25]);
        assert!((u - 0.125).abs() < 1e-6 && (v - 0.5).abs() < 1e-6, "{u} {v}");
    }
}
