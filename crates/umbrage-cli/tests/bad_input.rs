//! Bad input gets exit code 2 and a message that names the culprit, and leaves no file.

mod common;

use common::{Folder, bomb_png, glb, has_adapter, tiny_bin, tiny_glb, tiny_json};

/// Every subcommand reads these the same way.
#[test]
fn options_that_say_nonsense() {
    let folder = Folder::new();
    for (options, culprits) in [
        // Camera.
        ("--eye 0,5,9 --target 0,5,9", &["--eye", "--target"][..]),
        ("--eye 0,5,9", &["--eye", "--target"]),
        ("--target 0,0,0", &["--target", "--eye"]),
        ("--eye nan,5,9 --target 0,0,0", &["--eye", "nan"]),
        ("--eye 0,5,inf --target 0,0,0", &["--eye", "inf"]),
        ("--eye 0,5 --target 0,0,0", &["--eye", "0,5"]),
        ("--eye 0,5,9 --target 0,0,zero", &["--target", "zero"]),
        ("--eye 0,5,9 --target 0,0,0 --near 10 --far 5", &["--near 10", "--far 5"]),
        ("--eye 0,5,9 --target 0,0,0 --near 5 --far 5", &["--near", "--far"]),
        ("--eye 0,5,9 --target 0,0,0 --near 900", &["--near 900", "--far 800"]),
        ("--camera front --near 900", &["near", "far"]),
        ("--near 0", &["--near"]),
        ("--near -1", &["--near"]),
        ("--near nan", &["--near"]),
        ("--near inf", &["--near"]),
        ("--far nan", &["--far"]),
        ("--far -inf", &["--far"]),
        ("--fov 0", &["--fov"]),
        ("--fov 180", &["--fov"]),
        ("--fov -60", &["--fov"]),
        ("--fov nan", &["--fov"]),
        ("--camera nobody", &["--camera nobody", "front"]),
        ("--camera 1", &["--camera 1", "front"]),
        ("--camera front --eye 0,1,2 --target 0,0,0", &["--camera", "--eye"]),
        ("--camera front --path path.json", &["--camera", "--path"]),
        ("--path path.json --eye 0,1,2 --target 0,0,0", &["--path", "--eye"]),
        ("--frames 3", &["--frames", "--path"]),
        ("--sun-to 1,-1,0", &["--sun-to", "--frames"]),
        ("--sun-to 0,0,0 --frames 4", &["--sun-to"]),
        ("--sun-step 1", &["--sun-step", "--sun-to"]),
        ("--sun-fade 1", &["--sun-fade", "--sun-step"]),
        ("--sun-to 1,-1,0 --frames 4 --sun-fade 1", &["--sun-fade", "--sun-step"]),
        ("--sun-to 1,-1,0 --frames 4 --sun-step 0", &["--sun-step"]),
        ("--sun-to 1,-1,0 --frames 4 --sun-step 200", &["--sun-step"]),
        ("--path path.json --frames 0", &["--frames 0"]),
        ("--path path.json --frames -1", &["--frames"]),
        ("--path path.json --eye-height nan", &["--eye-height"]),
        ("--path nowhere.json", &["nowhere.json"]),
        ("--path tiny.glb", &["tiny.glb"]),
        // Numbers of objects.
        ("--trees 5", &["trees", "forest"]),
        ("--robots 0", &["--robots"]),
        ("--robots 100001", &["--robots"]),
        ("--buildings many", &["--buildings"]),
        // Size, time, light.
        ("--size 0x600", &["--size"]),
        ("--size -800x600", &["--size"]),
        ("--size 800", &["--size", "800x600"]),
        ("--size 99999x99999", &["--size"]),
        ("--time nan", &["--time"]),
        ("--time soon", &["--time"]),
        ("--sun 0,0,0", &["--sun"]),
        ("--sun nan,-1,0", &["--sun"]),
        ("--sun 1,2", &["--sun"]),
        ("--sun-angle -3", &["--sun-angle", "-3"]),
        ("--sun-angle nan", &["--sun-angle"]),
        ("--sun-angle 91", &["--sun-angle", "91"]),
        ("--sun-angle wide", &["--sun-angle", "wide"]),
        ("--light nobody", &["--light nobody", "sun", "lamp"]),
        ("--light sun,nobody", &["--light nobody", "sun", "lamp"]),
        ("--light sun,lamp,sun", &["--light sun,lamp,sun", "twice"]),
        ("--light lamp --sun-to 1,-1,0 --frames 2", &["--sun-to", "--light lamp"]),
        ("--light sun --sun 0,-1,0", &["--light", "--sun"]),
        ("--metres-per-post 0", &["--metres-per-post"]),
        ("--metres-per-unit nan", &["--metres-per-unit"]),
        ("--height-offset inf", &["--height-offset"]),
        ("--move-scene 1,2", &["--move-scene", "1,2"]),
        ("--move-scene 0,nan,0", &["--move-scene", "nan"]),
        ("--move-scene inf,0,0", &["--move-scene", "inf"]),
        ("--no-such-option", &["--no-such-option"]),
    ] {
        folder.refuse(&format!("render tiny.glb -o out.png {options}"), culprits);
        folder.refuse(&format!("truth tiny.glb -o out.png {options}"), culprits);
    }
}

