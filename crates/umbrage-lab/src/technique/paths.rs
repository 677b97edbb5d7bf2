//! `--generation`, `--storage` and `--coordinates`: which of them go together.

use umbrage_wgpu::ShadowMapsOptions;

use super::args::{Bands, Coordinates, Selection, ShadowArgs, Transition, Warp, typed_name};
use crate::failure::{Failure, Result, in_options};

/// `--blend` where nothing else says one.
const DEFAULT_BLEND: f64 = 0.1;

/// The share over which splits blend, once generation and storage are known to go together; and a note if that is not what it usually is.
///
/// # Errors
/// [`Failure::Input`] naming the two options that exclude each other.
pub fn blend(args: &ShadowArgs, map_sizes: &[u32]) -> Result<(f64, Option<String>)> {
    let options = ShadowMapsOptions {
        map_sizes: map_sizes.to_vec(),
        generation: args.generation.into(),
        storage: args.storage.into(),
        ..ShadowMapsOptions::default()
    };
    let (_, storage) = options.path().map_err(|error| Failure::input(in_options(&error)))?;
    let alone = storage == umbrage_wgpu::Storage::Reused && map_sizes.len() > 1 && args.transition != Transition::Hard;
    if storage == umbrage_wgpu::Storage::Reused && args.selection == Selection::Map {
        return Err(Failure::input(
            "--selection map and --storage reused (--generation multipass) exclude each other: there is one map at a time and none to \
             choose from; use --selection depth, or another storage",
        ));
    }
    if storage == umbrage_wgpu::Storage::Reused && args.bands == Bands::Radial {
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
    if splits > umbrage_render::Coordinates::MOST_SPLITS {
        return Err(Failure::input(format!(
            "--coordinates split and --splits {splits} exclude each other: vertices hand on the coordinates of at most {} splits; use \
             fewer, or --coordinates world",
            umbrage_render::Coordinates::MOST_SPLITS
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
