//! Stage 2 of a sun's plan: the lens for which maps are made, the planes between splits and the
//! sizes of stabilised maps.
//!
//! All held values are settled here, except for rectangles and depths.

use glam::DVec2;

use super::block::Block;
use super::frame::{Frame, Sun};
use super::in_view::InView;
use super::range;
use super::scope::Scope;
use super::slice_ends::{SliceEnds, covered};
use crate::config::{Cache, Selection, SplitScheme, Stability};
use crate::geometry::sphere::slice_sphere;
use crate::held::Held;
use crate::held::approach::{Decides, Turn};
use crate::held::ends::Range;
use crate::held::recovery::{Row, Standing};
use crate::held::rectangle::Stride;
use crate::planes::cells::Sight;
use crate::planes::optimal::{Maps, Placement};
use crate::planes::scheme::split_planes;
use crate::{MAX_SPLITS, Result, View, Warp};

/// Planes of the splits and sizes of stabilised maps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub range: Range,
    pub row: Row,
    /// The view through the lens for which maps are made: the camera's, or one around it.
    pub lens: View,
    /// Diameter in metres of the sphere around the whole shadowed range, for stabilised maps;
    /// otherwise 0.
    pub whole_width: f64,
    /// Block around all receivers, which no map has to exceed along any axis, for exactly
    /// stabilised maps.
    pub around_all: Option<Block>,
    /// The change of rectangles in this frame of an approach to the choice of a new planner;
    /// `None` while there is none.
    pub approach: Option<Turn>,
    /// The planes that an approach has just begun to lead to.
    pub next: Option<Row>,
}

/// Values that the stages of one split share.
#[derive(Clone, Copy)]
pub(super) struct SplitFrame<'a> {
    pub frame: &'a Frame<'a>,
    pub sun: &'a Sun<'a>,
    pub layout: &'a Layout,
    /// Index of the split.
    pub index: usize,
}

impl SplitFrame<'_> {
    /// Edge of the split's map in texels.
    pub fn size(&self) -> u32 {
        self.frame.config.map_sizes[self.index]
    }

    pub fn warp(&self) -> Warp {
        self.frame.config.warp(self.index)
    }

    /// The change of the split's rectangle in this frame of an approach; `None` without one.
    pub fn stride(&self) -> Option<Stride> {
        let turn = self.layout.approach?;
        Some(turn.filter(|(map, _)| *map == self.index).map_or(Stride::Stay, |(_, stride)| stride))
    }

    /// The extent of the split's stabilised map.
    pub fn block(&self) -> Block {
        self.layout.block(self.frame, self.sun, self.layout.planes(), self.index)
    }
}

/// Buffers of the stage.
#[derive(Clone, Debug, Default)]
pub(super) struct LayoutBuffers {
    placement: Placement,
    planes: Vec<f64>,
}

impl Layout {
    /// Split planes `C_0 ..= C_m`.
    pub fn planes(&self) -> &[f64] {
        &self.row.planes[..=self.row.splits]
    }

    /// # Errors
    /// [`crate::Error::InvalidSetting`] for a range or planes that do not fit this camera.
    pub fn new(
        (frame, sun): (&Frame<'_>, &Sun<'_>),
        scope: &Scope<'_>,
        held: &mut Held,
        in_view: &mut InView,
        buffers: &mut LayoutBuffers,
    ) -> Result<Self> {
        if !frame.stands_still() {
            return Self::holding((frame, sun), scope, (&mut Held::default(), 0.0), in_view, buffers);
        }
        let standing = held.begin(frame.view, sun.direction);
        let now = held.current_row(frame.config.splits());
        let (Standing::Due | Standing::Recovering, Some(row)) = (standing, now) else {
            return Self::holding((frame, sun), scope, (held, 0.0), in_view, buffers);
        };
        let mut fresh = held.released();
        if standing == Standing::Recovering {
            fresh.adopt(held);
        }
        let shown = row.planes[row.splits];
        let target = Self::holding((frame, sun), scope, (&mut fresh, shown), in_view, buffers)?;
        let is_exact = frame.config.stability == Stability::Exact;
        if standing == Standing::Due {
            if is_exact && !row.exceeds(&target.row) {
                held.standstill.set(Standing::Settled);
                return Self::holding((frame, sun), scope, (held, 0.0), in_view, buffers);
            }
            held.adopt(&fresh);
            held.standstill.set(Standing::Recovering);
        }
        Ok(if is_exact {
            target.recovered((frame, sun), row, held)
        } else {
            target.approached((frame, sun), (row, standing), held)
        })
    }

