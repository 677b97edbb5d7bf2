//! The planner: from a view, a light and bounds to a [`ShadowPlan`].

pub(crate) mod lists;

use glam::{DVec2, DVec3};

use crate::cells::Sight;
use crate::covered;
use crate::fit::{Block, fitted, snapped, stepped};
use crate::local::{Given, LightFrustum, LocalPlanner};
use crate::margin::{EDGE_TEXELS, Reach};
use crate::placement::{Maps, Placement};
use crate::range::{HeldEnds, Range};
use crate::reach::CoverageVolume;
use crate::receiver_mask::ReceiverMask;
use crate::rectangle::{HeldRectangle, longest_edge};
use crate::region::{Fan, Region};
use crate::settings::check_range;
use crate::split::{blend_begin, coverage, split_planes};
use crate::stable::{HeldHalf, HeldLens, HeldSize, slice_sphere, stable_texel};
use crate::volume::{Lies, Slice, lies_below};
use crate::warped::WarpPoints;
use crate::{
    Aabb, Bands, DirectionalLight, Error, Fit, Light, MAX_SPLITS, RangeFit, Result, Selection, ShadowPlan,
    ShadowSettings, Split, SplitScheme, Stabilize, View, Warp,
};

/// Plans shadow maps frame after frame. Keeps its buffers, so that only the first frame allocates, and the sizes that
/// stabilised maps hold on to.
#[derive(Clone, Debug)]
pub struct Planner {
    pub(crate) settings: ShadowSettings,
    pub(crate) plan: ShadowPlan,
    held_ends: HeldEnds,
    held_lens: HeldLens,
    /// Stabilised: the view through the lens that maps are made for, the camera's or one around it.
    held_view: Option<View>,
    held_half: [HeldHalf; MAX_SPLITS],
    held_whole: HeldSize,
    /// Stabilised: across the sphere around everything that is shadowed, metres. 0 otherwise.
    whole_width: f64,
    held_rectangle: [HeldRectangle; MAX_SPLITS],
    /// Exactly stabilised: around all receivers, which no map has to exceed along any axis.
    around_all: Option<Block>,
    pub(crate) fan: Option<Fan>,
    pub(crate) volumes: Vec<CoverageVolume>,
    /// Where the parts of each split's receivers lie, if they were told for the last plan.
    pub(crate) masks: Vec<ReceiverMask>,
    pub(crate) knows_parts: bool,
    /// With [`Selection::Map`]: everything that the view shows in range, which any map may be asked about.
    pub(crate) shown: Option<Shown>,
    world_depths: (f64, f64),
    casters: Vec<Placed>,
    receivers: Vec<Placed>,
    candidates: Vec<u32>,
    visible: Vec<u32>,
    across: Vec<u32>,
    warp_points: WarpPoints,
    placement: Placement,
    pub(crate) local: LocalPlanner,
}

/// A box as centre and half extent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub center: DVec3,
    pub half: DVec3,
}

impl Placed {
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.center - self.half, self.center + self.half)
    }
}

/// Everything that the view shows in range.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    volume: CoverageVolume,
    /// Metres along the light.
    depths: (f64, f64),
}

impl Planner {
    /// A planner for these settings.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the field that is wrong, [`Error::ConflictingSettings`] naming two that exclude each other.
    pub fn new(settings: ShadowSettings) -> Result<Self> {
        settings.validate()?;
        Ok(Self {
            settings,
            plan: ShadowPlan::default(),
            held_ends: HeldEnds::default(),
            held_lens: HeldLens::default(),
            held_view: None,
            held_half: [HeldHalf::default(); MAX_SPLITS],
            held_whole: HeldSize::default(),
            whole_width: 0.0,
            held_rectangle: [HeldRectangle::default(); MAX_SPLITS],
            around_all: None,
            fan: None,
            volumes: Vec::new(),
            masks: Vec::new(),
            knows_parts: false,
            shown: None,
            world_depths: (0.0, 0.0),
            casters: Vec::new(),
            receivers: Vec::new(),
            candidates: Vec::new(),
            visible: Vec::new(),
            across: Vec::new(),
            warp_points: WarpPoints::default(),
            placement: Placement::default(),
            local: LocalPlanner::default(),
        })
    }

