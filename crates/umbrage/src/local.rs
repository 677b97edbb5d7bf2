//! Lights that stand somewhere: parallel splits in the post-perspective space of a spot light, or of the six faces of a point light.
//!
//! Behind its perspective divide a light's frustum is a cube in which light is parallel: a place is `(u/w, v/w)` in units of the
//! tangent, `w` the depth along the frustum's axis, and whatever lies on one ray from the light has one place. There a slice's map is
//! planned as a sun's is: the rectangle around slice ∩ receivers, cropped to where casters lie, near before the first caster, far
//! behind the last receiver. Everything is clipped to the light's frustum *before* the divide, slices as well as boxes, as either
//! may straddle the light's plane, where w changes its sign. What can throw a shadow is asked by planes through the light, which divide
//! by nothing.

use glam::{DMat4, DVec2, DVec3};

use crate::light::map_axes;
use crate::plan::ShadowPlan;
use crate::planner::Placed;
use crate::split::{blend_begin, coverage, split_planes};
use crate::stable::HeldSize;
use crate::volume::{BELOW_ALL, Lies, Plane, Slice, SweptVolume};
use crate::{
    Aabb, Bands, Error, Fit, Light, PointLight, Result, Selection, ShadowSettings, Split, SplitScheme, SpotLight,
    Stabilize, View, Warp,
};

/// Share of its depths that a map keeps free before its first caster and behind its last receiver, for rounding.
const DEPTH_ROOM: f64 = 1e-3;

/// Share by which the shadowed range goes on behind the last receiver: a wall across the view is all at that depth.
const RANGE_ROOM: f64 = 1e-3;

/// The least share of a map's longer edge that its shorter one is, for receivers that the light sees edge-on.
const LEAST_EDGE: f64 = 1e-3;

/// What is the same for all maps of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub settings: &'a ShadowSettings,
    pub view: &'a View,
    /// Where the light stands, and how far it shines.
    pub position: DVec3,
    pub range: f64,
    pub casters: &'a [Placed],
    pub receivers: &'a [Placed],
    /// Texels that a map keeps free around what it serves.
    pub margin: f64,
}

/// Plans local lights; keeps its buffers, and the sizes that stabilised maps hold on to.
#[derive(Clone, Debug, Default)]
pub(crate) struct LocalPlanner {
    held: Vec<HeldSize>,
    coverages: Vec<Coverage>,
    receivers: Vec<u32>,
    casters: Vec<u32>,
}

/// The points whose shadows a split's caster list is complete for.
#[derive(Clone, Copy, Debug)]
struct Coverage {
    swept: SweptVolume,
    frustum: LightFrustum,
    part: Part,
}

/// What a spot light shines into, or one face of a point light: a square pyramid, from `near` to `range` along its axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightFrustum {
    position: DVec3,
    u: DVec3,
    v: DVec3,
    axis: DVec3,
    near: f64,
    range: f64,
    /// Tangent between the axis and the middle of a side.
    slope: f64,
    volume: Slice,
}

/// The part of a light's frustum that a map has to show: bounds in its post-perspective space, and in the world.
#[derive(Clone, Copy, Debug)]
struct Part {
    lo: DVec2,
    hi: DVec2,
    near: f64,
    far: f64,
    bounds: Aabb,
}

