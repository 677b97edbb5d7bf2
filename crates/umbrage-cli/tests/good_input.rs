//! Good input gives the files that were asked for, with what the contract says in them.

mod common;

use std::{fs, process::Stdio};

use common::{Folder, has_adapter, names, stderr};
use image::GenericImageView;

/// The tiny scene from straight above, its box in the middle; one argument list for all
/// subcommands.
const ABOVE: &str = "tiny.glb --size 64x48 --eye 0,20,0 --target 0,0,0 --fov 60 --near 1 --far inf --sun -1,-2,0.5 --time 0 \
                     --technique pssm --splits 2 --map-size 256,128 --lambda 0.7 --shadow-range 1..40 --fit dependent \
                     --stabilize none --filter hard --blend 0 --far-fade 0";

/// The point of the plane y = 0 that pixel (i, j) of [`ABOVE`] sees: up is −Z, so x runs right and
/// z down.
fn ground_under_pixel(i: u32, j: u32) -> [f64; 2] {
    let metres_per_pixel = 2.0 * 20.0 * 30f64.to_radians().tan() / 48.0;
    [(f64::from(i) + 0.5 - 32.0) * metres_per_pixel, (f64::from(j) + 0.5 - 24.0) * metres_per_pixel]
}

#[test]
fn render_writes_what_was_asked_for() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("render {ABOVE} -o p.png --visibility m.png --maps maps --report r.json"));
    assert_eq!(folder.new_names(), ["m.png", "maps", "p.png", "r.json"]);
    assert_eq!(names(&folder.at("maps")), ["split0.png", "split1.png"]);
    assert_eq!(image::open(folder.at("p.png")).expect("a picture").dimensions(), (64, 48));
    let map = |name: &str| image::open(folder.at("maps").join(name)).expect("a map").dimensions();
    assert_eq!((map("split0.png"), map("split1.png")), ((256, 256), (128, 128)));

    let mask = folder.mask("m.png");
    assert_eq!(mask.dimensions(), (64, 48));
    assert!(
        mask.pixels().all(|pixel| matches!(pixel.0, [0 | 255, 255])),
        "hard decisions, and the plane fills the view"
    );
    let shadowed = mask.pixels().filter(|pixel| pixel.0[0] == 0).count();
    assert!((5..200).contains(&shadowed), "the box casts a shadow: {shadowed} pixels");

    let report = folder.json("r.json");
    assert_eq!(report["technique"], "pssm");
    assert_eq!(report["filter"], "hard");
    assert_eq!(report["fit"], "dependent");
    assert_eq!(report["stabilize"], "none");
    assert_eq!(report["size"], serde_json::json!([64, 48]));
    for text in ["adapter", "generation", "storage"] {
        assert!(report[text].as_str().is_some_and(|text| !text.is_empty()), "{text}: {report}");
    }
    for time in ["plan", "shadow", "frame"] {
        assert!(report["times_ms"][time].as_f64().is_some_and(|ms| ms >= 0.0), "{time}: {report}");
    }
    let planes: Vec<f64> = report["planes_m"].as_array().expect("planes").iter().filter_map(|p| p.as_f64()).collect();
    assert_eq!(planes.len(), 3);
    assert_eq!((planes[0], planes[2]), (1.0, 40.0));
    let splits = report["splits"].as_array().expect("splits");
    assert_eq!(splits.len(), 2);
    assert_eq!((splits[0]["near"].as_f64(), splits[1]["far"].as_f64()), (Some(1.0), Some(40.0)));
    assert_eq!(splits[0]["far"], splits[1]["near"]);
    assert_eq!((splits[0]["bytes"].as_u64(), splits[1]["bytes"].as_u64()), (Some(256 * 256 * 4), Some(128 * 128 * 4)));
    for field in ["texel_m", "casters", "draws", "triangles"] {
        assert!(splits.iter().all(|split| split[field].as_f64().is_some()), "{field}: {report}");
    }
    assert!(splits[1]["casters"].as_u64().is_some_and(|casters| (1..=2).contains(&casters)), "{report}");
    assert!(report["bytes"].as_u64().is_some_and(|bytes| bytes >= (256 * 256 + 128 * 128) * 4), "{report}");
    assert!(report["notes"].is_array());
}

