//! The crates of the workspace.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::run::{cargo, output};

/// A crate of the workspace, as in `cargo metadata`.
#[derive(Deserialize)]
pub struct Package {
    pub name: String,
    /// The oldest compiler that the crate promises.
    pub rust_version: Option<String>,
    pub features: BTreeMap<String, Vec<String>>,
    /// Registries that the crate may be published to; all if there is no list.
    publish: Option<Vec<String>>,
}

impl Package {
    pub fn is_published(&self) -> bool {
        self.publish.as_ref().is_none_or(|registries| !registries.is_empty())
    }
}

/// Returns the crates of the workspace.
pub fn packages() -> Result<Vec<Package>> {
    #[derive(Deserialize)]
    struct Metadata {
        packages: Vec<Package>,
    }
    let text = output(cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: Metadata = serde_json::from_str(&text).context("cargo metadata says something unknown")?;
    Ok(metadata.packages)
}