impl LocalPlanner {
    /// Fills the plan, frustum after frustum; see [`crate::Planner::plan`].
    pub fn plan(&mut self, given: &Given<'_>, frusta: &[LightFrustum], plan: &mut ShadowPlan) -> Result<()> {
        let settings = given.settings;
        if settings.warps.iter().any(|&warp| warp != Warp::None) {
            return Err(Error::ConflictingSettings {
                first: "warps",
                second: "light",
                reason:
                    "a warp needs light that is parallel in the world; leave warps away, or use a directional light"
                        .to_owned(),
            });
        }
        if settings.selection != Selection::Depth {
            return Err(Error::ConflictingSettings {
                first: "selection",
                second: "light",
                reason: "maps of a local light lie in its perspective and are chosen by view depth; \
                         set selection to Depth, or use a directional light"
                    .to_owned(),
            });
        }
        if settings.bands != Bands::Planar {
            return Err(Error::ConflictingSettings {
                first: "bands",
                second: "light",
                reason: "splits of a local light are chosen by view depth; \
                         set bands to Planar, or use a directional light"
                    .to_owned(),
            });
        }
        if settings.scheme == SplitScheme::Fitted {
            return Err(Error::ConflictingSettings {
                first: "scheme",
                second: "light",
                reason: "fitted planes are chosen for light that is parallel in the world; \
                         set scheme to Logarithmic or another of near and far alone, or use a directional light"
                    .to_owned(),
            });
        }
        plan.selection = Selection::Depth;
        let m = settings.splits();
        let (near, far, fades) = shadowed_range(given);
        split_planes(&settings.scheme, near, far, m, &mut plan.planes)?;
        plan.fade_begin = if fades { far - settings.far_fade * (far - near) } else { far };
        plan.split_range.resize(given.casters.len(), None);
        self.held.resize(frusta.len() * m, HeldSize::default());
        self.coverages.clear();
        for frustum in frusta {
            self.cull_to(given, frustum);
            for i in 0..m {
                self.plan_split(given, frustum, i, plan);
            }
        }
        Ok(())
    }

    /// As [`crate::Planner::covering_split`].
    pub fn covering_split(&self, plan: &ShadowPlan, light: &Light, point: DVec3, filter_radius: f64) -> Option<usize> {
        if !light.reaches(point) {
            return None;
        }
        let splits = self.coverages.len() / light.faces();
        let first = light.face_of(point) * splits;
        (first..first + splits).find(|&index| {
            let split = &plan.splits[index];
            self.coverages[index].contains(point) && (split.casters.is_empty() || split.contains(point, filter_radius))
        })
    }

    /// Receivers and casters that the light reaches in this frustum.
    fn cull_to(&mut self, given: &Given<'_>, frustum: &LightFrustum) {
        let keep = |list: &mut Vec<u32>, boxes: &[Placed], margin: f64| {
            list.clear();
            let kept = boxes.iter().enumerate().filter(|(_, placed)| frustum.may_meet(placed, margin));
            list.extend(kept.map(|(index, _)| index as u32));
        };
        keep(&mut self.receivers, given.receivers, 0.0);
        // The margin around a map is a few of its texels: at most this share of the frustum's width.
        let smallest = given.settings.map_sizes.iter().copied().min().unwrap_or(1);
        let share = 2.0 * given.margin / f64::from(smallest).max(2.0 * given.margin + 2.0);
        keep(&mut self.casters, given.casters, share * 2.0 * frustum.slope * frustum.range);
    }

