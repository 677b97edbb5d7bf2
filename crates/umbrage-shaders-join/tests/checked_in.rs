//! The texts that are checked in are what the modules join to.

use std::fs;
use std::path::Path;

use umbrage_shaders_join::{Text, checked_in, differences, join, sources, write};

#[test]
fn texts_are_what_the_modules_join_to() {
    let texts = join(&sources()).expect("the modules join");
    let found = differences(&checked_in(), &texts).expect("the folder of texts can be read");
    assert!(found.is_empty(), "run `cargo xtask shaders` and commit what it writes:\n{}", found.join("\n"));
}

/// Each join hashes with another seed.
#[test]
fn joining_again_gives_the_same_bytes() {
    let first = join(&sources()).expect("the modules join");
    for _ in 0..3 {
        assert!(join(&sources()).expect("the modules join") == first, "the order of declarations depends on chance");
    }
}

fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder can be made");
    for entry in fs::read_dir(from).expect("a folder of modules") {
        let path = entry.expect("an entry").path();
        let to = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copied(&path, &to);
        } else {
            fs::copy(&path, &to).expect("a module can be copied");
        }
    }
}

/// The comparison must say no: a module that was changed, and one that no longer parses.
#[test]
fn changed_modules_are_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    copied(&sources(), folder.path());
    let filter = folder.path().join("lib/filter.wesl");
    let text = fs::read_to_string(&filter).expect("a module");
    let first = text.find("return").expect("a statement");
    fs::write(&filter, format!("{}{}", &text[..first], text[first..].replacen("return", "return 1.0 *", 1)))
        .expect("a module can be written");
    let found = differences(&checked_in(), &join(folder.path()).expect("it still joins")).expect("a folder");
    assert!(found.iter().any(|line| line == "receiver.wgsl is not what the modules join to"), "{found:?}");

    fs::write(&filter, "fn tent(").expect("a module can be written");
    let message = join(folder.path()).expect_err("a module that ends amid a function").to_string();
    assert!(message.contains("filter"), "{message}");
}

/// The comparison must say no: a file that is missing, spoilt or too many. Writing mends all of
/// them.
#[test]
fn spoilt_folders_are_seen_and_mended() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = |name: &str| Text { name: name.to_owned(), wgsl: format!("const {name} = 1;\n") };
    let texts = [text("A"), text("B"), text("C")];
    write(folder.path(), &texts).expect("a folder can be written");
    assert!(differences(folder.path(), &texts).expect("a folder").is_empty());

    fs::remove_file(folder.path().join("A.wgsl")).expect("a file can be removed");
    fs::write(folder.path().join("B.wgsl"), "const B = 2;\n").expect("a file can be written");
    fs::write(folder.path().join("D.wgsl"), "").expect("a file can be written");
    assert_eq!(
        differences(folder.path(), &texts).expect("a folder"),
        ["A.wgsl is missing", "B.wgsl is not what the modules join to", "D.wgsl is of no text"]
    );
    write(folder.path(), &texts).expect("a folder can be written");
    assert!(differences(folder.path(), &texts).expect("a folder").is_empty());
}