    /// What the planner was made with.
    #[must_use]
    pub fn settings(&self) -> &ShadowSettings {
        &self.settings
    }

    /// Plans the maps of one frame for one light: a [`DirectionalLight`], a [`crate::SpotLight`], a [`crate::PointLight`] or any
    /// [`Light`].
    ///
    /// `casters` throw shadows, `receivers` show them; most objects are in both lists. The plan's caster indices refer to
    /// `casters`. A point light's plan has six times as many splits as the settings: those of its first face, then those of the
    /// next ([`Light::FACE_AXES`]). Splits that the light does not reach have no casters.
    ///
    /// A local light's default range is narrowed to where it reaches. Its stabilised maps stand on whole texels, of a size that
    /// changes in steps: between two steps a shadow's texels stay where they are.
    ///
    /// # Errors
    /// [`Error::InvalidBounds`] naming a box that is inverted or not finite; [`Error::InvalidSetting`] if the range or the
    /// planes do not fit this camera; [`Error::ConflictingSettings`] for a warp or radial bands with a local light, and for radial bands with
    /// an orthographic camera.
    pub fn plan(
        &mut self,
        view: &View,
        light: &(impl Copy + Into<Light>),
        casters: &[Aabb],
        receivers: &[Aabb],
    ) -> Result<&ShadowPlan> {
        self.knows_parts = false;
        place(casters, "casters", &mut self.casters)?;
        place(receivers, "receivers", &mut self.receivers)?;
        let light = (*light).into();
        match &light {
            Light::Directional(sun) => self.plan_sun(view, sun)?,
            Light::Spot(spot) => {
                self.plan_local(view, &light, spot.position(), &[LightFrustum::of_spot(spot)])?;
            }
            Light::Point(point) => {
                let frusta = Light::FACE_AXES.map(|axis| LightFrustum::of_face(point, axis));
                self.plan_local(view, &light, point.position(), &frusta)?;
            }
        }
        Ok(&self.plan)
    }

    fn plan_local(&mut self, view: &View, light: &Light, position: DVec3, frusta: &[LightFrustum]) -> Result<()> {
        let given = Given {
            settings: &self.settings,
            view,
            position,
            range: light.range(),
            casters: &self.casters,
            receivers: &self.receivers,
            margin: self.settings.filter_radius + EDGE_TEXELS,
        };
        self.fan = None;
        self.plan.begin(view, *light);
        self.local.plan(&given, frusta, &mut self.plan)
    }