    fn plan_split(&mut self, given: &Given<'_>, frustum: &LightFrustum, i: usize, plan: &mut ShadowPlan) {
        let Given { settings, view, margin, .. } = *given;
        let (near, far) = (plan.planes[i], plan.planes[i + 1]);
        let (from, to) = coverage(view, &plan.planes, i, settings.blend, settings.image_size, Bands::Planar);
        let visible = to > from;
        let (from, to) = if visible { (from, to) } else { (near, far) };
        let slice = Slice::new(view, from, to);
        let swept = slice.swept_towards_point(frustum.position);
        let part = if visible { self.part_in(given, frustum, &slice) } else { Part::EMPTY };
        let size = settings.map_sizes[i];
        let texels = (f64::from(size) - 2.0 * margin).max(2.0);

        // A tangent per texel, of the whole part: what the margin around it may be at most.
        let widest = part.extent().max_element() / texels;
        let begin = plan.caster_indices.len();
        if !part.is_empty() {
            let margin_m = margin * widest * part.far;
            self.list_casters(given, &Coverage { swept, frustum: *frustum, part }, margin_m, plan);
        }
        let casters = begin..plan.caster_indices.len();

        // Where casters lie, seen from the light, and the depth of the first.
        let mut target = if part.is_empty() { frustum.whole() } else { part };
        if !casters.is_empty() {
            let (mut lo, mut hi, mut first) = (DVec2::INFINITY, DVec2::NEG_INFINITY, f64::INFINITY);
            for &index in &plan.caster_indices[casters.clone()] {
                let (caster_lo, caster_hi, depth) = frustum.seen(&given.casters[index as usize], &part);
                (lo, hi, first) = (lo.min(caster_lo), hi.max(caster_hi), first.min(depth));
            }
            target.near = first;
            if (settings.fit, settings.stabilize) == (Fit::Dependent, Stabilize::None) {
                (target.lo, target.hi) = (lo, hi);
            }
        }

        let index = plan.splits.len();
        let (texel, min_texel) = match settings.stabilize {
            Stabilize::None => {
                let texel = target.extent() / texels;
                (texel, 0.5 * (target.lo + target.hi) / texel - 0.5 * f64::from(size))
            }
            _ => {
                let extent = target.extent().max_element();
                let extent = if part.is_empty() { extent } else { self.held[index].hold(extent) };
                let texel = DVec2::splat(extent / (texels - 1.0));
                (texel, (0.5 * (target.lo + target.hi) / texel - 0.5 * f64::from(size)).round())
            }
        };
        let (w_near, w_far) = depths(&target, frustum.near, settings.stabilize);
        let axis_offset = frustum.axis.dot(frustum.position);
        let split = Split {
            near,
            far,
            blend_begin: blend_begin(&plan.planes, i, settings.blend),
            coverage: (from, to),
            size,
            u_axis: frustum.u,
            v_axis: frustum.v,
            depth_axis: frustum.axis,
            texel_m: texel * (0.5 * (part.near.min(w_far) + w_far)),
            min_texel,
            depth_near: axis_offset + w_near,
            depth_far: axis_offset + w_far,
            receiver_depths: (axis_offset + w_near, axis_offset + w_far),
            filter_reach: settings.filter_radius,
            warp: Some(frustum.shadow_from_world(texel, min_texel, size, (w_near, w_far))),
            light_position: Some(frustum.position),
            casters,
        };
        plan.splits.push(split);
        self.coverages.push(Coverage { swept, frustum: *frustum, part });
    }

    /// What a slice shows of the light's frustum: all of it, or its receivers.
    fn part_in(&self, given: &Given<'_>, frustum: &LightFrustum, slice: &Slice) -> Part {
        let mut part = Part::EMPTY;
        if given.settings.fit == Fit::Independent {
            slice.clip_slice(&frustum.volume, |point| part.include(frustum, point));
            return part;
        }
        for &index in &self.receivers {
            let Placed { center, half } = given.receivers[index as usize];
            let bounds = Aabb::new(center - half, center + half);
            match (slice.classify(center, half), frustum.volume.classify(center, half)) {
                (Lies::Outside, _) | (_, Lies::Outside) => {}
                (Lies::Inside, Lies::Inside) => bounds.corners().iter().for_each(|&p| part.include(frustum, p)),
                _ => slice.clip_box_with(&frustum.volume, &bounds, |point| part.include(frustum, point)),
            }
        }
        part
    }

    /// Appends the casters of a split to the plan's list: boxes that meet the hull of the light and what the map has to show.
    fn list_casters(&self, given: &Given<'_>, coverage: &Coverage, margin: f64, plan: &mut ShadowPlan) {
        let split = plan.splits.len() as u8;
        let Coverage { swept, frustum, part } = coverage;
        let sides = part.sides(frustum);
        let hull = part.bounds.including(frustum.position);
        // Rounding in the bounds.
        let slack = BELOW_ALL * (hull.max - hull.min).max_element();
        for &index in &self.casters {
            let placed @ Placed { center, half } = given.casters[index as usize];
            let bounds = placed.bounds();
            let beside = bounds.max.cmplt(hull.min - margin).any() || bounds.min.cmpgt(hull.max + margin).any();
            // A ground under everything is one of its own receivers; it throws its shadow on nothing.
            let below = |axis: usize| {
                let (lo, hi) = (part.bounds.min[axis], part.bounds.max[axis]);
                let light = frustum.position[axis];
                (light > lo + slack && bounds.max[axis] <= lo + slack)
                    || (light < hi - slack && bounds.min[axis] >= hi - slack)
            };
            let listed = !beside
                && !(0..3).any(below)
                && frustum.nearest_depth(&placed) <= part.far
                && swept.meets(center, half, margin)
                && sides.iter().all(|side| side.nearest(center, half) <= margin);
            if listed {
                plan.caster_indices.push(index);
                let range = &mut plan.split_range[index as usize];
                *range = Some((range.map_or(split, |(first, _)| first), split));
            }
        }
    }
}

