//! The check of this repository, and tests of the check on small crates.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use super::{in_circles, modules::Modules, uses_of};
use crate::run::root;

/// Root files of a package's targets.
fn targets(package: &Path) -> Vec<PathBuf> {
    let is_root = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "rs") && path.is_file();
    let mut found: Vec<PathBuf> = ["src/lib.rs", "src/main.rs", "build.rs"].map(|file| package.join(file)).into();
    for folder in ["src/bin", "tests", "examples", "benches"] {
        for entry in fs::read_dir(package.join(folder)).into_iter().flatten().flatten() {
            found.extend([entry.path(), entry.path().join("main.rs")]);
        }
    }
    found.retain(is_root);
    found
}

fn packages() -> Vec<PathBuf> {
    let mut found = vec![root().join("xtask")];
    for folder in ["crates", "integrations"] {
        let entries = fs::read_dir(root().join(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
        found.extend(entries.flatten().map(|entry| entry.path()).filter(|path| path.join("Cargo.toml").exists()));
    }
    found
}

/// All Rust sources below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

#[test]
fn files_use_each_other_in_no_circle() {
    let (mut circles, mut unread) = (Vec::new(), Vec::new());
    for package in packages() {
        let mut files = BTreeSet::new();
        for target in targets(&package) {
            let modules = Modules::read(&target, &|path| fs::read_to_string(path).ok());
            circles.extend(in_circles(&uses_of(&modules)));
            files.extend(modules.files().into_keys().map(Path::to_owned));
        }
        unread.extend(sources(&package.join("src")).into_iter().filter(|path| !files.contains(path)));
    }
    assert!(unread.is_empty(), "files of no module: {unread:#?}");
    let root = format!("{}/", root().display());
    assert!(circles.is_empty(), "uses in circles:\n{}", circles.join("\n").replace(&root, ""));
}

/// Circles in a library of these files.
fn circles(files: &[(&str, &str)]) -> Vec<String> {
    let text = |path: &Path| files.iter().find(|(name, _)| path == Path::new(name)).map(|(_, text)| (*text).to_owned());
    in_circles(&uses_of(&Modules::read(Path::new("lib.rs"), &text)))
}

const A_USES_B: (&str, &str) = ("a.rs", "pub struct A(crate::b::B);");

#[test]
fn a_circle_is_found_and_a_chain_is_not() {
    let root = ("lib.rs", "mod a; mod b; mod c;");
    let circle =
        circles(&[root, A_USES_B, ("b.rs", "use super::c::C; pub struct B(C);"), ("c.rs", "use crate::a::A;")]);
    assert_eq!(circle.len(), 3, "{circle:#?}");
    assert_eq!(circle[0], "a.rs -> b.rs: crate::b::B");
    let chain = circles(&[root, A_USES_B, ("b.rs", "use super::c::C; pub struct B(C);"), ("c.rs", "pub struct C;")]);
    assert_eq!(chain, Vec::<String>::new());
}

/// Names A in every way that is not a path to its file.
#[test]
fn circles_through_re_exports_are_found() {
    let is_circle = |root: &str, b: &str| {
        let root = format!("mod a; mod b; {root}");
        circles(&[("lib.rs", &root), A_USES_B, ("b.rs", &format!("pub struct B; {b}"))])
    };
    let both = |user: &str| vec!["a.rs -> b.rs: crate::b::B".to_owned(), format!("b.rs -> a.rs: {user}")];
    assert_eq!(is_circle("pub use a::A;", "use crate::A;"), both("crate::A"));
    assert_eq!(is_circle("pub(crate) use a::A;", "fn f(_: super::A) {}"), both("super::A"));
    assert_eq!(is_circle("use self::a::A;", "const C: usize = size_of::<super::A>();"), both("super::A"));
    assert_eq!(is_circle("pub use crate::a::A as Other;", "use crate::Other;"), both("crate::Other"));
    assert_eq!(is_circle("pub use a::*;", "use crate::A;"), both("crate::A"));
    assert_eq!(is_circle("use a as part; pub mod all { pub use crate::part::A; }", "use crate::all::A;").len(), 2);
    assert_eq!(is_circle("pub use a::{self as part};", "use crate::part::A;"), both("crate::part::A"));
    assert_eq!(is_circle("pub use a::A;", "use super::*; fn f(_: A) {}"), both("A"));
    assert_eq!(is_circle("pub use a::A;", "fn f() { say!(\"{}\", [crate::A::new()]) }"), both("crate::A::new"));
    assert_eq!(is_circle("pub use a::A;", "#[error(\"{}\", crate::A)] struct E;"), both("crate::A"));
    assert_eq!(is_circle("pub use a::A;", "macro_rules! m { () => { $crate::A } }"), both("crate::A"));
    // Neither what the root itself defines nor what another crate does is of a.rs.
    for (root, b) in [
        ("pub struct A;", "use crate::A;"),
        ("pub use other::A;", "use crate::A;"),
        ("use A as A;", "use crate::A;"),
        ("pub use a::A; struct Own;", "use super::*; fn f(_: Own) {}"),
        ("pub use a::A;", "#[cfg(test)] mod tests { use crate::A; } #[cfg(test)] fn f(_: crate::A) {}"),
    ] {
        assert_eq!(is_circle(root, b), Vec::<String>::new(), "{root} {b}");
    }
}

#[test]
fn a_function_is_not_taken_for_the_module_of_its_name() {
    let root = ("lib.rs", "mod plan; mod planner; pub use plan::Most; pub use planner::plan;");
    let planner = ("planner.rs", "pub fn plan() -> crate::plan::Most {}");
    assert_eq!(circles(&[root, planner, ("plan.rs", "pub struct Most; use crate::Most as It;")]), Vec::<String>::new());
    assert_eq!(circles(&[root, planner, ("plan.rs", "pub struct Most; use crate::plan as it;")]).len(), 2);
}

/// A module may use its parent, but not through a third file.
#[test]
fn parents_may_be_used() {
    let root = ("lib.rs", "mod a; mod c;");
    let a = ("a/mod.rs", "mod b; pub struct A(b::B);");
    let c = ("c.rs", "use crate::a::A; pub struct C(A);");
    assert_eq!(circles(&[root, a, c, ("a/b.rs", "use super::A; pub struct B;")]), Vec::<String>::new());
    let found = circles(&[root, a, c, ("a/b.rs", "use crate::c::C; pub struct B;")]);
    assert_eq!(found.len(), 3, "{found:#?}");
}

#[test]
fn modules_are_found_where_they_lie() {
    let files = [
        ("lib.rs", "mod a; mod inner { mod deep; }"),
        ("a.rs", "mod b; #[cfg(test)] #[path = \"a_tests.rs\"] mod tests;"),
        ("a/b/mod.rs", ""),
        ("a_tests.rs", ""),
        ("inner/deep.rs", ""),
    ];
    let text = |path: &Path| files.iter().find(|(name, _)| path == Path::new(name)).map(|(_, text)| (*text).to_owned());
    let modules = Modules::read(Path::new("lib.rs"), &text);
    let found: Vec<String> = modules.files().values().map(|module| module.join("::")).collect();
    assert_eq!(found, ["a::b", "a", "a::tests", "inner::deep", ""]);
}
