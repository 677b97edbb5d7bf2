//! Plans are the same bit for bit in every run, on any number of threads, by every system's
//! mathematical functions: they are compared with recorded ones.
//!
//! `UMBRAGE_BLESS=1 cargo test -p umbrage --test reproducible` records them again. A change of a
//! recorded plan is a change of every picture that is drawn with it.

use std::fmt::Write as _;

use umbrage::config::{LightKind, Preset};
use umbrage::glam::DVec3;
use umbrage::{
    Aabb, Caster, CasterSet, DirectionalLight, Frustum, Light, Motion, PlanInputs, Planner, PlannerOptions, PointLight,
    ShadowConfig, ShadowPlan, SpotLight, View,
};

const RECORDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/plans.txt");

/// Frames of a walk: enough for held values to grow, shrink and be recovered.
const FRAMES: u32 = 24;

/// A preset, and settings over it.
const CONFIGS: [(Preset, &str); 15] = [
    (Preset::Fast, ""),
    (Preset::Balanced, ""),
    (Preset::Exact, ""),
    (Preset::Sharp, ""),
    (Preset::Still, ""),
    (Preset::Papers, ""),
    (Preset::Papers, "scheme=log range-fit=visible"),
    (Preset::Papers, "scheme=uniform fit=independent"),
    (Preset::Papers, "scheme=optimal bands=radial transition=dither"),
    (Preset::Papers, "stabilize=approximate extent-levels=64"),
    (Preset::Papers, "technique=psm"),
    (Preset::Papers, "technique=lispsm"),
    (Preset::Papers, "technique=tsm"),
    (Preset::Balanced, "filter=pcss sun-angle=0.53"),
    (Preset::Balanced, "cache=kept drop-small-casters=on"),
];

fn config((preset, settings): (Preset, &str)) -> ShadowConfig {
    let mut config = preset.config();
    let pair = |setting: &str| {
        let (key, value) = setting.split_once('=').expect("key=value");
        (key.to_owned(), value.to_owned())
    };
    config.apply(&settings.split_whitespace().map(pair).collect::<Vec<_>>()).expect("settings that go together");
    config
}

/// Whole numbers that look random, by the linear congruence of Knuth's MMIX.
struct Numbers(u64);

impl Numbers {
    /// 0 to 1, in steps of 2^-20.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 44) as f64 / f64::from(1 << 20)
    }
}

/// A ground of 400 m and houses on it.
fn boxes() -> Vec<Aabb> {
    let mut numbers = Numbers(17);
    let mut boxes = vec![Aabb::new(DVec3::new(-200.0, -0.5, -200.0), DVec3::new(200.0, 0.0, 200.0))];
    boxes.extend((0..60).map(|_| {
        let at = DVec3::new(380.0 * numbers.next() - 190.0, 0.0, 380.0 * numbers.next() - 190.0);
        Aabb::new(at, at + DVec3::new(2.0, 1.0, 2.0) + 9.0 * DVec3::new(numbers.next(), numbers.next(), numbers.next()))
    }));
    boxes
}

/// A camera that walks, turns, and stands still in the last third.
fn view(frame: u32) -> View {
    let t = f64::from(frame.min(2 * FRAMES / 3)) / f64::from(FRAMES);
    let eye = DVec3::new(40.0 * t - 20.0, 1.7 + 3.0 * t, 30.0 - 25.0 * t * t);
    let target = eye + DVec3::new(1.5 * t - 1.0, -0.2, -1.0);
    let frustum = Frustum::perspective(0.9, 1.5, 0.1, 300.0).expect("a lens");
    View::look_at(eye, target, DVec3::Y, frustum).expect("a view")
}

