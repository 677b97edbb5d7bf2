//! The gallery: a page, and beside it everything at full size.

mod common;

use std::fs;

use common::{Folder, has_adapter, names};

#[test]
fn a_scene_of_the_gallery_has_four_shots_with_everything_that_is_shown() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    let output = folder.run("gallery chessboard --size 32x24 -o gallery");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "gallery/index.html");
    assert_eq!(folder.new_names(), ["gallery"]);
    assert_eq!(names(&folder.at("gallery")), ["index.html", "shots"]);
    let shots = names(&folder.at("gallery/shots"));
    assert_eq!(shots, ["dueling", "far", "middle", "near"].map(|name| format!("chessboard-{name}")));
    let files = ["map0.png", "map1.png", "map2.png", "map3.png", "mask.png", "picture.png", "report.json", "tint.png"];
    for shot in &shots {
        let home = folder.at("gallery/shots").join(shot);
        assert_eq!(names(&home), files, "{shot}");
        let picture = image::open(home.join("picture.png")).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (32, 24));
        let report = fs::read(home.join("report.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
        assert_eq!(report["splits"].as_array().map(Vec::len), Some(4), "{shot}");
    }
    let page = fs::read_to_string(folder.at("gallery/index.html")).expect("the page");
    assert_eq!(page.matches("<img ").count(), 4 * (2 + 1 + 4));
    assert!(page.contains("umbrage render chessboard --camera near --size 32x24 -o picture.png"));

    // Shots of the last run give way, with what they have no longer.
    fs::write(folder.at("gallery/shots/chessboard-near/map9.png"), "old").expect("an old map");
    assert!(folder.run("gallery chessboard --size 32x24 -o gallery").status.success());
    assert_eq!(names(&folder.at("gallery/shots/chessboard-near")), files);
}

#[test]
fn an_unknown_scene_is_refused_before_anything_is_drawn() {
    let folder = Folder::new();
    let output = folder.run("gallery moon -o gallery");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("moon") && message.contains("robot-war"), "{message}");
    assert!(folder.new_names().is_empty());
}
