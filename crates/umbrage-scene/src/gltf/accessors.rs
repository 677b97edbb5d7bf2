//! Accessors and buffer views. Every range is checked before a byte is read; nothing in the JSON is
//! trusted.

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

use super::budget::Part;
use super::{Document, buffers, meshopt};
use crate::Result;

/// Meaning of integers that are not marked as normalized.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Integers {
    /// Integers as such (KHR_mesh_quantization).
    AsMarked,
    /// Fractions, for colours and weights, which may not be given otherwise.
    Normalized,
}

/// Returns the bytes of a buffer view and its stride.
pub(super) fn view<'d>(document: &'d Document<'_>, index: usize, user: &str) -> Result<(&'d [u8], Option<usize>)> {
    let view = document.get(&document.root.buffer_views, index, "bufferViews", user)?;
    let stride = view.byte_stride.map(|stride| stride.0).filter(|&stride| stride != 0);
    let slot = document.get(&document.buffers.unpacked, index, "bufferViews", user)?;
    if let Some(bytes) = slot.get() {
        return Ok((bytes, stride));
    }
    if let Some(bytes) = meshopt::unpacked(document, index, user)? {
        return Ok((slot.get_or_init(|| bytes), stride));
    }
    let element = format!("bufferViews[{index}]");
    let buffer = buffers::buffer(document, view.buffer.value(), &element)?;
    let start = view.byte_offset.map_or(0, |offset| offset.0);
    let bytes = buffers::slice(buffer, start, view.byte_length.0).ok_or_else(|| {
        let length = view.byte_length.0;
        let reason = format!("takes {length} bytes from {start} of a buffer of {} bytes", buffer.len());
        document.invalid(element, reason)
    })?;
    Ok((bytes, stride))
}

/// Choice of the elements of an accessor that are read.
#[derive(Clone, Copy)]
pub(super) enum Wanted<'w> {
    /// All elements.
    All,
    /// Elements with these indices, which rise.
    Only(&'w [u32]),
}

/// Elements of an accessor without gaps, with sparse values put in.
pub(super) struct Packed {
    /// Index of the accessor, for messages.
    pub(super) index: usize,
    pub(super) bytes: Vec<u8>,
    pub(super) component: ComponentType,
    pub(super) normalized: bool,
}

/// Returns the number of elements of an accessor.
pub(super) fn count(document: &Document<'_>, index: usize, user: &str) -> Result<u64> {
    Ok(document.get(&document.root.accessors, index, "accessors", user)?.count.0)
}

/// Returns whether an accessor has neither bytes nor sparse values, so that all of it is zero.
pub(super) fn is_all_zero(document: &Document<'_>, index: usize, user: &str) -> Result<bool> {
    let accessor = document.get(&document.root.accessors, index, "accessors", user)?;
    Ok(accessor.buffer_view.is_none() && accessor.sparse.is_none())
}

/// Returns the type and the component type of an accessor. Its type has to be one of `expected`.
pub(super) fn types(
    document: &Document<'_>,
    index: usize,
    user: &str,
    expected: &[Type],
) -> Result<(Type, ComponentType)> {
    let accessor = document.get(&document.root.accessors, index, "accessors", user)?;
    let invalid = |reason: String| document.invalid(format!("accessors[{index}]"), reason);
    match (accessor.type_, accessor.component_type) {
        (Checked::Valid(ty), Checked::Valid(component)) if expected.contains(&ty) => Ok((ty, component.0)),
        (Checked::Valid(ty), Checked::Valid(_)) => Err(invalid(format!("is {ty:?}, but {user} needs {expected:?}"))),
        (Checked::Invalid, _) => Err(invalid("has an unknown type".into())),
        (_, Checked::Invalid) => Err(invalid("has an unknown component type".into())),
    }
}

/// Reads the chosen elements of an accessor.
pub(super) fn packed(
    document: &Document<'_>,
    index: usize,
    user: &str,
    expected: &[Type],
    wanted: Wanted<'_>,
) -> Result<Packed> {
    let (ty, component) = types(document, index, user, expected)?;
    let accessor = document.get(&document.root.accessors, index, "accessors", user)?;
    let element = format!("accessors[{index}]");
    let invalid = |reason: String| document.invalid(element.clone(), reason);
    let size = component.size() * ty.multiplicity();
    let (all, offset) = (accessor.count.0, accessor.byte_offset.map_or(0, |offset| offset.0));
    let count = match wanted {
        Wanted::All => all,
        Wanted::Only(list) => list.len() as u64,
    };
    document.count(Part::Element, count, &element)?;

    let mut bytes = match accessor.buffer_view {
        Some(index) => {
            let (bytes, stride) = view(document, index.value(), &element)?;
            gather(bytes, offset, all, size, stride, wanted).ok_or_else(|| {
                let there = bytes.len();
                invalid(format!("takes {all} elements of {size} bytes from byte {offset} of a view of {there} bytes"))
            })?
        }
        None => {
            document.count(Part::ZeroElement, count, &element)?;
            vec![0; count as usize * size]
        }
    };

    if let Some(sparse) = &accessor.sparse {
        let changed = sparse.count.0;
        let Checked::Valid(index_component) = sparse.indices.component_type else {
            return Err(invalid("has sparse indices of an unknown type".into()));
        };
        let part = |index: usize, offset: u64, size: usize| -> Result<Vec<u8>> {
            let (bytes, stride) = view(document, index, &element)?;
            gather(bytes, offset, changed, size, stride, Wanted::All)
                .ok_or_else(|| invalid(format!("has {changed} sparse values, more than their view holds")))
        };
        let (indices, values) = (&sparse.indices, &sparse.values);
        let indices = part(indices.buffer_view.value(), indices.byte_offset.0, index_component.0.size())?;
        let values = part(values.buffer_view.value(), values.byte_offset.0, size)?;
        for (at, value) in integers(&indices, index_component.0).zip(values.chunks_exact(size)) {
            if u64::from(at) >= all {
                return Err(invalid(format!("has a sparse index {at} beyond its {all} elements")));
            }
            let place = match wanted {
                Wanted::All => Some(at as usize),
                Wanted::Only(list) => list.binary_search(&at).ok(),
            };
            if let Some(place) = place {
                bytes[place * size..(place + 1) * size].copy_from_slice(value);
            }
        }
    }
    Ok(Packed { index, bytes, component, normalized: accessor.normalized })
}

