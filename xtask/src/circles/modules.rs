//! Modules of a target, read from its root file, and resolution of the paths in them.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use super::names::{Module, Names, read_names};

/// A module's file, and the names in the module.
pub struct Scope {
    pub file: PathBuf,
    pub names: Names,
}

/// Target of a path.
enum Named {
    Module(Module),
    /// A type or trait, which has variants and associated items, and the file that defines it.
    Type(PathBuf),
    /// A function, constant or macro, and the file that defines it.
    Value(PathBuf),
}

/// All modules of a target.
pub struct Modules(BTreeMap<Module, Scope>);

/// Folder of a file's child modules: the folder of a root or a `mod.rs`, otherwise a folder of the
/// file's name.
fn folder_of(file: &Path, is_root: bool) -> PathBuf {
    if is_root || file.file_stem().is_some_and(|stem| stem == "mod") {
        file.parent().unwrap_or(Path::new("")).to_owned()
    } else {
        file.with_extension("")
    }
}

impl Modules {
    /// Reads the target whose root is `root`. `read` returns a file's text; `None` if there is no
    /// such file.
    pub fn read(root: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Self {
        let mut found = BTreeMap::new();
        let mut next = vec![(Module::new(), root.to_owned())];
        while let Some((module, file)) = next.pop() {
            let text = read(&file).unwrap_or_else(|| panic!("{}: no such file", file.display()));
            let folder = folder_of(&file, module.is_empty());
            for (inline, names) in read_names(&text) {
                let inner: Module = [module.clone(), inline.clone()].concat();
                for (child, given) in &names.files {
                    let beside = |name: &str| match given {
                        Some(given) => file.with_file_name(given),
                        None => inline.iter().fold(folder.clone(), |at, part| at.join(part)).join(name),
                    };
                    let candidates = [beside(&format!("{child}.rs")), beside(&format!("{child}/mod.rs"))];
                    let path = candidates.into_iter().find(|path| read(path).is_some());
                    let path = path.unwrap_or_else(|| panic!("{}: no file of module {child}", file.display()));
                    next.push(([inner.clone(), vec![child.clone()]].concat(), path));
                }
                found.insert(inner, Scope { file: file.clone(), names });
            }
        }
        Self(found)
    }

    /// Files of the target, each with its module.
    pub fn files(&self) -> BTreeMap<&Path, &Module> {
        let mut files = BTreeMap::new();
        for (module, scope) in &self.0 {
            // Inline modules come after the module that their file is.
            files.entry(scope.file.as_path()).or_insert(module);
        }
        files
    }

    /// Pairs of files of which the first names an item of the second, each with the paths.
    pub fn uses(&self) -> BTreeMap<(PathBuf, PathBuf), BTreeSet<String>> {
        let mut uses: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
        for (module, scope) in &self.0 {
            for path in &scope.names.paths {
                let mut search = Search { modules: self, seen: BTreeSet::new() };
                for named in search.follow(path, module) {
                    let file = match named {
                        Named::Module(module) => self.0[&module].file.clone(),
                        Named::Type(file) | Named::Value(file) => file,
                    };
                    uses.entry((scope.file.clone(), file)).or_default().insert(path.join("::"));
                }
            }
        }
        uses
    }
}

/// Search for the targets of one path.
struct Search<'a> {
    modules: &'a Modules,
    /// Names that have been looked up, because imports may name each other.
    seen: BTreeSet<(Module, String)>,
}

impl Search<'_> {
    /// Targets of a path in `from`; none if they are in another crate.
    fn follow(&mut self, path: &[String], from: &Module) -> Vec<Named> {
        let Some((first, mut rest)) = path.split_first() else { return vec![Named::Module(from.clone())] };
        let parent = |module: &Module| module[..module.len().saturating_sub(1)].to_vec();
        let mut found = match first.as_str() {
            "crate" => vec![Named::Module(Module::new())],
            "self" => vec![Named::Module(from.clone())],
            "super" => {
                let mut at = parent(from);
                while let Some((_, after)) = rest.split_first().filter(|(name, _)| *name == "super") {
                    at = parent(&at);
                    rest = after;
                }
                vec![Named::Module(at)]
            }
            name => self.look_up(name, from),
        };
        for name in rest {
            let mut next = Vec::new();
            for named in found {
                match named {
                    Named::Module(module) => {
                        let inner = self.look_up(name, &module);
                        // An unknown name counts as defined here by a macro's call.
                        let unknown = Named::Type(self.modules.0[&module].file.clone());
                        next.extend(if inner.is_empty() { vec![unknown] } else { inner });
                    }
                    Named::Type(file) => next.push(Named::Type(file)),
                    Named::Value(_) => {}
                }
            }
            found = next;
        }
        found
    }

    /// Meanings of a name in a module.
    fn look_up(&mut self, name: &str, module: &Module) -> Vec<Named> {
        if !self.seen.insert((module.clone(), name.to_owned())) {
            return Vec::new();
        }
        let scope = &self.modules.0[module];
        let mut found = Vec::new();
        let child = [module.clone(), vec![name.to_owned()]].concat();
        if self.modules.0.contains_key(&child) {
            found.push(Named::Module(child));
        }
        if scope.names.types.contains(name) {
            found.push(Named::Type(scope.file.clone()));
        }
        if scope.names.values.contains(name) {
            found.push(Named::Value(scope.file.clone()));
        }
        for path in scope.names.imports.get(name).into_iter().flatten() {
            found.extend(self.follow(path, module));
        }
        if found.is_empty() {
            for path in &scope.names.globs {
                for named in self.follow(path, module) {
                    if let Named::Module(all) = named {
                        found.extend(self.look_up(name, &all));
                    }
                }
            }
        }
        found
    }
}
