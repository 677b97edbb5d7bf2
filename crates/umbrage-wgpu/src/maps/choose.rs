//! Which path is taken: what was asked for, what goes together, what the device can do.

use crate::{Error, Generation, Result, ShadowMapsOptions, Storage};

/// What of the device decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Abilities {
    /// Layers that one pass can draw into; 0 or 1 without multiview.
    pub views: u32,
    /// Whether instances can be cut off at the edges of a tile.
    pub clip_distances: bool,
    /// Whether multiview forgets which layer it draws into, see [`super::MapPass::leads`].
    pub leads: bool,
}

impl Abilities {
    /// Everything that any path needs.
    pub const ALL: Self = Self { views: umbrage::MAX_SPLITS as u32, clip_distances: true, leads: false };

    pub fn of(device: &wgpu::Device) -> Self {
        let has = |feature| device.features().contains(feature);
        Self {
            views: if has(wgpu::Features::MULTIVIEW) { device.limits().max_multiview_view_count } else { 0 },
            clip_distances: has(wgpu::Features::CLIP_DISTANCES),
            leads: device.adapter_info().driver == "llvmpipe",
        }
    }

    /// The feature that a generation lacks.
    fn lacking(self, generation: Generation) -> Option<&'static str> {
        let multiview = (self.views < 2).then_some("MULTIVIEW with max_multiview_view_count of 2 or more");
        let clip_distances = (!self.clip_distances).then_some("CLIP_DISTANCES");
        match generation {
            Generation::Layered => multiview,
            Generation::Instanced => clip_distances,
            Generation::Mixed => multiview.or(clip_distances),
            Generation::Auto | Generation::PerSplit | Generation::Multipass => None,
        }
    }
}

/// The path that is taken; neither is `Auto`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chosen {
    pub storage: Storage,
    pub generation: Generation,
    /// What was asked for and could not be had.
    pub notes: Vec<String>,
}

/// Finds the path, or says which two options exclude each other.
pub(crate) fn choose(options: &ShadowMapsOptions, abilities: Abilities) -> Result<Chosen> {
    let (generation, storage) = match (options.generation, options.storage) {
        // One pass per split draws the fewest vertices and needs nothing of the device (docs/notes/paths.md).
        (Generation::Auto, Storage::Auto) => (Generation::PerSplit, Storage::Array),
        (Generation::Auto, Storage::Reused) => (Generation::Multipass, Storage::Reused),
        (Generation::Auto, storage) => (Generation::PerSplit, storage),
        (generation, Storage::Auto) => (generation, usual_storage(generation)),
        (generation, storage) => (generation, storage),
    };
    if !goes_together(generation, storage) {
        return Err(Error::ConflictingOptions {
            first: format!("generation {}", generation.name()),
            second: format!("storage {}", storage.name()),
            reason: "multipass goes with reused; per-split with array, atlas, separate or cube; layered with array or cube; \
                     instanced with atlas; mixed with array. Leave one of them to auto",
        });
    }
    check_cube(options, storage)?;
    let Some(feature) = abilities.lacking(generation) else {
        return Ok(Chosen { storage, generation, notes: Vec::new() });
    };
    if !options.fallbacks {
        return Err(Error::MissingFeature { generation: generation.name(), feature });
    }
    let note = format!("generation {} needs {feature}, which this device does not give: per-split", generation.name());
    Ok(Chosen { storage, generation: Generation::PerSplit, notes: vec![note] })
}

fn usual_storage(generation: Generation) -> Storage {
    match generation {
        Generation::Multipass => Storage::Reused,
        Generation::Instanced => Storage::Atlas,
        Generation::Auto | Generation::PerSplit | Generation::Layered | Generation::Mixed => Storage::Array,
    }
}

fn goes_together(generation: Generation, storage: Storage) -> bool {
    matches!(
        (generation, storage),
        (Generation::Multipass, Storage::Reused)
            | (Generation::PerSplit, Storage::Array | Storage::Atlas | Storage::Separate | Storage::Cube)
            | (Generation::Layered, Storage::Array | Storage::Cube)
            | (Generation::Instanced, Storage::Atlas)
            | (Generation::Mixed, Storage::Array)
    )
}