    fn plan_sun(&mut self, view: &View, light: &DirectionalLight) -> Result<()> {
        let casters = self.casters.len();
        self.settings.bands.check_view(view)?;
        let range = self.held_ends.range(&self.settings, view, &self.receivers);
        if let Err(error) = check_range(range.near, range.inner_far) {
            self.held_ends.release_far();
            return Err(error);
        }
        let Range { near, far, .. } = range;
        let direction = light.direction();
        let (map_u, _) = light.map_axes();
        let first = match self.settings.stabilize {
            Stabilize::Approximate(_) => map_u,
            Stabilize::None | Stabilize::Exact => {
                (view.forward() - view.forward().dot(direction) * direction).try_normalize().unwrap_or(map_u)
            }
        };
        if self.plan.light_direction != direction {
            self.held_rectangle = [HeldRectangle::default(); MAX_SPLITS];
        }
        let fan = Fan::new(first, direction);
        self.fan = Some(fan);
        self.held_view = None;
        if self.settings.stabilize != Stabilize::None {
            let held_view = self.hold_lens(view)?;
            let sphere = slice_sphere(held_view.frustum(), view.frustum().near, far);
            self.whole_width = 2.0 * self.held_whole.hold(sphere.radius);
            self.held_view = Some(held_view);
        }
        let is_exact = self.settings.stabilize == Stabilize::Exact;
        self.around_all = if is_exact { Block::around(&self.receivers, light) } else { None };
        self.cull_to_view(view, direction, far);
        if let Err(error) = self.place_planes(view, &fan, range) {
            // A range that cannot be divided is not held on to.
            self.held_ends.release_far();
            return Err(error);
        }
        self.shown = (self.settings.selection == Selection::Map).then(|| self.all_that_is_shown(view, far, &fan));
        if self.settings.stabilize != Stabilize::None && !self.settings.depth_clamp {
            self.world_depths = self.measure_world_depths(direction);
        }

        let plan = &mut self.plan;
        plan.begin(view, (*light).into());
        plan.selection = self.settings.selection;
        plan.blend = self.settings.blend;
        plan.radial_eye = (self.settings.bands == Bands::Radial).then(|| view.eye());
        // Behind the last receiver and beyond the camera's far plane there is nothing to fade into.
        let last_shown = view.frustum().far / self.settings.bands.least_depth_share(view);
        let fades = self.settings.range.is_some_and(|(_, end)| end < last_shown);
        plan.fade_begin = if fades { far - self.settings.far_fade * (far - near) } else { far };
        plan.split_range.resize(casters, None);
        self.volumes.clear();
        for i in 0..self.settings.splits() {
            self.plan_split(i, view, light, &fan);
        }
        Ok(())
    }

    fn hold_lens(&mut self, view: &View) -> Result<View> {
        let before = self.held_lens;
        let lens = self.held_lens.hold(view.frustum());
        if self.held_lens != before {
            // All maps change with the lens: none's size is worth holding on to.
            self.held_half = Default::default();
        }
        view.with_frustum(lens)
    }

    /// Writes `C_0 ..= C_m` into the plan.
    fn place_planes(&mut self, view: &View, fan: &Fan, range: Range) -> Result<()> {
        let m = self.settings.splits();
        if self.settings.scheme == SplitScheme::Fitted {
            let sight = Sight {
                view,
                fan,
                receivers: &self.receivers,
                visible: &self.visible,
                casters: &self.casters,
                candidates: &self.candidates,
            };
            let margin = self.settings.filter_radius + EDGE_TEXELS;
            let most_half = self.around_all.map_or(DVec2::INFINITY, |all| all.half.truncate());
            let maps = Maps { settings: &self.settings, margin, whole_width: self.whole_width, most_half };
            if self.placement.place(&sight, &maps, range, &mut self.plan.planes)? {
                // Other slices have other sizes: none is worth holding on to.
                self.held_half = Default::default();
            }
        } else {
            split_planes(&self.settings.scheme, range.near, range.inner_far, m, &mut self.plan.planes)?;
        }
        self.plan.planes[m] = range.far;
        Ok(())
    }

    /// Receivers that some slice can contain and casters that some slice's sweep can meet.
    fn cull_to_view(&mut self, view: &View, direction: DVec3, far: f64) {
        let whole = Slice::new(view, view.frustum().near, far.min(view.frustum().far));
        self.visible.clear();
        for (i, receiver) in self.receivers.iter().enumerate() {
            if whole.classify(receiver.center, receiver.half) != Lies::Outside {
                self.visible.push(i as u32);
            }
        }
        let swept = whole.swept_towards_light(direction);
        // The margin around a split is a few of its texels: at most this share of its width.
        let across = whole.corners[4].distance(whole.corners[7]).max(whole.corners[0].distance(whole.corners[7]));
        let margin = self.margin_share() * across.max(self.whole_width);
        self.candidates.clear();
        for (i, caster) in self.casters.iter().enumerate() {
            if swept.meets(caster.center, caster.half, margin) {
                self.candidates.push(i as u32);
            }
        }
    }

