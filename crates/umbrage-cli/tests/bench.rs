//! `umbrage bench`: what it writes and what it refuses. How long anything takes is not looked at.

mod common;

use std::fs;

use common::{Folder, has_adapter};

#[test]
fn every_technique_and_crowd_has_its_row() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(
        "bench tiny.glb chessboard --size 64x48 --rounds 2 --objects 2,5 --techniques ssm:128,pssm:3:512 --paths off --json all.json -o page.html",
    );
    assert_eq!(folder.new_names(), ["all.json", "page.html"]);
    let report = folder.json("all.json");
    let scenes = report["scenes"].as_array().expect("scenes");
    assert_eq!(scenes.iter().map(|scene| &scene["scene"]).collect::<Vec<_>>(), ["tiny.glb", "chessboard"]);
    for scene in scenes {
        let rows = scene["rows"].as_array().expect("rows");
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0]["frame_ratio"]["median"], 1.0, "the baseline over itself");
        assert_eq!(rows[1]["splits"], 3);
        assert_eq!(rows[1]["map_bytes"], 3 * 512 * 512 * 4);
        for row in rows {
            assert!(row["frame_ratio"]["median"].as_f64().is_some_and(|ratio| ratio > 0.0), "{row}");
            for time in ["cpu_ms", "cpu_without_ms"] {
                assert!(row[time]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{time} of {row}");
            }
            for time in ["first_picture_ms", "first_picture_cpu_ms"] {
                assert!(row[time].as_f64().is_some_and(|ms| ms > 0.0), "{time} of {row}");
            }
            assert!(row["draws"].as_u64().is_some_and(|draws| draws > 0), "{row}");
        }
    }
    // Only the paper's own worlds and sizes have a figure of the paper beside them.
    assert!(scenes[0]["rows"][1]["paper_ratio"].is_null());
    assert!(scenes[1]["rows"][1]["paper_ratio"].as_f64().is_some_and(|ratio| (ratio - 67.29 / 50.08).abs() < 1e-12));
    let crowds = report["crowds"].as_array().expect("crowds");
    assert_eq!(crowds.iter().map(|crowd| &crowd["objects"]).collect::<Vec<_>>(), [2, 5]);
    let page = fs::read_to_string(folder.at("page.html")).expect("the page");
    for part in ["chessboard", "Over the number of objects", "<svg"] {
        assert!(page.contains(part), "the page lacks {part}");
    }
    assert!(!page.contains("src=\"http"), "the page fetches something");
}

#[test]
fn every_path_has_its_row() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed("bench tiny.glb --size 64x48 --rounds 1 --objects 2 --techniques ssm:128 --json all.json");
    let report = folder.json("all.json");
    let rows = report["scenes"][0]["paths"].as_array().expect("paths");
    let pair = |row: &serde_json::Value| {
        let text = |field: &str| row[field].as_str().unwrap_or_default().to_owned();
        format!("{}, {}", text("generation"), text("storage"))
    };
    assert_eq!(rows.len(), 9);
    for row in rows {
        // A path that this device cannot take says which one was taken.
        let label = row["technique"].as_str().expect("a label");
        assert!(label == pair(row) || pair(row).starts_with("per-split"), "{label} took {}", pair(row));
    }
    let sampled = |name: &str| rows.iter().find(|row| row["technique"] == name).expect("the row")["map_bytes"].clone();
    assert_eq!(sampled("multipass, reused"), 512 * 512 * 4);
    assert_eq!(sampled("per-split, separate"), 4 * 512 * 512 * 4);
}

#[test]
fn every_number_of_objects_has_its_cases() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(
        "bench --scale --objects 20,5000,900000 --scale-limit 5000 --size 64x48 --rounds 2 --json all.json -o page.html",
    );
    let report = folder.json("all.json");
    let sizes = report["sizes"].as_array().expect("sizes");
    assert_eq!(sizes.iter().map(|size| &size["trees"]).collect::<Vec<_>>(), [20, 5000]);
    for size in sizes {
        let cases = size["cases"].as_array().expect("cases");
        let case = |name: &str| cases.iter().find(|case| case["case"] == name).expect("a case");
        let median = |name: &str, value: &str| case(name)[value]["median"].as_f64().expect("a number");
        assert_eq!(cases.len(), 4);
        // The plan of tiles asks of instances what a list of them would have been asked.
        let by_gpu = &size["by_gpu"];
        assert!(by_gpu["pairs"].as_u64().is_some_and(|pairs| pairs > 0), "{by_gpu}");
        assert!(by_gpu["cull_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{by_gpu}");
        assert_eq!(median("standing", "triangles"), 0.0, "what is kept costs nothing");
        assert!(median("walking", "triangles") < 0.1 * median("uncached", "triangles"), "{size}");
        for name in ["uncached", "standing", "walking", "movers"] {
            assert!(median(name, "plan_us") > 0.0 && median(name, "pairs") > 0.0, "{name}: {size}");
            assert!(case(name)["first_triangles"].as_u64().is_some_and(|count| count > 0), "{name}: {size}");
        }
    }
    let page = fs::read_to_string(folder.at("page.html")).expect("the page");
    for part in ["Over the number of objects", "kept, 1 % moves", "<svg"] {
        assert!(page.contains(part), "the page lacks {part}");
    }
}

#[test]
fn mistakes_are_named() {
    let folder = Folder::new();
    folder.refuse("bench tiny.glb", &["-o"]);
    folder.refuse("bench tiny.glb --rounds 0 -o page.html", &["--rounds"]);
    folder.refuse("bench tiny.glb --objects 0 -o page.html", &["--objects"]);
    folder.refuse("bench tiny.glb --objects 200000 -o page.html", &["--objects 200000", "--scale"]);
    folder.refuse("bench tiny.glb --scale -o page.html", &["--scale"]);
    folder.refuse("bench --scale-limit 9 -o page.html", &["--scale"]);
    folder.refuse("bench --scale --scale-limit 9 -o page.html", &["--scale-limit"]);
    folder.refuse("bench --scale", &["-o"]);
    folder.refuse("bench tiny.glb --techniques pssm:9:512 -o page.html", &["pssm:9:512"]);
    folder.refuse("bench tiny.glb --samples 3 -o page.html", &["--samples"]);
    folder.refuse("bench missing.glb -o page.html", &["missing.glb"]);
}
