//! `--generation`, `--storage` and `--coordinates`: which of them go together.

use umbrage::config::{Filter, Layout, Preset, ShadowConfig, Transition as Band};

use super::args::{Bands, Coordinates, Selection, ShadowArgs, Transition, Warp, typed_name};
use crate::failure::{Failure, Result};

/// `--blend` where nothing else says one.
const DEFAULT_BLEND: f64 = 0.1;

/// Most splits of `--coordinates split`.
const MOST_SPLITS: usize = 4;

/// Where maps are kept and how they are drawn.
///
/// # Errors
/// [`Failure::Input`] naming the two options that exclude each other.
pub fn layout(args: &ShadowArgs, map_sizes: &[u32]) -> Result<Layout> {
    let any = Preset::Papers.config();
    // What else is asked for is checked elsewhere.
    let (transition, filter) = (Band::Hard, Filter::Hard);
    let mut config = ShadowConfig { map_sizes: map_sizes.to_vec(), transition, filter, ..any };
    let given = [("generation", typed_name(args.generation)), ("storage", typed_name(args.storage))];
    config.apply(&given.map(|(key, word)| (key.to_owned(), word))).map_err(|error| match error {
        umbrage::Error::InvalidSetting { field: "generation" | "storage", reason } => {
            Failure::input(format!("--{}", reason.replace(" and storage ", " and --storage ")))
        }
        other => other.into(),
    })?;
    Ok(config.layout)
}

/// The share over which splits blend; and a note if that is not what it usually is.
///
/// # Errors
/// [`Failure::Input`] naming the two options that exclude each other.
pub fn blend(args: &ShadowArgs, layout: Layout, splits: usize) -> Result<(f64, Option<String>)> {
    let alone = layout == Layout::Reused && splits > 1 && args.transition != Transition::Hard;
    if layout == Layout::Reused && args.selection == Selection::Map {
        return Err(Failure::input(
            "--selection map and --storage reused (--generation multipass) exclude each other: there is one map at a time and none to \
             choose from; use --selection depth, or another storage",
        ));
    }
    if layout == Layout::Reused && args.bands == Bands::Radial {
        return Err(Failure::input(
            "--bands radial and --storage reused (--generation multipass) exclude each other: the picture is drawn in slices of view \
             depth; use --bands planar, or another storage",
        ));
    }
    match args.blend {
        Some(blend) if blend > 0.0 && alone => Err(Failure::input(format!(
            "--blend {blend} and --storage reused (--generation multipass) exclude each other: there is one map at a time and none to \
             blend with; use --blend 0, --transition hard, or another storage"
        ))),
        // Without a band there is nothing to widen maps for.
        _ if args.transition == Transition::Hard => Ok((0.0, None)),
        Some(blend) => Ok((blend, None)),
        None if alone => Ok((0.0, Some("one map for all splits: they do not blend (--blend 0)".to_owned()))),
        None => Ok((DEFAULT_BLEND, None)),
    }
}

/// `--coordinates split` goes with a few plain maps alone.
///
/// # Errors
/// [`Failure::Input`] naming the two options that exclude each other.
pub fn check_coordinates(args: &ShadowArgs, splits: usize, warps: &[Warp]) -> Result<()> {
    if args.coordinates != Coordinates::Split {
        return Ok(());
    }
    if splits > MOST_SPLITS {
        return Err(Failure::input(format!(
            "--coordinates split and --splits {splits} exclude each other: vertices hand on the coordinates of at most {} splits; use \
             fewer, or --coordinates world",
            MOST_SPLITS
        )));
    }
    match warps.iter().find(|warp| **warp != Warp::None) {
        Some(warp) => Err(Failure::input(format!(
            "--coordinates split and --warp {} exclude each other: the places of a warped map are quotients, which cannot be \
             interpolated; use --coordinates world, or no warp",
            typed_name(*warp)
        ))),
        None => Ok(()),
    }
}
