//! Check for files of one crate that use each other in a circle. A module and its parents may.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use syn::{
    UseTree,
    visit::{Visit, visit_item_mod, visit_path},
};

use crate::run::root;

/// Path of a module in its crate; empty for the root.
type Module = Vec<String>;

/// Paths in a file, without its tests: `use` trees, and paths in code that begin with `crate`,
/// `self` or `super`.
#[derive(Default)]
struct Named(Vec<Vec<String>>);

impl Named {
    fn tree(&mut self, tree: &UseTree, before: &[String]) {
        match tree {
            UseTree::Path(path) => self.tree(&path.tree, &[before, &[path.ident.to_string()]].concat()),
            UseTree::Name(name) => self.0.push([before, &[name.ident.to_string()]].concat()),
            UseTree::Rename(name) => self.0.push([before, &[name.ident.to_string()]].concat()),
            UseTree::Glob(_) => self.0.push(before.to_vec()),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.tree(tree, before)),
        }
    }
}

impl<'ast> Visit<'ast> for Named {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.tree(&item.tree, &[]);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit_path(self, path);
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if item.ident != "tests" {
            visit_item_mod(self, item);
        }
    }
}

/// Returns the module that a path in `from` leads to: the longest part of the path that is a
/// module.
fn target(path: &[String], from: &Module, modules: &BTreeMap<Module, PathBuf>) -> Option<Module> {
    let (mut at, mut rest) = match path.first()?.as_str() {
        "crate" => (Vec::new(), &path[1..]),
        "self" => (from.clone(), &path[1..]),
        "super" => (from[..from.len().saturating_sub(1)].to_vec(), &path[1..]),
        _ => return None,
    };
    while let Some(("super", after)) = rest.split_first().map(|(first, after)| (first.as_str(), after)) {
        at.pop();
        rest = after;
    }
    for name in rest {
        let next = [at.clone(), vec![name.clone()]].concat();
        if !modules.contains_key(&next) {
            break;
        }
        at = next;
    }
    Some(at)
}

/// Lists the modules of a crate, each with its file.
fn modules(source: &Path, at: &Module, found: &mut BTreeMap<Module, PathBuf>) {
    for entry in fs::read_dir(source).unwrap_or_else(|error| panic!("{}: {error}", source.display())).flatten() {
        let path = entry.path();
        let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()).map(str::to_owned) else { continue };
        if path.is_dir() {
            modules(&path, &[at.clone(), vec![stem]].concat(), found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let is_of_folder = ["lib", "main", "mod"].contains(&stem.as_str());
            let module = if is_of_folder { at.clone() } else { [at.clone(), vec![stem]].concat() };
            found.insert(module, path);
        }
    }
}

/// Returns the modules that each module uses, without its parents and children.
fn uses(modules: &BTreeMap<Module, PathBuf>) -> BTreeMap<Module, BTreeSet<Module>> {
    let is_kin = |a: &Module, b: &Module| a.starts_with(b) || b.starts_with(a);
    let used = |(module, path): (&Module, &PathBuf)| {
        let text = fs::read_to_string(path).expect("a source is text");
        let mut named = Named::default();
        named.visit_file(&syn::parse_file(&text).expect("a source that compiles"));
        let targets = named.0.iter().filter_map(|path| target(path, module, modules));
        (module.clone(), targets.filter(|other| !is_kin(module, other)).collect())
    };
    modules.iter().map(used).collect()
}

/// Returns the modules that can be reached from themselves.
fn in_circles(uses: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<String> {
    let is_in_circle = |start: &Module| {
        let mut seen = BTreeSet::new();
        let mut next: Vec<&Module> = uses[start].iter().collect();
        while let Some(module) = next.pop() {
            if module == start {
                return true;
            }
            if seen.insert(module) {
                next.extend(&uses[module]);
            }
        }
        false
    };
    uses.keys().filter(|module| is_in_circle(module)).map(|module| module.join("::")).collect()
}

#[test]
fn files_use_each_other_in_no_circle() {
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join("crates")).expect("the crates are there").flatten() {
        let mut all = BTreeMap::new();
        modules(&entry.path().join("src"), &Vec::new(), &mut all);
        let name = entry.file_name().to_string_lossy().into_owned();
        found.extend(in_circles(&uses(&all)).into_iter().map(|module| format!("{name}::{module}")));
    }
    assert!(found.is_empty(), "files in circles: {found:#?}");
}

#[test]
fn circles_are_found() {
    let module = |path: &str| -> Module { path.split("::").map(str::to_owned).collect() };
    let uses = |pairs: &[(&str, &str)]| {
        let mut uses: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
        for (from, to) in pairs {
            uses.entry(module(from)).or_default().insert(module(to));
            uses.entry(module(to)).or_default();
        }
        uses
    };
    assert_eq!(in_circles(&uses(&[("a", "b"), ("b", "c"), ("a", "c")])), Vec::<String>::new());
    assert_eq!(in_circles(&uses(&[("a", "b::x"), ("b::x", "c"), ("c", "a"), ("d", "a")])), ["a", "b::x", "c"]);
}

#[test]
fn paths_lead_to_modules() {
    let modules: BTreeMap<Module, PathBuf> = [vec![], vec!["a"], vec!["a", "b"], vec!["c"]]
        .map(|path| (path.into_iter().map(str::to_owned).collect(), PathBuf::new()))
        .into();
    let from = |path: &str, module: &[&str]| {
        let words: Vec<String> = path.split("::").map(str::to_owned).collect();
        target(&words, &module.iter().map(|&word| word.to_owned()).collect(), &modules).map(|it| it.join("::"))
    };
    assert_eq!(from("crate::a::b::Thing", &["c"]).as_deref(), Some("a::b"));
    assert_eq!(from("super::super::c::f", &["a", "b"]).as_deref(), Some("c"));
    assert_eq!(from("self::b", &["a"]).as_deref(), Some("a::b"));
    assert_eq!(from("glam::DVec3", &["a"]), None);
}