#[test]
fn shadow_options_that_say_nonsense() {
    let folder = Folder::new();
    for (options, culprits) in [
        ("--splits 0", &["--splits 0", "1 to 8"][..]),
        ("--filter disc --filter-width 0", &["--filter-width"]),
        ("--filter disc --filter-width -1", &["--filter-width"]),
        ("--filter disc --filter-width nan", &["--filter-width"]),
        ("--filter-width 0.5 --filter hard", &["--filter-width", "hard"]),
        ("--filter-width 0.5 --filter pcss", &["--filter-width", "pcss"]),
        ("--filter vogel", &["--filter", "vogel"]),
        ("--filter disc --map-size 20", &["--map-size", "20", "filter"]),
        ("--filter vsm --filter-width 0", &["--filter-width"]),
        ("--filter vsm --map-size 32", &["--map-size", "32"]),
        ("--filter vsm --msaa 3", &["--msaa 3", "give 1 or 4"]),
        ("--filter vsm --msaa 0", &["--msaa 0"]),
        ("--filter pcf3 --msaa 4", &["--msaa", "pcf3", "vsm"]),
        ("--filter hard --derivatives quad", &["--derivatives", "hard"]),
        ("--filter pcss --bleeding 0.1", &["--bleeding", "pcss"]),
        ("--filter vsm --bleeding 2", &["--bleeding"]),
        ("--filter msm --derivatives naive", &["--derivatives", "analytic", "quad"]),
        ("--filter evsm4 --warp tsm", &["--filter evsm4", "tsm"]),
        ("--filter msm --storage atlas", &["--storage atlas", "--filter msm"]),
        ("--filter msm --sun-angle -1", &["--sun-angle"]),
        ("--transition soft", &["--transition", "soft"]),
        ("--bias none", &["--bias", "none"]),
        ("--shadow-strength 2", &["--shadow-strength", "2"]),
        ("--shadow-colour 0,0,2", &["--shadow-colour", "0 to 1"]),
        ("--shadow-colour red", &["--shadow-colour"]),
        ("--translucent glass", &["--translucent", "glass"]),
        ("--splits 9", &["--splits 9", "1 to 8"]),
        ("--splits -1", &["--splits"]),
        ("--splits nan", &["--splits"]),
        ("--splits 3 --map-size 512,512", &["--map-size", "3 splits"]),
        ("--splits 1 --map-size 512,512", &["--map-size", "1 split"]),
        ("--map-size 512,512,512,512,512,512,512,512,512", &["--map-size", "1 to 8"]),
        ("--map-size 0", &["--map-size"]),
        ("--map-size -512", &["--map-size"]),
        ("--map-size 65537", &["--map-size"]),
        ("--map-size 512,", &["--map-size"]),
        ("--map-size 4", &["--map-size"]),
        ("--technique ssm --splits 2", &["--splits 2", "ssm"]),
        ("--technique ssm --map-size 512,512", &["--map-size", "1 split"]),
        ("--technique magic", &["--technique", "pssm", "ssm"]),
        ("--technique psm --splits 2", &["--splits 2", "psm"]),
        ("--technique psm --stabilize exact", &["--technique psm", "--stabilize exact"]),
        ("--technique lispsm --warp tsm", &["--technique lispsm", "--warp tsm"]),
        ("--warp tsm --stabilize exact", &["--warp tsm", "--stabilize exact"]),
        ("--warp tsm --stabilize approximate", &["--warp tsm", "--stabilize approximate"]),
        ("--stabilize exact --extent-levels 64", &["--extent-levels", "--stabilize approximate"]),
        ("--stabilize approximate --extent-steps 8 --extent-levels 64", &["--extent-steps", "--extent-levels"]),
        ("--stabilize approximate --extent-steps 2", &["--extent-steps", "4 to 64"]),
        ("--stabilize approximate --extent-levels 99999", &["--extent-levels", "8 to 4096"]),
        ("--warp tsm,none", &["--warp", "2 warps"]),
        ("--warp trapeze", &["--warp", "trapeze", "lispsm"]),
        ("--tsm-focus 0.5", &["--tsm-focus", "tsm"]),
        ("--technique tsm --tsm-focus 0", &["--tsm-focus"]),
        ("--technique tsm --tsm-focus nan", &["--tsm-focus"]),
        ("--scheme magic", &["--scheme", "uniform", "log", "practical", "manual", "optimal"]),
        ("--scheme fitted", &["--scheme fitted", "`fitted` is now called `optimal`"]),
        ("--scheme optimal --lambda 0.5", &["--lambda", "practical", "optimal"]),
        ("--scheme log --lambda 0.5", &["--lambda", "practical", "log"]),
        ("--scheme uniform --delta 1", &["--delta", "practical", "uniform"]),
        ("--lambda 1.1", &["--lambda"]),
        ("--lambda -0.1", &["--lambda"]),
        ("--lambda nan", &["--lambda"]),
        ("--delta 1,2 --splits 4", &["--delta"]),
        ("--delta nan", &["--delta"]),
        ("--delta 100000 --shadow-range 1..100", &["--delta"]),
        ("--scheme manual", &["--planes", "manual"]),
        ("--scheme practical --planes 5,10,20", &["--planes", "practical"]),
        ("--planes 20,10,30", &["--planes"]),
        ("--planes 10,10,30", &["--planes"]),
        ("--planes 5,nan,30", &["--planes"]),
        ("--planes 5,10 --splits 4", &["--planes"]),
        ("--planes 5,10,200 --shadow-range 1..100", &["--planes"]),
        ("--planes 5,10,15,20,25,30,35,40", &["--planes", "1 to 8"]),
        ("--shadow-range 100..1", &["--shadow-range"]),
        ("--shadow-range 1..1", &["--shadow-range"]),
        ("--shadow-range 0..10", &["--shadow-range"]),
        ("--shadow-range nan..10", &["--shadow-range"]),
        ("--shadow-range 1..inf", &["--shadow-range"]),
        ("--shadow-range 10", &["--shadow-range", "N..F"]),
        ("--blend 1.5", &["--blend"]),
        ("--blend nan", &["--blend"]),
        ("--far-fade -0.5", &["--far-fade"]),
        ("--filter soft", &["--filter", "hard", "pcf2", "pcf3", "pcf5"]),
        ("--fit tight", &["--fit", "dependent", "independent"]),
        ("--stabilize maybe", &["--stabilize", "exact", "none"]),
        ("--depth-format d24", &["--depth-format", "d32f", "d16"]),
        ("--shadows maybe", &["--shadows", "on", "off"]),
        // Pairs of which there is no path.
        ("--coordinates split --splits 5", &["--coordinates split", "--splits 5", "4 splits"]),
        ("--coordinates split --technique lispsm", &["--coordinates split", "--warp lispsm"]),
        ("--coordinates vertex", &["--coordinates", "vertex"]),
        ("--generation layered --storage atlas", &["--generation layered", "--storage atlas"]),
        ("--generation instanced --storage array", &["--generation instanced", "--storage array"]),
        ("--generation mixed --storage separate", &["--generation mixed", "--storage separate"]),
        ("--generation multipass --storage cube", &["--generation multipass", "--storage cube"]),
        ("--generation per-split --storage reused", &["--generation per-split", "--storage reused"]),
        ("--generation multipass --blend 0.1", &["--blend 0.1", "--generation multipass", "--storage reused"]),
        ("--storage reused --blend 0.2 --transition dither", &["--blend 0.2", "--storage reused"]),
        ("--generation multipass --selection map", &["--selection map", "--generation multipass", "--storage reused"]),
        ("--generation multipass --bands radial", &["--bands radial", "--generation multipass", "--storage reused"]),
        ("--bands radial --selection map", &["--bands radial", "--selection map"]),
        ("--fit-to depth --stabilize exact", &["--fit-to depth", "--stabilize exact"]),
        ("--drop-small-casters --warp tsm", &["--drop-small-casters on", "--warp tsm"]),
        ("--edge-samples 4", &["--edge-samples 4", "--edges exact"]),
        ("--bands radial --range-fit visible", &["--bands radial", "--range-fit visible"]),
        ("--bands round", &["--bands", "planar", "radial"]),
        ("--storage cube --splits 7", &["--storage cube", "--splits 7"]),
        ("--storage cube --map-size 512,256", &["--storage cube", "--map-size 512,256"]),
        ("--generation fast", &["--generation", "multipass", "per-split", "layered", "instanced", "mixed", "auto"]),
        ("--storage disk", &["--storage", "array", "atlas", "separate", "cube", "reused", "auto"]),
    ] {
        let planned_late = options.starts_with("--delta 100000") || options.starts_with("--planes 5,10,200");
        if planned_late && !has_adapter() {
            continue;
        }
        folder.refuse(&format!("render tiny.glb -o out.png {options}"), culprits);
        folder.refuse(&format!("plan tiny.glb -o out.json {options}"), culprits);
    }
    folder.refuse(
        "plan tiny.glb --depth-convention backwards",
        &["--depth-convention", "zero-to-one", "zero-to-one-y-down", "minus-one-to-one"],
    );
    folder.refuse("plan missing.glb", &["missing.glb"]);
    folder.refuse("plan tiny.glb -o tiny.glb", &["tiny.glb", "input"]);
}

