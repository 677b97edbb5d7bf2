//! The folder of the joined texts that are checked in.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::Text;

const ENDING: &str = "wgsl";

/// Compares the files of `folder` with `texts`. Returns a line for each file that is missing,
/// differs, or belongs to no text.
///
/// # Errors
/// If the folder cannot be read.
pub fn differences(folder: &Path, texts: &[Text]) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for text in texts {
        let file = file_name(text);
        match fs::read(folder.join(&file)) {
            Ok(bytes) if bytes == text.wgsl.as_bytes() => {}
            Ok(_) => found.push(format!("{file} is not what the modules join to")),
            Err(_) => found.push(format!("{file} is missing")),
        }
    }
    found.extend(strangers(folder, texts)?.iter().map(|name| format!("{name} is of no text")));
    Ok(found)
}

/// Writes `texts` into `folder`, and removes files that belong to none.
///
/// # Errors
/// If the folder cannot be written.
pub fn write(folder: &Path, texts: &[Text]) -> Result<()> {
    for text in texts {
        let path = folder.join(file_name(text));
        // Files that stay as they are keep their time: cargo would compile them again.
        if fs::read(&path).is_ok_and(|bytes| bytes == text.wgsl.as_bytes()) {
            continue;
        }
        fs::write(&path, &text.wgsl).with_context(|| format!("{} cannot be written", path.display()))?;
    }
    for name in strangers(folder, texts)? {
        let path = folder.join(name);
        fs::remove_file(&path).with_context(|| format!("{} cannot be removed", path.display()))?;
    }
    Ok(())
}

fn file_name(text: &Text) -> String {
    format!("{}.{ENDING}", text.name)
}

/// Lists the WGSL files that belong to no text.
fn strangers(folder: &Path, texts: &[Text]) -> Result<Vec<String>> {
    let known: BTreeSet<String> = texts.iter().map(file_name).collect();
    let entries = fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))?;
    let mut names = Vec::new();
    for entry in entries {
        let name = entry.with_context(|| format!("{} cannot be read", folder.display()))?.file_name();
        let name = name.to_string_lossy().into_owned();
        if name.ends_with(&format!(".{ENDING}")) && !known.contains(&name) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}
