//! Every choice of a [`ShadowConfig`] as a setting with a key: what config files, the command line,
//! reports and a viewer's controls share.

use super::given::Wrong;
use super::setting::{Kind, Rebuilds, Setting, Value};
use super::{
    Cache, Coordinates, Crop, DepthFormat, Derivatives, ExtentSteps, Fallbacks, Filter, Range, ReceiverBias, Selection,
    SplitMetric, SplitScheme, Stability, Transition, Translucent,
};
use super::{set, text, words};
use crate::Warp;

/// The setting of this key.
pub(super) fn find(key: &str) -> Option<&'static Setting> {
    SETTINGS.iter().find(|setting| setting.key == key)
}

fn word(word: &'static str) -> Option<Value> {
    Some(Value::Word(word.to_owned()))
}

/// All settings, in the order in which they are applied.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "technique",
        help: "How the shadow maps share the view",
        kind: Kind::Words(words::TECHNIQUES),
        rebuilds: Rebuilds::Pipelines,
        set: |config, _, given| set::shape(config, given),
        get: |config| {
            word(match (config.splits(), config.warp(0)) {
                (1, Warp::None) => "ssm",
                (1, warp) => warp.word(),
                _ => "pssm",
            })
        },
    },
    Setting {
        key: "splits",
        help: "Number of splits (cascades)",
        kind: Kind::Count(1, crate::MAX_SPLITS as u32),
        rebuilds: Rebuilds::Pipelines,
        set: |config, _, given| set::shape(config, given),
        get: |config| Some(Value::Count(config.splits() as u32)),
    },
    Setting {
        key: "map-size",
        help: "Edge of each map in texels: one size, or one per split",
        kind: Kind::Texels,
        rebuilds: Rebuilds::Maps,
        set: |config, _, given| set::shape(config, given),
        get: |config| Some(Value::Counts(config.map_sizes.clone())),
    },
    Setting {
        key: "scheme",
        help: "Where the planes between splits stand",
        kind: Kind::Words(SplitScheme::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: set::scheme,
        get: |config| word(config.scheme.word()),
    },
    Setting {
        key: "lambda",
        help: "Share of the logarithmic scheme in the practical one",
        kind: Kind::Share(1.0),
        rebuilds: Rebuilds::Nothing,
        set: set::lambda,
        get: |config| match config.scheme {
            SplitScheme::Practical { lambda, .. } => Some(Value::Number(lambda)),
            _ => None,
        },
    },
    Setting {
        key: "delta",
        help: "Metres added to the inner planes of the practical scheme: one for all, or one for each",
        kind: Kind::MetresList,
        rebuilds: Rebuilds::Nothing,
        set: set::delta,
        get: |config| match &config.scheme {
            SplitScheme::Practical { delta, .. } if !delta.is_empty() => Some(Value::Numbers(delta.clone())),
            _ => None,
        },
    },
    Setting {
        key: "planes",
        help: "The inner planes of the manual scheme: view depths in metres, rising",
        kind: Kind::MetresList,
        rebuilds: Rebuilds::Nothing,
        set: set::planes,
        get: |config| match &config.scheme {
            SplitScheme::Manual { planes } if !planes.is_empty() => Some(Value::Numbers(planes.clone())),
            _ => None,
        },
    },
    Setting {
        key: "range-fit",
        help: "What the shadowed range is fitted to where no shadow-range is given",
        kind: Kind::Words(words::RANGE_FITS),
        rebuilds: Rebuilds::Nothing,
        set: set::range_fit,
        get: |config| match config.range {
            Range::Camera => word("camera"),
            Range::Visible => word("visible"),
            Range::Metres { .. } => None,
        },
    },
    Setting {
        key: "shadow-range",
        help: "View depths in metres that shadows cover",
        kind: Kind::Range,
        rebuilds: Rebuilds::Nothing,
        set: set::shadow_range,
        get: |config| match config.range {
            Range::Metres { near, far } => Some(Value::Word(format!("{near}..{far}"))),
            Range::Camera | Range::Visible => None,
        },
    },
    Setting {
        key: "fit",
        help: "What each map is cropped to",
        kind: Kind::Words(Crop::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text.parse().map(|crop| config.crop = crop).map_err(Wrong::from),
        get: |config| word(config.crop.word()),
    },
    Setting {
        key: "selection",
        help: "Which map answers for a point",
        kind: Kind::Words(words::SELECTIONS),
        rebuilds: Rebuilds::Pipelines,
        set: set::selection,
        get: |config| {
            word(match config.selection {
                Selection::Interval(_) => "depth",
                Selection::Map => "map",
            })
        },
    },
    Setting {
        key: "bands",
        help: "What the planes between splits measure",
        kind: Kind::Words(SplitMetric::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: set::bands,
        get: |config| match config.selection {
            Selection::Interval(metric) => word(metric.word()),
            Selection::Map => None,
        },
    },
    Setting {
        key: "stabilize",
        help: "Whether shadows stand still while the camera moves",
        kind: Kind::Words(Stability::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: set::stabilize,
        get: |config| word(config.stability.word()),
    },
    Setting {
        key: "extent-steps",
        help: "Approximately stable maps: steps to a doubling of a map's extent",
        kind: Kind::Count(4, 64),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, given| set::extent(config, given, ExtentSteps::PerDoubling(text::count(text)?)),
        get: |config| match config.stability {
            Stability::Approximate { steps: ExtentSteps::PerDoubling(count) } => Some(Value::Count(count)),
            _ => None,
        },
    },
    Setting {
        key: "extent-levels",
        help: "Approximately stable maps: equal steps of so many to the whole range instead",
        kind: Kind::Count(8, 4096),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, given| set::extent(config, given, ExtentSteps::Levels(text::count(text)?)),
        get: |config| match config.stability {
            Stability::Approximate { steps: ExtentSteps::Levels(count) } => Some(Value::Count(count)),
            _ => None,
        },
    },
    Setting {
        key: "drop-small-casters",
        help: "Whether casters are left out of a map in which their whole shadow is under half a texel",
        kind: Kind::Words(super::look::SWITCH),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text::switch(text).map(|on| config.drop_small_casters = on).map_err(Wrong::from),
        get: |config| word(if config.drop_small_casters { "on" } else { "off" }),
    },
    Setting {
        key: "warp",
        help: "How each split's map spreads its texels: one, or one per split",
        kind: Kind::WordList(Warp::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: set::warp,
        get: |config| match &config.stability {
            Stability::Tight { warps } if !warps.is_empty() => {
                Some(Value::Word(warps.iter().map(|warp| warp.word()).collect::<Vec<_>>().join(",")))
            }
            _ => None,
        },
    },
    Setting {
        key: "tsm-focus",
        help: "Share of the depth range that trapezoidal maps give four fifths of their texels",
        kind: Kind::Share(1.0),
        rebuilds: Rebuilds::Nothing,
        set: set::tsm_focus,
        get: |config| match &config.stability {
            Stability::Tight { warps } => warps.iter().find_map(|warp| match *warp {
                Warp::Tsm { focus } => Some(Value::Number(focus)),
                _ => None,
            }),
            _ => None,
        },
    },
    Setting {
        key: "filter",
        help: "How a map is looked up",
        kind: Kind::Words(Filter::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text.parse().map(|filter| config.filter = filter).map_err(Wrong::from),
        get: |config| word(config.filter.word()),
    },
    Setting {
        key: "filter-width",
        help: "Full width of the filter in metres, equal in every split",
        kind: Kind::Metres,
        rebuilds: Rebuilds::Nothing,
        set: set::filter_width,
        get: |config| config.filter.width_m().map(Value::Number),
    },
    Setting {
        key: "sun-angle",
        help: "Angle across the sun in degrees, for pcss",
        kind: Kind::Degrees(90.0),
        rebuilds: Rebuilds::Nothing,
        set: set::sun_angle,
        get: |config| match config.filter {
            Filter::Pcss { sun_degrees, .. } => Some(Value::Number(sun_degrees)),
            _ => None,
        },
    },
    Setting {
        key: "rotate-kernel",
        help: "Rotates the kernel of disc and pcss from pixel to pixel: noise instead of bands",
        kind: Kind::Switch,
        rebuilds: Rebuilds::Nothing,
        set: set::rotate_kernel,
        get: |config| match config.filter {
            Filter::Disc { rotated, .. } | Filter::Pcss { rotated, .. } => Some(Value::Switch(rotated)),
            _ => None,
        },
    },
    Setting {
        key: "msaa",
        help: "Samples of depth in a texel, for esm to msm: 1 or 4",
        kind: Kind::Count(1, 4),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| {
            set::moments(config, "msaa")?.samples = text::count(text)?;
            Ok(())
        },
        get: |config| match config.filter {
            Filter::Moments(moments) => Some(Value::Count(moments.samples)),
            _ => None,
        },
    },
    Setting {
        key: "bleeding",
        help: "Share of light that esm to msm take for a leak",
        kind: Kind::Share(0.9),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| {
            set::moments(config, "bleeding")?.bleeding = text::number(text)?;
            Ok(())
        },
        get: |config| match config.filter {
            Filter::Moments(moments) => Some(Value::Number(moments.bleeding)),
            _ => None,
        },
    },
    Setting {
        key: "derivatives",
        help: "How esm to msm know what a pixel covers where splits meet",
        kind: Kind::Words(Derivatives::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| {
            set::moments(config, "derivatives")?.derivatives = text.parse()?;
            Ok(())
        },
        get: |config| match config.filter {
            Filter::Moments(moments) => word(moments.derivatives.word()),
            _ => None,
        },
    },
    Setting {
        key: "fallbacks",
        help: "Whether what the device lacks is replaced",
        kind: Kind::Words(Fallbacks::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text.parse().map(|fallbacks| config.fallbacks = fallbacks).map_err(Wrong::from),
        get: |config| word(config.fallbacks.word()),
    },
    Setting {
        key: "transition",
        help: "How one split goes over into the next",
        kind: Kind::Words(words::TRANSITIONS),
        rebuilds: Rebuilds::Pipelines,
        set: set::transition,
        get: |config| {
            word(match config.transition {
                Transition::Hard => "hard",
                Transition::Blend { .. } => "blend",
                Transition::Dither { .. } => "dither",
            })
        },
    },
    Setting {
        key: "blend",
        help: "Share of each split over which it blends into the next; 0 is off",
        kind: Kind::Share(1.0),
        rebuilds: Rebuilds::Nothing,
        set: set::blend,
        get: |config| Some(Value::Number(config.transition.share())),
    },
    Setting {
        key: "far-fade",
        help: "Share of the shadowed range over which shadows fade out at its far end; 0 is off",
        kind: Kind::Share(1.0),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text::number(text).map(|share| config.far_fade = share).map_err(Wrong::from),
        get: |config| Some(Value::Number(config.far_fade)),
    },
    Setting {
        key: "coordinates",
        help: "Where receivers take a map's coordinates from",
        kind: Kind::Words(Coordinates::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text.parse().map(|coordinates| config.coordinates = coordinates).map_err(Wrong::from),
        get: |config| word(config.coordinates.word()),
    },
    Setting {
        key: "depth-format",
        help: "What a map stores",
        kind: Kind::Words(DepthFormat::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text.parse().map(|format| config.depth_format = format).map_err(Wrong::from),
        get: |config| word(config.depth_format.word()),
    },
    Setting {
        key: "generation",
        help: "How maps are drawn",
        kind: Kind::Words(words::GENERATIONS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, _, given| set::layout(config, given),
        get: |config| word(config.layout.generation().word()),
    },
    Setting {
        key: "storage",
        help: "Where maps are kept",
        kind: Kind::Words(words::STORAGES),
        rebuilds: Rebuilds::Pipelines,
        set: |config, _, given| set::layout(config, given),
        get: |config| word(config.layout.storage().word()),
    },
    Setting {
        key: "cache",
        help: "Whether what static casters draw into a sun's maps is kept from frame to frame",
        kind: Kind::Words(Cache::WORDS),
        rebuilds: Rebuilds::Maps,
        set: |config, text, _| text.parse().map(|cache| config.cache = cache).map_err(Wrong::from),
        get: |config| word(config.cache.word()),
    },
    Setting {
        key: "bias",
        help: "How surfaces are kept from shading themselves",
        kind: Kind::Words(ReceiverBias::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text.parse().map(|bias| config.look.bias = bias).map_err(Wrong::from),
        get: |config| word(config.look.bias.word()),
    },
    Setting {
        key: "shadow-strength",
        help: "How dark shadows are, 0 (not at all) to 1 (no sun)",
        kind: Kind::Share(1.0),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text::number(text).map(|strength| config.look.strength = strength).map_err(Wrong::from),
        get: |config| Some(Value::Number(config.look.strength)),
    },
    Setting {
        key: "shadow-colour",
        help: "Factor of the sun's light in full shadow: linear red, green, blue",
        kind: Kind::Colour,
        rebuilds: Rebuilds::Nothing,
        set: set::colour,
        get: |config| Some(Value::Numbers(config.look.colour.to_vec())),
    },
    Setting {
        key: "translucent",
        help: "Whether translucent surfaces throw shadows",
        kind: Kind::Words(Translucent::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| {
            text.parse().map(|translucent| config.look.translucent = translucent).map_err(Wrong::from)
        },
        get: |config| word(config.look.translucent.word()),
    },
    Setting {
        key: "contact-shadows",
        help: "Whether the picture's own depth is searched for casters too close for the maps",
        kind: Kind::Words(super::look::SWITCH),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text::switch(text).map(|on| config.look.contact = on).map_err(Wrong::from),
        get: |config| word(if config.look.contact { "on" } else { "off" }),
    },
];