/// Copies chosen elements out of `count` strided ones of `size` bytes; `None` if they do not fit.
fn gather(
    bytes: &[u8],
    offset: u64,
    count: u64,
    size: usize,
    stride: Option<usize>,
    wanted: Wanted<'_>,
) -> Option<Vec<u8>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let stride = stride.unwrap_or(size);
    if stride < size {
        return None;
    }
    let length = (count - 1).checked_mul(stride as u64)?.checked_add(size as u64)?;
    let bytes = buffers::slice(bytes, offset, length)?;
    let element = |index: usize| &bytes[index * stride..index * stride + size];
    match wanted {
        Wanted::All if stride == size => Some(bytes.to_vec()),
        Wanted::All => {
            let mut packed = Vec::with_capacity(count as usize * size);
            (0..count as usize).for_each(|index| packed.extend_from_slice(element(index)));
            Some(packed)
        }
        Wanted::Only(list) => {
            // They rise, so the last is the largest.
            if list.last().is_some_and(|&last| u64::from(last) >= count) {
                return None;
            }
            let mut packed = Vec::with_capacity(list.len() * size);
            list.iter().for_each(|&index| packed.extend_from_slice(element(index as usize)));
            Some(packed)
        }
    }
}

/// Iterates over the unsigned integers of a packed index list.
fn integers(bytes: &[u8], component: ComponentType) -> impl Iterator<Item = u32> + '_ {
    bytes.chunks_exact(component.size()).map(move |b| match *b {
        [a] => u32::from(a),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        _ => unreachable!("components have 1, 2 or 4 bytes"),
    })
}

/// Converts one component to a number. Normalized integers follow the glTF 2.0 specification,
/// section 3.11.
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

/// Returns the accessor type of vectors of `N` numbers.
pub(super) fn type_of<const N: usize>() -> Type {
    match N {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        16 => Type::Mat4,
        _ => unreachable!("glTF has no vectors of {N} numbers"),
    }
}

/// Reads vectors of `N` numbers of any component type.
pub(super) fn floats<const N: usize>(
    document: &Document<'_>,
    index: usize,
    user: &str,
    meaning: Integers,
) -> Result<Vec<[f32; N]>> {
    packed(document, index, user, &[type_of::<N>()], Wanted::All)?.floats(document, user, meaning)
}

/// Reads indices of vertices.
pub(super) fn indices(document: &Document<'_>, index: usize, user: &str) -> Result<Vec<u32>> {
    let packed = packed(document, index, user, &[Type::Scalar], Wanted::All)?;
    packed.unsigned(document, "indices")?;
    Ok(integers(&packed.bytes, packed.component).collect())
}

impl Packed {
    /// Converts the elements to vectors of `N` finite numbers.
    pub(super) fn floats<const N: usize>(
        &self,
        document: &Document<'_>,
        user: &str,
        meaning: Integers,
    ) -> Result<Vec<[f32; N]>> {
        if N == 16 && self.component != ComponentType::F32 {
            return Err(document.invalid(format!("accessors[{}]", self.index), "has matrices that are not of floats"));
        }
        let normalized = self.normalized || meaning == Integers::Normalized;
        let step = self.component.size();
        let values: Vec<[f32; N]> = self
            .bytes
            .chunks_exact(step * N)
            .map(|element| std::array::from_fn(|i| number(&element[i * step..], self.component, normalized)))
            .collect();
        if let Some(bad) = values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            let reason = format!("holds {:?} at element {bad}; {user} needs finite numbers", values[bad]);
            return Err(document.invalid(format!("accessors[{}]", self.index), reason));
        }
        Ok(values)
    }

    /// Converts the elements to four joints per vertex.
    pub(super) fn joints(&self, document: &Document<'_>) -> Result<Vec<[u16; 4]>> {
        self.unsigned(document, "joints")?;
        let flat: Vec<u32> = integers(&self.bytes, self.component).collect();
        flat.chunks_exact(4)
            .map(|four| {
                let joint = |i: usize| {
                    let wrong = || document.invalid(format!("accessors[{}]", self.index), "has a joint beyond 65535");
                    u16::try_from(four[i]).map_err(|_| wrong())
                };
                Ok([joint(0)?, joint(1)?, joint(2)?, joint(3)?])
            })
            .collect()
    }

    fn unsigned(&self, document: &Document<'_>, what: &str) -> Result<()> {
        match self.component {
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => Ok(()),
            other => {
                let reason = format!("has {what} of type {other:?}; they have to be unsigned integers");
                Err(document.invalid(format!("accessors[{}]", self.index), reason))
            }
        }
    }
}
