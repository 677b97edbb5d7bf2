//! Effect of each key's value on a config, given all other keys.

use super::given::{Given, Wrong, refuse, refuse_other};
use super::names::unknown;
use super::text::{count, map_sizes, number, numbers, range, switch};
use super::{
    Edges, ExtentSteps, Filter, Generation, Layout, Moments, Range, Selection, ShadowConfig, SplitMetric, SplitScheme,
    Stability, Storage, Transition, words,
};
use crate::{MAX_SPLITS, Warp};

/// Share of a split that blends if no share is given.
const USUAL_BLEND: f64 = 0.1;

/// Checks a word against the list of its key.
fn known(key: &str, text: &str) -> Result<(), String> {
    let words = words::WORDS.iter().find(|(listed, _)| *listed == key).map_or(&[][..], |(_, words)| words);
    if words.iter().any(|word| word.word == text) { Ok(()) } else { Err(unknown(key, text, words)) }
}

/// Number and sizes of maps, from `technique`, `splits`, `map-size` and `planes` together.
pub(super) fn shape(config: &mut ShadowConfig, given: &Given<'_>) -> Result<(), Wrong> {
    let single = single_map(given)?;
    let typed = match given.value("map-size").map(map_sizes).transpose() {
        Ok(typed) => typed,
        Err(reason) => return refuse_other("map-size", reason),
    };
    let (key, splits) = split_count(config, given, single, typed.as_deref())?;
    if !(1..=MAX_SPLITS).contains(&splits) {
        return refuse_other(key, format!("{splits} splits are not possible; give 1 to {MAX_SPLITS}"));
    }
    let sizes = typed.unwrap_or_else(|| config.map_sizes.clone());
    config.map_sizes = match sizes[..] {
        [edge] => vec![edge; splits],
        _ if sizes.len() == splits => sizes,
        [edge, ..] if !given.has("map-size") && sizes.iter().all(|size| *size == edge) => vec![edge; splits],
        _ => {
            let (maps, there) = (sizes.len(), if splits == 1 { "is 1 split" } else { "are" });
            let there = if splits == 1 { there.to_owned() } else { format!("{there} {splits} splits") };
            return refuse_other(
                "map-size",
                format!("lists {maps} maps, but there {there}; give one size, or one for each split"),
            );
        }
    };
    let Some(single) = single else { return Ok(()) };
    let warp = single.parse::<Warp>().unwrap_or(Warp::None);
    if let Some(other) = given.value("warp").filter(|other| *other != warp.word()) {
        return refuse(format!(
            "technique {single} already sets the warp, so warp {other} conflicts with it; omit warp, \
             or use technique pssm with splits 1"
        ));
    }
    if warp != Warp::None {
        set_warps(config, given, vec![warp], &format!("technique {single}"))
    } else {
        if config.first_warp().is_some() {
            config.stability = Stability::tight();
        }
        Ok(())
    }
}

/// The technique, if it is one map over the whole range.
fn single_map<'a>(given: &Given<'a>) -> Result<Option<&'a str>, Wrong> {
    let Some(technique) = given.value("technique").map(str::trim) else { return Ok(None) };
    known("technique", technique)?;
    Ok(Some(technique).filter(|technique| *technique != "pssm"))
}

/// The number of splits, and the setting that determines it.
fn split_count(
    config: &ShadowConfig,
    given: &Given<'_>,
    single: Option<&str>,
    sizes: Option<&[u32]>,
) -> Result<(&'static str, usize), Wrong> {
    let typed = match given.value("splits").map(count).transpose() {
        Ok(typed) => typed,
        Err(reason) => return refuse_other("splits", reason),
    };
    Ok(match (typed, single) {
        (Some(splits), Some(single)) if splits != 1 => {
            return refuse_other(
                "splits",
                format!("technique {single} is one map over the whole range; omit splits, or use technique pssm"),
            );
        }
        (Some(splits), _) => ("splits", splits as usize),
        (None, Some(_)) => ("technique", 1),
        (None, None) => match (sizes, given.value("planes")) {
            (Some(sizes), _) if sizes.len() > 1 => ("map-size", sizes.len()),
            (_, Some(planes)) => ("planes", planes.split(',').count() + 1),
            _ => ("splits", config.splits()),
        },
    })
}

pub(super) fn scheme(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    if config.scheme.word() == text {
        return Ok(());
    }
    config.scheme = match text {
        "uniform" => SplitScheme::Uniform,
        "log" => SplitScheme::Logarithmic,
        "practical" => SplitScheme::practical(),
        "optimal" => SplitScheme::Optimal,
        "manual" if given.has("planes") || config.splits() == 1 => SplitScheme::Manual { planes: Vec::new() },
        "manual" => {
            let (inner, splits) = (config.splits() - 1, config.splits());
            return refuse(format!("scheme manual needs planes A,B,…: the {inner} planes between {splits} splits"));
        }
        _ => return refuse(unknown("scheme", text, SplitScheme::WORDS)),
    };
    Ok(())
}

