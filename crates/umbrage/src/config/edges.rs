//! Choices of the method that decides where a shadow's edge lies.

use super::names::{Word, unknown};

/// Method that decides where a shadow's edge lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Edges {
    /// The filter: an edge is known to the texel.
    #[default]
    Sampled,
    /// The triangles that texels name: an edge is exact where casters can be asked.
    Exact {
        /// Number of positions of a pixel that are decided: 1, or 4 or 8 for smooth edges.
        samples: u32,
    },
}

impl Edges {
    /// The word of each way to decide edges.
    pub const WORDS: &'static [Word] = &[
        Word { word: "sampled", help: "The filter: an edge is known to the texel" },
        Word { word: "exact", help: "The triangles that texels name: an edge is exact where casters can be asked" },
    ];

    /// Exact edges of one position of a pixel: visibility is 0 or 1.
    #[must_use]
    pub const fn exact() -> Self {
        Self::Exact { samples: 1 }
    }

    /// Returns whether triangles decide, and not the filter.
    #[must_use]
    pub const fn is_exact(self) -> bool {
        matches!(self, Self::Exact { .. })
    }

    /// Positions of a pixel that triangles decide; `None` for [`Edges::Sampled`].
    #[must_use]
    pub const fn samples(self) -> Option<u32> {
        match self {
            Self::Sampled => None,
            Self::Exact { samples } => Some(samples),
        }
    }

    /// The word in config files and on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Sampled => "sampled",
            Self::Exact { .. } => "exact",
        }
    }
}

impl std::str::FromStr for Edges {
    type Err = String;

    /// The way of this word, exact edges with one position of a pixel.
    fn from_str(text: &str) -> Result<Self, String> {
        [Self::Sampled, Self::exact()]
            .into_iter()
            .find(|edges| edges.word() == text)
            .ok_or_else(|| unknown("way to decide edges", text, Self::WORDS))
    }
}
