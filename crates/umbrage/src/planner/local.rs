//! Plans for local lights: parallel splits in the post-perspective space of a spot light, or of the
//! six faces of a point light.
//!
//! After its perspective division a light's frustum is a cube in which light is parallel: a
//! position is `(u/w, v/w)` in units of the tangent, with `w` the depth along the frustum's axis,
//! and all points on one ray from the light have one position. There a slice's map is planned in
//! the stages of a sun: range → planes → casters → fit → snap → depth. Slices and boxes are clipped
//! to the light's frustum *before* the division, as either may straddle the light's plane, where w
//! changes its sign. The test of whether a box can cast a shadow uses planes through the light,
//! which need no division.

use glam::{DVec2, DVec3};

use super::frame::Frame;
use crate::bounds::Placed;
use crate::bounds::rounding;
use crate::casters::{Gathered, Most};
use crate::config::{Crop, LightKind, Range, SplitMetric, SplitScheme};
use crate::coverage::LocalVolume;
use crate::geometry::light_frustum::{LightFrustum, Part};
use crate::geometry::volume::{Lies, Slice};
use crate::held::Held;
use crate::held::recovery::Standing;
use crate::held::size::HeldSize;
use crate::planes::scheme::{blend_begin, coverage, split_planes};
use crate::{Error, Light, Result, ShadowPlan, Split, maths};

/// Share of its depths that a map keeps free before its first caster and behind its last receiver,
/// for rounding.
const DEPTH_ROOM: f64 = 1e-3;

/// Share by which the shadowed range extends behind the last receiver, because all of a wall across
/// the view lies at that depth.
const RANGE_ROOM: f64 = 1e-3;

/// Buffers that are reused from call to call.
#[derive(Clone, Debug, Default)]
pub(super) struct LocalBuffers {
    receivers: Gathered,
    casters: Gathered,
    /// Casters of a split, as indices into `casters`.
    listed: Vec<u32>,
}

/// A split of one of the light's frusta.
#[derive(Clone, Copy)]
struct LocalSplit<'a> {
    frame: &'a Frame<'a>,
    /// Index of the split within the frustum.
    index: usize,
    /// Range of view depths that sample the map.
    coverage: (f64, f64),
    volume: LocalVolume,
}

/// Fills a plan that has begun, frustum after frustum.
pub(super) fn plan(
    frame: &Frame<'_>,
    (light, position): (&Light, DVec3),
    frusta: &[LightFrustum],
    held: &mut Held,
    buffers: &mut LocalBuffers,
    plan: &mut ShadowPlan,
) -> Result<()> {
    let config = frame.config;
    if let Some(conflict) = config.conflict_of_plan(LightKind::from(*light)) {
        return Err(Error::Conflict(Box::new(conflict)));
    }
    let m = config.splits();
    let (near, far, fades) = shadowed_range(frame, light, position);
    split_planes(&config.scheme, near, far, m, &mut plan.planes)?;
    plan.fade_begin = if fades { far - config.far_fade * (far - near) } else { far };
    let recovering = recovering(frame, light, held, frusta.len() * m);
    for frustum in frusta {
        buffers.cull(frame, frustum);
        for index in 0..m {
            let split = LocalSplit::new(frame, frustum, index, &plan.planes, buffers);
            let target = split.list_casters(buffers);
            let at = plan.splits.len();
            let step = recovering.as_ref().filter(|(maps, _)| maps.contains(&at)).map(|&(_, step)| step);
            let map = split.map(&target, &plan.planes, &mut held.local.0[at], step);
            plan.add_listed(map, &mut buffers.casters, &buffers.listed);
            plan.coverage.local.push(split.volume);
        }
    }
    Ok(())
}

/// The range of those among `count` maps that may shrink in this frame although the held size
/// serves, and the step that they may take.
fn recovering(
    frame: &Frame<'_>,
    light: &Light,
    held: &mut Held,
    count: usize,
) -> Option<(std::ops::Range<usize>, f64)> {
    if !frame.stands_still() {
        return None;
    }
    let axis = match light {
        Light::Spot(spot) => spot.direction(),
        _ => DVec3::ZERO,
    };
    if held.begin(frame.view, axis) == Standing::Due {
        held.standstill.set(Standing::Recovering);
    }
    held.standstill.turn(count)
}

impl LocalBuffers {
    /// Keeps the receivers and casters that the light reaches in this frustum.
    fn cull(&mut self, frame: &Frame<'_>, frustum: &LightFrustum) {
        frame.receivers.gather(|placed| frustum.may_meet(placed, 0.0), &mut self.receivers);
        // The margin around a map is a few of its texels: at most this share of the frustum's
        // width.
        let margin = frame.margin_share() * 2.0 * frustum.slope * frustum.range;
        frame.casters.gather(|placed| frustum.may_meet(placed, margin), &mut self.casters);
    }
}

