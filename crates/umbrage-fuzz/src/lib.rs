//! What the fuzzers do with any bytes, and what must hold then.
//!
//! The workspace `fuzz` runs each [`Body`] under libFuzzer, which needs a nightly compiler. The
//! tests of this crate run them on a stable one, over the files of `fuzz/corpus` and mutations of
//! them.

#[path = "../../umbrage/tests/fuzz/case.rs"]
mod case;
#[path = "../../umbrage-scene/tests/common/exercise.rs"]
mod exercise;
mod mutate;
mod plan;
mod scenes;
#[cfg(feature = "lab")]
mod texts;

use std::path::{Path, PathBuf};

pub use mutate::{Numbers, mutated};

/// A fuzzer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// Settings, views, a sun and boxes become plans, which keep what every plan has to.
    Plan,
    /// A glTF file loads, is posed and written again, or is refused.
    Gltf,
    /// A height map becomes terrain, or is refused.
    HeightMap,
    /// A camera path is walked and written again, or is refused.
    Path,
    /// Techniques by name, and a file of them, are read or refused.
    Techniques,
    /// A config file is read and written again, or refused.
    Config,
}

impl Body {
    /// All fuzzers.
    pub const ALL: [Self; 6] = [Self::Plan, Self::Gltf, Self::HeightMap, Self::Path, Self::Techniques, Self::Config];

    /// Name of the libFuzzer target and of the corpus.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plan => "plan",
            Self::Gltf => "gltf",
            Self::HeightMap => "height_map",
            Self::Path => "path",
            Self::Techniques => "techniques",
            Self::Config => "config",
        }
    }

    /// The folder of the corpus.
    #[must_use]
    pub fn corpus(self) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(self.name())
    }

    /// Does with `bytes` whatever can be done.
    ///
    /// # Panics
    /// If what must hold does not.
    pub fn run(self, bytes: &[u8]) {
        match self {
            Self::Plan => plan::plan(bytes),
            Self::Gltf => exercise::exercise(bytes),
            Self::HeightMap => scenes::height_map(bytes),
            Self::Path => scenes::path(bytes),
            #[cfg(feature = "lab")]
            Self::Techniques => texts::techniques(bytes),
            #[cfg(feature = "lab")]
            Self::Config => texts::config(bytes),
            #[cfg(not(feature = "lab"))]
            Self::Techniques | Self::Config => panic!("{} needs the feature lab", self.name()),
        }
    }
}
