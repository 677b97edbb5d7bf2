//! Materials and the textures of their base colour.

use std::collections::HashMap;

use gltf::json;
use gltf::json::material::AlphaMode as JsonAlpha;
use gltf::json::texture::WrappingMode;
use gltf::json::validation::Checked;
use serde::Deserialize;

use super::Document;
use super::images::Images;
use crate::error::element;
use crate::{AlphaMode, Material, Result, Texture, Wrap};

/// Which texture coordinates a material wants, and what becomes of them (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TextureCoordinates {
    /// n of `TEXCOORD_n`.
    pub(super) set: u32,
    offset: [f64; 2],
    rotation: f64,
    scale: [f64; 2],
}

impl TextureCoordinates {
    /// Translation × rotation × scale, as KHR_texture_transform has it (its rotation is counter-clockwise with v down).
    pub(super) fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        if self.offset == [0.0; 2] && self.rotation == 0.0 && self.scale == [1.0; 2] {
            return [u, v];
        }
        let (sin, cos) = self.rotation.sin_cos();
        let (x, y) = (f64::from(u) * self.scale[0], f64::from(v) * self.scale[1]);
        [(cos * x + sin * y + self.offset[0]) as f32, (cos * y - sin * x + self.offset[1]) as f32]
    }
}

/// KHR_materials_pbrSpecularGlossiness, as far as base colour goes.
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

/// All materials, the textures they use, and per material where its texture coordinates come from.
type Loaded = (Vec<Material>, Vec<Texture>, Vec<Option<TextureCoordinates>>);

pub(super) fn load(document: &mut Document<'_>) -> Result<Loaded> {
    let mut textures = Textures::default();
    let (mut materials, mut coordinates) = (Vec::new(), Vec::new());
    for index in 0..document.root.materials.len() {
        let (material, source) = load_one(document, index, &mut textures)?;
        materials.push(material);
        coordinates.push(source);
    }
    Ok((materials, textures.list, coordinates))
}

fn load_one(
    document: &mut Document<'_>,
    index: usize,
    textures: &mut Textures,
) -> Result<(Material, Option<TextureCoordinates>)> {
    let json = &document.root.materials[index];
    let name = json.name.clone().unwrap_or_default();
    let user = element("materials", index, &name);
    let pbr = &json.pbr_metallic_roughness;
    let (mut base_color, mut info) = (pbr.base_color_factor.0, pbr.base_color_texture.clone());
    let extension = |name: &str| json.extensions.as_ref().and_then(|extensions| extensions.others.get(name));

    if let Some(value) = extension("KHR_materials_pbrSpecularGlossiness") {
        let old = SpecularGlossiness::deserialize(value).map_err(|error| {
            document.invalid(user.as_str(), format!("KHR_materials_pbrSpecularGlossiness: {error}"))
        })?;
        (base_color, info) = (old.diffuse_factor, old.diffuse_texture);
    }
    document.finite(&user, "the base colour", &base_color)?;

    let mut emissive = json.emissive_factor.0;
    if let Some(strength) = extension("KHR_materials_emissive_strength").and_then(|e| e.get("emissiveStrength")) {
        let strength =
            strength.as_f64().ok_or_else(|| document.invalid(user.as_str(), "emissiveStrength has to be a number"))?;
        emissive = emissive.map(|c| c * strength as f32);
    }
    document.finite(&user, "emissiveFactor", &emissive)?;
    let textured_glow = json.emissive_texture.is_some() && emissive != [0.0; 3];

    let cutoff = json.alpha_cutoff.unwrap_or_default().0;
    document.finite(&user, "alphaCutoff", &[cutoff])?;
    let alpha = match json.alpha_mode {
        Checked::Valid(JsonAlpha::Opaque) => AlphaMode::Opaque,
        Checked::Valid(JsonAlpha::Mask) => AlphaMode::Mask { cutoff },
        Checked::Valid(JsonAlpha::Blend) => AlphaMode::Blend,
        Checked::Invalid => return Err(document.invalid(user, "has an unknown alphaMode")),
    };
    let double_sided = json.double_sided;

    let mut base_color_texture = None;
    let mut coordinates = None;
    if let Some(info) = info {
        base_color_texture = textures.get(document, info.index.value(), &user)?;
        if base_color_texture.is_some() {
            coordinates = Some(texture_coordinates(document, &info, &user)?);
        }
    }
    if textured_glow {
        // Without its texture the whole surface would glow.
        emissive = [0.0; 3];
        document.notes.add("an emissive texture is left out, and the emission of its material with it");
    }
    Ok((Material { name, base_color, base_color_texture, alpha, double_sided, emissive }, coordinates))
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

/// Textures in use; the same picture with the same addressing is stored once.
#[derive(Default)]
struct Textures {
    images: Images,
    list: Vec<Texture>,
    known: HashMap<(usize, [Wrap; 2]), usize>,
    pictures_in_use: HashMap<usize, usize>,
}

impl Textures {
    /// Index into the scene's textures of `textures[index]` of the file; `None` if it has no picture that can be read.
    fn get(&mut self, document: &mut Document<'_>, index: usize, user: &str) -> Result<Option<usize>> {
        let texture = document.get(&document.root.textures, index, "textures", user)?;
        let user = element("textures", index, texture.name.as_deref().unwrap_or_default());
        let wrap = match texture.sampler {
            Some(sampler) => {
                let sampler = document.get(&document.root.samplers, sampler.value(), "samplers", &user)?;
                let wrap = |mode| match mode {
                    Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
                    Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
                    Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
                    Checked::Invalid => Err(document.invalid(user.as_str(), "has an unknown wrapping mode")),
                };
                [wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?]
            }
            None => [Wrap::Repeat; 2],
        };
        let source = texture.source.value();
        // The `gltf` crate's way of saying that there is no `source`: the picture is in an extension's format.
        if source == u32::MAX as usize {
            document.notes.add("a texture has its picture in an extension's format only and is left out");
            return Ok(None);
        }
        if let Some(&known) = self.known.get(&(source, wrap)) {
            return Ok(Some(known));
        }
        let pixels = self.images.get(document, source, &user)?;
        let copies = self.pictures_in_use.entry(source).or_default();
        if *copies > 0 {
            self.images.charge(document, &user, pixels.rgba.len())?;
        }
        *copies += 1;
        self.list.push(Texture { width: pixels.width, height: pixels.height, rgba: pixels.rgba.clone(), wrap });
        self.known.insert((source, wrap), self.list.len() - 1);
        Ok(Some(self.list.len() - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_transform_turns_as_the_extension_says() {
        // The extension's own example: offset (0, 1), rotation π/2, scale (0.5, 0.5) takes (u, v) to (v, −u)/2 + (0, 1).
        let transform =
            TextureCoordinates { set: 0, offset: [0.0, 1.0], rotation: std::f64::consts::FRAC_PI_2, scale: [0.5, 0.5] };
        let [u, v] = transform.apply([1.0, 0.25]);
        assert!((u - 0.125).abs() < 1e-6 && (v - 0.5).abs() < 1e-6, "{u} {v}");
    }
}
