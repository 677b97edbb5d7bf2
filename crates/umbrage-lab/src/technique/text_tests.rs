//! Tests of techniques by name: valid ones, invalid ones, files.

use umbrage::Warp;
use umbrage::config::{Crop, Filter, Preset, Range, SplitScheme, Stability};

use super::*;

fn technique(text: &str, with: &str) -> Result<Technique> {
    let with = parse_with(with)?;
    Ok(parse(text)?.finish(&with, None)?)
}

#[test]
fn shapes_and_settings_become_options_of_render() {
    let plain = technique("pssm:3:512", "").expect("plain");
    assert_eq!(plain.shadows.config.map_sizes, [512; 3]);
    assert_eq!(plain.label, "PSSM(3; 512²)");
    assert_eq!(plain.options, ["--technique=pssm", "--splits=3", "--map-size=512"]);
    assert_eq!((plain.texels(), plain.spec.as_str()), (3 * 512 * 512, "pssm:3:512"));

    let single = technique("ssm:2048", "").expect("single");
    assert_eq!((single.shadows.word("technique").as_str(), single.label.as_str()), ("ssm", "SSM(2048²)"));
    assert_eq!(single.texels(), 2048 * 2048);

    for (text, warp) in
        [("psm:1024", Warp::Psm), ("lispsm:1024", Warp::Lispsm), ("tsm:1024:tsm-focus=0.4", Warp::Tsm { focus: 0.4 })]
    {
        let warped = technique(text, "").expect(text);
        let config = &warped.shadows.config;
        assert_eq!(config.map_sizes.len(), 1, "{text}");
        assert_eq!(config.stability, Stability::Tight { warps: vec![warp] }, "{text}");
        assert_eq!(technique(&warped.spec, "").expect("its own short form").shadows.config, *config);
    }
    assert_eq!(technique("lispsm:1024", "").expect("single").label, "LISPSM(1024²)");
    let mixed = technique("pssm:3:512:warp=tsm/lispsm/none", "").expect("warps in splits");
    let Stability::Tight { warps } = &mixed.shadows.config.stability else { panic!("warps are tight") };
    assert!(matches!(warps[..], [Warp::Tsm { .. }, Warp::Lispsm, Warp::None]));
    assert_eq!(mixed.label, "PSSM(3; 512²) warp tsm,lispsm,none");

    let rich = "pssm:3:1024/512/256:lambda=0.9:stabilize=none:fit=independent:filter=pcf5:delta=1/2:label=ours";
    let rich = technique(rich, "").expect("rich");
    assert_eq!(rich.shadows.config.map_sizes, [1024, 512, 256]);
    assert_eq!(rich.shadows.config.scheme, SplitScheme::Practical { lambda: 0.9, delta: vec![1.0, 2.0] });
    assert_eq!(rich.shadows.config.stability, Stability::tight());
    assert_eq!(rich.shadows.config.crop, Crop::SceneIndependent);
    assert_eq!(rich.shadows.config.filter, Filter::Pcf5 { width_m: None });
    assert_eq!(rich.label, "ours");
    assert_eq!(technique(&rich.spec, "").expect("its own short form").shadows, rich.shadows);

    assert_eq!(
        technique("pssm:4:512:lambda=0.9:stabilize=exact", "").expect("label").label,
        "PSSM(4; 512²) λ 0.9 still"
    );
}

#[test]
fn settings_for_all_hold_unless_a_technique_says_otherwise() {
    let with = "filter=hard:blend=0:lambda=0.7";
    let all = technique("pssm:2:512", with).expect("all");
    assert_eq!(all.shadows.config.filter, Filter::Hard);
    assert_eq!(all.shadows.config.blend(), 0.0);
    let own = technique("pssm:2:512:filter=pcf2", with).expect("own");
    assert_eq!(own.shadows.config.filter, Filter::Pcf2);
    assert_eq!(own.shadows.config.scheme, SplitScheme::Practical { lambda: 0.7, delta: Vec::new() });
    // A preset's settings come first, the user's after them.
    let mut merged = parse_with("filter=hard").expect("preset");
    merged.extend(parse_with("filter=pcf5").expect("user"));
    let last = parse("ssm:64").and_then(|source| Ok(source.finish(&merged, None)?)).expect("merged");
    assert_eq!(last.shadows.config.filter, Filter::Pcf5 { width_m: None });
    assert!(all.family == technique("pssm:2:1024", with).expect("larger").family, "one family at two sizes");
    assert_ne!(all.family, own.family);
}