impl Coverage {
    fn contains(&self, point: DVec3) -> bool {
        let Self { swept, frustum, part } = self;
        let hull = part.bounds.including(frustum.position);
        !part.is_empty()
            && swept.contains(point)
            && frustum.depth(point) <= part.far
            && part.sides(frustum).iter().all(|side| side.distance(point) <= 0.0)
            && hull.including(point) == hull
    }
}

impl LightFrustum {
    /// All that a spot light shines into.
    pub fn of_spot(light: &SpotLight) -> Self {
        let slope = light.outer_angle().tan();
        Self::new(light.position(), light.direction(), slope, (light.near(), light.range()))
    }

    /// The part of a point light's surroundings around one of [`Light::FACE_AXES`].
    pub fn of_face(light: &PointLight, axis: DVec3) -> Self {
        Self::new(light.position(), axis, 1.0, (light.near(), light.range()))
    }

    fn new(position: DVec3, axis: DVec3, slope: f64, (near, range): (f64, f64)) -> Self {
        let (u, v) = map_axes(axis);
        let corner = |i: usize| {
            let depth = if i < 4 { near } else { range };
            let (x, y) = (if i & 1 == 0 { -slope } else { slope }, if i & 2 == 0 { slope } else { -slope });
            position + depth * (axis + x * u + y * v)
        };
        let volume = Slice::from_corners(std::array::from_fn(corner), axis);
        Self { position, u, v, axis, near, range, slope, volume }
    }

    fn depth(&self, point: DVec3) -> f64 {
        self.axis.dot(point - self.position)
    }

    fn nearest_depth(&self, placed: &Placed) -> f64 {
        self.depth(placed.center) - self.axis.abs().dot(placed.half)
    }

    /// Whether any of a box may lie in the frustum, widened by `margin` metres, from the light's very place on.
    fn may_meet(&self, placed: &Placed, margin: f64) -> bool {
        let nearest = self.position.clamp(placed.center - placed.half, placed.center + placed.half);
        nearest.distance(self.position) <= self.range + margin
            && self.volume.planes[1..].iter().all(|side| side.nearest(placed.center, placed.half) <= margin)
            && self.depth(placed.center) + self.axis.abs().dot(placed.half) >= 0.0
    }

    /// The place of a point in front of the light.
    fn project(&self, point: DVec3) -> DVec2 {
        let from_light = point - self.position;
        DVec2::new(self.u.dot(from_light), self.v.dot(from_light)) / self.axis.dot(from_light)
    }

    /// What a map shows of a caster: its bounds within those of `part`, and the depth of its first point. One that comes nearer than
    /// `near` may be anywhere.
    fn seen(&self, caster: &Placed, part: &Part) -> (DVec2, DVec2, f64) {
        let first = self.nearest_depth(caster);
        if first < self.near {
            return (part.lo, part.hi, self.near);
        }
        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in caster.bounds().corners() {
            let at = self.project(corner);
            (lo, hi) = (lo.min(at), hi.max(at));
        }
        (lo.clamp(part.lo, part.hi), hi.clamp(part.lo, part.hi), first)
    }

    /// All of it, for splits in which nothing is seen.
    fn whole(&self) -> Part {
        Part {
            lo: DVec2::splat(-self.slope),
            hi: DVec2::splat(self.slope),
            near: self.near,
            far: self.range,
            bounds: Aabb::EMPTY,
        }
    }

    /// To shadow NDC, with w the depth along the axis in metres and `z/w = far/(far − near) − near far/((far − near) w)`.
    fn shadow_from_world(&self, texel: DVec2, min_texel: DVec2, size: u32, (near, far): (f64, f64)) -> DMat4 {
        let half = 0.5 * f64::from(size);
        let row = |axis: DVec3, constant: f64| axis.extend(constant - axis.dot(self.position));
        let middle = (min_texel + half) * texel;
        let rows = [
            row((self.u - middle.x * self.axis) / (half * texel.x), 0.0),
            row((middle.y * self.axis - self.v) / (half * texel.y), 0.0),
            row(self.axis * (far / (far - near)), -near * far / (far - near)),
            row(self.axis, 0.0),
        ];
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }
}

