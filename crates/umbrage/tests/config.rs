//! A config is a value: settings as text and back, rules, presets.
#![cfg(feature = "serde")]

use proptest::prelude::*;
use umbrage::config::{
    Choice, Kind, LightKind, Preset, RENAMED, RULES, Range, Rebuilds, Renamed, SETTINGS, Setting, Stability, Transition,
};
use umbrage::{Error, ShadowConfig};

fn given(text: &str) -> Vec<(String, String)> {
    let pair = |setting: &str| {
        let (key, value) = setting.split_once('=').unwrap_or((setting, "on"));
        (key.to_owned(), value.to_owned())
    };
    text.split_whitespace().map(pair).collect()
}

/// The papers' config with settings over it.
fn config(text: &str) -> Result<ShadowConfig, Error> {
    let mut config = Preset::Papers.config();
    config.apply(&given(text))?;
    Ok(config)
}

#[test]
fn every_preset_is_valid_and_reads_itself_back() {
    for preset in Preset::ALL {
        let config = preset.config();
        assert_eq!(config.validate(), Ok(()), "{preset}");
        let json = serde_json::to_string(&config).unwrap();
        assert_eq!(serde_json::from_str::<ShadowConfig>(&json).unwrap(), config, "{preset}: {json}");
    }
    assert_eq!(ShadowConfig::default(), Preset::Balanced.config());
}

#[test]
fn settings_have_keys_and_help_of_their_own() {
    for (i, setting) in SETTINGS.iter().enumerate() {
        assert!(SETTINGS[..i].iter().all(|other| other.key != setting.key), "{} twice", setting.key);
        assert!(!setting.help.is_empty() && setting.help.len() <= 100, "{}: {}", setting.key, setting.help);
    }
}

#[test]
fn a_part_of_a_choice_chooses_it_unless_another_was_asked_for() {
    assert!(matches!(config("extent-steps=8").unwrap().stability, Stability::Approximate { .. }));
    assert!(config("extent-steps=8 stabilize=exact").is_err());
    assert_eq!(config("planes=5,20").unwrap().splits(), 3);
    assert!(config("lambda=0.9 scheme=log").unwrap_err().to_string().contains("practical"));
    assert!(config("lambda=0.9 planes=5,20,80").is_err());
    assert_eq!(config("warp=tsm").unwrap().stability.word(), "none");
    assert!(config("warp=tsm stabilize=exact").unwrap_err().to_string().contains("follows the camera"));
    assert_eq!(config("technique=ssm map-size=2048").unwrap().map_sizes, [2048]);
    assert!(config("technique=psm splits=3").is_err());
    assert!(config("technique=psm warp=tsm").is_err());
    assert_eq!(config("blend=0").unwrap().transition, Transition::Hard);
    assert_eq!(config("transition=dither blend=0.2").unwrap().transition, Transition::Dither { share: 0.2 });
    assert!(config("shadow-range=1..100 range-fit=visible").is_err());
    assert_eq!(config("shadow-range=1..100").unwrap().range, Range::Metres { near: 1.0, far: 100.0 });
    assert!(config("filter=pcf2 filter-width=0.1").unwrap_err().to_string().contains("no width"));
    assert!(config("splits=3 map-size=1024,512").is_err());
    assert_eq!(
        config("splits=9").unwrap_err().to_string(),
        config("splits=0").unwrap_err().to_string().replace("0 splits", "9 splits")
    );
}

#[test]
fn what_nobody_asked_for_gives_way_with_a_note() {
    let mut config = Preset::Sharp.config();
    let notes = config.apply(&given("warp=tsm")).unwrap();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("selection map is ignored"), "{notes:?}");
    let mut config = Preset::Papers.config();
    assert_eq!(config.apply(&given("storage=reused")).unwrap().len(), 1);
    assert_eq!(config.transition, Transition::Hard);
}

#[test]
fn a_refused_setting_changes_nothing() {
    let before = Preset::Papers.config();
    let mut config = before.clone();
    for bad in ["splits=3 warp=tsm selection=map", "map-size=0", "blend=2", "filter=soft", "lambda=nan", "colour=1,1,1"]
    {
        assert!(config.apply(&given(bad)).is_err(), "{bad}");
        assert_eq!(config, before, "{bad}");
    }
    assert!(matches!(config.apply(&given("no-such-thing=1")), Err(Error::UnknownSetting { .. })));
}

