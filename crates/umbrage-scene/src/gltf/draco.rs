//! Primitives under KHR_draco_mesh_compression.

use std::collections::BTreeMap;

use draco_core::{DataType, DecodeLimits, DecoderBuffer, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::ComponentType;
use gltf::json::mesh::{Primitive as JsonPrimitive, Semantic};
use serde::Deserialize;

use super::Document;
use super::accessors::{self, Packed, Wanted};
use super::budget::Part;
use crate::Result;

const NAME: &str = "KHR_draco_mesh_compression";

/// Number of corners of a triangle.
const CORNERS: u64 = 3;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Extension {
    buffer_view: usize,
    /// Unique identifier in the stream of each attribute, by semantic.
    attributes: BTreeMap<String, u32>,
}

/// Content of a decoded stream.
pub(super) struct Decoded {
    mesh: draco_core::Mesh,
    attributes: BTreeMap<String, u32>,
}

/// Decodes the stream of a primitive; `None` if it has no stream, or an unreadable one whose data
/// the accessors hold too.
pub(super) fn decode(document: &Document<'_>, json: &JsonPrimitive, user: &str) -> Result<Option<Decoded>> {
    let Some(extension) = json.extensions.as_ref().and_then(|extensions| extensions.others.get(NAME)) else {
        return Ok(None);
    };
    let element = format!("{user}.extensions.{NAME}");
    match decode_stream(document, extension, &element) {
        Ok(decoded) => Ok(Some(decoded)),
        Err(error) if !document.root.extensions_required.iter().any(|name| name == NAME) => {
            document.notes.add(&element, format!("left out for the accessors beside it: {}", document.said(&error)));
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

fn decode_stream(document: &Document<'_>, extension: &serde_json::Value, element: &str) -> Result<Decoded> {
    let invalid = |reason: String| document.invalid(element, reason);
    let Extension { buffer_view, attributes } =
        Extension::deserialize(extension).map_err(|error| invalid(error.to_string()))?;
    let (bytes, _) = accessors::view(document, buffer_view, element)?;
    let faces = document.left(Part::Unpacked) / (CORNERS * size_of::<u32>() as u64);
    let limits = DecodeLimits::default()
        .with_max_faces(faces)
        .with_max_points(CORNERS * faces)
        .with_max_decoded_bytes(document.left(Part::Unpacked));
    let mut mesh = draco_core::Mesh::new();
    let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
    MeshDecoder::new()
        .decode(&mut buffer, &mut mesh)
        .map_err(|error| invalid(format!("cannot be decoded: {error}")))?;
    let corners = CORNERS * mesh.num_faces() as u64;
    document.count(Part::Unpacked, corners * size_of::<u32>() as u64, element)?;
    Ok(Decoded { mesh, attributes })
}

impl Decoded {
    /// Returns the number of vertices.
    pub(super) fn vertices(&self) -> u64 {
        self.mesh.num_points() as u64
    }

    /// Returns the indices, three for each triangle.
    pub(super) fn indices(&self) -> Vec<u32> {
        self.mesh.faces().as_flattened().iter().map(|point| point.0).collect()
    }

    /// Returns the chosen elements of an attribute that an accessor describes; `None` if the stream
    /// lacks it.
    pub(super) fn packed(
        &self,
        document: &Document<'_>,
        semantic: &Semantic,
        accessor: usize,
        components: usize,
        user: &str,
        wanted: Wanted<'_>,
    ) -> Result<Option<Packed>> {
        let Some(id) = self.attributes.get(&semantic.to_string()) else { return Ok(None) };
        let attribute = self.mesh.attribute_by_unique_id(*id).ok_or_else(|| {
            document.invalid(user, format!("its Draco stream has no attribute with the identifier {id}"))
        })?;
        let component = component(attribute.data_type()).ok_or_else(|| {
            document.invalid(user, format!("its Draco stream has components of the type {:?}", attribute.data_type()))
        })?;
        if usize::from(attribute.num_components()) != components {
            let reason = format!("its Draco stream has {} components, not {components}", attribute.num_components());
            return Err(document.invalid(user, reason));
        }
        let points = self.mesh.num_points() as u32;
        let size = components * component.size();
        let mut bytes = Vec::new();
        match wanted {
            Wanted::All => (0..points).for_each(|point| push(&mut bytes, attribute, point, size)),
            Wanted::Only(list) => list.iter().for_each(|&point| push(&mut bytes, attribute, point, size)),
        }
        document.count(Part::Element, (bytes.len() / size) as u64, user)?;
        let normalized =
            document.get(&document.root.accessors, accessor, "accessors", user)?.normalized || attribute.normalized();
        Ok(Some(Packed { index: accessor, bytes, component, normalized }))
    }
}

/// Appends the value of a point, or zeros if an inconsistent stream has none.
fn push(bytes: &mut Vec<u8>, attribute: &PointAttribute, point: u32, size: usize) {
    let value = attribute.mapped_index(PointIndex(point)).0 as usize;
    let start = usize::try_from(attribute.byte_stride()).ok().and_then(|stride| stride.checked_mul(value));
    match start.and_then(|start| attribute.buffer().data().get(start..start.checked_add(size)?)) {
        Some(value) => bytes.extend_from_slice(value),
        None => bytes.resize(bytes.len() + size, 0),
    }
}

fn component(ty: DataType) -> Option<ComponentType> {
    match ty {
        DataType::Int8 => Some(ComponentType::I8),
        DataType::Uint8 => Some(ComponentType::U8),
        DataType::Int16 => Some(ComponentType::I16),
        DataType::Uint16 => Some(ComponentType::U16),
        DataType::Uint32 => Some(ComponentType::U32),
        DataType::Float32 => Some(ComponentType::F32),
        _ => None,
    }
}
