//! Buffers and accessors. Every range is checked before a byte is read; nothing is trusted because the JSON says so.

use std::borrow::Cow;

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

use super::budget::Part;
use super::{Document, uri};
use crate::Result;

/// What integers mean that are not marked as normalized.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Integers {
    /// Themselves (KHR_mesh_quantization).
    AsMarked,
    /// Always fractions: colours and weights, which may not be given otherwise.
    Normalized,
}

/// Loads every buffer of the file.
pub(super) fn load<'a>(document: &Document<'a>, binary: Option<&'a [u8]>) -> Result<Vec<Cow<'a, [u8]>>> {
    let mut buffers = Vec::with_capacity(document.root.buffers.len());
    for (index, buffer) in document.root.buffers.iter().enumerate() {
        let element = format!("buffers[{index}]");
        let bytes: Cow<'a, [u8]> = match (&buffer.uri, binary) {
            (Some(uri), _) => Cow::Owned(uri::read(document, &element, uri)?),
            (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
            (None, _) => return Err(document.invalid(element, "has neither a URI nor a binary chunk")),
        };
        let promised = buffer.byte_length.0;
        if (bytes.len() as u64) < promised {
            let reason = format!("is cut short: {promised} bytes are promised, but there are {}", bytes.len());
            return Err(document.invalid(element, reason));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The bytes of a buffer view and its stride.
pub(super) fn view<'d>(document: &'d Document<'_>, index: usize, user: &str) -> Result<(&'d [u8], Option<usize>)> {
    let view = document.get(&document.root.buffer_views, index, "bufferViews", user)?;
    let element = format!("bufferViews[{index}]");
    let buffer = document.get(&document.buffers, view.buffer.value(), "buffers", &element)?;
    let start = view.byte_offset.map_or(0, |offset| offset.0);
    let bytes = slice(buffer, start, view.byte_length.0).ok_or_else(|| {
        let length = view.byte_length.0;
        let reason = format!("takes {length} bytes from {start} of a buffer of {} bytes", buffer.len());
        document.invalid(element, reason)
    })?;
    Ok((bytes, view.byte_stride.map(|stride| stride.0).filter(|&stride| stride != 0)))
}

fn slice(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}

/// An accessor's elements without gaps, sparse values put in.
struct Packed {
    bytes: Vec<u8>,
    count: usize,
    component: ComponentType,
    normalized: bool,
}

/// How many elements an accessor has.
pub(super) fn count(document: &Document<'_>, index: usize, user: &str) -> Result<u64> {
    Ok(document.get(&document.root.accessors, index, "accessors", user)?.count.0)
}

/// Components of an accessor: 3 for VEC3.
pub(super) fn components(document: &Document<'_>, index: usize, user: &str) -> Result<usize> {
    let accessor = document.get(&document.root.accessors, index, "accessors", user)?;
    match accessor.type_ {
        Checked::Valid(ty) => Ok(ty.multiplicity()),
        Checked::Invalid => Err(document.invalid(format!("accessors[{index}]"), "has an unknown type")),
    }
}

fn packed(document: &Document<'_>, index: usize, user: &str, expected: &[Type]) -> Result<Packed> {
    let accessor = document.get(&document.root.accessors, index, "accessors", user)?;
    let element = format!("accessors[{index}]");
    let invalid = |reason: String| document.invalid(element.clone(), reason);
    let ty = match accessor.type_ {
        Checked::Valid(ty) if expected.contains(&ty) => ty,
        Checked::Valid(ty) => return Err(invalid(format!("is {ty:?}, but {user} needs {expected:?}"))),
        Checked::Invalid => return Err(invalid("has an unknown type".into())),
    };
    let Checked::Valid(component) = accessor.component_type else {
        return Err(invalid("has an unknown component type".into()));
    };
    let component = component.0;
    let size = component.size() * ty.multiplicity();
    document.count(Part::Element, accessor.count.0, &element)?;

    let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
    let mut bytes = match accessor.buffer_view {
        Some(index) => {
            let (bytes, stride) = view(document, index.value(), &element)?;
            gather(bytes, offset, accessor.count.0, size, stride).ok_or_else(|| {
                let (count, there) = (accessor.count.0, bytes.len());
                invalid(format!("takes {count} elements of {size} bytes from byte {offset} of a view of {there} bytes"))
            })?
        }
        None if accessor.sparse.is_some() => {
            document.count(Part::ZeroElement, accessor.count.0, &element)?;
            vec![0; accessor.count.0 as usize * size]
        }
        None => return Err(invalid("has no buffer view and no sparse values".into())),
    };
    let count = bytes.len() / size;

    if let Some(sparse) = &accessor.sparse {
        let changed = sparse.count.0;
        let Checked::Valid(index_component) = sparse.indices.component_type else {
            return Err(invalid("has sparse indices of an unknown type".into()));
        };
        let part = |index: usize, offset: u64, size: usize| -> Result<Vec<u8>> {
            let (bytes, stride) = view(document, index, &element)?;
            gather(bytes, offset, changed, size, stride)
                .ok_or_else(|| invalid(format!("has {changed} sparse values, more than their view holds")))
        };
        let (indices, values) = (&sparse.indices, &sparse.values);
        let indices = part(indices.buffer_view.value(), indices.byte_offset.0, index_component.0.size())?;
        let values = part(values.buffer_view.value(), values.byte_offset.0, size)?;
        for (at, value) in integers(&indices, index_component.0).zip(values.chunks_exact(size)) {
            let start = at as usize * size;
            let target = bytes
                .get_mut(start..start + size)
                .ok_or_else(|| invalid(format!("has a sparse index {at} beyond its {count} elements")))?;
            target.copy_from_slice(value);
        }
    }
    Ok(Packed { bytes, count, component, normalized: accessor.normalized })
}

/// Copies `count` elements of `size` bytes out of strided bytes; `None` if they do not fit.
fn gather(bytes: &[u8], offset: u64, count: u64, size: usize, stride: Option<usize>) -> Option<Vec<u8>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let stride = stride.unwrap_or(size);
    if stride < size {
        return None;
    }
    let length = (count - 1).checked_mul(stride as u64)?.checked_add(size as u64)?;
    let bytes = slice(bytes, offset, length)?;
    if stride == size {
        return Some(bytes.to_vec());
    }
    let mut packed = Vec::with_capacity(count as usize * size);
    for element in bytes.chunks(stride) {
        packed.extend_from_slice(&element[..size]);
    }
    Some(packed)
}

/// Unsigned integers of a packed index list.
fn integers(bytes: &[u8], component: ComponentType) -> impl Iterator<Item = u32> + '_ {
    bytes.chunks_exact(component.size()).map(move |b| match *b {
        [a] => u32::from(a),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        _ => unreachable!("components have 1, 2 or 4 bytes"),
    })
}