/// The practical scheme, to which `key` applies.
fn practical<'a>(
    config: &'a mut ShadowConfig,
    given: &Given<'_>,
    key: &str,
) -> Result<(&'a mut f64, &'a mut Vec<f64>), Wrong> {
    let is_practical = matches!(config.scheme, SplitScheme::Practical { .. });
    let other = match is_practical {
        _ if given.has("planes") => Some("manual"),
        false => given.value("scheme"),
        true => None,
    };
    if let Some(scheme) = other {
        return refuse(format!(
            "{key} applies to scheme practical only, but scheme is {scheme}; give only one of the two"
        ));
    }
    if !is_practical {
        config.scheme = SplitScheme::practical();
    }
    match &mut config.scheme {
        SplitScheme::Practical { lambda, delta } => Ok((lambda, delta)),
        _ => refuse(format!("{key} applies to scheme practical only")),
    }
}

pub(super) fn lambda(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let value = number(text)?;
    practical(config, given, "lambda").map(|(lambda, _)| *lambda = value)
}

pub(super) fn delta(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let values = numbers(text)?;
    practical(config, given, "delta").map(|(_, delta)| *delta = values)
}

pub(super) fn planes(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let planes = numbers(text)?;
    if planes.iter().any(|plane| *plane <= 0.0) {
        return refuse("a plane is a view depth in metres, above 0".to_owned());
    }
    match given.value("scheme") {
        Some(scheme) if scheme.trim() != "manual" => {
            return refuse(format!(
                "planes applies to scheme manual only, but scheme is {scheme}; give only one of the two"
            ));
        }
        _ => config.scheme = SplitScheme::Manual { planes },
    }
    shape(config, given)
}

pub(super) fn range_fit(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    known("range-fit", text)?;
    config.range = if text == "visible" { Range::Visible } else { Range::Camera };
    Ok(())
}

pub(super) fn shadow_range(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    if given.value("range-fit") == Some("visible") {
        return refuse(
            "shadow-range and range-fit visible both choose the shadowed range; give one of them".to_owned(),
        );
    }
    let (near, far) = range(text)?;
    config.range = Range::Metres { near, far };
    Ok(())
}

pub(super) fn selection(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    known("selection", text)?;
    match (text, config.selection) {
        ("map", _) => config.selection = Selection::Map,
        (_, Selection::Map) => config.selection = Selection::VIEW_DEPTH,
        (_, Selection::Interval(_)) => {}
    }
    Ok(())
}

pub(super) fn bands(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let metric: SplitMetric = text.parse()?;
    if metric == SplitMetric::Distance && given.value("selection") == Some("map") {
        return refuse(
            "bands radial and selection map exclude each other: maps that are chosen by what they contain \
                    have no bands; give only one of the two",
        );
    }
    if metric == SplitMetric::Distance || config.selection != Selection::Map {
        config.selection = Selection::Interval(metric);
    }
    Ok(())
}

pub(super) fn stabilize(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    if config.stability.word() == text {
        return Ok(());
    }
    config.stability = match text {
        "exact" => Stability::Exact,
        "approximate" => Stability::Approximate { steps: ExtentSteps::default() },
        "none" => Stability::tight(),
        _ => return refuse(unknown("stability", text, Stability::WORDS)),
    };
    Ok(())
}

pub(super) fn extent(config: &mut ShadowConfig, given: &Given<'_>, steps: ExtentSteps) -> Result<(), Wrong> {
    if given.has("extent-steps") && given.has("extent-levels") {
        return refuse("extent-steps and extent-levels both choose the steps of a map's extent; give one".to_owned());
    }
    match given.value("stabilize") {
        Some(stability) if stability.trim() != "approximate" => {
            refuse(format!("needs stabilize approximate, but stabilize is {stability}; give only one of the two"))
        }
        _ => {
            config.stability = Stability::Approximate { steps };
            Ok(())
        }
    }
}

pub(super) fn warp(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let warps: Vec<Warp> = text.split(',').map(|warp| warp.trim().parse()).collect::<Result<_, _>>()?;
    if warps.iter().all(|warp| *warp == Warp::None) {
        if config.first_warp().is_some() {
            config.stability = Stability::tight();
        }
        return Ok(());
    }
    let typed = format!("warp {text}");
    set_warps(config, given, warps, &typed)
}

fn set_warps(config: &mut ShadowConfig, given: &Given<'_>, warps: Vec<Warp>, typed: &str) -> Result<(), Wrong> {
    match given.value("stabilize") {
        Some(stability) if stability.trim() != "none" => refuse(format!(
            "{typed} and stabilize {stability} exclude each other: a warped map follows the camera; \
             give only one of the two"
        )),
        _ => {
            config.stability = Stability::Tight { warps };
            Ok(())
        }
    }
}

