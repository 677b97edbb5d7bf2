//! The JSON of a glTF document: parsed, adapted to the types of the `gltf` crate, with the place of
//! each fault.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use gltf::json;
use gltf::json::extensions::scene::khr_lights_punctual::Light;
use serde::Deserialize as _;
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;
use serde_json::{Map, Value, json};
use serde_path_to_error::{Path, Segment};

use super::Notes;
use crate::{Error, Result};

/// Stands for the node of a channel that has none, which glTF allows. No file has as many nodes.
pub(super) const NO_NODE: usize = u32::MAX as usize;

/// The largest whole number up to which every whole number is an `f64`.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// Faults of elements that the scene does not depend on, by index.
#[derive(Debug, Default)]
pub(super) struct Broken {
    pub(super) animations: BTreeMap<usize, String>,
    pub(super) cameras: BTreeMap<usize, String>,
    pub(super) lights: BTreeMap<usize, String>,
}

/// Parses the JSON of a glTF 2.0 document.
pub(super) fn parse(file: &str, bytes: &[u8], notes: &Notes) -> Result<(json::Root, Broken)> {
    let malformed = |reason: String| Error::Malformed { file: file.to_owned(), reason };
    let text = text(bytes, notes);
    let mut value: Value =
        serde_json::from_str(&text).map_err(|error| malformed(format!("its JSON cannot be read: {error}")))?;
    check_version(&value).map_err(malformed)?;
    adapt(&mut value);
    let broken = Broken {
        animations: replace_broken::<json::Animation>(
            list(&mut value, "/animations"),
            &json!({ "channels": [], "samplers": [] }),
        ),
        cameras: replace_broken::<json::Camera>(list(&mut value, "/cameras"), &json!({ "type": "unknown" })),
        lights: replace_broken::<Light>(
            list(&mut value, "/extensions/KHR_lights_punctual/lights"),
            &json!({ "type": "unknown" }),
        ),
    };
    let root = json::Root::deserialize(&value).map_err(|error| {
        // Once more, for the path; it costs twice the time, so only what is wrong pays it.
        let mut track = serde_path_to_error::Track::new();
        let again: Result<json::Root, _> =
            json::Root::deserialize(serde_path_to_error::Deserializer::new(&value, &mut track));
        let path = track.path();
        if again.is_ok() || path.iter().next().is_none() {
            return malformed(format!("its JSON is not a glTF 2.0 document: {error}"));
        }
        let line = line(&text, &path).map(|line| format!(" (line {line})")).unwrap_or_default();
        Error::Invalid { file: file.to_owned(), element: format!("{path}{line}"), reason: error.to_string() }
    })?;
    Ok((root, broken))
}

/// Replaces each unreadable element by an empty one, so that indices stay valid.
fn replace_broken<T: DeserializeOwned>(list: &mut [Value], with: &Value) -> BTreeMap<usize, String> {
    let mut broken = BTreeMap::new();
    for (index, value) in list.iter_mut().enumerate() {
        if let Err(error) = T::deserialize(&*value) {
            broken.insert(index, error.to_string());
            value.clone_from(with);
        }
    }
    broken
}

fn list<'v>(value: &'v mut Value, pointer: &str) -> &'v mut [Value] {
    value.pointer_mut(pointer).and_then(Value::as_array_mut).map_or(&mut [], Vec::as_mut_slice)
}

/// Decodes the text. Names in another encoding lose the characters that are not UTF-8.
fn text<'b>(bytes: &'b [u8], notes: &Notes) -> Cow<'b, str> {
    let text = String::from_utf8_lossy(bytes);
    if matches!(text, Cow::Owned(_)) {
        notes.add("the JSON", "has characters that are not UTF-8; they are replaced");
    }
    text
}

/// Refuses any other version of glTF by its name. Before version 2 the lists of a document were
/// objects.
fn check_version(value: &Value) -> Result<(), String> {
    let Some(document) = value.as_object() else { return Err("its JSON is not a glTF document: no object".into()) };
    let version = match document.get("asset").and_then(|asset| asset.get("version")) {
        Some(Value::String(version)) => version.clone(),
        Some(Value::Number(version)) => version.to_string(),
        _ => {
            const LISTS: [&str; 6] = ["accessors", "buffers", "bufferViews", "meshes", "nodes", "scenes"];
            let is_old = LISTS.iter().any(|list| document.get(*list).is_some_and(Value::is_object));
            if !is_old {
                return Err("its JSON is not a glTF 2.0 document: asset.version is missing".into());
            }
            "1.0".into()
        }
    };
    match version.split('.').next() {
        Some("2") => Ok(()),
        Some("0" | "1") => Err(format!(
            "is glTF {version}; only version 2 is read: convert it, for example with gltf-pipeline, or export it again"
        )),
        _ => Err(format!("is glTF {version}; only version 2 is read")),
    }
}