#[test]
fn the_mask_is_close_to_the_truth() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("render {ABOVE} --visibility m.png"));
    folder.succeed(&format!("truth {ABOVE} --tint --shadows off -o t.png --report t.json"));
    let (mask, truth) = (folder.mask("m.png"), folder.mask("t.png"));
    let differ = mask.pixels().zip(truth.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ <= 12, "{differ} of 3072 pixels differ; the shadow's edge is some 40 pixels long");
    let lit = truth.pixels().filter(|pixel| pixel.0 == [255, 255]).count();
    assert!((2500..3070).contains(&lit), "{lit} pixels are lit");
    assert_eq!(folder.json("t.json")["camera"]["far"], serde_json::Value::Null);
}

#[test]
fn probes_answer_what_the_mask_shows() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!("render {ABOVE} --visibility m.png"));
    let mask = folder.mask("m.png");
    let mut records = Vec::new();
    let mut expected = Vec::new();
    for (i, j, pixel) in mask.enumerate_pixels() {
        let [x, z] = ground_under_pixel(i, j);
        if x.abs().max(z.abs()) > 2.0 {
            records.extend([x, 0.0, z, 0.0, 1.0, 0.0].iter().flat_map(|number| number.to_le_bytes()));
            expected.push(pixel.0[0]);
        }
    }
    // Turned away from the light; and far outside of every map.
    records.extend([5.0, 0.0, 5.0, 0.0, -1.0, 0.0].iter().flat_map(|number: &f64| number.to_le_bytes()));
    records.extend([5e4, 0.0, 5e4, 0.0, 1.0, 0.0].iter().flat_map(|number: &f64| number.to_le_bytes()));
    fs::write(folder.at("points.bin"), &records).expect("points");
    folder.succeed(&format!("probe {ABOVE} --points points.bin --out a.bin --report r.json"));

    let answers = fs::read(folder.at("a.bin")).expect("answers");
    let answers: Vec<f32> =
        answers.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four bytes"))).collect();
    let report = folder.json("r.json");
    let splits = report["probe"]["split"].as_array().expect("splits of the answers");
    assert_eq!((answers.len(), splits.len()), (expected.len() + 2, expected.len() + 2));
    let differ = answers.iter().zip(&expected).filter(|(answer, mask)| (*answer * 255.0).round() != f32::from(**mask));
    // A ray in f32 and the same point in f64 may fall on two sides of a texel's border.
    assert!(differ.count() <= 2);
    assert!(expected.contains(&0), "the comparison met shadow");
    assert_eq!(answers[expected.len()], 0.0, "turned away");
    assert_eq!(answers[expected.len() + 1], 1.0, "out of range");
    assert_eq!(splits[expected.len() + 1], -1, "out of range");
}

#[test]
fn no_points_give_no_answers() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::with("points.bin", []);
    folder.succeed("probe tiny.glb --size 64x48 --points points.bin --out a.bin");
    assert_eq!(fs::read(folder.at("a.bin")).expect("answers"), b"");
}

/// Between steps of the sun the very same picture; a step is faded over as many frames as were
/// asked for.
#[test]
fn a_sun_that_moves_in_steps() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(
        "render tiny.glb --size 48x36 --camera front --map-size 128 --filter hard --sun 0.3,-1,0.2 --sun-to 0.8,-1,0.2 --frames 13 \
         --sun-step 12 --sun-fade 3 -o p.png --visibility m.png --report r.json",
    );
    let bytes = |name: &str| std::fs::read(folder.at(name)).expect(name);
    let mask = |k: usize| bytes(&format!("m.{k:04}.png"));
    let shown = |k: usize| folder.json(&format!("r.{k:04}.json"))["sun_shown"].clone();
    let weights: Vec<f64> = (0..13).map(|k| shown(k)["weight"].as_f64().expect("a share")).collect();
    let first_step = weights.iter().position(|&weight| weight < 1.0).expect("a step is taken");
    assert!(first_step >= 3, "{weights:?}");
    for k in 1..first_step {
        assert!(mask(k) == mask(0), "frame {k} before the first step");
        assert!(bytes(&format!("p.{k:04}.png")) == bytes("p.0000.png"));
    }
    let faded = &weights[first_step..first_step + 3];
    assert!((faded[0] - 1.0 / 3.0).abs() < 1e-9 && (faded[1] - 2.0 / 3.0).abs() < 1e-9 && faded[2] == 1.0);
    assert!(mask(first_step) != mask(0) && mask(first_step) != mask(first_step + 1));
    assert_eq!(shown(first_step)["from"], shown(0)["to"]);
    let sun = |k: usize| folder.json(&format!("r.{k:04}.json"))["sun"].clone();
    assert!(sun(1) != sun(0), "the true sun moves every frame");
}