#[test]
fn an_old_word_is_refused_by_the_new_one() {
    for row in RENAMED {
        let old = [(row.key.to_owned(), row.old.to_owned())];
        let new = [(row.key.to_owned(), row.new.to_owned())];
        let mut config = Preset::Papers.config();
        let error = config.apply(&old).unwrap_err();
        assert!(matches!(error, Error::RenamedWord(renamed) if renamed == *row), "{row:?}: {error:?}");
        let message = format!("{} `{}` is now called `{}`", row.key, row.old, row.new);
        assert!(error.to_string().contains(&message), "{error}");
        let json = format!("{{\"{}\": \"{}\"}}", row.key, row.old);
        let refused = serde_json::from_str::<ShadowConfig>(&json).unwrap_err().to_string();
        assert!(refused.contains(&message), "{refused}");
        assert_eq!(config.apply(&new).map(|_| ()), Ok(()), "{row:?}");
        let setting = SETTINGS.iter().find(|setting| setting.key == row.key).unwrap();
        assert_eq!((setting.check(row.new), setting.check(row.old)), (Ok(()), Err(message)), "{row:?}");
    }
    assert!(Renamed::find("scheme", "optimal").is_none() && Renamed::find("filter", "fitted").is_none());
}

/// Makes a choice without breaking any rule of its own making.
fn choose(choice: Choice) -> (&'static str, &'static [LightKind]) {
    let sun = &[LightKind::Directional];
    match choice {
        Choice::Warp => ("warp=tsm", sun),
        Choice::AllWarped => ("warp=lispsm", sun),
        Choice::SmallCasters => ("drop-small-casters=on", sun),
        Choice::MapSelection => ("selection=map", sun),
        Choice::DistanceMetric => ("bands=radial", sun),
        Choice::VisibleRange => ("range-fit=visible", sun),
        Choice::OptimalScheme => ("scheme=optimal", sun),
        Choice::Band => ("blend=0.1", sun),
        Choice::MomentFilter => ("filter=msm", sun),
        Choice::SunFilter => ("filter=pcss", sun),
        Choice::OtherThanPcf3 => ("filter=pcf5", sun),
        Choice::ExactEdges => ("edges=exact", sun),
        Choice::SeveralSamples => ("filter=msm msaa=4", sun),
        Choice::ColourMaps => ("depth-format=r32f", sun),
        Choice::TiledLayers => ("generation=mixed", sun),
        Choice::OneMap => ("storage=reused", sun),
        Choice::NotLayers => ("storage=atlas", sun),
        Choice::NotPerSplit => ("generation=layered", sun),
        Choice::CubeFaces => ("storage=cube", sun),
        Choice::MoreThanSixSplits => ("splits=7", sun),
        Choice::UnequalSizes => ("map-size=1024,512,512,256", sun),
        Choice::NotStill => ("stabilize=none", sun),
        Choice::ExactlyStill => ("stabilize=exact", sun),
        Choice::OtherDepth => ("depth-format=d16", sun),
        Choice::KeptMaps => ("cache=kept", sun),
        Choice::DeferredCoordinates => ("coordinates=deferred", sun),
        Choice::VertexCoordinates => ("coordinates=split", sun),
        Choice::MoreThanFourSplits => ("splits=5", sun),
        Choice::LocalLight => ("", &[LightKind::Spot]),
        Choice::SeveralFaces => ("", &[LightKind::Directional, LightKind::Directional]),
        Choice::FitToDepth => ("fit-to=depth", sun),
        Choice::IntervalSelection => ("selection=depth", sun),
        Choice::SliceCrop => ("fit=independent", sun),
        other => panic!("{other:?} is not chosen by anything here"),
    }
}