#[test]
fn lights_and_views_that_do_not_go_together() {
    let range_zero = tiny_json(8).replace("\"type\":\"point\"", "\"type\":\"point\",\"range\":0");
    let folder = Folder::with("zero.glb", glb(&range_zero, &tiny_bin()));
    folder.refuse("render zero.glb --light lamp -o out.png", &["lamp", "range is 0"]);
    folder.refuse("plan tiny.glb --light lamp --stabilize none --warp lispsm", &["--warp", "--light"]);
    folder.refuse("plan tiny.glb --camera front,front", &["--camera front,front", "twice"]);
    folder.refuse("render tiny.glb --light lamp --filter pcss -o out.png", &["--filter pcss", "--light lamp"]);
    folder.refuse(
        "render tiny.glb --light lamp --coordinates split -o out.png",
        &["--coordinates split", "--light lamp"],
    );
    folder.refuse("compare tiny.glb --techniques pssm:1:64 --light sun,lamp -o out", &["--light sun,lamp", "one"]);
    folder.refuse("compare tiny.glb --techniques pssm:1:64 --light lamp --suns 40 -o out", &["--suns", "--light lamp"]);
}

#[test]
fn what_only_the_device_or_the_plan_can_refuse() {
    if has_adapter() {
        let folder = Folder::new();
        for filter in ["vsm", "disc", "pcf5"] {
            let words = format!("render tiny.glb --filter {filter} --filter-width 100000 -o out.png --report out.json");
            folder.refuse(&words, &["--filter-width", "100000", "widest map"]);
        }
        folder.refuse("render tiny.glb --map-size 65536 -o out.png --report out.json", &["--map-size", "65536"]);
    }
}