#[test]
fn settings_go_over_the_default_or_a_preset() {
    assert_eq!(technique("pssm:4:1024", "").expect("default").shadows.config, Preset::Balanced.config());
    assert_eq!(technique("pssm:4:1024", "preset=papers").expect("papers").shadows.config, Preset::Papers.config());
    let message = technique("pssm:4:1024:preset=best", "").expect_err("no preset").to_string();
    assert!(message.contains("--preset") && message.contains("balanced"), "{message}");
}

#[test]
fn mistakes_name_the_culprit() {
    for (text, culprits) in [
        ("", &["no technique named"][..]),
        ("pssm", &["pssm", "SPLITS"]),
        ("pssm:4", &["pssm:4", "SPLITS"]),
        ("pssm:4:512:256", &["pssm:SPLITS:SIZE"]),
        ("ssm", &["ssm:SIZE"]),
        ("ssm:2:512", &["ssm:2:512", "ssm:SIZE"]),
        ("pssm:9:512", &["pssm:9:512", "--splits 9"]),
        ("pssm:x:512", &["pssm:x:512", "--splits"]),
        ("pssm:4:0", &["pssm:4:0", "0 texels"]),
        ("pssm:4:512/256", &["--map-size"]),
        ("pssm:4:512:lambda=2", &["--lambda", "2 is out of range"]),
        ("pssm:4:512:lambda", &["SPLITS:SIZE", "KEY=VALUE"]),
        ("pssm:4:512:lambda=", &["lambda has no value"]),
        ("pssm:4:512:lambda=0.5:lambda=0.6", &["lambda is said twice"]),
        ("pssm:4:512:scheme=log:lambda=0.5", &["--lambda", "practical"]),
        ("pssm:4:512:filter=sharp", &["--filter", "pcf3"]),
        ("pssm:4:512:colour=red", &["no setting colour", "lambda"]),
        ("pssm:4:512:splits=3", &["splits="]),
        ("pssm:4:512:shadow-range=1..5", &["--shadow-range"]),
        ("pssm:4:512:tint=blue", &["tint"]),
        ("pssm:4:512:sun-angle=3", &["--sun-angle"]),
        ("ssm:1024:lambda=0.5:2048", &["\"2048\""]),
        ("sdsm:1024", &["sdsm is not built yet", "pssm, ssm, psm, lispsm, tsm"]),
        ("vsm:1024", &["no technique vsm"]),
        ("psm:2:1024", &["psm:SIZE"]),
        ("psm:1024:stabilize=exact", &["--technique psm", "--stabilize exact"]),
        ("lispsm:1024:warp=tsm", &["--warp tsm", "--technique lispsm"]),
        ("ssm:1024:warp=tsm", &["--warp tsm", "--technique ssm"]),
        ("tsm:1024:tsm-focus=1", &["--tsm-focus"]),
        ("ssm:1024:tsm-focus=0.5", &["--tsm-focus", "--warp tsm"]),
        ("pssm:3:512:warp=tsm/none", &["--warp", "2 warps", "3"]),
        ("pssm:3:512:warp=trapeze", &["--warp", "lispsm"]),
        ("pssm:3:512:warp=tsm:stabilize=exact", &["--warp tsm", "--stabilize exact"]),
        ("magic:1024", &["no technique magic"]),
    ] {
        let message = technique(text, "").expect_err(text).to_string();
        assert!(message.contains(text), "{text}: {message}");
        for culprit in culprits {
            assert!(message.contains(culprit), "{text}: the message does not name {culprit:?}\n{message}");
        }
    }
    for (with, culprit) in
        [("map-size=512", "map-size"), ("hard", "\"hard\""), ("label=x", "label"), ("filter=x", "--filter")]
    {
        let message = technique("ssm:64", with).expect_err(with).to_string();
        assert!(message.contains(culprit), "{with}: {message}");
    }
}

