//! The job of measuring costs over the number of objects.

use std::path::PathBuf;

use glam::DVec3;
use serde::Serialize;
use umbrage::View;

use crate::technique::Technique;

/// Number of frames of a case that are drawn before measured ones, while caches fill and shaders
/// compile.
pub(super) const WARM_UP: u32 = 2;

/// Metres that a walking camera moves in a frame: 1.4 m/s at 60 Hz.
pub(super) const STEP_M: f64 = 1.4 / 60.0;

/// Number of frames after which the state held for a standing camera has settled, so that plans are
/// copied.
const SETTLED: u32 = 64;

/// Numbers of objects to measure, and the outputs.
#[derive(Debug)]
pub struct ScaleJob {
    /// Numbers of objects, rising.
    pub objects: Vec<u32>,
    /// Technique of the shadows. Maps are kept if the case says so.
    pub technique: Technique,
    /// Number of measured frames of each case.
    pub rounds: u32,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// File of the results (JSON).
    pub json: Option<PathBuf>,
    /// File of the page.
    pub html: Option<PathBuf>,
}

impl ScaleJob {
    /// Returns the number of frames that are drawn.
    pub(super) fn frames(&self) -> u64 {
        let of_case = |case: Case| u64::from(case.settling() + WARM_UP + self.rounds);
        self.objects.len() as u64 * Case::ALL.map(of_case).iter().sum::<u64>()
    }
}

/// Case of a measurement: motion from frame to frame, and whether maps are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// Maps are not kept; the camera walks.
    Uncached,
    /// Maps are kept, and nothing moves.
    Standing,
    /// Maps are kept, and the camera walks.
    Walking,
    /// Maps are kept, and one object in a hundred moves.
    Movers,
}

impl Case {
    /// All cases, in the order in which they are measured.
    pub const ALL: [Self; 4] = [Self::Uncached, Self::Walking, Self::Standing, Self::Movers];

    /// Returns the case in words.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Uncached => "nothing kept, walking",
            Self::Standing => "kept, standing",
            Self::Walking => "kept, walking",
            Self::Movers => "kept, 1 % moves",
        }
    }

    /// Returns whether maps are kept.
    #[must_use]
    pub const fn is_kept(self) -> bool {
        !matches!(self, Self::Uncached)
    }

    /// Returns the number of frames that are planned before any is drawn, until held state no
    /// longer changes.
    #[must_use]
    pub(super) const fn settling(self) -> u32 {
        if matches!(self, Self::Standing) { SETTLED } else { 0 }
    }

    /// Returns whether the camera walks.
    #[must_use]
    pub const fn walks(self) -> bool {
        matches!(self, Self::Uncached | Self::Walking)
    }
}

/// Moves a view forward by some metres.
pub(super) fn ahead(view: &View, metres: f64) -> View {
    let level = DVec3::new(view.forward().x, 0.0, view.forward().z).normalize_or_zero();
    View::look_at_upright(view.eye() + metres * level, view.eye() + metres * level + view.forward(), *view.frustum())
        .unwrap_or(*view)
}
