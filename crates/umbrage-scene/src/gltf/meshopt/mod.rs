//! Compressed buffer views: EXT_meshopt_compression and KHR_meshopt_compression. Source: the
//! specification of the latter, appendices A and B, which holds that of the former as its
//! version 0.

mod attributes;
mod filters;
mod indices;

use serde::Deserialize;

use super::Document;
use super::budget::Part;
use super::buffers;
use crate::Result;

/// The names of the extension.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// Description of compressed bytes: their codec, filter and layout.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compression {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

/// Codec of the bytes.
#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// Filter that was applied to elements to make them compress better.
#[derive(Clone, Copy, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

/// Returns the bytes of a buffer view that is compressed; `None` if it is not.
pub(super) fn unpacked(document: &Document<'_>, index: usize, user: &str) -> Result<Option<Vec<u8>>> {
    let view = document.get(&document.root.buffer_views, index, "bufferViews", user)?;
    let extensions = view.extensions.as_ref().map(|extensions| &extensions.others);
    let found = NAMES.iter().find_map(|name| Some((name, extensions?.get(*name)?)));
    let Some((name, extension)) = found else { return Ok(None) };
    let element = format!("bufferViews[{index}].extensions.{name}");
    let invalid = |reason: String| document.invalid(element.as_str(), reason);
    let said = Compression::deserialize(extension).map_err(|error| invalid(error.to_string()))?;
    check(&said).map_err(|reason| invalid(reason.into()))?;
    let length = (said.byte_stride as u64).saturating_mul(said.count as u64);
    if length > view.byte_length.0 {
        return Err(invalid(format!("unpacks to {length} bytes, but the view has {}", view.byte_length.0)));
    }
    document.count(Part::Unpacked, length, &element)?;
    let buffer = buffers::buffer(document, said.buffer, &element)?;
    let packed = buffers::slice(buffer, said.byte_offset, said.byte_length).ok_or_else(|| {
        let (bytes, start) = (said.byte_length, said.byte_offset);
        invalid(format!("takes {bytes} bytes from {start} of a buffer of {} bytes", buffer.len()))
    })?;
    let (stride, count) = (said.byte_stride, said.count);
    let decoded = match said.mode {
        Mode::Attributes => attributes::decode(packed, count, stride),
        Mode::Triangles => indices::triangles(packed, count).map(|list| indices::bytes(&list, stride)),
        Mode::Indices => indices::sequence(packed, count).map(|list| indices::bytes(&list, stride)),
    };
    let mut bytes = decoded.ok_or_else(|| invalid("holds bytes that are no stream of its mode".into()))?;
    match said.filter {
        Filter::None => {}
        Filter::Octahedral => filters::octahedral(&mut bytes, stride),
        Filter::Quaternion => filters::quaternion(&mut bytes),
        Filter::Exponential => filters::exponential(&mut bytes),
        Filter::Color => filters::color(&mut bytes, stride),
    }
    Ok(Some(bytes))
}

/// Checks the conditions of the specification.
fn check(said: &Compression) -> Result<(), &'static str> {
    let stride = said.byte_stride;
    match said.mode {
        Mode::Attributes if !(stride.is_multiple_of(4) && (4..=256).contains(&stride)) => {
            return Err("has a byteStride that is not a multiple of 4 from 4 to 256");
        }
        Mode::Triangles if !said.count.is_multiple_of(3) => return Err("has a count that is not a multiple of 3"),
        Mode::Triangles | Mode::Indices if stride != 2 && stride != 4 => {
            return Err("has a byteStride other than 2 and 4");
        }
        Mode::Triangles | Mode::Indices if said.filter != Filter::None => return Err("has a filter for indices"),
        _ => {}
    }
    match said.filter {
        Filter::Octahedral | Filter::Color if stride != 4 && stride != 8 => {
            Err("has a byteStride other than 4 and 8 for its filter")
        }
        Filter::Quaternion if stride != 8 => Err("has a byteStride other than 8 for its filter"),
        _ => Ok(()),
    }
}

/// Reader of bytes from the front.
struct Reader<'b> {
    bytes: &'b [u8],
}

impl<'b> Reader<'b> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(first)
    }

    fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let (front, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(front)
    }
}
