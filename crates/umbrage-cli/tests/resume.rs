//! A comparison that is cut off goes on from what it had finished.

mod common;

use std::{fs, thread::sleep, time::Duration};

use common::{Folder, has_adapter};

const COMPARE: &str =
    "compare tiny.glb --techniques ssm:64,pssm:2:64 --size 48x36 --suns 80,60,40,20,10 -o out --resume kept";

#[test]
fn a_run_that_was_cut_off_ends_like_one_that_was_not() {
    if !has_adapter() {
        return;
    }
    let whole = Folder::new();
    assert!(whole.run(COMPARE).status.success());
    assert_eq!(whole.new_names(), ["out"], "what was kept goes away in the end");

    let cut = Folder::new();
    let mut process = cut.command(COMPARE).spawn().expect("the command starts");
    let lines = || fs::read(cut.at("kept")).map_or(0, |bytes| bytes.iter().filter(|&&byte| byte == b'\n').count());
    // What is compared and one series: as soon as that is there, the run is cut off (or is over
    // already, which is as good).
    while lines() < 2 && process.try_wait().expect("its state").is_none() {
        sleep(Duration::from_millis(5));
    }
    drop(process.kill());
    process.wait().expect("it ends");
    let was_cut = cut.at("kept").exists();
    let again = cut.run(COMPARE);
    assert!(again.status.success(), "{}", String::from_utf8_lossy(&again.stderr));
    assert_eq!(cut.new_names(), ["out"]);

    let read = |folder: &Folder| -> serde_json::Value {
        serde_json::from_slice(&fs::read(folder.at("out/scores.json")).expect("scores")).expect("JSON")
    };
    let (whole_scores, mut cut_scores) = (read(&whole), read(&cut));
    if was_cut {
        let notes = cut_scores["notes"].as_array_mut().expect("notes");
        let of_resume = notes.iter().position(|note| note.as_str().is_some_and(|note| note.contains("--resume kept")));
        notes.remove(of_resume.expect("a note says that earlier results were taken over"));
    }
    assert_eq!(whole_scores, cut_scores);
    for sheet in ["out/sheet.png", "out/errors.png"] {
        assert_eq!(fs::read(whole.at(sheet)).ok(), fs::read(cut.at(sheet)).ok(), "{sheet}");
    }
}

#[test]
fn what_another_comparison_kept_is_refused_and_stays() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::with("kept", "{\"techniques\":[]}\n");
    let output = folder.run(COMPARE);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("--resume kept") && message.contains("another comparison"), "{message}");
    assert!(folder.new_names().is_empty(), "{:?}", folder.new_names());
}
