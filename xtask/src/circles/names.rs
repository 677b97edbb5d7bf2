//! Names in a file, without its tests: items that it defines, imports, and paths.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use syn::{
    Attribute, Item, UseTree,
    visit::{Visit, visit_item, visit_path},
};

/// Path of a module in its target; empty for the root.
pub type Module = Vec<String>;

/// Names in one module.
#[derive(Default)]
pub struct Names {
    /// Types and traits defined here.
    pub types: BTreeSet<String>,
    /// Functions, constants and macros defined here.
    pub values: BTreeSet<String>,
    /// Names imported by `use`, each with its paths.
    pub imports: BTreeMap<String, Vec<Vec<String>>>,
    /// Modules and enums of which `use` imports everything.
    pub globs: Vec<Vec<String>>,
    /// Child modules with files of their own, each with the path from its attribute.
    pub files: Vec<(String, Option<String>)>,
    /// All paths in `use` and in code.
    pub paths: BTreeSet<Vec<String>>,
}

/// Reads the names in a file's own module, which has an empty path here, and in its inline modules.
pub fn read_names(text: &str) -> BTreeMap<Module, Names> {
    let mut reader = Reader { at: Vec::new(), found: BTreeMap::from([(Vec::new(), Names::default())]) };
    reader.visit_file(&syn::parse_file(text).expect("a source that compiles"));
    reader.found
}

struct Reader {
    at: Module,
    found: BTreeMap<Module, Names>,
}

impl Reader {
    fn names(&mut self) -> &mut Names {
        self.found.entry(self.at.clone()).or_default()
    }

    fn define(&mut self, item: &Item) {
        let (names, name) = match item {
            Item::Enum(item) => (&mut self.names().types, &item.ident),
            Item::Struct(item) => (&mut self.names().types, &item.ident),
            Item::Trait(item) => (&mut self.names().types, &item.ident),
            Item::Type(item) => (&mut self.names().types, &item.ident),
            Item::Union(item) => (&mut self.names().types, &item.ident),
            Item::Const(item) => (&mut self.names().values, &item.ident),
            Item::Fn(item) => (&mut self.names().values, &item.sig.ident),
            Item::Static(item) => (&mut self.names().values, &item.ident),
            Item::Macro(syn::ItemMacro { ident: Some(name), .. }) => (&mut self.names().values, name),
            _ => return,
        };
        names.insert(name.to_string());
    }

    fn import(&mut self, tree: &UseTree, before: &[String]) {
        let with = |name: &syn::Ident| match name.to_string() {
            name if name == "self" && !before.is_empty() => before.to_vec(),
            name => [before, &[name]].concat(),
        };
        let (path, name) = match tree {
            UseTree::Path(path) => return self.import(&path.tree, &with(&path.ident)),
            UseTree::Group(group) => return group.items.iter().for_each(|tree| self.import(tree, before)),
            UseTree::Glob(_) => {
                self.names().globs.push(before.to_vec());
                self.names().paths.insert(before.to_vec());
                return;
            }
            UseTree::Name(name) => (with(&name.ident), None),
            UseTree::Rename(name) => (with(&name.ident), Some(name.rename.to_string())),
        };
        let name = name.or_else(|| path.last().cloned()).expect("a path has an end");
        self.names().imports.entry(name).or_default().push(path.clone());
        self.names().paths.insert(path);
    }

    /// Adds the paths in a macro's tokens that begin with `crate`, `self` or `super`.
    fn scan(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in
            tokens.into_iter().chain([TokenTree::Punct(proc_macro2::Punct::new(';', proc_macro2::Spacing::Alone))])
        {
            match &token {
                TokenTree::Punct(mark) if mark.as_char() == ':' && !path.is_empty() && colons < 2 => colons += 1,
                TokenTree::Ident(name) if colons == 2 => {
                    path.push(name.to_string());
                    colons = 0;
                }
                _ => {
                    if path.len() > 1 {
                        self.names().paths.insert(path.clone());
                    }
                    (path, colons) = (Vec::new(), 0);
                    match token {
                        TokenTree::Ident(name) if ["crate", "self", "super"].iter().any(|it| name == it) => {
                            path.push(name.to_string());
                        }
                        TokenTree::Group(group) => self.scan(group.stream()),
                        _ => {}
                    }
                }
            }
        }
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// True if an item exists in tests only.
fn is_test(item: &Item) -> bool {
    let says_test = |attribute: &Attribute| {
        attribute.path().is_ident("test")
            || (attribute.path().is_ident("cfg")
                && attribute.parse_args::<syn::Path>().is_ok_and(|condition| condition.is_ident("test")))
    };
    attributes(item).iter().any(says_test)
}

/// Value of a module's attribute `#[path = "…"]`.
fn given_path(item: &syn::ItemMod) -> Option<String> {
    let mut values = item.attrs.iter().filter(|attribute| attribute.path().is_ident("path"));
    match &values.next()?.meta.require_name_value().ok()?.value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
        _ => None,
    }
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        if let Item::Mod(module) = item
            && module.content.is_none()
        {
            // A file of tests is a file, too.
            self.names().files.push((module.ident.to_string(), given_path(module)));
        }
        if !is_test(item) {
            self.define(item);
            visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&item.tree, &[]);
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if let Some((_, items)) = &item.content {
            self.at.push(item.ident.to_string());
            self.names();
            items.iter().for_each(|item| self.visit_item(item));
            self.at.pop();
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let words = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.names().paths.insert(words);
        visit_path(self, path);
    }

    fn visit_attribute(&mut self, item: &'ast Attribute) {
        self.visit_path(item.path());
        match &item.meta {
            syn::Meta::List(list) => self.scan(list.tokens.clone()),
            syn::Meta::Path(_) | syn::Meta::NameValue(_) => {}
        }
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        self.visit_path(&item.path);
        self.scan(item.tokens.clone());
    }
}
