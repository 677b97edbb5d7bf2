//! The state that a planner keeps between frames so that shadows stand still.
//!
//! A static shadow does not move while its map's texels lie on one grid, which is given by the
//! map's axes, the size of its texels and its offset in whole texels. The axes are those of the
//! light. Every plan rounds offsets to whole texels (`planner/snap.rs`). Sizes follow from the
//! lens, the range, the planes and the extent of a slice, and each of these is held here:
//!
//! | held | until |
//! |---|---|
//! | lens ([`size::HeldLens`]) | the camera's is wider, or narrower by √2 |
//! | range ([`ends::HeldEnds`]) | the scene ends elsewhere by a step |
//! | split planes of the last frame ([`Held::row`]) | the range changes; optimal ones: until a set of planes with an error a third smaller is found, for which [`pace::Pace`] searches now and then |
//! | map sizes, as half extents ([`size::HeldExtents`]) | a slice needs more, or less by two steps of 9 % |
//! | rectangles ([`rectangle::HeldRectangle`]) | as map sizes, in steps of the setting |
//! | depth range ([`depths::HeldDepths`]) | a caster or receiver lies outside |
//! | local maps' sizes ([`Held::local`]) | as map sizes |
//!
//! While the camera stands still, all of this recovers to the choice of a new planner: exactly
//! still maps by [`recovery`], almost still ones by [`approach`].

pub(crate) mod approach;
pub(crate) mod depths;
pub(crate) mod ends;
pub(crate) mod pace;
pub(crate) mod recovery;
pub(crate) mod rectangle;
pub(crate) mod size;

use glam::{DVec2, DVec3};

use crate::{MAX_SPLITS, View};
use approach::Approach;
use depths::HeldDepths;
use ends::{HeldEnds, Range};
use pace::Pace;
use recovery::{Recovery, Row, Standing, Standstill};
use rectangle::HeldRectangle;
use size::{HeldExtents, HeldLens, HeldSize};

/// Faces of a point light's cube.
const FACES: usize = 6;

/// State that a planner keeps between frames so that shadows stand still. It is a value: a pure
/// function of the frames that were planned with it.
///
/// A default one holds nothing: the plan made with it is that of a new planner. Without
/// stabilisation nothing is held. A frame that the planner refuses leaves the state unchanged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Held {
    pub(crate) standstill: Standstill,
    pub(crate) recovery: Recovery,
    pub(crate) approach: Approach,
    pub(crate) light_direction: Option<DVec3>,
    pub(crate) ends: HeldEnds,
    pub(crate) lens: HeldLens,
    pub(crate) whole: HeldSize,
    /// The planes of the last frame and the range that they were placed for.
    pub(crate) row: Option<(Range, [f64; MAX_SPLITS + 1])>,
    /// When optimal planes are searched for.
    pub(crate) pace: Pace,
    pub(crate) extents: [HeldExtents; MAX_SPLITS],
    pub(crate) rectangle: [HeldRectangle; MAX_SPLITS],
    pub(crate) depths: HeldDepths,
    pub(crate) local: LocalSizes,
}

/// One size for each map of a local light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LocalSizes(pub [HeldSize; MAX_SPLITS * FACES]);

impl Default for LocalSizes {
    fn default() -> Self {
        Self([HeldSize::default(); MAX_SPLITS * FACES])
    }
}

impl Held {
    /// Takes the view and the light of the next frame, and returns whether the camera stands still.
    pub(crate) fn begin(&mut self, view: &View, direction: DVec3) -> Standing {
        if self.light_direction.replace(direction) != Some(direction) {
            self.rectangle = Default::default();
        }
        let reach = self.row.map_or(view.frustum().near.abs(), |(_, planes)| planes[1]);
        let standing = self.standstill.follow(view, reach);
        if standing == Standing::Moving {
            (self.recovery, self.approach) = Default::default();
        }
        standing
    }

    /// The state of a new planner, as to the range and the lens: nothing is held of either.
    pub(crate) fn released(&self) -> Self {
        Self { standstill: self.standstill, ..Self::default() }
    }

    /// Takes over the range and the lens of `fresh`. Planes and sizes follow step by step.
    pub(crate) fn adopt(&mut self, fresh: &Self) {
        (self.ends, self.lens, self.whole) = (fresh.ends, fresh.lens, fresh.whole);
    }

    /// The planes and sizes of the last frame.
    pub(crate) fn current_row(&self, splits: usize) -> Option<Row> {
        let (_, planes) = self.row?;
        let mut half = [DVec2::ONE; MAX_SPLITS];
        for (half, held) in half.iter_mut().zip(&self.extents).take(splits) {
            *half = held.get()?;
        }
        Some(Row { planes, half, splits })
    }

    /// Holds `row`, whose planes are placed for `range`, from now on.
    pub(crate) fn keep(&mut self, range: Range, row: &Row) {
        self.row = Some((range, row.planes));
        for (held, &half) in self.extents.iter_mut().zip(&row.half).take(row.splits) {
            held.set(half);
        }
    }
}
