//! Buffers, each read when it is first asked for.

use std::borrow::Cow;
use std::cell::OnceCell;

use gltf::json;

use super::{Document, uri};
use crate::Result;

/// Bytes of a file. Each buffer is read when it is first asked for: an unused one may be missing.
pub(super) struct Buffers<'a> {
    binary: Option<&'a [u8]>,
    buffers: Vec<OnceCell<Cow<'a, [u8]>>>,
    /// Contents of compressed buffer views, unpacked.
    pub(super) unpacked: Vec<OnceCell<Vec<u8>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(root: &json::Root, binary: Option<&'a [u8]>) -> Self {
        let buffers = vec![OnceCell::new(); root.buffers.len()];
        Self { binary, buffers, unpacked: vec![OnceCell::new(); root.buffer_views.len()] }
    }
}

/// Returns the bytes of a buffer.
pub(super) fn buffer<'d>(document: &'d Document<'_>, index: usize, user: &str) -> Result<&'d [u8]> {
    let json = document.get(&document.root.buffers, index, "buffers", user)?;
    let slot = document.get(&document.buffers.buffers, index, "buffers", user)?;
    if let Some(bytes) = slot.get() {
        return Ok(bytes);
    }
    let element = format!("buffers[{index}]");
    let bytes: Cow<'_, [u8]> = match (&json.uri, document.buffers.binary) {
        (Some(uri), _) => {
            let bytes = uri::read(document, &element, uri)?;
            document.used.add_bytes(bytes.len());
            Cow::Owned(bytes)
        }
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) => {
            return Err(document.invalid(element, format!("has neither a URI nor a binary chunk, but {user} needs it")));
        }
    };
    let promised = json.byte_length.0;
    if (bytes.len() as u64) < promised {
        let reason = format!("is cut short: {promised} bytes are promised, but there are {}", bytes.len());
        return Err(document.invalid(element, reason));
    }
    Ok(slot.get_or_init(|| bytes))
}

/// Returns a range of bytes; `None` if it ends behind them.
pub(super) fn slice(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}