impl<'a> LocalSplit<'a> {
    /// The slice, and the part of the light's frustum that it shows.
    fn new(frame: &'a Frame<'a>, frustum: &LightFrustum, index: usize, planes: &[f64], buffers: &LocalBuffers) -> Self {
        let blend = frame.config.blend();
        let (from, to) = coverage(frame.view, planes, index, blend, frame.image_size, SplitMetric::ViewDepth);
        let is_visible = to > from;
        let (from, to) = if is_visible { (from, to) } else { (planes[index], planes[index + 1]) };
        let slice = Slice::new(frame.view, from, to);
        let part = if is_visible { part_in(frame, frustum, &slice, &buffers.receivers) } else { Part::EMPTY };
        let swept = slice.swept_towards_point(frustum.position);
        let volume = LocalVolume { swept, frustum: *frustum, part };
        Self { frame, index, coverage: (from, to), volume }
    }

    /// Edge of the map in texels.
    fn size(&self) -> u32 {
        self.frame.config.map_sizes[self.index]
    }

    /// Texels across the map that serve its slice.
    fn texels(&self) -> f64 {
        (f64::from(self.size()) - 2.0 * self.frame.margin).max(2.0)
    }

    /// Lists the casters of a split: boxes that meet the hull of the light and the part that the
    /// map has to show. Returns that part for these casters.
    fn list_casters(&self, LocalBuffers { casters, listed, .. }: &mut LocalBuffers) -> Part {
        let LocalVolume { frustum, part, .. } = &self.volume;
        listed.clear();
        if part.is_empty() {
            return frustum.whole();
        }
        let casts = self.casts();
        listed.extend((0u32..).zip(&casters.boxes).filter(|(_, caster)| casts(caster)).map(|(at, _)| at));
        // Where casters lie, seen from the light, and the depth of the first.
        let mut target = *part;
        if !listed.is_empty() {
            let (mut lo, mut hi, mut first) = (DVec2::INFINITY, DVec2::NEG_INFINITY, f64::INFINITY);
            for caster in listed.iter().map(|&at| &casters.boxes[at as usize]) {
                let (caster_lo, caster_hi, depth) = frustum.seen(caster, part);
                (lo, hi, first) = (lo.min(caster_lo), hi.max(caster_hi), first.min(depth));
            }
            target.near = first;
            if self.frame.config.crop == Crop::SceneDependent && !self.frame.stands_still() {
                (target.lo, target.hi) = (lo, hi);
            }
        }
        target
    }

    /// Returns the test of whether a box can shade the part of the frustum that the map shows.
    fn casts(&self) -> impl Fn(&Placed) -> bool {
        let LocalVolume { swept, frustum, part } = self.volume;
        // A tangent per texel, of the whole part: what the margin around it may be at most.
        let widest = part.extent().max_element() / self.texels();
        let margin = self.frame.margin * widest * part.far;
        let sides = part.sides(&frustum);
        let hull = part.bounds.including(frustum.position);
        // Rounding in the bounds.
        let slack = rounding(hull.max - hull.min);
        move |placed| {
            let (bounds, Placed { center, half }) = (placed.bounds(), *placed);
            let beside = bounds.max.cmplt(hull.min - margin).any() || bounds.min.cmpgt(hull.max + margin).any();
            // A ground under everything is one of its own receivers; it casts its shadow on
            // nothing.
            let below = |axis: usize| {
                let (lo, hi) = (part.bounds.min[axis], part.bounds.max[axis]);
                let light = frustum.position[axis];
                (light > lo + slack && bounds.max[axis] <= lo + slack)
                    || (light < hi - slack && bounds.min[axis] >= hi - slack)
            };
            !beside
                && !(0..3).any(below)
                && frustum.nearest_depth(placed) <= part.far
                && swept.meets(center, half, margin)
                && sides.iter().all(|side| side.nearest(center, half) <= margin)
        }
    }

    /// Tangents per texel, and the map's corner in texels. `held` holds the size of a stabilised
    /// map.
    fn snapped(&self, target: &Part, held: &mut HeldSize, step: Option<f64>) -> (DVec2, DVec2) {
        let (size, texels) = (f64::from(self.size()), self.texels());
        if !self.frame.stands_still() {
            let texel = target.extent() / texels;
            return (texel, 0.5 * (target.lo + target.hi) / texel - 0.5 * size);
        }
        let need = target.extent().max_element();
        let extent = match step {
            _ if self.volume.part.is_empty() => need,
            Some(step) => held.shrink(need, step),
            None => held.hold(need),
        };
        let texel = DVec2::splat(extent / (texels - 1.0));
        (texel, (0.5 * (target.lo + target.hi) / texel - 0.5 * size).round())
    }

