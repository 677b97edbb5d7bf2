//! The binary chunk: buffer views, accessors, and the container around all.

use serde_json::{Map, Value, json};

use super::numbers;
use crate::{Error, Result};

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// Use of a range of bytes. glTF asks for it for vertices and indices only.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    Vertices,
    Indices,
    Other,
}

/// The binary chunk under construction. Every view starts at a multiple of four bytes.
#[derive(Default)]
pub(super) struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// Adds bytes and returns the index of their view.
    pub(super) fn view(&mut self, bytes: &[u8], usage: Use) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        match usage {
            Use::Vertices => view["target"] = json!(ARRAY_BUFFER),
            Use::Indices => view["target"] = json!(ELEMENT_ARRAY_BUFFER),
            Use::Other => {}
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, component: u32, kind: &str, count: usize) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count,
        }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], usage: Use) -> usize {
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(N).copied().unwrap_or("MAT4");
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes, usage);
        self.accessor(view, FLOAT, kind, values.len())
    }

    /// Writes the least and greatest value of each component, which glTF asks for in positions and
    /// key times.
    fn with_limits<const N: usize>(&mut self, accessor: usize, values: &[[f32; N]]) -> usize {
        let limit = |pick: fn(f32, f32) -> f32, start: f32| {
            let mut limit = [start; N];
            values.iter().for_each(|value| limit = std::array::from_fn(|i| pick(limit[i], value[i])));
            limit
        };
        self.accessors[accessor]["min"] = numbers(&limit(f32::min, f32::INFINITY));
        self.accessors[accessor]["max"] = numbers(&limit(f32::max, f32::NEG_INFINITY));
        accessor
    }

    /// Adds positions of vertices.
    pub(super) fn positions(&mut self, values: &[[f32; 3]]) -> usize {
        let accessor = self.floats(values, Use::Vertices);
        self.with_limits(accessor, values)
    }

    /// Adds another attribute of vertices.
    pub(super) fn attribute<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        self.floats(values, Use::Vertices)
    }

    /// Adds joints of vertices, in bytes if they fit.
    pub(super) fn joints(&mut self, values: &[[u16; 4]]) -> usize {
        let flat = values.as_flattened();
        let (bytes, component): (Vec<u8>, u32) = if flat.iter().all(|&joint| joint < 256) {
            (flat.iter().map(|&joint| joint as u8).collect(), UNSIGNED_BYTE)
        } else {
            (flat.iter().flat_map(|joint| joint.to_le_bytes()).collect(), UNSIGNED_SHORT)
        };
        let view = self.view(&bytes, Use::Vertices);
        self.accessor(view, component, "VEC4", values.len())
    }

    /// Adds indices, 16 bits wide if they fit. 65535 itself restarts primitives and is never used.
    pub(super) fn indices(&mut self, values: &[u32]) -> usize {
        let (bytes, component): (Vec<u8>, u32) = if values.iter().all(|&index| index < u32::from(u16::MAX)) {
            (values.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect(), UNSIGNED_SHORT)
        } else {
            (values.iter().flat_map(|index| index.to_le_bytes()).collect(), UNSIGNED_INT)
        };
        let view = self.view(&bytes, Use::Indices);
        self.accessor(view, component, "SCALAR", values.len())
    }

    /// Adds vectors or matrices that are not vertex attributes.
    pub(super) fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        self.floats(values, Use::Other)
    }

    /// Adds numbers that are not vertex attributes.
    pub(super) fn scalars(&mut self, values: &[f32]) -> usize {
        let values: Vec<[f32; 1]> = values.iter().map(|&value| [value]).collect();
        self.floats(&values, Use::Other)
    }

    /// Adds key times.
    pub(super) fn times(&mut self, values: &[f32]) -> usize {
        let values: Vec<[f32; 1]> = values.iter().map(|&time| [time]).collect();
        let accessor = self.floats(&values, Use::Other);
        self.with_limits(accessor, &values)
    }

    /// Returns the bytes of the file.
    pub(super) fn finish(mut self, mut document: Map<String, Value>) -> Result<Vec<u8>> {
        const HEADER: usize = 12;
        const CHUNK_HEADER: usize = 8;
        if !self.bytes.is_empty() {
            self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
            document.insert("buffers".into(), json!([{ "byteLength": self.bytes.len() }]));
            document.insert("bufferViews".into(), Value::Array(self.views));
        }
        if !self.accessors.is_empty() {
            document.insert("accessors".into(), Value::Array(self.accessors));
        }
        let mut text = Value::Object(document).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');

        let chunks: &[(&[u8], &[u8])] =
            if self.bytes.is_empty() { &[(b"JSON", &text)] } else { &[(b"JSON", &text), (b"BIN\0", &self.bytes)] };
        let length = HEADER + chunks.iter().map(|(_, content)| CHUNK_HEADER + content.len()).sum::<usize>();
        let too_large = |_| Error::Export {
            element: "the scene".into(),
            reason: format!("it would take {length} bytes, and a .glb can have 4 GiB"),
        };
        let total = u32::try_from(length).map_err(too_large)?;
        let mut file = Vec::with_capacity(length);
        file.extend_from_slice(b"glTF");
        file.extend_from_slice(&2_u32.to_le_bytes());
        file.extend_from_slice(&total.to_le_bytes());
        for (kind, content) in chunks {
            file.extend_from_slice(&u32::try_from(content.len()).map_err(too_large)?.to_le_bytes());
            file.extend_from_slice(kind);
            file.extend_from_slice(content);
        }
        Ok(file)
    }
}