#[test]
fn frames_get_numbers() {
    let folder = Folder::with("points.bin", [0.0, 0.0, 5.0, 0.0, 1.0, 0.0].map(f64::to_le_bytes).concat());
    let along = "tiny.glb --size 32x24 --path path.json --frames 2 --eye-height 3 --map-size 64";
    folder.succeed(&format!("truth {along} -o t.png --report t.json"));
    assert_eq!(folder.new_names(), ["t.0000.json", "t.0000.png", "t.0001.json", "t.0001.png"]);
    let (first, second) = (folder.json("t.0000.json"), folder.json("t.0001.json"));
    assert_eq!((&first["frame"], &second["frame"]), (&0.into(), &1.into()));
    assert_ne!(first["camera"]["eye"], second["camera"]["eye"]);
    assert!(first["sun"][1].as_f64().is_some_and(|y| y < 0.0), "the path's sun shines downwards: {first}");
    if !has_adapter() {
        return;
    }
    let folder = Folder::with("points.bin", [0.0, 0.0, 5.0, 0.0, 1.0, 0.0].map(f64::to_le_bytes).concat());
    folder.succeed(&format!("render {along} -o p.png --visibility m.png --maps maps --report r.json"));
    folder.succeed(&format!("probe {along} --points points.bin --out a.bin --report q.json"));
    let stems = [("a", ".bin"), ("m", ".png"), ("maps", ""), ("p", ".png"), ("q", ".json"), ("r", ".json")];
    let expected: Vec<String> =
        stems.iter().flat_map(|(stem, end)| (0..2).map(move |k| format!("{stem}.{k:04}{end}"))).collect();
    assert_eq!(folder.new_names(), expected);
}

#[test]
fn an_empty_scene_gives_an_empty_picture() {
    let folder = Folder::new();
    folder.succeed("truth empty.gltf --size 32x24 -o t.png");
    assert!(folder.mask("t.png").pixels().all(|pixel| pixel.0[1] == 0), "nothing was hit");
    if !has_adapter() {
        return;
    }
    folder.succeed("render empty.gltf --size 32x24 -o p.png --visibility m.png --maps maps --report r.json");
    assert!(folder.mask("m.png").pixels().all(|pixel| pixel.0[1] == 0), "nothing was hit");
    assert_eq!(image::open(folder.at("p.png")).expect("a picture").dimensions(), (32, 24));
    let report = folder.json("r.json");
    assert!(report["notes"].as_array().is_some_and(|notes| notes.len() >= 2), "camera and sun are invented: {report}");
    assert!(report["splits"].as_array().is_some_and(|s| s.iter().all(|s| s["casters"] == 0)), "{report}");
    // A view with nothing in it is as good as an empty scene.
    folder.succeed(
        "render tiny.glb --size 32x24 --eye 0,5,0 --target 0,50,1 --visibility n.png -o q.png --report q.json",
    );
    assert!(folder.mask("n.png").pixels().all(|pixel| pixel.0[1] == 0), "nothing was hit");
}

#[test]
fn notes_reach_standard_error_once() {
    let folder = Folder::new();
    let output = folder.run("truth empty.gltf --size 32x24 -o t.png");
    let said = stderr(&output);
    let notes: Vec<&str> = said.lines().filter(|line| line.starts_with("umbrage: note: ")).collect();
    assert_eq!(notes.iter().filter(|note| note.contains("no camera")).count(), 1, "{said}");
    assert_eq!(notes.len(), 2, "camera and sun are invented: {said}");
}

