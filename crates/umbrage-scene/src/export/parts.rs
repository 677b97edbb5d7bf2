//! The lists of a glTF document, one function each.

use std::collections::HashMap;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Map, Value, json};

use super::binary::{Binary, Use};
use super::{named, number, numbers};
use crate::error::element;
use crate::{
    AlphaMode, Error, Interpolation, Keys, Lens, LightKind, MorphTarget, Primitive, Result, Scene, TextureFilter, Wrap,
};

/// Value of `magFilter` for samplers that show the nearest texel.
const NEAREST: u32 = 9728;

/// Writes the meshes that have triangles, and returns the new index of each mesh of the scene.
pub(super) fn meshes(scene: &Scene, binary: &mut Binary) -> Result<(Vec<Value>, Vec<Option<usize>>)> {
    let (mut list, mut place) = (Vec::new(), Vec::with_capacity(scene.meshes.len()));
    for mesh in &scene.meshes {
        let drawn = mesh.primitives.iter().filter(|primitive| !primitive.indices.is_empty());
        let primitives: Vec<Value> = drawn.map(|primitive| self::primitive(primitive, binary)).collect();
        if primitives.is_empty() {
            place.push(None);
            continue;
        }
        place.push(Some(list.len()));
        let mut json = named(&mesh.name);
        json.insert("primitives".into(), Value::Array(primitives));
        if !mesh.weights.is_empty() && mesh.is_morphed() {
            json.insert("weights".into(), numbers(&mesh.weights));
        }
        list.push(Value::Object(json));
    }
    Ok((list, place))
}

fn primitive(primitive: &Primitive, binary: &mut Binary) -> Value {
    let mut attributes = Map::new();
    attributes.insert("POSITION".into(), json!(binary.positions(&primitive.positions)));
    // Without normals a reader computes flat ones of the posed shape, which is what is meant.
    if !primitive.flat || primitive.targets.is_empty() {
        attributes.insert("NORMAL".into(), json!(binary.attribute(&primitive.normals)));
    }
    if !primitive.uvs.is_empty() {
        attributes.insert("TEXCOORD_0".into(), json!(binary.attribute(&primitive.uvs)));
    }
    if !primitive.colors.is_empty() {
        attributes.insert("COLOR_0".into(), json!(binary.attribute(&primitive.colors)));
    }
    if !primitive.joints.is_empty() {
        attributes.insert("JOINTS_0".into(), json!(binary.joints(&primitive.joints)));
        attributes.insert("WEIGHTS_0".into(), json!(binary.attribute(&primitive.weights)));
    }
    let indices = binary.indices(&primitive.indices);
    let mut json = json!({ "attributes": attributes, "indices": indices, "material": primitive.material });
    if !primitive.targets.is_empty() {
        json["targets"] = primitive.targets.iter().map(|target| self::target(primitive, target, binary)).collect();
    }
    json
}

/// Writes a morph target. glTF asks for one attribute at least, so a target without differences
/// gets those of positions.
fn target(primitive: &Primitive, target: &MorphTarget, binary: &mut Binary) -> Value {
    let mut attributes = Map::new();
    if !target.positions.is_empty() {
        attributes.insert("POSITION".into(), json!(binary.positions(&target.positions)));
    }
    if !target.normals.is_empty() {
        attributes.insert("NORMAL".into(), json!(binary.attribute(&target.normals)));
    }
    if attributes.is_empty() {
        let still = vec![[0.0; 3]; primitive.positions.len()];
        attributes.insert("POSITION".into(), json!(binary.positions(&still)));
    }
    Value::Object(attributes)
}

