//! Words of settings whose values are not one enum.

use super::names::{Word, unknown};
use super::{Generation, Storage};

/// Words of techniques: splits, or one map with a warp.
pub(super) const TECHNIQUES: &[Word] = &[
    Word { word: "pssm", help: "Parallel-split shadow maps" },
    Word { word: "ssm", help: "One map over the whole range" },
    Word { word: "psm", help: "One perspective shadow map" },
    Word { word: "lispsm", help: "One light space perspective shadow map" },
    Word { word: "tsm", help: "One trapezoidal shadow map" },
];

/// Words of the shadowed range.
pub(super) const RANGE_FITS: &[Word] = &[
    Word { word: "camera", help: "The camera's near and far, far capped by the scene" },
    Word { word: "visible", help: "The nearest and the farthest thing in view" },
];

/// Words of the rule by which a point selects its split.
pub(super) const SELECTIONS: &[Word] = &[
    Word { word: "depth", help: "Interval-based: by the planes between splits" },
    Word { word: "map", help: "Map-based: the first map that contains the point" },
];

/// Words of the transition between splits.
pub(super) const TRANSITIONS: &[Word] = &[
    Word { word: "blend", help: "Both splits are mixed over a band" },
    Word { word: "dither", help: "Each pixel of a band uses one of both splits, by noise" },
    Word { word: "hard", help: "No band" },
];

/// Words of the passes that draw maps.
pub(super) const GENERATIONS: &[Word] = &[
    Word { word: "auto", help: "Whatever suits the storage" },
    Word { word: "multipass", help: "Map and picture slice by slice, one map for all" },
    Word { word: "per-split", help: "One pass for each split" },
    Word { word: "layered", help: "As many splits at once as the device has views" },
    Word { word: "instanced", help: "All splits at once, by instancing into tiles" },
    Word { word: "mixed", help: "All splits at once: tiles in layers" },
];

/// Words of the storage of maps.
pub(super) const STORAGES: &[Word] = &[
    Word { word: "auto", help: "Whatever suits the generation" },
    Word { word: "array", help: "Layers of one texture" },
    Word { word: "atlas", help: "Tiles of one texture" },
    Word { word: "separate", help: "A texture for each map" },
    Word { word: "cube", help: "Faces of a cube: six maps of one size at most" },
    Word { word: "reused", help: "One map, used for one split after the other" },
];

/// Generation of a word; `None` for `auto`.
pub(super) fn generation(text: &str) -> Result<Option<Generation>, String> {
    match text {
        "auto" => Ok(None),
        _ => text.parse().map(Some).map_err(|_: String| unknown("generation", text, GENERATIONS)),
    }
}

/// Storage of a word; `None` for `auto`.
pub(super) fn storage(text: &str) -> Result<Option<Storage>, String> {
    match text {
        "auto" => Ok(None),
        _ => text.parse().map(Some).map_err(|_: String| unknown("storage", text, STORAGES)),
    }
}

/// Word lists that setters check against.
pub(super) const WORDS: [(&str, &[Word]); 4] =
    [("technique", TECHNIQUES), ("range-fit", RANGE_FITS), ("selection", SELECTIONS), ("transition", TRANSITIONS)];