#[test]
fn scenes_that_are_none() {
    let bomb = bomb_png(60_000, 60_000);
    let whole = tiny_glb();
    let mut infinite = tiny_bin();
    infinite[60..64].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let mut not_a_number = tiny_bin();
    not_a_number[60..64].copy_from_slice(&f32::NAN.to_le_bytes());
    let escaping = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"../secret.bin"}]}"#;
    let missing = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"gone.bin"}]}"#;
    for (name, bytes) in [
        ("cut.glb", whole[..whole.len() / 2].to_vec()),
        ("header.glb", whole[..10].to_vec()),
        ("nothing.glb", Vec::new()),
        ("noise.glb", (0..=255).cycle().take(4000).collect()),
        ("lies.glb", glb(&tiny_json(8_000_000), &tiny_bin())),
        ("infinite.glb", glb(&tiny_json(8), &infinite)),
        ("nan.glb", glb(&tiny_json(8), &not_a_number)),
        ("text.gltf", b"not JSON at all".to_vec()),
        ("escaping.gltf", escaping.into()),
        ("missing.gltf", missing.into()),
        ("bomb.png", bomb),
        ("scene.obj", b"v 0 0 0".to_vec()),
    ] {
        let folder = Folder::with(name, bytes);
        let scale = if name == "bomb.png" { "--metres-per-post 30 --metres-per-unit 1" } else { "" };
        let culprit = if name == "missing.gltf" { "gone.bin" } else { name };
        folder.refuse(&format!("render {name} {scale} -o out.png"), &[culprit]);
        folder.refuse(&format!("truth {name} {scale} -o out.png --report out.json"), &[culprit]);
    }
    let folder = Folder::new();
    folder.refuse("render nowhere.glb -o out.png", &["nowhere.glb"]);
    folder.refuse("render robot-peace -o out.png", &["robot-peace", "robot-war"]);
    folder.refuse("worlds export robot-peace -o out.glb", &["robot-peace", "robot-war"]);
    folder.refuse("render -o out.png", &["SCENE"]);
    folder.refuse("paint tiny.glb -o out.png", &["paint"]);
    folder.refuse("", &["Usage"]);
}