fn lights() -> [(&'static str, Light); 3] {
    let spot = SpotLight::new(DVec3::new(-8.0, 12.0, 18.0), DVec3::new(0.3, -1.0, -0.4), 0.7, 45.0);
    [
        ("sun", DirectionalLight::new(DVec3::new(0.4, -1.0, 0.25)).expect("a sun").into()),
        ("spot", spot.expect("a spot light").into()),
        ("point", PointLight::new(DVec3::new(-6.0, 6.0, 20.0), 30.0).expect("a lamp").into()),
    ]
}

/// The plan of each frame.
fn walk(config: &ShadowConfig, light: Light, mut each: impl FnMut(u32, &ShadowPlan)) {
    let boxes = boxes();
    let mut set = CasterSet::new();
    let casters =
        boxes.iter().zip(0..).map(|(&bounds, key)| Caster { motion: Motion::Static, ..Caster::new(bounds, key) });
    let is_kept = config.cache == umbrage::config::Cache::Kept;
    set.insert_all(casters.filter(|_| is_kept)).expect("boxes");
    let mut planner = Planner::with_options(config, PlannerOptions::default()).expect("a config");
    for frame in 0..FRAMES {
        let view = view(frame);
        let inputs = match is_kept {
            true => PlanInputs::new(&view, light, &set, &set),
            false => PlanInputs::new(&view, light, &boxes, &boxes),
        };
        each(frame, planner.plan_frame(&inputs).expect("a plan"));
    }
}

/// 64 bits that depend on every byte of a text (FNV-1a).
fn digest(text: &str, begin: u64) -> u64 {
    text.bytes().fold(begin, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// What is recorded of a walk: the last plan's maps as text, which is exact (a number is written
/// with as many digits as tell it from its neighbours), and a digest of all plans.
fn record(name: &str, config: &ShadowConfig, light: Light, change: impl Fn(u32, &mut ShadowPlan)) -> String {
    let (mut sum, mut text) = (0xcbf2_9ce4_8422_2325, String::new());
    walk(config, light, |frame, plan| {
        let mut plan = plan.clone();
        change(frame, &mut plan);
        sum = digest(&format!("{plan:?}"), sum);
        if frame + 1 == FRAMES {
            writeln!(text, "{name}\n  planes {:?}", plan.planes).expect("memory");
            for split in &plan.splits {
                writeln!(text, "  {split:?}").expect("memory");
            }
        }
    });
    writeln!(text, "  digest of {FRAMES} plans {sum:016x}").expect("memory");
    text
}

fn records() -> String {
    let [sun, local @ ..] = lights();
    let mut text = String::new();
    for (preset, settings) in CONFIGS {
        let name = format!("{} {settings} {}", preset.word(), sun.0);
        text += &record(&name, &config((preset, settings)), sun.1, |_, _| {});
    }
    for ((name, light), kind) in local.into_iter().zip([LightKind::Spot, LightKind::Point]) {
        for (preset, settings) in [(Preset::Balanced, ""), (Preset::Papers, "splits=2")] {
            let name = format!("{} {settings} {name}", preset.word());
            text += &record(&name, &config((preset, settings)).for_lights(&[kind]).0, light, |_, _| {});
        }
    }
    text
}

/// The first line that differs, of either text.
fn difference(recorded: &str, found: &str) -> Option<(String, String)> {
    let mut lines = (recorded.lines(), found.lines());
    loop {
        match (lines.0.next(), lines.1.next()) {
            (None, None) => return None,
            (recorded, found) if recorded == found => {}
            (recorded, found) => {
                return Some((recorded.unwrap_or_default().to_owned(), found.unwrap_or_default().to_owned()));
            }
        }
    }
}

#[test]
fn plans_are_the_recorded_ones() {
    let found = records();
    if std::env::var_os("UMBRAGE_BLESS").is_some_and(|it| it == "1") {
        std::fs::write(RECORDED, &found).expect("the record can be written");
    }
    let recorded = std::fs::read_to_string(RECORDED).expect("the record");
    if let Some((recorded, found)) = difference(&recorded.replace("\r\n", "\n"), &found) {
        panic!("another plan than was recorded:\n  recorded {recorded}\n  found    {found}");
    }
}

/// The comparison must say no to one bit, in what is written out and in what only the digest tells.
#[test]
fn one_changed_bit_is_seen() {
    let (config, light) = (Preset::Balanced.config(), lights()[0].1);
    let unchanged = record("", &config, light, |_, _| {});
    assert_eq!(difference(&unchanged, &record("", &config, light, |_, _| {})), None);
    let flip = |value: &mut f64| *value = f64::from_bits(value.to_bits() ^ 1);
    let in_text = record("", &config, light, |_, plan| flip(&mut plan.splits[2].texel_m.x));
    let line = difference(&unchanged, &in_text).expect("a bit of the last plan");
    assert!(line.0.starts_with("  Split {"), "{line:?}");
    for changed in [
        record("", &config, light, |frame, plan| plan.splits[0].min_texel.y += f64::from(u8::from(frame == 3))),
        record("", &config, light, |frame, plan| {
            if frame == 7 {
                flip(&mut plan.light_direction.z)
            }
        }),
        record("", &config, light, |frame, plan| {
            if frame == 11 {
                plan.caster_indices[0] ^= 1
            }
        }),
        record("", &config, light, |frame, plan| {
            if frame == 0 {
                plan.fade_begin = -plan.fade_begin
            }
        }),
    ] {
        let line = difference(&unchanged, &changed).expect("a bit of an earlier plan");
        assert!(line.0.starts_with("  digest"), "{line:?}");
    }
}

/// Sets are packed by as many threads as there are.
#[cfg(feature = "rayon")]
#[test]
fn plans_do_not_depend_on_the_number_of_threads() {
    let config = config((Preset::Balanced, "cache=kept"));
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut numbers = Numbers(5);
            let mut set = CasterSet::new();
            let casters = (0..20_000).map(|key| {
                let at = 400.0 * DVec3::new(numbers.next() - 0.5, 0.0, numbers.next() - 0.5);
                Caster::new(Aabb::new(at, at + 2.0 * numbers.next()), key)
            });
            set.insert_all(casters.collect::<Vec<_>>()).expect("boxes");
            set.pack();
            let mut planner = Planner::new(&config).expect("a config");
            let view = view(0);
            let inputs = PlanInputs::new(&view, lights()[0].1, &set, &set);
            format!("{:?}", planner.plan_frame(&inputs).expect("a plan"))
        })
    };
    let one = by(1);
    assert!([2, 3, 7].into_iter().all(|threads| by(threads) == one));
}
