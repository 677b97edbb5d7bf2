//! What is measured over the number of objects.

use std::path::PathBuf;

use glam::DVec3;
use serde::Serialize;
use umbrage::View;

use crate::technique::Technique;

/// Frames that a case is drawn before any that counts: caches fill, and shaders compile.
pub(super) const WARM_UP: u32 = 2;

/// Metres that a walking camera goes in a frame: 1.4 m/s at 60 Hz.
pub(super) const STEP_M: f64 = 1.4 / 60.0;

/// Frames after which what is held for a standing camera has settled, so that plans are copied.
const SETTLED: u32 = 64;

/// Numbers of objects, and where the figures go.
#[derive(Debug)]
pub struct ScaleJob {
    /// Numbers of objects, rising.
    pub objects: Vec<u32>,
    /// How shadows are made; maps are kept where the case says so.
    pub technique: Technique,
    /// Frames that are measured of each case.
    pub rounds: u32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The figures (JSON).
    pub json: Option<PathBuf>,
    /// The page.
    pub html: Option<PathBuf>,
}

impl ScaleJob {
    /// How many frames are drawn.
    pub(super) fn frames(&self) -> u64 {
        let of_case = |case: Case| u64::from(case.settling() + WARM_UP + self.rounds);
        self.objects.len() as u64 * Case::ALL.map(of_case).iter().sum::<u64>()
    }
}

/// What happens from frame to frame, and what is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// Nothing is kept; the camera walks.
    Uncached,
    /// Maps are kept, and nothing moves.
    Standing,
    /// Maps are kept, and the camera walks.
    Walking,
    /// Maps are kept, and one object in a hundred moves.
    Movers,
}

impl Case {
    /// All, in the order in which they are measured.
    pub const ALL: [Self; 4] = [Self::Uncached, Self::Walking, Self::Standing, Self::Movers];

    /// In words.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Uncached => "nothing kept, walking",
            Self::Standing => "kept, standing",
            Self::Walking => "kept, walking",
            Self::Movers => "kept, 1 % moves",
        }
    }

    /// Whether maps are kept.
    #[must_use]
    pub const fn is_kept(self) -> bool {
        !matches!(self, Self::Uncached)
    }

    /// Frames that are planned before any is drawn, until nothing that is held changes any more.
    #[must_use]
    pub(super) const fn settling(self) -> u32 {
        if matches!(self, Self::Standing) { SETTLED } else { 0 }
    }

    /// Whether the camera walks.
    #[must_use]
    pub const fn walks(self) -> bool {
        matches!(self, Self::Uncached | Self::Walking)
    }
}

/// A view so many metres further on.
pub(super) fn ahead(view: &View, metres: f64) -> View {
    let level = DVec3::new(view.forward().x, 0.0, view.forward().z).normalize_or_zero();
    View::look_at_upright(view.eye() + metres * level, view.eye() + metres * level + view.forward(), *view.frustum())
        .unwrap_or(*view)
}
