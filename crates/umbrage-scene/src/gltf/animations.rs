//! Animations: translations, rotations and scales of nodes.

use gltf::json;
use gltf::json::animation::{Interpolation as JsonInterpolation, Property};
use gltf::json::validation::Checked;

use super::Document;
use super::budget::Part;
use super::buffers::{self, Integers};
use super::nodes::Places;
use crate::error::element;
use crate::{Animation, Channel, Interpolation, Keys, Result};

pub(super) fn load(document: &mut Document<'_>, places: &Places) -> Result<Vec<Animation>> {
    let mut animations = Vec::with_capacity(document.root.animations.len());
    let mut notes = std::mem::take(&mut document.notes);
    for (index, json) in document.root.animations.iter().enumerate() {
        let name = json.name.clone().unwrap_or_default();
        let user = element("animations", index, &name);
        let mut channels = Vec::with_capacity(json.channels.len());
        for (index, channel) in json.channels.iter().enumerate() {
            let user = format!("{user}.channels[{index}]");
            let sampler = document.get(&json.samplers, channel.sampler.value(), "samplers", &user)?;
            match channel.target.path {
                Checked::Valid(Property::MorphTargetWeights) => {
                    notes.add("animated weights of morph targets are left out");
                }
                Checked::Valid(property) => {
                    let target = channel.target.node.value();
                    let node = document.get(&places.of_file_node, target, "nodes", &user)?;
                    channels.push(load_channel(document, sampler, property, *node, &user)?);
                }
                Checked::Invalid => return Err(document.invalid(user, "moves an unknown property")),
            }
        }
        let last_key = |channel: &Channel| channel.times.last().copied().map_or(0.0, f64::from);
        let duration = channels.iter().map(last_key).fold(0.0, f64::max);
        animations.push(Animation { name, channels, duration });
    }
    document.notes = notes;
    Ok(animations)
}

fn load_channel(
    document: &Document<'_>,
    sampler: &json::animation::Sampler,
    property: Property,
    node: usize,
    user: &str,
) -> Result<Channel> {
    let invalid = |reason: String| document.invalid(user, reason);
    let interpolation = match sampler.interpolation {
        Checked::Valid(JsonInterpolation::Linear) => Interpolation::Linear,
        Checked::Valid(JsonInterpolation::Step) => Interpolation::Step,
        Checked::Valid(JsonInterpolation::CubicSpline) => Interpolation::CubicSpline,
        Checked::Invalid => return Err(invalid("has an unknown interpolation".into())),
    };
    let times = buffers::floats::<1>(document, sampler.input.value(), &format!("{user} input"), Integers::AsMarked)?;
    let times: Vec<f32> = times.into_iter().map(|[t]| t).collect();
    if times.is_empty() {
        return Err(invalid("has no keys".into()));
    }
    if times[0] < 0.0 {
        return Err(invalid(format!("has its first key at {} s; keys start at 0 s or later", times[0])));
    }
    if let Some(at) = times.windows(2).position(|t| t[1] < t[0]) {
        return Err(invalid(format!("has key {} before key {at}: {} s after {} s", at + 1, times[at + 1], times[at])));
    }
    let (output, purpose) = (sampler.output.value(), format!("{user} output"));
    let values = match property {
        Property::Translation => Keys::Translation(buffers::floats(document, output, &purpose, Integers::AsMarked)?),
        Property::Scale => Keys::Scale(buffers::floats(document, output, &purpose, Integers::AsMarked)?),
        _ => Keys::Rotation(buffers::floats(document, output, &purpose, Integers::Normalized)?),
    };
    let count = match &values {
        Keys::Translation(keys) | Keys::Scale(keys) => keys.len(),
        Keys::Rotation(keys) => keys.len(),
    };
    let expected = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    document.count(Part::Key, count as u64, user)?;
    if count != expected {
        return Err(invalid(format!("has {} keys, so it needs {expected} values, but it has {count}", times.len())));
    }
    Ok(Channel { node, times, values, interpolation })
}
