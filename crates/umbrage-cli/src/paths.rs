//! `--generation` and `--storage`: how maps are drawn and where they are kept.

use clap::ValueEnum;
use umbrage_wgpu::ShadowMapsOptions;

use crate::{
    args::{Coordinates, ShadowArgs, Warp},
    failure::{Failure, Result},
    shadow_job::typed_name,
};

/// `--generation`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Generation {
    /// What goes with the storage
    #[default]
    Auto,
    /// Map and picture slice by slice, one map for all
    Multipass,
    /// One pass for each split
    PerSplit,
    /// As many splits at once as the device has views, by multiview
    Layered,
    /// All splits at once, by instancing into tiles
    Instanced,
    /// All splits at once, by both: tiles in layers
    Mixed,
}

/// `--storage`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Storage {
    /// What goes with the generation
    #[default]
    Auto,
    /// Layers of one texture
    Array,
    /// Tiles of one texture
    Atlas,
    /// A texture for each map
    Separate,
    /// Faces of a cube: six maps of one size at most
    Cube,
    /// One map, used for one split after the other
    Reused,
}

impl From<Generation> for umbrage_wgpu::Generation {
    fn from(generation: Generation) -> Self {
        match generation {
            Generation::Auto => Self::Auto,
            Generation::Multipass => Self::Multipass,
            Generation::PerSplit => Self::PerSplit,
            Generation::Layered => Self::Layered,
            Generation::Instanced => Self::Instanced,
            Generation::Mixed => Self::Mixed,
        }
    }
}

impl From<Storage> for umbrage_wgpu::Storage {
    fn from(storage: Storage) -> Self {
        match storage {
            Storage::Auto => Self::Auto,
            Storage::Array => Self::Array,
            Storage::Atlas => Self::Atlas,
            Storage::Separate => Self::Separate,
            Storage::Cube => Self::Cube,
            Storage::Reused => Self::Reused,
        }
    }
}

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
    let alone = storage == umbrage_wgpu::Storage::Reused
        && map_sizes.len() > 1
        && args.transition != crate::args::Transition::Hard;
    if storage == umbrage_wgpu::Storage::Reused && args.selection == crate::args::Selection::Map {
        return Err(Failure::input(
            "--selection map and --storage reused (--generation multipass) exclude each other: there is one map at a time and none to \
             choose from; use --selection depth, or another storage",
        ));
    }
    if storage == umbrage_wgpu::Storage::Reused && args.bands == crate::args::Bands::Radial {
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

/// The library's message in the language of the command line.
#[must_use]
pub fn in_options(error: &umbrage_wgpu::Error) -> String {
    match error {
        umbrage_wgpu::Error::ConflictingOptions { first, second, reason } => {
            let option = |name: &str| format!("--{}", name.replace("map_sizes", "map-size"));
            format!("{} and {} exclude each other: {reason}", option(first), option(second))
        }
        umbrage_wgpu::Error::FilterTooWide { .. } => format!("--filter-width: {error}"),
        other => other.to_string(),
    }
}
