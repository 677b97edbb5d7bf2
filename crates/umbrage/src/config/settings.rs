//! Every choice of a [`ShadowConfig`] as a setting with a key, shared by config files, the command
//! line, reports and a viewer's controls.

use super::given::Wrong;
use super::setting::{Kind, Rebuilds, Setting, Value};
use super::{
    Cache, Coordinates, Crop, DepthFormat, Derivatives, Edges, ExtentSteps, Fallbacks, Filter, FitTo, Range,
    ReceiverBias, Selection, SplitMetric, SplitScheme, Stability, Transition, Translucent,
};
use super::{set, text, words};
use crate::Warp;

/// The setting with this key.
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
        help: "Where the planes between splits are",
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
        help: "The inner planes of the manual scheme: view depths in metres, from near to far",
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
        help: "What the shadowed range is fitted to if no shadow-range is given",
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
        help: "What each map is cropped to; with stabilize exact its depth range and casters alone",
        kind: Kind::Words(Crop::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text.parse().map(|crop| config.crop = crop).map_err(Wrong::from),
        get: |config| word(config.crop.word()),
    },
    Setting {
        key: "selection",
        help: "Which split a point uses: by its depth, or the first map that contains it",
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
        help: "Whether splits end at a view depth (planar) or a distance from the eye (radial)",
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
        help: "How still shadows are while the camera moves",
        kind: Kind::Words(Stability::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: set::stabilize,
        get: |config| word(config.stability.word()),
    },
    Setting {
        key: "extent-steps",
        help: "With stabilize approximate: size steps per doubling; 24 if no preset sets it",
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
        help: "With stabilize approximate: equal size levels, as in the paper, for extent-steps",
        kind: Kind::Count(8, 4096),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, given| set::extent(config, given, ExtentSteps::Levels(text::count(text)?)),
        get: |config| match config.stability {
            Stability::Approximate { steps: ExtentSteps::Levels(count) } => Some(Value::Count(count)),
            _ => None,
        },
    },
    Setting {
        key: "fit-to",
        help: "What planes and maps are fitted to",
        kind: Kind::Words(FitTo::WORDS),
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text.parse().map(|fit_to| config.fit_to = fit_to).map_err(Wrong::from),
        get: |config| word(config.fit_to.word()),
    },
    Setting {
        key: "drop-small-casters",
        help: "Omit casters from maps in which their shadow is smaller than half a texel",
        kind: Kind::Switch,
        rebuilds: Rebuilds::Nothing,
        set: |config, text, _| text::switch(text).map(|on| config.drop_small_casters = on).map_err(Wrong::from),
        get: |config| Some(Value::Switch(config.drop_small_casters)),
    },
    Setting {
        key: "warp",
        help: "The warp of each split's map",
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
        help: "Near share of the slice's depth that gets 80 % of a trapezoidal map; not 0 or 1",
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
        help: "How a map is filtered",
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
        help: "Angular diameter of the sun in degrees, for pcss",
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
        help: "Rotate the disc or pcss kernel per pixel: noise instead of banding",
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
        help: "Depth samples per texel, for moment filters",
        kind: Kind::CountOf(&[1, 4]),
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
        help: "Moment filters: light below this share becomes shadow; more hides leaks",
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
        help: "Moment filters: how the mip level is found at split borders",
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
        key: "edges",
        help: "What decides where a shadow ends",
        kind: Kind::Words(Edges::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: set::edges,
        get: |config| word(config.edges.word()),
    },
    Setting {
        key: "edge-samples",
        help: "Exact edges: positions of a pixel that are decided, for smooth edges",
        kind: Kind::CountOf(&[1, 4, 8]),
        rebuilds: Rebuilds::Pipelines,
        set: set::edge_samples,
        get: |config| config.edges.samples().map(Value::Count),
    },
    Setting {
        key: "fallbacks",
        help: "Whether unsupported features are replaced by supported ones, with a note",
        kind: Kind::Words(Fallbacks::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text.parse().map(|fallbacks| config.fallbacks = fallbacks).map_err(Wrong::from),
        get: |config| word(config.fallbacks.word()),
    },
    Setting {
        key: "transition",
        help: "How neighbouring splits are joined",
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
        help: "Where receivers take the coordinates in a map from",
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
        help: "Where maps are stored",
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
        help: "How surfaces are prevented from shading themselves",
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
        help: "Factor of the sunlight in full shadow: linear red, green, blue",
        kind: Kind::Colour,
        rebuilds: Rebuilds::Nothing,
        set: set::colour,
        get: |config| Some(Value::Numbers(config.look.colour.to_vec())),
    },
    Setting {
        key: "translucent",
        help: "Whether translucent surfaces cast shadows",
        kind: Kind::Words(Translucent::WORDS),
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| {
            text.parse().map(|translucent| config.look.translucent = translucent).map_err(Wrong::from)
        },
        get: |config| word(config.look.translucent.word()),
    },
    Setting {
        key: "contact-shadows",
        help: "Screen-space contact shadows: detail too small for the maps, from the depth buffer",
        kind: Kind::Switch,
        rebuilds: Rebuilds::Pipelines,
        set: |config, text, _| text::switch(text).map(|on| config.look.contact = on).map_err(Wrong::from),
        get: |config| Some(Value::Switch(config.look.contact)),
    },
];
