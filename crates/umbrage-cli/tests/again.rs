//! A report draws its picture again.

mod common;

use std::fs;

use common::{Folder, has_adapter};

const SHOT: &str = "tiny.glb --size 64x48 --eye 3,9,12 --target 0,1,0 --near 0.5 --far inf --sun -1,-2,0.5 --splits 2 \
                    --map-size 128 --filter pcf3 --tint";

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.at(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn a_report_draws_its_picture_again() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("render {SHOT} -o a.png --visibility a-mask.png --report a.json"));
    folder.succeed("render --config a.json -o b.png --visibility b-mask.png --report b.json");
    assert_eq!(bytes(&folder, "a.png"), bytes(&folder, "b.png"));
    assert_eq!(bytes(&folder, "a-mask.png"), bytes(&folder, "b-mask.png"));
    for key in ["scene", "options", "size", "camera", "sun", "config", "planes_m"] {
        assert_eq!(folder.json("a.json")[key], folder.json("b.json")[key], "{key}");
    }
    // And what is drawn by other settings is another picture.
    folder.succeed("render --config b.json --filter hard -o c.png");
    assert_ne!(bytes(&folder, "a.png"), bytes(&folder, "c.png"));
    // The judge looks at what the report looks at.
    folder.succeed(&format!("truth {SHOT} -o truth-a.png"));
    folder.succeed("truth --config a.json -o truth-b.png");
    assert_eq!(bytes(&folder, "truth-a.png"), bytes(&folder, "truth-b.png"));
}

#[test]
fn options_go_over_a_report() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("render {SHOT} -o a.png --report a.json"));
    folder.succeed("render --config a.json --size 32x24 --camera front --tint=false -o b.png --report b.json");
    let report = folder.json("b.json");
    assert_eq!(report["size"], serde_json::json!([32, 24]));
    assert_eq!(report["camera"]["name"], "front");
    let written = [
        "render tiny.glb --size 32x24 --camera front --near 0.5 --far inf --sun -1,-2,0.5 --splits 2",
        "--map-size 128 --filter pcf3 -o c.png",
    ];
    folder.succeed(&written.join(" "));
    assert_eq!(bytes(&folder, "b.png"), bytes(&folder, "c.png"));
    folder.succeed("render empty.gltf --config a.json -o d.png --report d.json");
    assert_eq!(folder.json("d.json")["scene"], "empty.gltf");
}

/// Maps that are held depend on the frames before.
#[test]
fn a_frame_is_drawn_again_with_those_before_it() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed("render tiny.glb --size 32x24 --path path.json --frames 4 --map-size 64 -o a.png --report a.json");
    folder.succeed("render --config a.0002.json -o again.png --report again.json");
    assert_eq!(bytes(&folder, "a.0002.png"), bytes(&folder, "again.png"));
    assert_eq!(folder.json("again.json")["frame"], 2);
    folder.succeed("render --config again.json --frames 4 -o all.png");
    for frame in 0..4 {
        assert_eq!(bytes(&folder, &format!("a.000{frame}.png")), bytes(&folder, &format!("all.000{frame}.png")));
    }
    let report = fs::read_to_string(folder.at("again.json")).expect("a report");
    fs::write(folder.at("fifth.json"), report.replace("\"frame\": 2", "\"frame\": 5")).expect("a report");
    let output = folder.run("render --config fifth.json -o fifth.png");
    assert_eq!(output.status.code(), Some(2));
    assert!(common::stderr(&output).contains("--frames 6"), "{}", common::stderr(&output));
}

#[test]
fn files_of_a_report_are_looked_for_here_and_beside_it() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    fs::create_dir(folder.at("kept")).expect("a folder");
    folder.succeed(&format!("render {SHOT} -o a.png --report kept/a.json"));
    fs::rename(folder.at("tiny.glb"), folder.at("kept/tiny.glb")).expect("the scene can be moved");
    folder.succeed("render --config kept/a.json -o b.png --report b.json");
    assert_eq!(bytes(&folder, "a.png"), bytes(&folder, "b.png"));
    assert_eq!(folder.json("b.json")["scene"], "kept/tiny.glb");
    fs::remove_file(folder.at("kept/tiny.glb")).expect("the scene can be removed");
    let output = folder.run("render --config kept/a.json -o c.png");
    let message = common::stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    for part in ["kept/a.json", "tiny.glb", "working directory", "report's folder", "SCENE"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn what_draws_nothing_again_is_refused_by_name() {
    for (name, text, culprits) in [
        ("only.toml", "splits = 2\n", &["no scene", "only.toml", "SCENE"][..]),
        ("old.json", r#"{"adapter": "x", "scene": "tiny.glb", "config": {}}"#, &["no scene", "old.json"]),
        (
            "compare.json",
            r#"{"adapter": "x", "techniques": []}"#,
            &["compare.json", "umbrage compare", "umbrage render"],
        ),
        ("truth.json", r#"{"scene": "tiny.glb", "times_ms": {}}"#, &["truth.json", "umbrage truth"]),
        ("size.json", r#"{"config": {}, "options": ["tiny.glb", "--size=0x5"]}"#, &["size.json", "--size"]),
        ("word.json", r#"{"config": {}, "options": ["tiny.glb", "--colour=5"]}"#, &["word.json", "--colour"]),
        ("path.json2", r#"{"config": {}, "options": ["tiny.glb", "--path=gone.json"]}"#, &["gone.json", "--path FILE"]),
    ] {
        let folder = Folder::with(name, text);
        folder.refuse(&format!("render --config {name} -o p.png"), culprits);
        folder.refuse(&format!("render --config {name} -o {name}"), &[]);
    }
    Folder::new().refuse("render -o p.png", &["no scene", "SCENE", "--config"]);
    let folder = Folder::with("a.json", r#"{"config": {}, "options": ["tiny.glb"]}"#);
    folder.refuse("render --config a.json --report a.json", &["a.json"]);
}
