//! Joins `shaders/lib` and `shaders/pass` into one plain WGSL text per root, with names that an app can live beside.

use wesl::{CompileOptions, Mangler, ModulePath, Wesl};

/// The roots in `shaders`, the features that they are built with, and the file that each becomes in `OUT_DIR`.
const ROOTS: [(&str, &[&str], &str); 12] = [
    ("pass::caster", &[], "caster"),
    ("pass::contact", &[], "contact"),
    ("pass::receiver", &["depth_loads"], "receiver"),
    ("pass::receiver", &[], "receiver_without_loads"),
    ("pass::receiver", &["moments"], "receiver_of_moments"),
    ("pass::moments", &[], "moment_passes"),
    ("pass::moments", &["multisampled"], "moment_passes_of_samples"),
    ("maps::array", &["depth_loads"], "array"),
    ("maps::array", &[], "array_without_loads"),
    ("maps::moments", &[], "moments"),
    ("maps::moments", &["own_taps"], "moments_by_taps"),
    ("maps::moments", &["own_taps", "by_hand"], "moments_by_hand"),
];

/// `depth_loads`: depth textures can be loaded from. `moments`: maps hold moments of depth. `multisampled`: depth has four samples a
/// texel. `own_taps`: the shader takes an anisotropic sample's taps. `by_hand`: and no sampler filters moments.
const FEATURES: [&str; 5] = ["depth_loads", "moments", "multisampled", "own_taps", "by_hand"];

fn main() {
    let mut compiler = Wesl::new("shaders");
    compiler.set_custom_mangler(HouseNames);
    compiler.set_options(CompileOptions {
        // A root has no entry point of its own (the app has it): all of it is kept, and what it uses of `lib`.
        keep_root: true,
        // The constant of the bind group's index is declared at run time, by `umbrage_shaders::receiver`, and the two functions
        // that read maps by the text of `shaders/maps` that it adds: unknown here. Undeclared names are found by naga instead,
        // which validates every text in this crate's tests.
        validate: false,
        ..CompileOptions::default()
    });
    for (root, features, file) in ROOTS {
        FEATURES.iter().for_each(|feature| {
            compiler.set_feature(feature, features.contains(feature));
        });
        let path: ModulePath = format!("package::{root}").parse().expect("a root's name is a module path");
        compiler.build_artifact(&path, file);
    }
    println!("cargo::rerun-if-changed=shaders");
}

/// Turns the path of an item in `lib` into a name in our own namespace: `lib::filter::tent` is `umbrage_filter_tent`,
/// `lib::bias::MAX_SLOPE` is `UMBRAGE_BIAS_MAX_SLOPE` and `lib::layout::Split` is `UmbrageSplit`. Items of a root keep
/// their names. The default of `wesl` counts underscores (`package_lib_filter_tent`, `__1` …), which reads worse in an
/// error message of the app's shader.
struct HouseNames;

impl Mangler for HouseNames {
    fn mangle(&self, path: &ModulePath, item: &str) -> String {
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
}
