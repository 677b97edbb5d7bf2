//! Check that published crates have what a registry and a reader of the package need.

use std::{fs, path::Path};

use serde_json::Value;

use crate::run::{cargo, output, root};

/// Files beside the manifest.
const FILES: [&str; 3] = ["README.md", "LICENSE-MIT", "LICENSE-APACHE"];
/// Keys of the manifest, by their names in `cargo metadata`.
const KEYS: [&str; 5] = ["description", "keywords", "rust_version", "license", "readme"];

/// Keys and files that a package of `cargo metadata` lacks; none if it is not published. `has_file`
/// returns true if a file lies beside its manifest.
fn lacking(package: &Value, has_repository: bool, has_file: impl Fn(&str) -> bool) -> Vec<String> {
    if package["publish"].as_array().is_some_and(Vec::is_empty) {
        return Vec::new();
    }
    let is_given = |key: &str| match &package[key] {
        Value::String(text) => !text.is_empty(),
        Value::Array(list) => !list.is_empty(),
        _ => false,
    };
    let repository = has_repository.then_some("repository");
    let keys = KEYS.into_iter().chain(repository).filter(|key| !is_given(key));
    keys.chain(FILES.into_iter().filter(|file| !has_file(file))).map(str::to_owned).collect()
}

#[test]
fn published_crates_are_complete() {
    let metadata = output(cargo().args(["metadata", "--no-deps", "--format-version", "1"])).expect("cargo metadata");
    let metadata: Value = serde_json::from_str(&metadata).expect("JSON");
    let workspace = fs::read_to_string(root().join("Cargo.toml")).expect("the workspace's manifest");
    let has_repository = workspace.lines().any(|line| line.starts_with("repository"));
    let mut wrong = Vec::new();
    let mut published = 0;
    for package in metadata["packages"].as_array().expect("packages") {
        let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
        // A link to nothing is no file.
        let has_file = |name: &str| manifest.with_file_name(name).is_file();
        published += usize::from(!package["publish"].is_array());
        let lacking = lacking(package, has_repository, has_file);
        wrong.extend(lacking.into_iter().map(|what| format!("{} lacks {what}", package["name"])));
    }
    assert!(published > 5, "only {published} crates are published");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_lacking_is_found() {
    let package: Value = serde_json::json!({
        "description": "Shadows", "keywords": ["shadow"], "rust_version": "1.88", "license": "MIT",
        "readme": "README.md", "repository": null, "publish": null,
    });
    assert_eq!(lacking(&package, false, |_| true), Vec::<String>::new());
    assert_eq!(lacking(&package, true, |_| true), ["repository"]);
    assert_eq!(lacking(&package, false, |file| file != "LICENSE-MIT"), ["LICENSE-MIT"]);
    for key in KEYS {
        let mut less = package.clone();
        less[key] = if key == "keywords" { serde_json::json!([]) } else { Value::Null };
        assert_eq!(lacking(&less, false, |_| true), [key]);
        less["publish"] = serde_json::json!([]);
        assert_eq!(lacking(&less, true, |_| false), Vec::<String>::new(), "it is not published");
    }
}
