//! `umbrage compare`: what it writes, that its scores are those of `render` and `truth`, and what
//! it refuses.

mod common;

use std::fs;

use common::{Folder, has_adapter, names};
use serde_json::Value;

/// Two views and three techniques, the first of them twice.
const TINY: &str = "compare tiny.glb --size 96x72 --camera front --suns 45@60,20@120 --techniques \
                    pssm:2:256,ssm:16:label=coarse,pssm:2:256 --with filter=hard:blend=0 --least-edges 10";

/// All errors must be numbers, whatever else they are.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn everything_is_written_and_says_what_it_should() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("{TINY} -o out --json copy.json"));
    assert_eq!(folder.new_names(), ["copy.json", "out"]);
    assert_eq!(names(&folder.at("out")), ["compare.html", "errors.png", "scores.json", "sheet.png"]);

    let scores = folder.json("out/scores.json");
    assert_eq!(scores, folder.json("copy.json"));
    assert_eq!(scores["size"], serde_json::json!([96, 72]));
    for text in ["adapter", "reproduce"] {
        assert!(scores[text].as_str().is_some_and(|text| !text.is_empty()), "{text}");
    }
    let techniques = scores["techniques"].as_array().expect("techniques");
    let labels: Vec<&str> = techniques.iter().filter_map(|technique| technique["label"].as_str()).collect();
    assert_eq!(labels, ["PSSM(2; 256²)", "coarse", "PSSM(2; 256²) #2"]);
    assert_eq!(techniques[0]["texels"], 2 * 256 * 256);
    assert_eq!(techniques[0]["bytes"], 2 * 256 * 256 * 4);
    assert_eq!(techniques[1]["spec"], "ssm:16:filter=hard:blend=0");
    assert_eq!(techniques[0]["mean"]["views"], 2);
    for field in ["e", "e_false_shadow", "e_false_light", "edge_distance_px", "ssim", "caster_split_pairs"] {
        assert!(number(&techniques[0]["mean"][field]) >= 0.0, "{field}");
    }
    assert!(techniques[0]["mean"]["flicker"].is_null(), "nothing walks");

    let views = scores["views"].as_array().expect("views");
    assert_eq!(views.len(), 2);
    for view in views {
        assert_eq!((view["counts"].as_bool(), view["camera"]["name"].as_str()), (Some(true), Some("front")));
        assert!(number(&view["true_edges"]) >= 10.0 && number(&view["scored_pixels"]) > 1000.0, "{view}");
        let of = view["scores"].as_array().expect("scores");
        assert_eq!(of.len(), 3);
        let sum = number(&of[1]["e_false_shadow"]) + number(&of[1]["e_false_light"]);
        assert!((sum - number(&of[1]["e"])).abs() < 1e-12, "E is E_fs + E_fl");
        assert!(number(&of[1]["e"]) > number(&of[0]["e"]), "16² over everything is worse than two of 256²: {view}");
        assert!(number(&of[1]["edge_distance_px"]) > number(&of[0]["edge_distance_px"]));
        let texel = |number_of: usize| number(&of[number_of]["texel_px"]["perspective_p50"]);
        assert!(texel(1) > texel(0), "its texels are larger, too");
        assert_eq!(of[0], of[2], "a technique beside itself");
        assert_eq!(of[0]["by_depth"].as_array().map(Vec::len), Some(8));
    }
    let pairs = scores["pairs"].as_array().expect("pairs");
    assert_eq!(pairs.len(), 3);
    assert_eq!((pairs[1]["first"].as_str(), pairs[1]["second"].as_str()), (Some(labels[0]), Some(labels[2])));
    assert_eq!((number(&pairs[1]["mean_difference"]), &pairs[1]["ties"]), (0.0, &serde_json::json!(2)));
    assert_eq!(pairs[0]["first_better"], 2);

    for sheet in ["sheet.png", "errors.png"] {
        let sheet = image::open(folder.at("out").join(sheet)).expect("a sheet").into_rgb8();
        assert!(sheet.width() > 2 * 96 && sheet.height() > 4 * 72, "two columns, four rows: {:?}", sheet.dimensions());
        assert!(sheet.pixels().any(|pixel| pixel.0 == [255, 205, 0]), "an inset is marked");
    }
    let page = fs::read_to_string(folder.at("out/compare.html")).expect("a page");
    for part in ["<!doctype html>", "data:image/png;base64,", "<svg", "PSSM(2; 256²)", "coarse", "E_fs"] {
        assert!(page.contains(part), "{part} is not on the page");
    }
    for fetched in ["src=\"http", "href=\"http", "url(", "<script", "@import"] {
        assert!(!page.contains(fetched), "the page fetches nothing: {fetched}");
    }
}

