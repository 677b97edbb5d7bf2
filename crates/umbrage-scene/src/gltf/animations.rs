//! Animations: translations, rotations and scales of nodes, weights of morph targets.

use gltf::json;
use gltf::json::animation::{Interpolation as JsonInterpolation, Property};
use gltf::json::validation::Checked;

use super::Document;
use super::accessors::{self, Integers};
use super::budget::Part;
use super::nodes::Places;
use super::text::NO_NODE;
use crate::error::element;
use crate::{Animation, Channel, Interpolation, Keys, Result};

/// Loads all animations. An animation with any fault is left out as a whole, because half a
/// movement would look wrong.
pub(super) fn load(document: &Document<'_>, places: &Places) -> Vec<Animation> {
    let mut animations = Vec::with_capacity(document.root.animations.len());
    for (index, json) in document.root.animations.iter().enumerate() {
        let user = element("animations", index, json.name.as_deref().unwrap_or_default());
        let loaded = match document.broken.animations.get(&index) {
            Some(reason) => Err(document.invalid(&user, reason.as_str())),
            None => load_one(document, json, &user, places),
        };
        match loaded {
            Ok(animation) => animations.push(animation),
            Err(error) => document.leave_out(&user, &error),
        }
    }
    animations
}

fn load_one(document: &Document<'_>, json: &json::Animation, user: &str, places: &Places) -> Result<Animation> {
    let mut channels = Vec::with_capacity(json.channels.len());
    for (index, channel) in json.channels.iter().enumerate() {
        let user = format!("{user}.channels[{index}]");
        let property = match channel.target.path {
            Checked::Valid(property) => property,
            Checked::Invalid => {
                document.notes.add(&user, "left out: it moves a property that is not known");
                continue;
            }
        };
        // The specification says to ignore a channel without a target.
        if channel.target.node.value() == NO_NODE {
            continue;
        }
        let sampler = document.get(&json.samplers, channel.sampler.value(), "samplers", &user)?;
        let node = *document.get(&places.of_file_node, channel.target.node.value(), "nodes", &user)?;
        let channel = load_channel(document, sampler, property, node, &user)?;
        if channel.times.is_empty() {
            document.notes.add(&user, "left out: it has no keys");
        } else {
            channels.push(channel);
        }
    }
    let last_key = |channel: &Channel| channel.times.last().copied().map_or(0.0, f64::from);
    let duration = channels.iter().map(last_key).fold(0.0, f64::max);
    Ok(Animation { name: json.name.clone().unwrap_or_default(), channels, duration })
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
    for accessor in [sampler.input, sampler.output] {
        document.count(Part::Key, accessors::count(document, accessor.value(), user)?, user)?;
    }
    let times = accessors::floats::<1>(document, sampler.input.value(), &format!("{user} input"), Integers::AsMarked)?;
    let times: Vec<f32> = times.into_iter().map(|[t]| t).collect();
    if let Some(at) = times.windows(2).position(|t| t[1] < t[0]) {
        return Err(invalid(format!("has key {} before key {at}: {} s after {} s", at + 1, times[at + 1], times[at])));
    }
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let expected = times.len() * per_key;
    let (output, purpose) = (sampler.output.value(), format!("{user} output"));
    let values = match property {
        Property::Translation => Keys::Translation(accessors::floats(document, output, &purpose, Integers::AsMarked)?),
        Property::Scale => Keys::Scale(accessors::floats(document, output, &purpose, Integers::AsMarked)?),
        Property::Rotation => {
            let mut keys = accessors::floats(document, output, &purpose, Integers::Normalized)?;
            // Tangents of splines may be zero.
            let is_value = |i: usize| per_key == 1 || i % 3 == 1;
            for (_, key) in keys.iter_mut().enumerate().filter(|(i, key)| is_value(*i) && **key == [0.0; 4]) {
                document.notes.add(user, "has a rotation of length 0; it is not rotated");
                *key = [0.0, 0.0, 0.0, 1.0];
            }
            Keys::Rotation(keys)
        }
        Property::MorphTargetWeights => {
            let weights = accessors::floats::<1>(document, output, &purpose, Integers::Normalized)?;
            let values: Vec<f32> = weights.into_iter().map(|[weight]| weight).collect();
            let each = values.len().checked_div(expected).unwrap_or(0).max(1);
            Keys::Weights { per_key: each, values }
        }
    };
    let count = values.count();
    let is_whole = !matches!(&values, Keys::Weights { per_key, values } if !values.len().is_multiple_of(*per_key));
    if count != expected || !is_whole {
        return Err(invalid(format!("has {} keys, so it needs {expected} values, but it has {count}", times.len())));
    }
    Ok(Channel { node, times, values, interpolation })
}