#[test]
fn points_that_are_none() {
    let numbers = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    for (bytes, culprit) in [
        (vec![0; 47], "47 bytes"),
        (vec![0; 96 + 1], "97 bytes"),
        (numbers(&[0.0, 0.0, 0.0, 0.0, 1.0, f64::NAN]), "record 0"),
        (numbers(&[0.0, f64::INFINITY, 0.0, 0.0, 1.0, 0.0]), "record 0"),
    ] {
        let folder = Folder::with("points.bin", bytes);
        let words = "probe tiny.glb --points points.bin --out answers.bin --report out.json";
        folder.refuse(words, &["--points", "points.bin", culprit]);
    }
    let folder = Folder::new();
    folder.refuse("probe tiny.glb --points gone.bin --out answers.bin", &["gone.bin"]);
    folder.refuse("probe tiny.glb --out answers.bin", &["--points"]);
}

#[test]
fn outputs_that_cannot_be() {
    let folder = Folder::new();
    folder.refuse("render tiny.glb", &["-o", "--visibility", "--maps", "--report"]);
    folder.refuse("truth tiny.glb", &["--output"]);
    folder.refuse("render tiny.glb -o missing/out.png", &["missing/out.png"]);
    folder.refuse("render tiny.glb -o out.png --report missing/out.json", &["missing/out.json"]);
    folder.refuse("render tiny.glb -o out.png --maps missing/maps", &["missing/maps"]);
    folder.refuse("render tiny.glb -o out.png --visibility ./out.png", &["out.png", "two outputs"]);
    folder.refuse("render tiny.glb -o .", &["folder"]);
    folder.refuse("render tiny.glb -o out.png --maps empty.gltf", &["empty.gltf"]);
    folder.refuse("render tiny.glb -o tiny.glb", &["tiny.glb", "input"]);
    folder.refuse("truth tiny.glb -o out.png --report tiny.glb", &["tiny.glb", "input"]);
    folder.refuse("truth tiny.glb -o missing/out.png", &["missing/out.png"]);
    folder.refuse("worlds export chessboard -o missing/out.glb", &["missing/out.glb"]);
    assert_eq!(std::fs::read(folder.at("tiny.glb")).expect("still there"), tiny_glb(), "the input is untouched");
}

/// A device that is always full, and a limit on the size of files, stand for a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk() {
    use std::process::Command;

    let folder = Folder::new();
    folder.refuse("truth tiny.glb --size 64x48 -o out.png --report /dev/full", &["/dev/full"]);
    if has_adapter() {
        let words = "render tiny.glb --size 64x48 -o out.png --maps maps --visibility mask.png --report /dev/full";
        folder.refuse(words, &["/dev/full"]);
    }
    for words in ["truth tiny.glb --size 64x48 -o out.png --report out.json", "worlds export chessboard -o out.glb"] {
        let script = format!("trap '' XFSZ; ulimit -f 0; exec {} {words}", common::UMBRAGE);
        let output = Command::new("sh").current_dir(folder.at("")).args(["-c", &script]).output().expect("sh starts");
        folder.is_refusal(words, &output, &["out."]);
    }
}