    /// Makes the split's map.
    fn map(&self, target: &Part, planes: &[f64], held: &mut HeldSize, step: Option<f64>) -> Split {
        let LocalVolume { frustum, part, .. } = &self.volume;
        let (texel, min_texel) = self.snapped(target, held, step);
        let (w_near, w_far) = depths(target, frustum.near, self.frame.stands_still());
        let axis_offset = frustum.axis.dot(frustum.position);
        let (size, depths) = (self.size(), (axis_offset + w_near, axis_offset + w_far));
        Split {
            near: planes[self.index],
            far: planes[self.index + 1],
            blend_begin: blend_begin(planes, self.index, self.frame.config.blend()),
            coverage: self.coverage,
            size,
            u_axis: frustum.u,
            v_axis: frustum.v,
            depth_axis: frustum.axis,
            texel_m: texel * (0.5 * (part.near.min(w_far) + w_far)),
            min_texel,
            depth_near: depths.0,
            depth_far: depths.1,
            receiver_depths: depths,
            filter_radius_texels: self.frame.reach.radius_texels,
            warp: Some(frustum.shadow_from_world(texel, min_texel, size, (w_near, w_far))),
            light_position: Some(frustum.position),
            casters: 0..0,
        }
    }
}

/// The part of the light's frustum that a slice shows: all of it, or its receivers.
fn part_in(frame: &Frame<'_>, frustum: &LightFrustum, slice: &Slice, receivers: &Gathered) -> Part {
    let mut part = Part::EMPTY;
    if frame.config.crop == Crop::SceneIndependent {
        slice.clip_slice(&frustum.volume, |point| part.include(frustum, point));
        return part;
    }
    for placed in &receivers.boxes {
        let (Placed { center, half }, bounds) = (*placed, placed.bounds());
        match (slice.classify(center, half), frustum.volume.classify(center, half)) {
            (Lies::Outside, _) | (_, Lies::Outside) => {}
            (Lies::Inside, Lies::Inside) => bounds.corners().iter().for_each(|&p| part.include(frustum, p)),
            _ => slice.clip_box_with(&frustum.volume, &bounds, |point| part.include(frustum, point)),
        }
    }
    part
}

/// Depths along the axis that are stored as 0 and 1: before the first caster and behind the last
/// receiver; in whole steps for stabilised maps.
fn depths(target: &Part, least: f64, stands_still: bool) -> (f64, f64) {
    let far = target.far * (1.0 + DEPTH_ROOM);
    let near = (target.near.max(least) * (1.0 - DEPTH_ROOM)).min(0.5 * far);
    if stands_still {
        (maths::exp2(maths::log2(near).floor()), maths::exp2(maths::log2(far).ceil()))
    } else {
        (near, far)
    }
}

/// Range of view depths that shadows cover, `C_0` and `C_m`, and whether they fade at its end. The
/// range is that of the setting; or the camera's near and far, with far capped by the receivers
/// that the light reaches, both narrowed to the light's range. Shadows fade only if they end
/// although the light continues.
fn shadowed_range(frame: &Frame<'_>, light: &Light, position: DVec3) -> (f64, f64, bool) {
    let Frame { config, view, receivers, .. } = *frame;
    let range = light.range();
    if let Range::Metres { near, far } = config.range {
        return (near, far, true);
    }
    let forward = view.forward();
    let (camera_near, camera_far) = (view.frustum().near, view.frustum().far);
    let is_reached = |r: &Placed| position.clamp(r.center - r.half, r.center + r.half).distance(position) <= range;
    let deepest = receivers.most(|r| match is_reached(r) {
        true => view.view_depth(r.center) + forward.abs().dot(r.half),
        false => f64::NEG_INFINITY,
    });
    let at = view.view_depth(position);
    let reach = (at - range, at + range);
    let nothing = (camera_near, 2.0 * camera_near.abs() + 1.0, false);
    let far = deepest.min(reach.1) * (1.0 + RANGE_ROOM);
    if far <= camera_near || !far.is_finite() || reach.0 >= camera_far {
        // The light reaches nothing that is seen: any short range will do.
        return nothing;
    }
    // Planes that were given in metres mean those of the whole view.
    let free = match &config.scheme {
        SplitScheme::Uniform | SplitScheme::Logarithmic | SplitScheme::Optimal => true,
        SplitScheme::Practical { delta, .. } => delta.is_empty(),
        SplitScheme::Manual { .. } => false,
    };
    let near = if free { camera_near.max(reach.0) } else { camera_near };
    if near >= far { nothing } else { (near, far.min(camera_far), camera_far < far) }
}