    /// The largest share of a map's width that its margin can be.
    fn margin_share(&self) -> f64 {
        let margin = self.settings.filter_radius + EDGE_TEXELS;
        let smallest = self.settings.map_sizes.iter().copied().min().unwrap_or(1);
        2.0 * margin / f64::from(smallest).max(2.0 * margin + 2.0)
    }

    fn plan_split(&mut self, i: usize, view: &View, light: &DirectionalLight, fan: &Fan) {
        let settings = &self.settings;
        let planes = &self.plan.planes;
        let direction = light.direction();
        let size = settings.map_sizes[i];
        let margin = settings.filter_radius + EDGE_TEXELS;
        let covered = |view| coverage(view, planes, i, settings.blend, settings.image_size, settings.bands);
        let (from, to) = covered(view);
        let blend_begin = blend_begin(planes, i, settings.blend);
        let (near, far) = (planes[i], planes[i + 1]);
        // Where the range holds all that is visible, nothing before it asks.
        let fitted_begin = i == 0 && settings.range_fit == RangeFit::Visible;
        let from = if fitted_begin { from.max(near) } else { from };
        let visible = to > from;
        // A slice beyond the camera's far plane serves nothing; it still gets a valid matrix.
        let (from, to) = if visible { (from, to) } else { (near, far) };
        let slice = Slice::new(view, from, to);
        let swept = slice.swept_towards_light(direction);
        let mut slice_region = Region::EMPTY;
        slice.corners.iter().for_each(|&corner| slice_region.include_point(fan, corner));

        // A wider lens has wider pixels, and its slices reach back farther.
        let held_view = self.held_view.as_ref().unwrap_or(view);
        let begin = if visible && i > 0 { covered(held_view).0.min(from) } else { from };
        let sphere = slice_sphere(held_view.frustum(), begin, to);
        let block = Block::around_sphere(view.world_from_view_point(sphere.center), sphere.radius, light);
        let block = self.around_all.map_or(block, |all| block.no_longer_than(&all));
        let half = match settings.stabilize {
            Stabilize::Exact | Stabilize::Approximate(_) => self.held_half[i].hold(block.half.truncate()),
            Stabilize::None => block.half.truncate(),
        };
        let radius = half.max_element();
        // A warped map's texels differ in size.
        let reach = if settings.warp(i) == Warp::None { Reach::of(settings) } else { Reach::most(settings) };
        let stable_reach = reach.texels(2.0 * half.min_element(), size, 2.0 * EDGE_TEXELS + 1.0);
        let stable_texel = half.to_array().map(|half| stable_texel(half, size, stable_reach + EDGE_TEXELS));
        let stable_texel = DVec2::from(stable_texel);

        let served = match self.settings.fit {
            Fit::Independent => None,
            Fit::Dependent => Some(self.receivers_in(&slice, fan)),
        };
        let widest = served.as_ref().map_or(&slice_region, |(region, _)| region).widest().max(0.0);
        let (stabilize, whole_width) = (self.settings.stabilize, self.whole_width);
        let margin_of = |widest: f64| match stabilize {
            Stabilize::Exact => (stable_reach + EDGE_TEXELS) * stable_texel.max_element(),
            Stabilize::Approximate(steps) => {
                margin * longest_edge(steps, widest, whole_width) / (f64::from(size) - 2.0 * margin - 1.0)
            }
            Stabilize::None => widest * margin / (f64::from(size) - 2.0 * margin).max(1.0),
        };
        let mut margin_m = margin_of(widest);
        let mut casters =
            if visible { self.list_casters(&swept, served.as_ref(), fan, margin_m) } else { self.empty_list() };
        let (mut target, mut caster_near) = self.target(casters.clone(), served.as_ref(), slice_region, fan);
        // Casters leave a map with smaller texels than its receivers alone, and with those its filter reaches less far.
        if served.is_some() && !casters.is_empty() && self.settings.warp(i) == Warp::None {
            margin_m = margin_of(target.widest());
            if self.keep_casters(&mut casters, &swept, served.as_ref(), fan, margin_m) {
                (target, caster_near) = self.target(casters.clone(), served.as_ref(), slice_region, fan);
            }
        }
        let split = Split {
            near,
            far,
            blend_begin,
            coverage: (from, to),
            size,
            u_axis: DVec3::ZERO,
            v_axis: DVec3::ZERO,
            depth_axis: direction,
            texel_m: DVec2::ONE,
            min_texel: DVec2::ZERO,
            depth_near: target.depth.0,
            depth_far: target.depth.1,
            receiver_depths: target.depth,
            filter_reach: stable_reach,
            warp: None,
            light_position: None,
            casters,
        };
        let split = match self.settings.stabilize {
            Stabilize::None => fitted(split, &target, fan, reach),
            Stabilize::Exact => snapped(split, light, &block, stable_texel),
            Stabilize::Approximate(steps) => {
                // A split without casters is lit, whatever its rectangle; it changes nothing that is held.
                let mut unheld = HeldRectangle::default();
                let held = if split.casters.is_empty() { &mut unheld } else { &mut self.held_rectangle[i] };
                let rectangle = held.hold(&target, steps, self.whole_width);
                stepped(split, &target, fan, reach, rectangle, (block.center.z - radius, block.center.z + radius))
            }
        };
        let (split, caster_near) = match self.shown.clone() {
            Some(shown) if !split.casters.is_empty() => self.serving_all_it_covers(split, &shown, fan, caster_near),
            _ => (split, caster_near),
        };
        for &index in &self.plan.caster_indices[split.casters.clone()] {
            let range = &mut self.plan.split_range[index as usize];
            *range = Some((range.map_or(i as u8, |(first, _)| first), i as u8));
        }
        let mut split = self.with_depth_range(split, caster_near, radius);
        let warp = self.settings.warp(i);
        if warp != Warp::None && !split.casters.is_empty() {
            let boxes = match self.settings.fit {
                Fit::Independent => None,
                Fit::Dependent => Some((&self.receivers[..], &self.visible[..])),
            };
            self.warp_points.receivers_of(&slice, boxes);
            let casters = self.plan.caster_indices[split.casters.clone()].iter();
            self.warp_points.casters_of(&swept, margin_m, casters.map(|&index| &self.casters[index as usize]));
            self.warp_points.warp(&mut split, warp, view, margin, self.settings.fit);
        }
        self.plan.splits.push(split);
        self.volumes.push(match &self.shown {
            Some(shown) => shown.volume.clone(),
            None => CoverageVolume { slice, swept, receivers: served, margin: margin_m },
        });
    }