    /// A layout of exactly still maps that is one step nearer to this one than `row`, and is held
    /// from now on.
    fn recovered(self, (frame, sun): (&Frame<'_>, &Sun<'_>), mut row: Row, held: &mut Held) -> Self {
        let need = |i: usize, planes: &[f64]| self.block(frame, sun, planes, i).half.truncate();
        if !held.recovery.step(&mut row, &self.row, held.standstill.frames_left(), need) {
            held.standstill.set(Standing::Settled);
        }
        self.held_from_now_on((frame, sun), row, held)
    }

    /// A layout of almost still maps that is one step nearer to this one than `row`, and is held
    /// from now on. Their rectangles follow in the stage that places them.
    fn approached(
        self,
        (frame, sun): (&Frame<'_>, &Sun<'_>),
        (mut row, standing): (Row, Standing),
        held: &mut Held,
    ) -> Self {
        let target = self.row;
        let (approach, next) = if standing == Standing::Due {
            (Some(None), Some(target))
        } else {
            let decides = if frame.config.selection == Selection::Map { Decides::Map } else { Decides::Planes };
            let pace = (decides, held.standstill.frames_left());
            let turn = held.approach.step(&mut row, &target, pace, &mut held.rectangle);
            if turn.is_none() {
                held.standstill.set(Standing::Settled);
            }
            (Some(turn.flatten()), None)
        };
        // Things that move while the camera stands may need a longer range.
        let last = row.splits;
        row.planes[0] = row.planes[0].min(target.planes[0]);
        row.planes[last] = row.planes[last].max(target.planes[last]);
        row.half = target.half;
        Self { approach, next, ..self.held_from_now_on((frame, sun), row, held) }
    }

    /// This layout with the planes and sizes of `row`, which are held from now on.
    fn held_from_now_on(self, (frame, sun): (&Frame<'_>, &Sun<'_>), mut row: Row, held: &mut Held) -> Self {
        let need = |i: usize, planes: &[f64]| self.block(frame, sun, planes, i).half.truncate();
        // Things that move while the camera stands may need more.
        for i in 0..row.splits {
            row.half[i] = row.half[i].max(need(i, &row.planes[..=row.splits]));
        }
        held.keep(self.range, &row);
        Self { row, ..self }
    }

    /// A layout that keeps every held value that serves. `shown` is the least view depth up to
    /// which casters are looked for.
    fn holding(
        (frame, sun): (&Frame<'_>, &Sun<'_>),
        scope: &Scope<'_>,
        (held, shown): (&mut Held, f64),
        in_view: &mut InView,
        buffers: &mut LayoutBuffers,
    ) -> Result<Self> {
        let range = range::shadowed(frame, scope, &mut held.ends)?;
        let stands_still = frame.stands_still();
        let lens = if stands_still { hold_lens(frame, held)? } else { *frame.view };
        let mut layout = Self { range, lens, ..Self::empty(frame) };
        if stands_still {
            let sphere = slice_sphere(lens.frustum(), frame.view.frustum().near, range.far);
            layout.whole_width = 2.0 * held.whole.hold(sphere.radius);
        }
        if frame.config.stability == Stability::Exact {
            layout.around_all = Block::around(&frame.receivers, |r| scope.matters(r), sun.light);
        }
        in_view.cull(frame, sun, range.far.max(shown), layout.whole_width);
        layout.place_planes(frame, sun, held, in_view, buffers)?;
        if stands_still {
            for i in 0..layout.row.splits {
                let need = layout.block(frame, sun, layout.planes(), i).half.truncate();
                layout.row.half[i] = held.extents[i].hold(need);
            }
            held.row = Some((range, layout.row.planes));
        }
        Ok(layout)
    }

