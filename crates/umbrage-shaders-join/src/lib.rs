//! Joins the modules of `umbrage-shaders/shaders` into one plain WGSL text per root, with names
//! that do not collide with an application's.
//!
//! The texts are checked in, in `umbrage-shaders/src/wgsl`, so that a build of `umbrage-shaders`
//! needs no WESL compiler. `cargo xtask shaders` writes them; a test of this crate fails if they
//! differ from the joined modules.

mod folder;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use anyhow::{Context, Result, anyhow};
use wesl::{CompileOptions, Feature, Features, Mangler, ModulePath, Wesl};
use wgsl_parse::SyntaxNode as _;

pub use folder::{differences, write};

/// Root module in `shaders` of a text, the features that it is built with, and the name of the
/// text.
type Root = (&'static str, Vec<String>, String);

/// A joined text and its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// Name of the text: that of its file without the extension.
    pub name: String,
    /// Source of the text: plain WGSL, with the conditions of a receiver's choices.
    pub wgsl: String,
}

/// Largest number of maps that are separate textures: `layout::MAX_SPLITS`.
const MOST_MAPS: usize = 8;

fn roots() -> Vec<Root> {
    let text = |root, features: &[&str], file: String| (root, features.iter().map(ToString::to_string).collect(), file);
    let mut texts = vec![
        text("pass::caster", &[], "caster".into()),
        text("pass::casters", &["views"], "casters_views".into()),
        text("pass::casters", &["tiles"], "casters_tiles".into()),
        text("pass::casters", &["views", "tiles"], "casters_views_tiles".into()),
        text("pass::contact", &[], "contact".into()),
        text("pass::kept", &[], "kept".into()),
        text("pass::cull", &[], "cull".into()),
        text("pass::mask", &[], "mask".into()),
        text("pass::mask", &["normals"], "mask_with_normals".into()),
        text("pass::seen", &[], "seen".into()),
        text("pass::seen", &["multisampled"], "seen_of_samples".into()),
        text("receiver::api", &["depth_loads"], "receiver".into()),
        text("receiver::api", &[], "receiver_without_loads".into()),
        text("receiver::api", &["moments"], "receiver_of_moments".into()),
        text("receiver::api", &["depth_loads", "coordinates"], "receiver_with_coordinates".into()),
        text("receiver::api", &["coordinates"], "receiver_with_coordinates_without_loads".into()),
        text("receiver::api", &["moments", "coordinates"], "receiver_with_coordinates_of_moments".into()),
        text("maps::ids", &[], "ids".into()),
        text("maps::stored_runs", &[], "stored_runs".into()),
        text("pass::moments", &[], "moment_passes".into()),
        text("pass::moments", &["multisampled"], "moment_passes_of_samples".into()),
        text("maps::moments", &[], "moments".into()),
        text("maps::moments", &["own_taps"], "moments_by_taps".into()),
        text("maps::moments", &["own_taps", "by_hand"], "moments_by_hand".into()),
    ];
    // How maps can be read, and what that is called.
    for (feature, name) in [("depth_loads", ""), ("none", "_without_loads"), ("r32f", "_r32f")] {
        texts.push(text("maps::array", &[feature], format!("array{name}")));
        texts.push(text("maps::cube", &[feature], format!("cube{name}")));
        for count in 1..=MOST_MAPS {
            let mut features = vec![feature.to_owned()];
            features.extend((2..=count).map(|map| format!("maps_{map}")));
            texts.push(("maps::separate", features, format!("separate_{count}{name}")));
        }
    }
    for count in 1..=MOST_MAPS {
        let features = (1..=count).map(|map| format!("maps_{map}")).collect();
        texts.push(("maps::ids", features, format!("ids_{count}")));
    }
    texts
}

/// Features of the modules. `depth_loads`: depth textures can be loaded from. `r32f`: maps are
/// colour textures. `views`, `tiles`: casters are drawn into several layers or tiles. `moments`:
/// maps hold moments of depth. `multisampled`: depth has four samples per texel. `own_taps`: the
/// shader takes the taps of an anisotropic sample itself. `by_hand`: with `own_taps`, no sampler
/// filters moments. `normals`: a mask has a buffer of normals. `coordinates`: receivers take shadow
/// coordinates from vertex shaders. `maps_1` to `maps_8` are further features.
const FEATURES: [&str; 10] = [
    "depth_loads",
    "r32f",
    "views",
    "tiles",
    "normals",
    "moments",
    "multisampled",
    "own_taps",
    "by_hand",
    "coordinates",
];