pub(super) fn tsm_focus(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    let value = number(text)?;
    let mut is_used = false;
    if let Stability::Tight { warps } = &mut config.stability {
        for warp in warps {
            if let Warp::Tsm { focus } = warp {
                (*focus, is_used) = (value, true);
            }
        }
    }
    if is_used { Ok(()) } else { refuse("applies to warp tsm only, which no map has; omit it, or use warp tsm") }
}

pub(super) fn filter_width(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    let value = number(text)?;
    let filter = config.filter.word();
    match config.filter.width_mut() {
        Some(width) => {
            *width = Some(value);
            Ok(())
        }
        None => {
            let with_width: Vec<_> = Filter::ALL.iter().filter(|filter| filter.has_width()).map(Filter::word).collect();
            let names = with_width.join(", ");
            refuse(format!("filter {filter} has no width to choose; omit it, or use one of {names}"))
        }
    }
}

pub(super) fn sun_angle(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    let value = number(text)?;
    match &mut config.filter {
        Filter::Pcss { sun_degrees, .. } => {
            *sun_degrees = value;
            Ok(())
        }
        other => {
            refuse(format!("applies to filter pcss only, but filter is {}; omit it, or use filter pcss", other.word()))
        }
    }
}

pub(super) fn rotate_kernel(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    let on = switch(text)?;
    match &mut config.filter {
        Filter::Disc { rotated, .. } | Filter::Pcss { rotated, .. } => {
            *rotated = on;
            Ok(())
        }
        other => refuse(format!(
            "applies to filters disc and pcss only, but filter is {}; omit it, or use one of these",
            other.word()
        )),
    }
}

pub(super) fn moments<'a>(config: &'a mut ShadowConfig, key: &str) -> Result<&'a mut Moments, Wrong> {
    match &mut config.filter {
        Filter::Moments(moments) => Ok(moments),
        other => {
            let filter = other.word();
            refuse(format!(
                "{key} applies to filters esm, vsm, evsm2, evsm4 and msm only, but filter is {filter}; omit it, or use one of these"
            ))
        }
    }
}

pub(super) fn edges(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    if config.edges.word() != text {
        config.edges = text.parse()?;
    }
    Ok(())
}

pub(super) fn edge_samples(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    match &mut config.edges {
        Edges::Exact { samples } => {
            *samples = count(text)?;
            Ok(())
        }
        Edges::Sampled => refuse("applies to edges exact only, but edges is sampled; omit it, or use edges exact"),
    }
}

pub(super) fn transition(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    known("transition", text)?;
    let before = config.transition.share();
    let share = if before > 0.0 { before } else { USUAL_BLEND };
    config.transition = match text {
        "blend" => Transition::Blend { share },
        "dither" => Transition::Dither { share },
        _ => Transition::Hard,
    };
    Ok(())
}

pub(super) fn blend(config: &mut ShadowConfig, text: &str, given: &Given<'_>) -> Result<(), Wrong> {
    let share = number(text)?;
    if !(0.0..=1.0).contains(&share) {
        return refuse(format!("{share} is out of range; give 0 to 1"));
    }
    config.transition = match config.transition {
        // Borders that were asked to be hard have no band, however wide.
        _ if share == 0.0 || given.value("transition") == Some("hard") => Transition::Hard,
        Transition::Dither { .. } => Transition::Dither { share },
        Transition::Blend { .. } | Transition::Hard => Transition::Blend { share },
    };
    Ok(())
}

pub(super) fn colour(config: &mut ShadowConfig, text: &str, _: &Given<'_>) -> Result<(), Wrong> {
    match numbers(text)?[..] {
        [red, green, blue] => config.look.colour = [red, green, blue],
        ref other => return refuse(format!("{} numbers; give red, green and blue from 0 to 1", other.len())),
    }
    Ok(())
}

/// The layout of `generation` and `storage` together; either may be `auto`.
pub(super) fn layout(config: &mut ShadowConfig, given: &Given<'_>) -> Result<(), Wrong> {
    let generation = given.value("generation").map(words::generation).transpose()?.flatten();
    let storage = given.value("storage").map(words::storage).transpose()?.flatten();
    let (generation, storage) = match (generation, storage) {
        (None, None) => return Ok(()),
        (None, Some(Storage::Reused)) => (Generation::Multipass, Storage::Reused),
        (None, Some(storage)) => (Generation::PerSplit, storage),
        (Some(generation), None) => (generation, usual_storage(generation)),
        (Some(generation), Some(storage)) => (generation, storage),
    };
    match Layout::of(generation, storage) {
        Some(layout) => {
            config.layout = layout;
            Ok(())
        }
        None => refuse(format!(
            "generation {generation} and storage {storage} exclude each other: multipass goes with reused; per-split \
             with array, atlas, separate or cube; layered with array or cube; instanced with atlas; mixed with array; \
             set only one of the two"
        )),
    }
}

fn usual_storage(generation: Generation) -> Storage {
    match generation {
        Generation::Multipass => Storage::Reused,
        Generation::Instanced => Storage::Atlas,
        Generation::PerSplit | Generation::Layered | Generation::Mixed => Storage::Array,
    }
}