    fn empty(frame: &Frame<'_>) -> Self {
        let splits = frame.config.splits();
        let row = Row { planes: [0.0; MAX_SPLITS + 1], half: [DVec2::ONE; MAX_SPLITS], splits };
        Self {
            range: Range::new(0.0, 0.0),
            row,
            lens: *frame.view,
            whole_width: 0.0,
            around_all: None,
            approach: None,
            next: None,
        }
    }

    /// Writes the planes `C_0 ..= C_m`: the held ones if they were placed for the same range,
    /// otherwise new ones.
    fn place_planes(
        &mut self,
        frame: &Frame<'_>,
        sun: &Sun<'_>,
        held: &mut Held,
        in_view: &mut InView,
        buffers: &mut LayoutBuffers,
    ) -> Result<()> {
        let config = frame.config;
        let (m, range) = (config.splits(), self.range);
        let is_optimal = config.scheme == SplitScheme::Optimal;
        let LayoutBuffers { placement, planes } = buffers;
        if is_optimal {
            let inner = held.row.as_ref().map(|(_, planes)| &planes[1..m]);
            let reach = inner.and_then(|inner| inner.first()).copied().unwrap_or(range.near);
            let is_due = held.pace.is_due(frame.view, range, reach);
            match inner.filter(|_| !is_due && m > 1) {
                Some(inner) => {
                    planes.clear();
                    planes.push(range.near);
                    planes.extend_from_slice(inner);
                    planes.push(range.inner_far);
                }
                None => {
                    let last_map = if in_view.is_seen { in_view.shadowed(frame.view, sun, range) } else { None };
                    let (view, fan) = (frame.view, &sun.fan);
                    let sight = Sight { view, fan, receivers: in_view.sought(), casters: &in_view.casters, last_map };
                    let most_half = self.around_all.map_or(DVec2::INFINITY, |all| all.half.truncate());
                    let (margin, whole_width, image_size) = (frame.margin, self.whole_width, frame.image_size);
                    let maps = Maps { config, image_size, margin, whole_width, most_half };
                    placement.place(&sight, &maps, range, inner, planes)?;
                }
            }
            if inner != Some(&planes[1..m]) {
                // Other slices have other sizes: none is worth holding on to.
                held.extents = Default::default();
            }
        } else {
            split_planes(&config.scheme, range.near, range.inner_far, m, planes)?;
        }
        planes[m] = range.far;
        match held.row {
            // Between two ranges planes are on their way, and stay as far as they came.
            Some((placed_for, row)) if !is_optimal && placed_for == range && row[m] >= range.far => {
                self.row.planes = row;
            }
            _ => self.row.planes[..=m].copy_from_slice(planes),
        }
        Ok(())
    }

    /// The extent of the stabilised map of split `i`: a block around its slice, no longer than all
    /// receivers.
    pub fn block(&self, frame: &Frame<'_>, sun: &Sun<'_>, planes: &[f64], i: usize) -> Block {
        let slice = SliceEnds::new(frame, planes, i);
        // A kept map stands in for those before it, too. A wider lens has wider pixels, and its
        // slices reach back farther.
        let begin = if frame.config.cache == Cache::Kept {
            slice.from.min(frame.view.frustum().near)
        } else if slice.is_visible && i > 0 {
            covered(frame, &self.lens, planes, i).0.min(slice.from)
        } else {
            slice.from
        };
        let sphere = slice_sphere(self.lens.frustum(), begin, slice.to);
        let block = Block::around_sphere(frame.view.world_from_view_point(sphere.center), sphere.radius, sun.light);
        self.around_all.map_or(block, |all| block.no_longer_than(&all))
    }
}

fn hold_lens(frame: &Frame<'_>, held: &mut Held) -> Result<View> {
    let before = held.lens;
    let lens = held.lens.hold(frame.view.frustum());
    if held.lens != before {
        // All maps change with the lens: none's size is worth holding on to.
        held.extents = Default::default();
    }
    frame.view.with_frustum(lens)
}