fn check_cube(options: &ShadowMapsOptions, storage: Storage) -> Result<()> {
    if storage != Storage::Cube {
        return Ok(());
    }
    let sizes = &options.map_sizes;
    let conflict =
        |second: String, reason| Err(Error::ConflictingOptions { first: "storage cube".to_owned(), second, reason });
    if sizes.len() > 6 {
        return conflict(
            format!("map_sizes of {} splits", sizes.len()),
            "a cube has six faces; use 6 splits at most, or storage array",
        );
    }
    if sizes.iter().any(|size| Some(size) != sizes.first()) {
        return conflict(
            format!("map_sizes {sizes:?}"),
            "the faces of a cube are alike; give one size for all, or use storage atlas",
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GENERATIONS: [Generation; 6] = [
        Generation::Auto,
        Generation::Multipass,
        Generation::PerSplit,
        Generation::Layered,
        Generation::Instanced,
        Generation::Mixed,
    ];
    const STORAGES: [Storage; 6] =
        [Storage::Auto, Storage::Array, Storage::Atlas, Storage::Separate, Storage::Cube, Storage::Reused];

    fn options(generation: Generation, storage: Storage) -> ShadowMapsOptions {
        ShadowMapsOptions { generation, storage, ..Default::default() }
    }

    #[test]
    fn nine_pairs_go_together_and_the_others_are_named() {
        let mut valid = 0;
        for generation in GENERATIONS {
            for storage in STORAGES {
                match choose(&options(generation, storage), Abilities::ALL) {
                    Ok(chosen) => {
                        assert!(chosen.notes.is_empty() && goes_together(chosen.generation, chosen.storage));
                        assert!(generation == Generation::Auto || chosen.generation == generation);
                        assert!(storage == Storage::Auto || chosen.storage == storage);
                        valid += usize::from(generation != Generation::Auto && storage != Storage::Auto);
                    }
                    Err(error) => {
                        let message = error.to_string();
                        let names =
                            [format!("generation {}", generation.name()), format!("storage {}", storage.name())];
                        assert!(names.iter().all(|name| message.contains(name)), "{message}");
                    }
                }
            }
        }
        assert_eq!(valid, 9);
    }

    #[test]
    fn what_a_device_lacks_is_replaced_or_refused() {
        for generation in GENERATIONS {
            for abilities in [
                Abilities::default(),
                Abilities { views: 6, clip_distances: false, leads: false },
                Abilities { views: 1, clip_distances: true, leads: false },
            ] {
                let asked = options(generation, Storage::Auto);
                let chosen = choose(&asked, abilities).expect("there is always a way");
                assert_eq!(abilities.lacking(chosen.generation), None);
                let strict = choose(&ShadowMapsOptions { fallbacks: false, ..asked }, abilities);
                match abilities.lacking(generation) {
                    Some(feature) => {
                        assert!(chosen.notes[0].contains(generation.name()) && chosen.notes[0].contains("per-split"));
                        assert_eq!(strict, Err(Error::MissingFeature { generation: generation.name(), feature }));
                    }
                    None => assert_eq!(strict, Ok(chosen)),
                }
            }
        }
    }

    #[test]
    fn cubes_have_six_faces_alike() {
        let cube = |sizes: &[u32]| {
            let options = ShadowMapsOptions { map_sizes: sizes.to_vec(), ..options(Generation::Auto, Storage::Cube) };
            choose(&options, Abilities::ALL).map_err(|error| error.to_string())
        };
        assert!(cube(&[512; 6]).is_ok() && cube(&[512]).is_ok());
        let seven = cube(&[512; 7]).expect_err("seven");
        assert!(seven.contains("storage cube") && seven.contains("7 splits"), "{seven}");
        let unlike = cube(&[512, 256]).expect_err("unlike");
        assert!(unlike.contains("storage cube") && unlike.contains("[512, 256]"), "{unlike}");
    }
}