/// Adapts JSON that glTF or its writers allow to the types of the `gltf` crate: whole numbers
/// written as `24.0`, scenes without nodes, channels without a target node, a version that is a
/// number.
fn adapt(value: &mut Value) {
    make_whole(value);
    if let Some(Value::Number(version)) = value.pointer("/asset/version") {
        let version = Value::String(version.to_string());
        value["asset"]["version"] = version;
    }
    for scene in objects(value, "scenes") {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    for animation in objects(value, "animations") {
        let channels = animation.get_mut("channels").and_then(Value::as_array_mut);
        for target in channels.into_iter().flatten().filter_map(|c| c.get_mut("target")) {
            if let Some(target) = target.as_object_mut() {
                target.entry("node").or_insert_with(|| Value::from(NO_NODE));
            }
        }
    }
}

/// Iterates over the objects of a list in a JSON object.
fn objects<'v>(object: &'v mut Value, name: &str) -> impl Iterator<Item = &'v mut Map<String, Value>> {
    let list = object.get_mut(name).and_then(Value::as_array_mut);
    list.into_iter().flatten().filter_map(Value::as_object_mut)
}

/// Converts all whole numbers to integers, however they are written.
fn make_whole(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(make_whole),
        Value::Object(object) => object.values_mut().for_each(make_whole),
        Value::Number(number) if number.is_f64() => {
            if let Some(x) = number.as_f64().filter(|x| x.fract() == 0.0 && x.abs() < LARGEST_WHOLE) {
                *number = (x as i64).into();
            }
        }
        _ => {}
    }
}

/// Returns the line of the text, from 1, at which the value at a path starts.
fn line(text: &str, path: &Path) -> Option<usize> {
    let mut here: &RawValue = serde_json::from_str(text).ok()?;
    for segment in path.iter() {
        here = match segment {
            Segment::Map { key } => {
                let map: HashMap<Cow<'_, str>, &RawValue> = serde_json::from_str(here.get()).ok()?;
                map.get(key.as_str()).copied()?
            }
            Segment::Seq { index } => {
                let list: Vec<&RawValue> = serde_json::from_str(here.get()).ok()?;
                list.get(*index).copied()?
            }
            Segment::Enum { .. } | Segment::Unknown => break,
        };
    }
    let offset = (here.get().as_ptr() as usize).checked_sub(text.as_ptr() as usize)?;
    Some(1 + text.get(..offset)?.matches('\n').count())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        parse("a.gltf", text.as_bytes(), &Notes::default()).expect_err("it is wrong").to_string()
    }

    #[test]
    fn a_wrong_type_is_named_with_its_line() {
        let text =
            "{ \"asset\": { \"version\": \"2.0\" },\n \"nodes\": [\n  {},\n  { \"scale\": [1,\n \"wide\", 1] }\n ] }";
        let message = refusal(text);
        assert!(message.starts_with("a.gltf: nodes[1].scale[1] (line 5): invalid type"), "{message}");
        let message = refusal("{ \"asset\": { \"version\": \"2.0\" }, \"meshes\": [\n{ \"name\": \"m\" }] }");
        assert!(message.starts_with("a.gltf: meshes[0] (line 2): missing field `primitives`"), "{message}");
        let message = refusal("{ \"asset\": { \"version\": \"2.0\" },\n\n ]");
        assert!(message.contains("line 3"), "{message}");
    }

    #[test]
    fn other_versions_are_refused_by_name() {
        for text in [
            r#"{ "asset": { "version": "1.0" }, "nodes": { "n": {} } }"#,
            r#"{ "asset": { "version": 1.0 }, "nodes": { "n": {} } }"#,
            r#"{ "nodes": { "n": {} } }"#,
        ] {
            assert!(refusal(text).contains("is glTF 1.0; only version 2 is read"), "{}", refusal(text));
        }
        assert!(refusal(r#"{ "asset": { "version": "3.0" } }"#).contains("is glTF 3.0"));
        assert!(refusal("{}").contains("asset.version is missing"));
    }

    #[test]
    fn whole_numbers_may_be_written_with_a_point() {
        let text = r#"{ "asset": { "version": 2.0 }, "accessors": [
            { "bufferView": 0.0, "componentType": 5126.0, "count": 2.4e1, "type": "VEC3" }],
            "nodes": [{ "scale": [-2.0, 0.5, 1e30] }] }"#;
        let (root, _) = parse("a", text.as_bytes(), &Notes::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((root.asset.version.as_str(), root.accessors[0].count.0), ("2", 24));
        assert_eq!(root.nodes[0].scale, Some([-2.0, 0.5, 1e30]));
    }
}