#[test]
fn every_pair_of_choices_is_refused_exactly_where_a_rule_says_so() {
    for first in Choice::ALL {
        for second in Choice::ALL {
            let ((a, lights), (b, more)) = (choose(first), choose(second));
            let of_one_key = |choice: Choice| choose(choice).0.split('=').next();
            if first == second || (of_one_key(first) == of_one_key(second) && !a.is_empty()) {
                continue;
            }
            let lights = if more.len() > lights.len() || more[0] != LightKind::Directional { more } else { lights };
            let mut config = Preset::Papers.config();
            let applied = config.apply(&given(&format!("{a} {b}")));
            let told = match applied {
                Ok(_) => config.validate_for(lights).err(),
                Err(error) => Some(error),
            };
            let holds = |choice: Choice| match &told {
                // What was refused is not in the config: by what was asked for.
                Some(Error::Conflict(conflict)) => conflict.rule.first == choice || conflict.rule.second == choice,
                _ => false,
            };
            let ruled = RULES.iter().any(|rule| {
                (rule.first == first && rule.second == second) || (rule.first == second && rule.second == first)
            });
            let is_by_type = |first, second| {
                matches!(
                    (first, second),
                    (Choice::MapSelection | Choice::FitToDepth, Choice::DistanceMetric)
                        | (Choice::OneMap | Choice::NotLayers, Choice::NotPerSplit | Choice::TiledLayers)
                        | (Choice::CubeFaces, Choice::TiledLayers)
                        | (Choice::Warp | Choice::AllWarped, Choice::ExactlyStill)
                        | (Choice::MoreThanSixSplits | Choice::MoreThanFourSplits, Choice::UnequalSizes)
                )
            };
            let by_type = is_by_type(first, second) || is_by_type(second, first);
            if ruled {
                let error = told.clone().unwrap_or_else(|| panic!("{a} {b} {lights:?} is accepted"));
                let text = error.to_string();
                assert!(holds(first) && holds(second), "{first:?} {second:?}: {text}");
                assert!(text.contains(" exclude each other: "), "{text}");
            } else if by_type {
                // No value makes both choices: who asks for both is told, and gets neither.
                let error = told.clone().unwrap_or_else(|| panic!("{a} {b} {lights:?} is accepted"));
                assert!(config == Preset::Papers.config(), "{first:?} {second:?}: {error}");
                let keys =
                    [first, second].map(|choice| choice.keys().iter().any(|key| error.to_string().contains(key)));
                assert_eq!(keys, [true; 2], "{first:?} {second:?}: {error}");
            } else {
                let implied = |choice: Choice, other: Choice| {
                    RULES.iter().any(|rule| {
                        let (one, two) = (rule.first, rule.second);
                        let also = |c: Choice| c == choice || choice.holds_with(c);
                        (also(one) && (two == other || other.holds_with(two)))
                            || (also(two) && (one == other || other.holds_with(one)))
                    })
                };
                assert_eq!(told.is_some(), implied(first, second), "{first:?} {second:?}: {told:?}");
            }
        }
    }
}

/// Choices that come along with another.
trait HoldsWith {
    fn holds_with(self, other: Choice) -> bool;
}

impl HoldsWith for Choice {
    fn holds_with(self, other: Choice) -> bool {
        let (settings, lights) = choose(self);
        let mut config = Preset::Papers.config();
        config.transition = Transition::Hard;
        // What nobody chose is given up for what somebody did.
        let is_chosen = !other.holds(&config, &[LightKind::Directional]);
        config.apply(&given(settings)).unwrap();
        is_chosen && other.holds(&config, lights)
    }
}

#[test]
fn the_default_serves_every_kind_of_light() {
    for preset in Preset::ALL {
        for lights in [&[LightKind::Spot][..], &[LightKind::Point], &[LightKind::Directional, LightKind::Point]] {
            let (config, _) = preset.config().for_lights(lights);
            assert_eq!(config.validate_for(lights), Ok(()), "{preset} {lights:?}");
        }
    }
}

#[test]
fn a_lamp_beside_a_sun_leaves_the_suns_choices_alone() {
    let lights = [LightKind::Directional, LightKind::Point];
    let sharp = Preset::Sharp.config();
    assert!(matches!(sharp.validate_for(&lights), Err(Error::Conflict(_))));
    assert_eq!(sharp.validate_shared(&lights), Ok(()));
    let (of_sun, none) = sharp.for_light(LightKind::Directional);
    assert!(of_sun == sharp && none.is_empty());
    let (of_lamp, notes) = sharp.for_light(LightKind::Point);
    assert_eq!(of_lamp.validate_for(&[LightKind::Point]), Ok(()));
    // Sharp's planes and selection are the default's, and what the default chose was chosen by
    // nobody.
    assert!(of_lamp != sharp && notes.is_empty(), "{notes:?}");
    let (_, notes) = config("warp=tsm").unwrap().for_light(LightKind::Point);
    let [note] = &notes[..] else { panic!("{notes:?}") };
    assert!(note.contains("is ignored for a spot or point light"), "{note}");
    // What all maps share is no light's own.
    for shared in ["filter=pcss", "filter=vsm", "storage=atlas", "coordinates=split"] {
        let told = config(shared).unwrap().validate_shared(&lights);
        assert!(matches!(told, Err(Error::Conflict(_))), "{shared}: {told:?}");
    }
}