#[test]
fn scores_are_those_of_render_and_truth() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("{TINY} --json s.json"));
    let scores = folder.json("s.json");
    let words = |value: &Value| {
        let words: Vec<&str> = value.as_array().expect("options").iter().filter_map(Value::as_str).collect();
        words.join(" ")
    };
    for view in scores["views"].as_array().expect("views") {
        folder.succeed(&format!("truth {} -o t.png", words(&view["options"])));
        let truth = folder.mask("t.png");
        for (technique, of) in
            scores["techniques"].as_array().expect("techniques").iter().zip(view["scores"].as_array().expect("scores"))
        {
            let command =
                format!("render {} {} --visibility m.png", words(&view["options"]), words(&technique["options"]));
            folder.succeed(&command);
            let wrong = folder
                .mask("m.png")
                .pixels()
                .zip(truth.pixels())
                .filter(|(mask, truth)| mask.0[0] / 128 != truth.0[0] / 128)
                .count();
            let expected = number(&of["e"]) * number(&view["scored_pixels"]);
            // Pixels that hardly face the light are in the masks but not scored.
            assert!(
                (wrong as f64 - expected).abs() <= 2.0,
                "{command}: {wrong} wrong pixels, {expected} by the scores"
            );
        }
    }
}

#[test]
fn walks_give_flicker_and_still_techniques_have_less() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(
        "compare tiny.glb --size 96x72 --camera front --step 0.37 --frames 4 --least-edges 10 --image-metrics off --techniques \
         pssm:2:64:stabilize=none,pssm:2:64:stabilize=exact,pssm:2:64:stabilize=approximate --with \
         filter=hard:blend=0:fit=independent --json s.json --sheet s.png",
    );
    let scores = folder.json("s.json");
    assert_eq!(scores["views"].as_array().map(Vec::len), Some(4));
    let walk = &scores["walks"][0];
    assert_eq!((walk["frames"].as_u64(), walk["counts"].as_bool()), (Some(4), Some(true)));
    let rate = |number_of: usize| number(&walk["flicker"][number_of]["rate"]);
    assert!(rate(0) > rate(1), "tight maps flicker more than still ones: {walk}");
    assert!(number(&walk["flicker"][0]["per_edge"]) > rate(0));
    assert_eq!(number(&walk["flicker"][1]["kept_per_edge"]), 0.0, "points that keep a still split do not flip");
    assert_eq!(number(&walk["flicker"][1]["standing_per_edge"]), 0.0, "{walk}");
    assert!(10.0 * rate(2) <= rate(0), "approximate maps stand almost as still: {walk}");
    assert_eq!((number(&walk["flicker"][2]["standing_per_edge"]), &walk["flicker"][2]["steps"]), (0.0, &0.into()));
    let texels = |number_of: usize| number(&scores["techniques"][number_of]["mean"]["texel_px"]["perspective_p50"]);
    assert!(texels(2) < 1.2 * texels(0) && texels(2) < texels(1), "and are almost as tight");
    let standing = |number_of: usize| number(&walk["flicker"][number_of]["standing_points"]);
    assert!(standing(0) < 0.01 * standing(1), "no tight map stands, only points that no split decides on: {walk}");
    assert_eq!((&walk["flicker"][0]["steps"], &walk["flicker"][1]["steps"]), (&6.into(), &0.into()), "{walk}");
    assert_eq!(scores["techniques"][0]["mean"]["flicker"], walk["flicker"][0]["rate"]);
    assert!(scores["techniques"][0]["mean"]["ssim"].is_null(), "image metrics are off");

    folder.succeed("compare tiny.glb --size 64x48 --path path.json --frames 3 --techniques ssm:64 --json p.json");
    let scores = folder.json("p.json");
    assert_eq!(scores["views"].as_array().map(Vec::len), Some(3));
    assert!(scores["notes"].to_string().contains("no view counts"), "{}", scores["notes"]);
    assert!(scores["techniques"][0]["mean"]["e"].is_null(), "no mean over views that do not count");
}