#[test]
fn scenes_bring_their_cameras_and_lights() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed("render tiny.glb --size 32x24 --report r.json");
    let report = folder.json("r.json");
    assert_eq!(report["camera"]["name"], "front");
    assert_eq!((report["camera"]["near"].as_f64(), report["camera"]["far"].as_f64()), (Some(0.5), Some(200.0)));
    let fov = report["camera"]["fov"].as_f64().expect("an angle");
    assert!((fov - 1f64.to_degrees()).abs() < 1e-6, "{fov}");
    assert!(report["sun"][1].as_f64().is_some_and(|y| y < -0.5), "the scene's light: {report}");
    folder.succeed("render tiny.glb --size 32x24 --camera 0 --light 0 --fov 30 --near 2 --far 50 --report q.json");
    let report = folder.json("q.json");
    assert_eq!((report["camera"]["near"].as_f64(), report["camera"]["far"].as_f64()), (Some(2.0), Some(50.0)));
    assert!((report["camera"]["fov"].as_f64().expect("an angle") - 30.0).abs() < 1e-6);
}

#[test]
fn lamps_and_several_lights() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    let lamp = "tiny.glb --size 96x72 --splits 1 --map-size 256 --light lamp --filter hard";
    folder.succeed(&format!("render {lamp} --visibility m.png --maps maps --report r.json"));
    folder.succeed(&format!("truth {lamp} -o t.png --report t.json"));
    let (mask, truth) = (folder.mask("m.png"), folder.mask("t.png"));
    let dark = truth.pixels().filter(|pixel| pixel.0 == [0, 255]).count();
    let wrong = mask.pixels().zip(truth.pixels()).filter(|(a, b)| a.0 != b.0).count();
    assert!(dark > 50 && wrong * 20 < dark, "{wrong} wrong, {dark} dark pixels");
    let report = folder.json("r.json");
    assert_eq!(report["lights"][0]["kind"], "point");
    assert_eq!(report["lights"][0]["position"][1].as_f64(), Some(9.0));
    assert_eq!(report["splits"].as_array().map(Vec::len), Some(6), "one split for each face");
    assert!(report["sun"].is_null() && folder.json("t.json")["sun"].is_null(), "a lamp is no sun");
    assert_eq!(names(&folder.at("maps")).len(), 6);

    // Both lights in the picture; the mask is the first one's.
    let both = lamp.replace("lamp", "lamp,sun");
    folder.succeed(&format!("render {both} --visibility b.png -o p.png --report b.json"));
    assert_eq!(folder.mask("b.png"), mask);
    let lights = folder.json("b.json")["lights"].clone();
    assert_eq!((&lights[1]["name"], &lights[1]["kind"]), (&"sun".into(), &"directional".into()));
    assert_eq!(lights[1]["splits"].as_array().map(Vec::len), Some(1));
    folder.succeed(&format!("plan {lamp} -o plan.json"));
    assert_eq!(folder.json("plan.json")["splits"].as_array().map(Vec::len), Some(6));
}

#[test]
fn techniques_schemes_and_formats() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    for (options, splits) in [
        ("--technique ssm --map-size 256", 1),
        ("--technique ssm --splits 1", 1),
        ("--scheme uniform --splits 3 --map-size 64", 3),
        ("--scheme log --splits 8 --map-size 64", 8),
        ("--scheme optimal --splits 3 --map-size 64", 3),
        ("--planes 5,10 --map-size 64 --shadow-range 1..60", 3),
        ("--map-size 128,64 --delta 0.5", 2),
        ("--depth-format d16 --filter pcf5 --map-size 128", 4),
        ("--fit independent --stabilize exact --filter pcf2 --map-size 128", 4),
        ("--tint --shadows off --map-size 64", 4),
        ("--technique psm --map-size 128", 1),
        ("--stabilize approximate --map-size 128", 4),
        ("--stabilize approximate --extent-levels 64 --fit independent --map-size 128", 4),
        ("--technique lispsm --map-size 128 --stabilize none --filter hard", 1),
        ("--technique tsm --map-size 128 --tsm-focus 0.4 --fit independent", 1),
        ("--splits 3 --map-size 64 --warp tsm,lispsm,none --depth-format d16", 3),
    ] {
        folder.succeed(&format!("render tiny.glb --size 32x24 {options} --report r.json -o p.png --visibility m.png"));
        let report = folder.json("r.json");
        assert_eq!(report["splits"].as_array().map(Vec::len), Some(splits), "{options}: {report}");
        let kind = options.split_once("--technique ").map_or("pssm", |(_, rest)| rest.split(' ').next().unwrap_or(""));
        assert_eq!(report["technique"], kind, "{options}");
        let warped = !matches!(kind, "ssm" | "pssm") || options.contains("--warp");
        assert_eq!(report["stabilize"] == "none", warped, "{options}: {report}");
        // A split without casters has no need of a warp.
        let any = report["splits"].as_array().is_some_and(|splits| splits.iter().any(|split| split["warped"] == true));
        assert_eq!(any, warped, "{options}: {report}");
    }
}