/// Returns the folder of the modules.
#[must_use]
pub fn sources() -> PathBuf {
    shaders_crate().join("shaders")
}

/// Returns the folder of the texts that are checked in.
#[must_use]
pub fn checked_in() -> PathBuf {
    shaders_crate().join("src/wgsl")
}

fn shaders_crate() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../umbrage-shaders")
}

/// Joins the modules in the folder `sources` into all texts, by name.
///
/// # Errors
/// If a module is missing or wrong; the message shows the place.
pub fn join(sources: &Path) -> Result<Vec<Text>> {
    let mut texts = roots().iter().map(|root| joined(sources, root)).collect::<Result<Vec<_>>>()?;
    texts.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(texts)
}

fn joined(sources: &Path, (root, features, name): &Root) -> Result<Text> {
    let names = HouseNames::default();
    let counts: Vec<String> = (1..=MOST_MAPS).map(|map| format!("maps_{map}")).collect();
    let known = FEATURES.into_iter().chain(counts.iter().map(String::as_str));
    let features = Features {
        // All other conditions are choices that a text may be made without at run time:
        // `ReceiverText` and `MaskText` of `umbrage-shaders` know them. They stay in the texts of
        // receivers and masks; every other text has all of them.
        default: if ["receiver::api", "pass::mask"].contains(root) { Feature::Keep } else { Feature::Enable },
        flags: known.map(|name| (name.to_owned(), features.iter().any(|wanted| wanted == name).into())).collect(),
    };
    let mut compiler = Wesl::new(sources);
    compiler.set_custom_mangler(names.clone());
    compiler.set_options(CompileOptions {
        features,
        // A root has no entry point of its own (the app has it): all of it is kept, and what it
        // uses of `lib`.
        keep_root: true,
        // The constant of the bind group's index is declared at run time, by
        // `umbrage_shaders::receiver`, and the two functions that read maps by the text of
        // `shaders/maps` that it adds: unknown here. Undeclared names are found by naga instead,
        // which validates every text in the tests of `umbrage-shaders`.
        validate: false,
        ..CompileOptions::default()
    });
    let path: ModulePath = format!("package::{root}").parse().with_context(|| format!("{root} is no module path"))?;
    let mut compiled = compiler.compile(&path).map_err(|error| anyhow!("{root} does not join:\n{error}"))?;
    // `wesl` takes modules in the order of a hash set, another one in every run.
    compiled
        .syntax
        .global_declarations
        .sort_by_cached_key(|declaration| declaration.ident().and_then(|name| names.module_of(&name.to_string())));
    Ok(Text { name: name.clone(), wgsl: compiled.to_string() })
}

/// Turns the path of an item in `lib` into a name in our own namespace: `lib::kernel::pair` is
/// `umbrage_kernel_pair`, `lib::bias::MAX_SLOPE` is `UMBRAGE_BIAS_MAX_SLOPE` and
/// `lib::layout::Split` is `UmbrageSplit`. Items of a root, and those that are in the namespace
/// already, keep their names. The default of `wesl` counts underscores (`package_lib_filter_tent`,
/// `__1` …), which reads worse in an error message of the app's shader.
///
/// It remembers the module of each name.
#[derive(Clone, Default)]
struct HouseNames {
    modules: Arc<Mutex<BTreeMap<String, Vec<String>>>>,
}

impl HouseNames {
    /// Returns the module of a name that was made; `None` for a name of a root.
    fn module_of(&self, name: &str) -> Option<Vec<String>> {
        self.modules.lock().ok()?.get(name).cloned()
    }
}

impl Mangler for HouseNames {
    fn mangle(&self, path: &ModulePath, item: &str) -> String {
        let name = house_name(path, item);
        if let Ok(mut modules) = self.modules.lock() {
            modules.insert(name.clone(), path.components.clone());
        }
        name
    }
}

fn house_name(path: &ModulePath, item: &str) -> String {
    if item.to_lowercase().starts_with("umbrage_") || item.starts_with("Umbrage") {
        return item.to_owned();
    }
    let module = path.components.last().map_or("root", String::as_str);
    let is_constant = item.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    if is_constant {
        format!("UMBRAGE_{}_{item}", module.to_uppercase())
    } else if item.starts_with(|c: char| c.is_ascii_uppercase()) {
        format!("Umbrage{item}")
    } else {
        format!("umbrage_{module}_{item}")
    }
}