    /// What any map may be asked about where maps are chosen by what they contain.
    fn all_that_is_shown(&mut self, view: &View, far: f64, fan: &Fan) -> Shown {
        let frustum = view.frustum();
        let (near, far) = (frustum.near, far.min(frustum.far));
        let slice = Slice::new(view, near, if far > near { far } else { near * 1.01 + 0.01 });
        let mut corners = Region::EMPTY;
        slice.corners.iter().for_each(|&corner| corners.include_point(fan, corner));
        let receivers = match self.settings.fit {
            Fit::Independent => None,
            Fit::Dependent => Some(self.receivers_in(&slice, fan)),
        };
        let depths = receivers.as_ref().map_or(corners, |(region, _)| *region).depth;
        let swept = slice.swept_towards_light(fan.depth);
        // Each map has a margin of its own.
        Shown { volume: CoverageVolume { slice, swept, receivers, margin: 0.0 }, depths }
    }

    /// The split with a list and a depth range for everything that its map covers and no earlier one takes, and the depth of its
    /// first caster.
    fn serving_all_it_covers(&mut self, mut split: Split, shown: &Shown, fan: &Fan, caster_near: f64) -> (Split, f64) {
        self.plan.caster_indices.truncate(split.casters.start);
        let taken = covered::Taken::new(&split, &self.plan.splits, self.settings.blend);
        let margin = taken.margin * split.texel_m.max_element();
        let mut caster_near = caster_near;
        for &index in &self.candidates {
            let Placed { center, half } = self.casters[index as usize];
            let can_shade = shown.volume.receivers.as_ref().is_none_or(|(region, bounds)| {
                !lies_below(center, half, bounds, fan.depth, margin)
                    && region.can_be_shadowed_by(fan, center, half, margin)
            });
            if can_shade && covered::reaches(&split, center, half) && !taken.holds(center, half) {
                self.plan.caster_indices.push(index);
                caster_near = caster_near.min(fan.depth.dot(center) - fan.depth.abs().dot(half));
            }
        }
        split.casters.end = self.plan.caster_indices.len();
        split.depth_near = split.depth_near.min(shown.depths.0);
        split.depth_far = split.depth_far.max(shown.depths.1);
        (split, caster_near)
    }