/// One component as a number. Normalized integers as in the glTF 2.0 specification, section 3.11.
fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, most) = match component {
        ComponentType::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        ComponentType::I8 => (f32::from(bytes[0].cast_signed()), 127.0),
        ComponentType::U8 => (f32::from(bytes[0]), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32_767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65_535.0),
        ComponentType::U32 => {
            let value = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            (value as f32, u32::MAX as f32)
        }
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

/// Reads vectors of `N` numbers of any component type.
pub(super) fn floats<const N: usize>(
    document: &Document<'_>,
    index: usize,
    user: &str,
    meaning: Integers,
) -> Result<Vec<[f32; N]>> {
    let ty = match N {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        16 => Type::Mat4,
        _ => unreachable!("glTF has no vectors of {N} numbers"),
    };
    let packed = packed(document, index, user, &[ty])?;
    if N == 16 && packed.component != ComponentType::F32 {
        return Err(document.invalid(format!("accessors[{index}]"), "has matrices that are not of floats"));
    }
    let normalized = packed.normalized || meaning == Integers::Normalized;
    let step = packed.component.size();
    let values: Vec<[f32; N]> = packed
        .bytes
        .chunks_exact(step * N)
        .map(|element| std::array::from_fn(|i| number(&element[i * step..], packed.component, normalized)))
        .collect();
    debug_assert_eq!(values.len(), packed.count, "an accessor is read whole");
    if let Some(bad) = values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        let reason = format!("holds {:?} at element {bad}; {user} needs finite numbers", values[bad]);
        return Err(document.invalid(format!("accessors[{index}]"), reason));
    }
    Ok(values)
}

/// Reads indices of vertices.
pub(super) fn indices(document: &Document<'_>, index: usize, user: &str) -> Result<Vec<u32>> {
    let packed = packed(document, index, user, &[Type::Scalar])?;
    unsigned(document, index, &packed, "indices")?;
    Ok(integers(&packed.bytes, packed.component).collect())
}

/// Reads four joints per vertex.
pub(super) fn joints(document: &Document<'_>, index: usize, user: &str) -> Result<Vec<[u16; 4]>> {
    let packed = packed(document, index, user, &[Type::Vec4])?;
    unsigned(document, index, &packed, "joints")?;
    let flat: Vec<u32> = integers(&packed.bytes, packed.component).collect();
    flat.chunks_exact(4)
        .map(|four| {
            let joint = |i: usize| {
                u16::try_from(four[i])
                    .map_err(|_| document.invalid(format!("accessors[{index}]"), "has a joint beyond 65535"))
            };
            Ok([joint(0)?, joint(1)?, joint(2)?, joint(3)?])
        })
        .collect()
}

fn unsigned(document: &Document<'_>, index: usize, packed: &Packed, what: &str) -> Result<()> {
    match packed.component {
        ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => Ok(()),
        other => {
            let reason = format!("has {what} of type {other:?}; they have to be unsigned integers");
            Err(document.invalid(format!("accessors[{index}]"), reason))
        }
    }
}
