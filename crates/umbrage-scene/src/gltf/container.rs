//! The .glb container. Source: glTF 2.0 specification, section 4 (GLB file format).

/// Chunks of the file, as bytes.
pub(super) struct Chunks<'a> {
    pub(super) json: &'a [u8],
    pub(super) binary: Option<&'a [u8]>,
}

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Splits a .glb into its chunks. Anything else is taken for the JSON of a .gltf. The error says
/// what is wrong.
pub(super) fn split(bytes: &[u8]) -> Result<Chunks<'_>, String> {
    if !bytes.starts_with(b"glTF") {
        let json = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        if json.is_empty() {
            return Err("is empty; a glTF file was expected".into());
        }
        return Ok(Chunks { json, binary: None });
    }
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(format!("is cut short: {} bytes are less than the header of a .glb", bytes.len()));
    };
    if version != 2 {
        return Err(format!("is a .glb of version {version}; only version 2 is read"));
    }
    let length = length as usize;
    if length > bytes.len() {
        return Err(format!("is cut short: its header promises {length} bytes, but it has {}", bytes.len()));
    }
    let body =
        bytes.get(HEADER..length).ok_or_else(|| format!("has a .glb header that promises only {length} bytes"))?;

    let mut rest = body;
    let mut chunks = Vec::new();
    // Chunks of unknown type behind the first two are to be ignored, as are less than 8 trailing
    // bytes.
    while rest.len() >= CHUNK_HEADER && chunks.len() < 2 {
        let (header, data) = rest.split_at(CHUNK_HEADER);
        let size = u32::from_le_bytes([header[0], header[1], header[2], header[3]]) as usize;
        let content = data.get(..size).ok_or_else(|| {
            format!("is cut short: chunk {} promises {size} bytes, but {} are left", chunks.len(), data.len())
        })?;
        chunks.push((&header[4..], content));
        rest = &data[size..];
    }
    match chunks.as_slice() {
        [(b"JSON", json)] => Ok(Chunks { json: unpadded(json), binary: None }),
        [(b"JSON", json), (kind, binary)] => {
            Ok(Chunks { json: unpadded(json), binary: (*kind == b"BIN\0").then_some(*binary) })
        }
        _ => Err("is a .glb whose first chunk is not JSON".into()),
    }
}

/// Strips the padding of a JSON chunk. The specification's blanks need no care, but zeros do.
fn unpadded(json: &[u8]) -> &[u8] {
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    &json[..end]
}