impl Part {
    const EMPTY: Self = Self {
        lo: DVec2::INFINITY,
        hi: DVec2::NEG_INFINITY,
        near: f64::INFINITY,
        far: f64::NEG_INFINITY,
        bounds: Aabb::EMPTY,
    };

    fn is_empty(&self) -> bool {
        self.far < self.near
    }

    /// Takes a point of the light's frustum.
    fn include(&mut self, frustum: &LightFrustum, point: DVec3) {
        // Clipping rounds; the frustum itself ends at `near`.
        let depth = frustum.depth(point).max(0.5 * frustum.near);
        let at = frustum.project(point);
        (self.lo, self.hi) = (self.lo.min(at), self.hi.max(at));
        (self.near, self.far) = (self.near.min(depth), self.far.max(depth));
        self.bounds = self.bounds.including(point);
    }

    /// Width and height in units of the tangent; never quite nothing.
    fn extent(&self) -> DVec2 {
        let extent = (self.hi - self.lo).max(DVec2::ZERO);
        extent.max(DVec2::splat(LEAST_EDGE * extent.max_element().max(LEAST_EDGE)))
    }

    /// Planes through the light and the four edges of the rectangle.
    fn sides(&self, frustum: &LightFrustum) -> [Plane; 4] {
        let side = |normal: DVec3| {
            let normal = normal.normalize();
            Plane { normal, offset: normal.dot(frustum.position) }
        };
        let LightFrustum { u, v, axis, .. } = *frustum;
        [side(self.lo.x * axis - u), side(u - self.hi.x * axis), side(self.lo.y * axis - v), side(v - self.hi.y * axis)]
    }
}

/// Depths along the axis at 0 and 1: before the first caster and behind the last receiver; in whole steps where the map is to stand
/// still.
fn depths(target: &Part, least: f64, stabilize: Stabilize) -> (f64, f64) {
    let far = target.far * (1.0 + DEPTH_ROOM);
    let near = (target.near.max(least) * (1.0 - DEPTH_ROOM)).min(0.5 * far);
    match stabilize {
        Stabilize::None => (near, far),
        _ => (2f64.powf(near.log2().floor()), 2f64.powf(far.log2().ceil())),
    }
}

/// View depths that shadows cover, `C_0` and `C_m`, and whether they fade at the end: the setting; or the camera's near and far, far
/// capped by the receivers that the light reaches, both narrowed to where it reaches. Shadows fade only where they end though
/// the light goes on.
fn shadowed_range(given: &Given<'_>) -> (f64, f64, bool) {
    let Given { settings, view, position, range, .. } = *given;
    if let Some((near, far)) = settings.range {
        return (near, far, true);
    }
    let forward = view.forward();
    let (camera_near, camera_far) = (view.frustum().near, view.frustum().far);
    let deepest = given
        .receivers
        .iter()
        .filter(|r| position.clamp(r.center - r.half, r.center + r.half).distance(position) <= range)
        .map(|r| view.view_depth(r.center) + forward.abs().dot(r.half))
        .fold(f64::NEG_INFINITY, f64::max);
    let at = view.view_depth(position);
    let reach = (at - range, at + range);
    let nothing = (camera_near, 2.0 * camera_near.abs() + 1.0, false);
    let far = deepest.min(reach.1) * (1.0 + RANGE_ROOM);
    if far <= camera_near || !far.is_finite() || reach.0 >= camera_far {
        // The light reaches nothing that is seen: any short range will do.
        return nothing;
    }
    // Planes that were given in metres mean those of the whole view.
    let free = match &settings.scheme {
        SplitScheme::Uniform | SplitScheme::Logarithmic | SplitScheme::Fitted => true,
        SplitScheme::Practical { delta, .. } => delta.is_empty(),
        SplitScheme::Manual(_) => false,
    };
    let near = if free { camera_near.max(reach.0) } else { camera_near };
    if near >= far { nothing } else { (near, far.min(camera_far), camera_far < far) }
}