#[test]
fn a_planned_kind_is_told_from_a_mistake() {
    let rejected = |text: &str| parse(text).expect("a source").finish(&Vec::new(), None).expect_err(text);
    assert!(matches!(rejected("sdsm:64"), Rejected::NotBuilt(_)));
    assert!(matches!(rejected("magic:64"), Rejected::Wrong(_)));
}

#[test]
fn names_are_told_apart() {
    let sources = [parse("ssm:64").expect("one"), parse("ssm:64").expect("two"), parse("ssm:64").expect("three")];
    let labels: Vec<String> =
        finish(&sources, &Vec::new(), None).expect("three").into_iter().map(|technique| technique.label).collect();
    assert_eq!(labels, ["SSM(64²)", "SSM(64²) #2", "SSM(64²) #3"]);
}

#[test]
fn files_say_the_same() {
    let text = r#"
        [with]
        filter = "hard"
        blend = 0

        [[technique]]
        technique = "pssm"
        map-size = [1024, 512]
        lambda = 0.9
        label = "ours"

        [[technique]]
        technique = "ssm"
        map-size = 256
        filter = "pcf2"
    "#;
    let (with, sources) = parse_file("t.toml", text).expect("a good file");
    let techniques = finish(&sources, &with, Some((1.0, 90.0))).expect("two techniques");
    assert_eq!(techniques[0].shadows.config.map_sizes, [1024, 512]);
    assert_eq!(techniques[0].shadows.config.filter, Filter::Hard);
    assert_eq!(techniques[0].shadows.config.range, Range::Metres { near: 1.0, far: 90.0 });
    assert_eq!((techniques[0].label.as_str(), techniques[1].label.as_str()), ("ours", "SSM(256²) pcf2"));
    assert_eq!(techniques[1].shadows.config.filter, Filter::Pcf2);

    for (text, culprit) in [
        ("[[technique", "is not valid TOML"),
        ("", "[[technique]]"),
        ("technique = 3", "[[technique]]"),
        ("with = 3\n[[technique]]\ntechnique='ssm'", "with"),
        ("[with]\nsplits = 3\n[[technique]]\ntechnique='ssm'", "splits"),
        ("[[technique]]\nsplits = 3", "technique 1"),
        ("[[technique]]\ntechnique = 'ssm'\nmap-size = true", "map-size"),
        ("[other]\n[[technique]]\ntechnique = 'ssm'", "other"),
    ] {
        let message = parse_file("t.toml", text).expect_err(text).to_string();
        assert!(message.contains("t.toml") && message.contains(culprit), "{text}: {message}");
    }
    let (with, sources) = parse_file("t.toml", "[[technique]]\ntechnique='ssm'\nlambda=7").expect("sources");
    let message = Failure::from(finish(&sources, &with, None).expect_err("lambda")).to_string();
    assert!(message.contains("t.toml, technique 1") && message.contains("--lambda"), "{message}");
    let message = load(Path::new("no/such.toml")).expect_err("missing").to_string();
    assert!(message.contains("no/such.toml"), "{message}");
}

#[test]
fn each_filter_is_one_technique() {
    let texts = ["ssm:64".to_owned(), "pssm:4:64:filter=each:blend=0".to_owned()];
    let techniques = parse_all(&texts, "").expect("techniques");
    let labels: Vec<&str> = techniques.iter().skip(1).map(|technique| technique.label.as_str()).collect();
    assert_eq!(labels, Filter::ALL.map(|filter| filter.word()));
    for (technique, filter) in techniques.iter().skip(1).zip(Filter::ALL) {
        assert_eq!(technique.shadows.config.filter, filter);
    }
    assert_eq!(each("pssm:4:64:filter=each:label=a")[1], "pssm:4:64:filter=pcf2:label=a");
    assert_eq!(each("pssm:4:64:filter=hard"), ["pssm:4:64:filter=hard"]);
}