    /// Near and far planes: before the first caster and behind the last receiver, with room for the bias. Where depth is clamped
    /// near lies at the first receiver. A stabilised split takes the bounds of the whole world (or, clamped, of its sphere)
    /// in whole steps, so that what it stores does not depend on where the camera stands.
    fn with_depth_range(&self, mut split: Split, caster_near: f64, radius: f64) -> Split {
        let texel = split.texel_m.max_element();
        let clamped = self.settings.depth_clamp;
        let (near, far, step) = match (self.settings.stabilize, clamped) {
            (Stabilize::None, true) => (split.depth_near, split.depth_far, None),
            (Stabilize::None, false) => (split.depth_near.min(caster_near), split.depth_far, None),
            (_, true) => (split.depth_near, split.depth_far, Some(0.5 * radius)),
            (_, false) => {
                let (near, far) = self.world_depths;
                let known = near.is_finite() && far > near;
                let (near, far) = if known { (near, far) } else { (split.depth_near, split.depth_far) };
                (near, far, Some((far - near) / 16.0))
            }
        };
        let receivers = match self.settings.stabilize {
            Stabilize::None => None,
            // Finer steps would move more often, and with them what leaks.
            _ => Some(radius / 8.0),
        };
        let (first, last) = split.receiver_depths;
        split.receiver_depths = with_room(first, last, texel, receivers);
        (split.depth_near, split.depth_far) = with_room(near, far, texel, step);
        split
    }

    /// Depth of the first caster and of the last receiver of all.
    fn measure_world_depths(&self, depth_axis: DVec3) -> (f64, f64) {
        let reach = depth_axis.abs();
        let near =
            self.casters.iter().map(|c| depth_axis.dot(c.center) - reach.dot(c.half)).fold(f64::INFINITY, f64::min);
        let far = self
            .receivers
            .iter()
            .map(|r| depth_axis.dot(r.center) + reach.dot(r.half))
            .fold(f64::NEG_INFINITY, f64::max);
        (near, far)
    }
}

/// A range of depths with room for the bias, in whole steps if there is one.
fn with_room(near: f64, far: f64, texel: f64, step: Option<f64>) -> (f64, f64) {
    let room = 4.0 * texel + 1e-4 * (far - near);
    let (near, far) = (near - room, far + room);
    let Some(step) = step else { return (near, far) };
    let step = 2f64.powf(step.log2().round());
    ((near / step).floor() * step, (far / step).ceil() * step)
}

fn place(boxes: &[Aabb], list: &'static str, placed: &mut Vec<Placed>) -> Result<()> {
    placed.clear();
    for (index, bounds) in boxes.iter().enumerate() {
        if !bounds.is_valid() {
            return Err(Error::InvalidBounds { list, index, min: bounds.min, max: bounds.max });
        }
        placed.push(Placed { center: bounds.center(), half: bounds.half_extent() });
    }
    Ok(())
}