pub(super) fn materials(scene: &Scene, extensions_used: &mut Vec<&'static str>) -> Result<Vec<Value>> {
    let mut list = Vec::with_capacity(scene.materials.len());
    for (index, material) in scene.materials.iter().enumerate() {
        let is_finite = material.base_color.iter().chain(&material.emissive).all(|c| c.is_finite());
        if !is_finite {
            let element = element("materials", index, &material.name);
            return Err(Error::Export { element, reason: "has a colour that is not finite".into() });
        }
        let mut pbr = json!({
            "baseColorFactor": numbers(&material.base_color), "metallicFactor": 0, "roughnessFactor": 1,
        });
        if let Some(texture) = material.base_color_texture {
            pbr["baseColorTexture"] = json!({ "index": texture });
        }
        let mut json = named(&material.name);
        json.insert("pbrMetallicRoughness".into(), pbr);
        match material.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Mask { cutoff } => {
                json.insert("alphaMode".into(), json!("MASK"));
                json.insert("alphaCutoff".into(), json!(f64::from(cutoff)));
            }
            AlphaMode::Blend => {
                json.insert("alphaMode".into(), json!("BLEND"));
            }
        }
        if material.double_sided {
            json.insert("doubleSided".into(), json!(true));
        }
        // The factor is at most 1; what goes beyond is the extension's strength.
        let strength = material.emissive.iter().copied().fold(0.0, f32::max);
        if strength > 1.0 {
            json.insert("emissiveFactor".into(), numbers(&material.emissive.map(|c| c / strength)));
            let extension = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": f64::from(strength) } });
            json.insert("extensions".into(), extension);
            if !extensions_used.contains(&"KHR_materials_emissive_strength") {
                extensions_used.push("KHR_materials_emissive_strength");
            }
        } else if strength > 0.0 {
            json.insert("emissiveFactor".into(), numbers(&material.emissive));
        }
        list.push(Value::Object(json));
    }
    Ok(list)
}

/// Lists of textures, samplers and images.
#[derive(Default)]
pub(super) struct TextureLists {
    pub(super) textures: Vec<Value>,
    pub(super) samplers: Vec<Value>,
    pub(super) images: Vec<Value>,
}

pub(super) fn textures(scene: &Scene, binary: &mut Binary) -> Result<TextureLists> {
    let mut lists = TextureLists::default();
    let mut known_images: HashMap<(u32, u32, &[u8]), usize> = HashMap::new();
    let mut known_samplers: HashMap<([Wrap; 2], TextureFilter), usize> = HashMap::new();
    for (index, texture) in scene.textures.iter().enumerate() {
        let key = (texture.width, texture.height, texture.rgba.as_slice());
        let image = match known_images.get(&key) {
            Some(&image) => image,
            None => {
                let mut png = Vec::new();
                PngEncoder::new(&mut png)
                    .write_image(&texture.rgba, texture.width, texture.height, ExtendedColorType::Rgba8)
                    .map_err(|error| Error::Export {
                        element: format!("textures[{index}]"),
                        reason: format!("it cannot be written as PNG: {error}"),
                    })?;
                let view = binary.view(&png, Use::Other);
                lists.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
                known_images.insert(key, lists.images.len() - 1);
                lists.images.len() - 1
            }
        };
        let sampler = *known_samplers.entry((texture.wrap, texture.filter)).or_insert_with(|| {
            let mode = |wrap| match wrap {
                Wrap::Repeat => 10_497,
                Wrap::Clamp => 33_071,
                Wrap::Mirror => 33_648,
            };
            let mut sampler = json!({ "wrapS": mode(texture.wrap[0]), "wrapT": mode(texture.wrap[1]) });
            if texture.filter == TextureFilter::Nearest {
                sampler["magFilter"] = json!(NEAREST);
            }
            lists.samplers.push(sampler);
            lists.samplers.len() - 1
        });
        lists.textures.push(json!({ "source": image, "sampler": sampler }));
    }
    Ok(lists)
}