#[test]
fn a_world_at_small_size() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::with(
        "t.toml",
        "[with]\nfilter = \"hard\"\n[[technique]]\ntechnique = \"pssm\"\nmap-size = [512, 256]\nlabel = \"from a file\"\n",
    );
    folder.succeed(
        "compare robot-war chessboard --size 96x72 --camera near,middle --suns metrics --least-edges 100 --techniques ssm:512 \
         --techniques-file t.toml --columns 3 --image-metrics off -o out",
    );
    let scores = folder.json("out/scores.json");
    let views = scores["views"].as_array().expect("views");
    assert_eq!(views.len(), 2 * (2 * 2 + 1), "two suns for each camera, one view into the light for each scene");
    let labels: Vec<_> =
        scores["techniques"].as_array().expect("techniques").iter().map(|t| t["label"].clone()).collect();
    assert_eq!(labels, ["from a file", "SSM(512²)"]);
    assert!(views.iter().filter(|view| view["counts"] == true).count() >= 4, "{}", scores["notes"]);
    let means: Vec<f64> = (0..2).map(|t| number(&scores["techniques"][t]["mean"]["e"])).collect();
    assert!(means.iter().all(|e| (0.0..0.2).contains(e)), "{means:?}");
}

#[test]
fn an_empty_scene_has_nothing_to_score_and_is_no_error() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed("compare empty.gltf --size 32x24 --techniques ssm:64,pssm:2:64 -o out");
    let scores = folder.json("out/scores.json");
    assert!(scores["views"][0]["scores"][0]["e"].is_null());
    assert_eq!(scores["views"][0]["counts"], false);
}

#[test]
fn mistakes_name_the_culprit_and_leave_nothing() {
    let folder = Folder::with("bad.toml", "[[technique]]\ntechnique = \"pssm\"\nmap-size = 0\n");
    let one = "compare tiny.glb --techniques ssm:64";
    for (words, culprits) in [
        ("compare --techniques ssm:64 -o out", &["scene"][..]),
        ("compare tiny.glb -o out", &["--techniques"]),
        ("compare tiny.glb --techniques ssm:64", &["-o DIR"]),
        ("compare tiny.glb --techniques ssm:64,sdsm:64 -o out", &["sdsm:64", "not built yet"]),
        ("compare tiny.glb --techniques magic:64 -o out", &["magic"]),
        ("compare tiny.glb --techniques pssm:4:512:lambda=7 -o out", &["pssm:4:512:lambda=7", "--lambda"]),
        ("compare tiny.glb --techniques ssm:64 --with colour=red -o out", &["colour"]),
        ("compare tiny.glb --techniques-file missing.toml -o out", &["missing.toml"]),
        ("compare tiny.glb --techniques-file bad.toml -o out", &["bad.toml", "--map-size"]),
        ("compare missing.glb --techniques ssm:64 -o out", &["missing.glb"]),
        ("compare tiny.glb missing.glb --techniques ssm:64 -o out", &["missing.glb"]),
        ("compare tiny.glb --techniques ssm:64 --preset none -o out", &["--preset"]),
        (&format!("{one} --suns noon -o out"), &["--suns", "noon"]),
        (&format!("{one} --camera back -o out"), &["--camera back", "front"]),
        (&format!("{one} --eye 1,2,3 -o out"), &["--target"]),
        (&format!("{one} --sun 1,2,3 --light sun -o out"), &["--sun", "--light"]),
        (&format!("{one} --frames 5 -o out"), &["--frames"]),
        (&format!("{one} --path missing.json -o out"), &["missing.json"]),
        (&format!("{one} --columns 0 -o out"), &["--columns"]),
        (&format!("{one} --size 0x5 -o out"), &["--size"]),
        (&format!("{one} --json missing/s.json"), &["missing/s.json"]),
        (&format!("{one} --json tiny.glb"), &["tiny.glb", "input"]),
        (&format!("{one} --json a --html a"), &["a", "two outputs"]),
        (&format!("{one} -o missing/out"), &["missing/out"]),
        (&format!("{one} -o tiny.glb"), &["tiny.glb"]),
    ] {
        folder.refuse(words, culprits);
    }
}

#[test]
fn a_map_that_no_device_can_hold_names_its_technique() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.refuse("compare tiny.glb --size 32x24 --techniques ssm:64,ssm:65536 -o out", &["ssm:65536", "65536"]);
}