#[test]
fn reports_name_the_path_that_was_taken() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    let shot = "tiny.glb --size 64x48 --map-size 128 --report out.json --maps maps";
    let report = |options: &str| {
        folder.succeed(&format!("render {shot} {options}"));
        let report = folder.json("out.json");
        let text = |field: &str| report[field].as_str().unwrap_or_default().to_owned();
        (format!("{} {}", text("generation"), text("storage")), report["notes"].to_string())
    };
    assert_eq!(report("").0, "per-split array");
    assert_eq!(report("--storage separate --depth-format r32f").0, "per-split separate");
    let (path, notes) = report("--generation multipass");
    assert_eq!(path, "multipass reused");
    assert!(notes.contains("--blend 0"), "{notes}");
    assert!(!report("--storage reused --blend 0").1.contains("--blend"), "nothing was invented");
    assert!(!report("--storage reused --transition hard --blend 0.3").1.contains("--blend"), "nothing was invented");
    for (generation, path) in [("layered", "layered array"), ("instanced", "instanced atlas"), ("mixed", "mixed array")]
    {
        let (taken, notes) = report(&format!("--generation {generation}"));
        assert!(taken == path || notes.contains(generation), "{generation} took {taken}: {notes}");
    }
}

#[test]
fn a_plan_needs_no_gpu_and_says_it_in_both_conventions() {
    let folder = Folder::new();
    let options = "--splits 2 --map-size 256,128 --warp lispsm,none --shadow-range 1..60 --fit independent";
    folder.succeed(&format!("plan tiny.glb {options} -o z.json"));
    folder.succeed(&format!("plan tiny.glb {options} --depth-convention minus-one-to-one -o gl.json"));
    let printed = folder.run(&format!("plan tiny.glb {options}"));
    assert!(printed.status.success());
    let printed: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON is printed");
    let (plan, gl) = (folder.json("z.json"), folder.json("gl.json"));
    assert_eq!(plan, printed);
    assert_eq!((&plan["technique"], &plan["warp"]), (&"pssm".into(), &serde_json::json!(["lispsm", "none"])));
    assert_eq!(
        (&plan["depth_convention"], &gl["depth_convention"]),
        (&"zero-to-one".into(), &"minus-one-to-one".into())
    );
    assert_eq!(plan["planes_m"].as_array().map(Vec::len), Some(3));
    assert_eq!((plan["planes_m"][0].as_f64(), plan["planes_m"][2].as_f64()), (Some(1.0), Some(60.0)));
    let casters = plan["casters"].as_array().expect("casters");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    for (split, warped) in [(0, true), (1, false)] {
        let (here, there) = (&plan["splits"][split], &gl["splits"][split]);
        assert_eq!(here["warped"], warped, "{here}");
        let listed = here["casters"].as_array().expect("a list");
        assert!(listed.iter().all(|c| c.as_u64().is_some_and(|c| (c as usize) < casters.len())), "{here}");
        // z' = 2z − w for any point, the other rows are the same; texture coordinates are 0..1, v
        // runs down, and up with OpenGL.
        let (a, b, t) = (&here["shadow_from_world"], &there["shadow_from_world"], &here["texture_from_world"]);
        let gl_t = &there["texture_from_world"];
        for column in 0..4 {
            let [x, y, z, w] = [0, 1, 2, 3].map(|row| number(&a[column][row]));
            let [x2, y2, z2, w2] = [0, 1, 2, 3].map(|row| number(&b[column][row]));
            assert_eq!((x, y, w), (x2, y2, w2));
            assert!((z2 - (2.0 * z - w)).abs() < 1e-9 * (1.0 + z.abs() + w.abs()));
            assert!((number(&t[column][0]) - 0.5 * (x + w)).abs() < 1e-9 * (1.0 + x.abs() + w.abs()));
            assert!((number(&t[column][1]) - 0.5 * (w - y)).abs() < 1e-9 * (1.0 + y.abs() + w.abs()));
            assert!((number(&gl_t[column][1]) - 0.5 * (w + y)).abs() < 1e-9 * (1.0 + y.abs() + w.abs()));
            for row in [0, 2, 3] {
                assert_eq!(number(&gl_t[column][row]), number(&t[column][row]));
            }
            assert_eq!(number(&t[column][2]), z);
        }
    }
    folder.succeed("plan tiny.glb --path path.json --frames 2 -o n.json");
    assert!(folder.at("n.0000.json").exists() && folder.at("n.0001.json").exists());
    folder.succeed("plan empty.gltf -o e.json");
    assert!(folder.json("e.json")["splits"].as_array().is_some_and(|splits| splits.len() == 4));
}