pub(super) fn cameras(scene: &Scene) -> Result<Vec<Value>> {
    let mut list = Vec::with_capacity(scene.cameras.len());
    for (index, camera) in scene.cameras.iter().enumerate() {
        let at = element("cameras", index, &camera.name);
        let number = |value, field| number(value, &at, field);
        let mut json = named(&camera.name);
        match camera.lens {
            Lens::Perspective { yfov, aspect, znear, zfar } => {
                let mut lens = json!({ "yfov": number(yfov, "yfov")?, "znear": number(znear, "znear")? });
                if let Some(zfar) = zfar {
                    lens["zfar"] = number(zfar, "zfar")?;
                }
                if let Some(aspect) = aspect {
                    lens["aspectRatio"] = number(aspect, "aspectRatio")?;
                }
                json.insert("type".into(), json!("perspective"));
                json.insert("perspective".into(), lens);
            }
            Lens::Orthographic { xmag, ymag, znear, zfar } => {
                json.insert("type".into(), json!("orthographic"));
                let lens = json!({
                    "xmag": number(xmag, "xmag")?, "ymag": number(ymag, "ymag")?,
                    "znear": number(znear, "znear")?, "zfar": number(zfar, "zfar")?,
                });
                json.insert("orthographic".into(), lens);
            }
        }
        list.push(Value::Object(json));
    }
    Ok(list)
}

/// Writes the lights of KHR_lights_punctual.
pub(super) fn lights(scene: &Scene) -> Result<Vec<Value>> {
    let mut list = Vec::with_capacity(scene.lights.len());
    for (index, light) in scene.lights.iter().enumerate() {
        let at = element("lights", index, &light.name);
        let number = |value, field| number(value, &at, field);
        let mut json = named(&light.name);
        for channel in light.color {
            number(channel.into(), "color")?;
        }
        json.insert("color".into(), numbers(&light.color));
        json.insert("intensity".into(), number(light.intensity.into(), "intensity")?);
        if let Some(range) = light.range {
            json.insert("range".into(), number(range, "range")?);
        }
        let kind = match light.kind {
            LightKind::Directional => "directional",
            LightKind::Point => "point",
            LightKind::Spot { inner, outer } => {
                let cone = json!({
                    "innerConeAngle": number(inner, "innerConeAngle")?,
                    "outerConeAngle": number(outer, "outerConeAngle")?,
                });
                json.insert("spot".into(), cone);
                "spot"
            }
        };
        json.insert("type".into(), json!(kind));
        list.push(Value::Object(json));
    }
    Ok(list)
}

pub(super) fn skins(scene: &Scene, binary: &mut Binary) -> Result<Vec<Value>> {
    let mut list = Vec::with_capacity(scene.skins.len());
    for (index, skin) in scene.skins.iter().enumerate() {
        if skin.joints.is_empty() {
            return Err(Error::Export { element: format!("skins[{index}]"), reason: "it has no joints".into() });
        }
        let matrices: Vec<[f32; 16]> = skin.inverse_bind.iter().map(|matrix| matrix.to_cols_array()).collect();
        list.push(json!({ "joints": skin.joints, "inverseBindMatrices": binary.vectors(&matrices) }));
    }
    Ok(list)
}

pub(super) fn animations(scene: &Scene, binary: &mut Binary) -> Result<Vec<Value>> {
    let mut list = Vec::with_capacity(scene.animations.len());
    for animation in scene.animations.iter().filter(|animation| !animation.channels.is_empty()) {
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        // Clips often give many channels the same key times.
        let mut known_times: HashMap<Vec<u32>, usize> = HashMap::new();
        for channel in &animation.channels {
            let bits = channel.times.iter().map(|time| time.to_bits()).collect();
            let input = *known_times.entry(bits).or_insert_with(|| binary.times(&channel.times));
            let (path, output) = match &channel.values {
                Keys::Translation(keys) => ("translation", binary.vectors(keys)),
                Keys::Rotation(keys) => ("rotation", binary.vectors(keys)),
                Keys::Scale(keys) => ("scale", binary.vectors(keys)),
                Keys::Weights { values, .. } => ("weights", binary.scalars(values)),
            };
            let interpolation = match channel.interpolation {
                Interpolation::Linear => "LINEAR",
                Interpolation::Step => "STEP",
                Interpolation::CubicSpline => "CUBICSPLINE",
            };
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": channel.node, "path": path } }));
            samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        }
        let mut json = named(&animation.name);
        json.insert("channels".into(), Value::Array(channels));
        json.insert("samplers".into(), Value::Array(samplers));
        list.push(Value::Object(json));
    }
    Ok(list)
}