#[test]
fn a_change_is_as_large_as_its_largest_setting() {
    let papers = Preset::Papers.config();
    assert_eq!(papers.rebuilds(&papers), None);
    let to = |settings: &str| papers.rebuilds(&config(settings).unwrap());
    assert_eq!(to("shadow-strength=0.5"), Some((Rebuilds::Nothing, "shadow-strength")));
    assert_eq!(to("shadow-strength=0.5 map-size=512"), Some((Rebuilds::Maps, "map-size")));
    assert_eq!(to("shadow-strength=0.5 map-size=512 storage=atlas"), Some((Rebuilds::Pipelines, "storage")));
}

/// A value of a setting, awkward ones included.
fn value(setting: &'static Setting) -> BoxedStrategy<String> {
    match setting.kind {
        Kind::Words(words) | Kind::WordList(words) => {
            (0..words.len()).prop_map(move |i| words[i].word.to_owned()).boxed()
        }
        Kind::Share(most) | Kind::Degrees(most) => (0.0..=most).prop_map(|share| share.to_string()).boxed(),
        Kind::Metres => (1e-3..1e3).prop_map(|metres: f64| metres.to_string()).boxed(),
        Kind::MetresList => proptest::collection::vec(1e-3..1e3, 1..4)
            .prop_map(|mut metres: Vec<f64>| {
                metres.sort_by(f64::total_cmp);
                metres.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
            })
            .boxed(),
        Kind::Range => (1e-3..10.0, 11.0..1e5).prop_map(|(near, far)| format!("{near}..{far}")).boxed(),
        Kind::Count(least, most) => (least..=most).prop_map(|count| count.to_string()).boxed(),
        Kind::CountOf(counts) => (0..counts.len()).prop_map(move |i| counts[i].to_string()).boxed(),
        Kind::Texels => (64u32..4096).prop_map(|texels| texels.to_string()).boxed(),
        Kind::Colour => [0.0..=1.0, 0.0..=1.0, 0.0..=1.0]
            .prop_map(|parts: [f64; 3]| parts.map(|part| part.to_string()).join(","))
            .boxed(),
        Kind::Switch => (0..4usize).prop_map(|i| ["on", "off", "true", "false"][i].to_owned()).boxed(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever is accepted is valid, and its own settings make it again, through JSON and TOML.
    #[test]
    fn accepted_settings_are_valid_and_come_back(
        preset in 0..Preset::ALL.len(),
        chosen in proptest::collection::btree_set(0..SETTINGS.len(), 0..6)
            .prop_flat_map(|keys| {
                keys.into_iter()
                    .map(|i| value(&SETTINGS[i]).prop_map(move |value| (SETTINGS[i].key.to_owned(), value)))
                    .collect::<Vec<_>>()
            }),
    ) {
        let mut config = Preset::ALL[preset].config();
        if config.apply(&chosen).is_ok() {
            prop_assert_eq!(config.validate(), Ok(()));
            let json = serde_json::to_string(&config).unwrap();
            prop_assert_eq!(serde_json::from_str::<ShadowConfig>(&json).unwrap(), config);
        }
    }
}

#[test]
fn a_value_is_checked_alone_before_it_is_applied() {
    let bad = [
        ("scheme", "even"),
        ("blend", "1.5"),
        ("blend", "nan"),
        ("splits", "0"),
        ("splits", "2.5"),
        ("map-size", "512,,256"),
        ("shadow-range", "5..1"),
        ("shadow-range", "1..inf"),
        ("filter-width", "0"),
        ("planes", "5,x"),
        ("shadow-colour", "0,0"),
        ("shadow-colour", "0,0,1.01"),
        ("warp", "tsm,"),
        ("rotate-kernel", "maybe"),
        ("msaa", "2"),
        ("sun-angle", "90.5"),
    ];
    for (key, value) in bad {
        let setting = SETTINGS.iter().find(|setting| setting.key == key).unwrap();
        assert!(setting.check(value).is_err(), "{key} {value}");
    }
    for preset in Preset::ALL {
        for (key, value) in preset.config().settings() {
            let setting = SETTINGS.iter().find(|setting| setting.key == key).unwrap();
            assert_eq!(setting.check(&value.to_string()), Ok(()), "{key} {value}");
        }
    }
}