#[test]
fn a_scene_that_was_moved_far_away_is_planned_alike() {
    let folder = Folder::new();
    let options = "--splits 2 --map-size 256,128";
    folder.succeed(&format!("plan tiny.glb --eye 0,5,9 --target 0,0,0 {options} -o here.json"));
    let there = "--move-scene 100000,-12,-5000 --eye 100000,-7,-4991 --target 100000,-12,-5000";
    folder.succeed(&format!("plan tiny.glb {there} {options} -o there.json"));
    let (here, there) = (folder.json("here.json"), folder.json("there.json"));
    let near = |a: &serde_json::Value, b: &serde_json::Value| {
        let (a, b) = (a.as_f64().expect("a number"), b.as_f64().expect("a number"));
        assert!((a - b).abs() < 1e-9 * (1.0 + a.abs()), "{a} {b}");
    };
    (0..3).for_each(|plane| near(&here["planes_m"][plane], &there["planes_m"][plane]));
    for split in 0..2 {
        (0..2).for_each(|axis| near(&here["splits"][split]["texel_m"][axis], &there["splits"][split]["texel_m"][axis]));
        assert_eq!(here["splits"][split]["casters"], there["splits"][split]["casters"]);
    }
}

#[test]
fn a_world_by_its_name() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed("render robot-war --size 64x48 --map-size 128 -o p.png --visibility m.png --report r.json");
    let report = folder.json("r.json");
    let casters: u64 = report["splits"].as_array().expect("splits").iter().filter_map(|s| s["casters"].as_u64()).sum();
    assert!((1..=4 * 161).contains(&casters), "{report}");
    assert!(folder.mask("m.png").pixels().any(|pixel| pixel.0 == [255, 255]), "something is lit");
}

#[test]
fn a_world_as_a_file_is_the_same_world() {
    let folder = Folder::new();
    folder.succeed("worlds export chessboard -o chess.glb");
    folder.succeed("truth chessboard --size 64x48 -o a.png --report a.json");
    folder.succeed("truth chess.glb --size 64x48 -o b.png --report b.json");
    // Two steps of f32 at a kilometre: that is what a file keeps of a position.
    for axis in 0..3 {
        let eye = |name: &str| folder.json(name)["camera"]["eye"][axis].as_f64().expect("a coordinate");
        assert!((eye("a.json") - eye("b.json")).abs() < 2e-4, "{} and {}", eye("a.json"), eye("b.json"));
    }
    let (a, b) = (folder.mask("a.png"), folder.mask("b.png"));
    let differ = a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ <= 3, "{differ} of 3072 pixels differ");
}

#[test]
fn a_reader_who_leaves_is_no_error() {
    let folder = Folder::new();
    let mut child =
        folder.command("worlds list").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{}", stderr(&output));
    let listed = folder.run("worlds list");
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    for world in ["robot-war", "chessboard", "knights", "mining-terrain"] {
        assert!(listed.contains(world), "{listed}");
    }
    assert!(folder.run("--help").status.success() && folder.run("--version").status.success());
    assert!(folder.run("render --help").status.success());
}
