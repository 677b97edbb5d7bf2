//! URIs of buffers and images: `data:` URIs, and relative ones that stay in the folder of the file.

use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::Document;
use crate::error::read_file;
use crate::{Error, GltfOptions, Result};

/// Base64 with optional padding, because some exporters leave it out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Returns the bytes behind a URI of `element`.
pub(super) fn read(document: &Document<'_>, element: &str, uri: &str) -> Result<Vec<u8>> {
    let is_data = uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"));
    if !is_data {
        return (document.external)(element, uri);
    }
    let (header, body) = uri
        .split_once(',')
        .ok_or_else(|| document.invalid(element, "has a data: URI without a comma between its header and its data"))?;
    if header.to_ascii_lowercase().ends_with(";base64") {
        BASE64
            .decode(body.trim_end())
            .map_err(|error| document.invalid(element, format!("has a data: URI that is not base64: {error}")))
    } else {
        Ok(percent_encoding::percent_decode_str(body).collect())
    }
}

/// Reads a file that a glTF file in `folder` refers to.
pub(super) fn read_external(
    file: &str,
    folder: Option<&Path>,
    element: &str,
    uri: &str,
    options: &GltfOptions,
) -> Result<Vec<u8>> {
    let refuse =
        |reason| Error::UnsafeUri { file: file.to_owned(), element: element.to_owned(), uri: shortened(uri), reason };
    let folder = match folder {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let path = folder.join(relative_path(uri, options.parent_folders).map_err(refuse)?);
    let failed = |reason: String| Error::External {
        file: file.to_owned(),
        element: element.to_owned(),
        path: path.clone(),
        reason,
    };
    if !options.parent_folders {
        // A symbolic link may lead out of the folder although the name does not.
        let real = |path: &Path| path.canonicalize().map_err(|source| failed(source.to_string()));
        if !real(&path)?.starts_with(real(folder)?) {
            return Err(refuse("leads out of the file's folder through a link; --parent-folders lets it"));
        }
    }
    read_file(&path).map_err(|error| match error {
        Error::Read { source, .. } => failed(source.to_string()),
        Error::NotAFile { kind, .. } => failed(format!("it is {kind}, not a regular file")),
        other => other,
    })
}

/// Returns the relative path of a URI reference, with `.` and `..` resolved. It never leaves the
/// folder unless `parents` allows it.
fn relative_path(uri: &str, parents: bool) -> Result<PathBuf, &'static str> {
    // RFC 3986 section 4.2: in a relative reference no colon stands before the first slash. This
    // covers http:, file: and C:.
    if uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err("has a scheme or a drive");
    }
    let decoded = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| "is not UTF-8 once its percent escapes are decoded")?;
    if decoded.starts_with(['/', '\\']) {
        return Err("is absolute");
    }
    let mut parts: Vec<&str> = Vec::new();
    // Windows takes a backslash for a separator, so it is one everywhere.
    for part in decoded.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            ".." if parents => parts.push(part),
            ".." => return Err("leads out of the file's folder; --parent-folders lets it"),
            _ if part.contains(['\0', ':']) => return Err("has a drive, a stream or a null character in it"),
            name => parts.push(name),
        }
    }
    if parts.is_empty() { Err("names no file") } else { Ok(parts.iter().collect()) }
}

/// Shortens a URI for a message: long ones lose their tail.
pub(super) fn shortened(uri: &str) -> String {
    const MOST: usize = 120;
    match uri.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &uri[..end]),
        None => uri.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_references_stay_inside() {
        for (uri, path) in [
            ("a.bin", "a.bin"),
            ("./a%20b/c.png", "a b/c.png"),
            ("x/../a.bin", "a.bin"),
            ("a//b.bin", "a/b.bin"),
            ("sub\\a.bin", "sub/a.bin"),
            ("..a/b...bin", "..a/b...bin"),
        ] {
            assert_eq!(relative_path(uri, false).as_deref(), Ok(Path::new(path)), "{uri}");
        }
    }

    #[test]
    fn everything_else_is_refused() {
        for uri in [
            "",
            ".",
            "..",
            "../a",
            "a/../../b",
            "%2e%2e/a",
            "..%2fa",
            "..\\a",
            "a/..\\..\\b",
            "/etc/passwd",
            "%2fetc/passwd",
            "\\\\server\\share",
            "//server/share",
            "C:/a",
            "C%3A/a",
            "x/C:/a",
            "file:///etc/passwd",
            "https://example.invalid/a.bin",
            "a%00.bin",
            "%ff",
        ] {
            assert!(relative_path(uri, false).is_err(), "{uri}");
        }
    }

    #[test]
    fn parents_are_reached_where_they_may_be() {
        for (uri, path) in [("../t/a.png", "../t/a.png"), ("a/../../b", "../b"), ("..\\..\\b", "../../b")] {
            assert_eq!(relative_path(uri, true).as_deref(), Ok(Path::new(path)), "{uri}");
        }
        for uri in ["", "..", "/etc/passwd", "file:///a", "C:/a"] {
            assert!(relative_path(uri, true).is_err() || uri == "..", "{uri}");
        }
    }
}
