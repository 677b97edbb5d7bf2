//! The result of the planner: everything a renderer needs for one light and one view.

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::casters::Gathered;
use crate::config::{Selection, SplitMetric};
use crate::coverage::PlanCoverage;
use crate::{Aabb, DepthConvention, Light, View};

/// The most splits that a light can have.
pub const MAX_SPLITS: usize = 8;

/// The shadow maps of one light for one view.
///
/// All positions are `f64` world metres; a renderer subtracts its own origin before it converts
/// them to `f32`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShadowPlan {
    /// The splits, nearest first. For a point light, the splits of its first face, then those of
    /// the next.
    pub splits: Vec<Split>,
    /// Split planes `C_0 ..= C_m`: view depths in metres. With radial bands they are distances to
    /// the camera, see [`ShadowPlan::metric`].
    pub planes: Vec<f64>,
    /// The plane that measures view depth: `xyz · point + w`, in metres.
    pub view_depth_plane: DVec4,
    /// Position of the camera in metres; for a parallel projection the point that [`View::eye`]
    /// gives.
    pub eye: DVec3,
    /// Direction in which light travels, a unit vector; for a spot light its axis. A point light
    /// has none, and the value is straight down.
    pub light_direction: DVec3,
    /// The light that was planned for; `None` stands for a sun along `light_direction`.
    pub light: Option<Light>,
    /// View depth at which the fade to lit begins; `C_m` if there is none.
    pub fade_begin: f64,
    /// Rule by which a point selects its split.
    pub selection: Selection,
    /// With [`Selection::Map`]: share of a map's half edge over which the map blends into the next
    /// one that contains the point.
    pub blend: f64,
    /// Casters of all splits, one split after the other: indices into the planner's caster list, or
    /// keys of its set; see [`ShadowPlan::casters`].
    pub caster_indices: Vec<u32>,
    /// For each split, the number of casters that its list omits by
    /// [`crate::ShadowConfig::drop_small_casters`].
    pub dropped_casters: Vec<u32>,
    /// For each caster of a list, the first and the last split in which it is drawn; `None` if it
    /// is drawn in no split. The range is a bound: the lists are exact. Empty for a set, whose keys
    /// may be any numbers: see [`ShadowPlan::splits_of`].
    pub split_range: Vec<Option<(u8, u8)>>,
    /// Points for which the caster lists are complete; see [`ShadowPlan::casts_into`] and
    /// [`ShadowPlan::covering_split`].
    pub coverage: PlanCoverage,
}

impl Default for ShadowPlan {
    /// A plan without splits.
    fn default() -> Self {
        Self {
            splits: Vec::new(),
            planes: Vec::new(),
            view_depth_plane: DVec4::ZERO,
            eye: DVec3::ZERO,
            light_direction: DVec3::ZERO,
            light: None,
            fade_begin: 0.0,
            selection: Selection::VIEW_DEPTH,
            blend: 0.0,
            caster_indices: Vec::new(),
            dropped_casters: Vec::new(),
            split_range: Vec::new(),
            coverage: PlanCoverage::default(),
        }
    }
}

impl ShadowPlan {
    /// Empties the plan for a frame.
    pub(crate) fn begin(&mut self, view: &View, light: Light) {
        self.view_depth_plane = view.forward().extend(-view.forward().dot(view.eye()));
        self.eye = view.eye();
        self.light_direction = match light {
            Light::Directional(sun) => sun.direction(),
            Light::Spot(spot) => spot.direction(),
            Light::Point(_) => DVec3::NEG_Y,
        };
        self.light = Some(light);
        self.selection = Selection::VIEW_DEPTH;
        self.blend = 0.0;
        self.planes.clear();
        self.caster_indices.clear();
        self.dropped_casters.clear();
        self.split_range.clear();
        self.splits.clear();
        self.coverage.clear();
    }

    /// Copies another plan that was made without receiver clusters. Buffers are kept.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.splits.clone_from(&other.splits);
        self.planes.clone_from(&other.planes);
        self.caster_indices.clone_from(&other.caster_indices);
        self.split_range.clone_from(&other.split_range);
        self.dropped_casters.clone_from(&other.dropped_casters);
        self.coverage.copy_from(&other.coverage);
        (self.view_depth_plane, self.eye) = (other.view_depth_plane, other.eye);
        (self.light_direction, self.light) = (other.light_direction, other.light);
        (self.fade_begin, self.selection, self.blend) = (other.fade_begin, other.selection, other.blend);
    }

    /// Adds a split with those of the gathered casters that are at `places`.
    pub(crate) fn add_listed(&mut self, mut split: Split, casters: &mut Gathered, places: &[u32]) {
        let begin = self.caster_indices.len();
        casters.name(places, &mut self.caster_indices);
        split.casters = begin..self.caster_indices.len();
        self.add(split);
    }

    /// Adds a split whose casters are listed. Casters of a set have no entry in `split_range`.
    fn add(&mut self, split: Split) {
        let at = self.splits.len() as u8;
        if !self.split_range.is_empty() {
            for &index in &self.caster_indices[split.casters.clone()] {
                let range = &mut self.split_range[index as usize];
                *range = Some((range.map_or(at, |(first, _)| first), at));
            }
        }
        self.splits.push(split);
        self.dropped_casters.resize(self.splits.len(), 0);
    }

    /// Depth in metres by which the split of a world point is chosen: its view depth, or with
    /// radial bands its distance to the camera.
    #[must_use]
    pub fn depth_at(&self, point: DVec3) -> f64 {
        match self.metric() {
            SplitMetric::Distance => self.eye.distance(point),
            SplitMetric::ViewDepth => self.view_depth_plane.truncate().dot(point) + self.view_depth_plane.w,
        }
    }

    /// Measure of the plan's depths.
    #[must_use]
    pub const fn metric(&self) -> SplitMetric {
        self.selection.metric()
    }

    /// Number of faces, each of which has the splits of the config; see [`Light::faces`].
    #[must_use]
    pub fn faces(&self) -> usize {
        self.light.map_or(1, |light| light.faces())
    }

    /// Returns whether a part of a caster of `split`, given by its world box, can cast a shadow on
    /// anything that the split serves. This is the test by which casters were listed. An
    /// application that keeps large meshes in clusters skips those that are rejected.
    ///
    /// The test is conservative: skipping what it rejects never changes a visible pixel. With
    /// [`crate::PlanInputs::receiver_clusters`] it also rejects parts without such a cluster behind
    /// them. Always `true` for local lights and with [`Selection::Map`].
    #[must_use]
    pub fn casts_into(&self, split: usize, part: &Aabb) -> bool {
        self.coverage.casts_into(split, part)
    }

    /// The first split whose map contains every caster that can shade `point`, for points that the
    /// view does not show (points that it shows use the split of their view depth). A split without
    /// casters counts as well, and means lit, but not with [`Selection::Map`]. `None` if no map
    /// serves the point.
    #[must_use]
    pub fn covering_split(&self, point: DVec3) -> Option<usize> {
        let in_map = |split: &Split| split.contains(point, split.filter_radius_texels);
        if let Some(light) = self.light.filter(|light| light.position().is_some()) {
            let m = self.coverage.local.len() / light.faces();
            let first = light.face_of(point) * m;
            let covers = |&i: &usize| {
                let split = &self.splits[i];
                self.coverage.contains_local(i, point) && (split.casters.is_empty() || in_map(split))
            };
            return (first..first + m).find(covers).filter(|_| light.illuminates(point));
        }
        let mut covering = self.splits.iter().enumerate().filter(|(i, _)| self.coverage.contains(*i, point));
        match self.selection {
            Selection::Interval(_) => covering.find(|(_, split)| split.casters.is_empty() || in_map(split)),
            // Later maps leave out casters whose shadows lie over an earlier one, so that one has
            // to answer or nobody does. It does not answer for points before its depth range, where
            // nobody looked for casters.
            Selection::Map => covering
                .find(|(_, split)| !split.casters.is_empty() && split.lies_over(point, split.filter_radius_texels))
                .filter(|(_, split)| in_map(split)),
        }
        .map(|(i, _)| i)
    }

    /// Mask of the splits in which a caster, named by its index or key, is drawn: bit `i` stands
    /// for split `i`. 0 if there is none.
    #[must_use]
    pub fn splits_of(&self, caster: u32) -> u64 {
        let is_in = |&split: &usize| self.casters(split).binary_search(&caster).is_ok();
        (0..self.splits.len()).filter(is_in).fold(0, |splits, split| splits | 1 << split)
    }

    /// Casters of split `index`, rising: indices into the list given to the planner, or keys of its
    /// set.
    #[must_use]
    pub fn casters(&self, index: usize) -> &[u32] {
        &self.caster_indices[self.splits[index].casters.clone()]
    }
}

/// One slice of the view and the map that serves it.
///
/// A plain map is an orthographic image along [`Split::depth_axis`]. For a world point `p`, `texel
/// = ((u_axis·p)/texel_m.x − min_texel.x, (v_axis·p)/texel_m.y − min_texel.y)` is its position in
/// the map in texels, v down, `[0, size]²`, and `depth = (depth_axis·p − depth_near)/(depth_far −
/// depth_near)` is the depth that the map stores.
///
/// A warped map is projected by [`Split::warp`]. The axes, `min_texel` and the depths are then
/// those of the plain map that it replaces; [`Split::map_from_world`] and the methods beside it
/// work for either kind.
///
/// The map of a local light is a perspective image from [`Split::light_position`] along
/// [`Split::depth_axis`], also projected by [`Split::warp`]: w is the depth along that axis in
/// metres, and the stored depth is `A − B/w`, 0 at `depth_near` and 1 at `depth_far`.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Split {
    /// Start of the slice, `C_i`: a view depth in metres; with radial bands a distance to the
    /// eye, see [`ShadowPlan::metric`].
    pub near: f64,
    /// Far end of the slice, `C_{i+1}`.
    pub far: f64,
    /// View depth at which the blend into the next split begins; `far` if there is none.
    pub blend_begin: f64,
    /// Range of view depths, with radial bands too, that may sample this map: the slice, widened by
    /// the previous split's blend band and a pixel quad.
    pub coverage: (f64, f64),
    /// Edge of the map in texels.
    pub size: u32,
    /// World direction of the map's u (to the right), a unit vector.
    pub u_axis: DVec3,
    /// World direction of the map's v (down), a unit vector.
    pub v_axis: DVec3,
    /// World direction of depth, a unit vector: the direction in which light travels, or the
    /// viewing direction of a local light's map.
    pub depth_axis: DVec3,
    /// Metres per texel along u and v. In a warped map or that of a local light, texels have this
    /// size only in the middle of their receivers; see [`Split::texel_size_m`].
    pub texel_m: DVec2,
    /// The map's upper left corner in texels of the light's plane (for a local light: from the
    /// axis); whole numbers if the split is stabilised.
    pub min_texel: DVec2,
    /// Metres along `depth_axis` at depth 0.
    pub depth_near: f64,
    /// Metres along `depth_axis` at depth 1.
    pub depth_far: f64,
    /// Metres along `depth_axis` of the nearest and the farthest point that is shaded by this map,
    /// with room for the bias. Moment filters scale depth to this range. A caster may lie before
    /// it.
    pub receiver_depths: (f64, f64),
    /// Texels around a sample that a filter may read: points on screen lie at least this far inside
    /// the map. [`crate::FilterReach::radius_texels`], or less if the filter's width is known in
    /// metres.
    pub filter_radius_texels: f64,
    /// Matrix from world to shadow NDC (x, y in [−1,1], y up, z in \[0,1\]), to be divided by w;
    /// `None` for a plain map. w is positive at every receiver, and does not change along parallel
    /// light.
    pub warp: Option<DMat4>,
    /// Position of the light in world metres; `None` for parallel light.
    pub light_position: Option<DVec3>,
    /// This split's part of [`ShadowPlan::caster_indices`]. If it is empty, nothing casts a shadow
    /// here and the split is lit.
    pub casters: std::ops::Range<usize>,
}

impl Split {
    /// Position of a world point in the map: texels (v down) and stored depth. NaN behind a warped
    /// map's projection centre, where the map shows nothing.
    #[must_use]
    pub fn map_from_world(&self, point: DVec3) -> DVec3 {
        if let Some(shadow_from_world) = self.warp {
            let at = shadow_from_world * point.extend(1.0);
            if at.w <= 0.0 {
                return DVec3::NAN;
            }
            let half = 0.5 * f64::from(self.size);
            let ndc = at.truncate() / at.w;
            return DVec3::new(half * (1.0 + ndc.x), half * (1.0 - ndc.y), ndc.z);
        }
        let texel = DVec2::new(self.u_axis.dot(point), self.v_axis.dot(point)) / self.texel_m - self.min_texel;
        texel.extend((self.depth_axis.dot(point) - self.depth_near) / (self.depth_far - self.depth_near))
    }

    /// Direction in which light travels at a world point, a unit vector.
    #[must_use]
    pub fn light_direction_at(&self, point: DVec3) -> DVec3 {
        self.light_position.map_or(self.depth_axis, |light| (point - light).try_normalize().unwrap_or(self.depth_axis))
    }

    /// Matrix from world to the map's NDC (x right, y up, both in [−1,1], z in \[0,1\]), to be
    /// divided by w, which is 1 in a plain map.
    #[must_use]
    pub fn shadow_from_world(&self) -> DMat4 {
        self.warp.unwrap_or_else(|| self.plain_shadow_from_world())
    }

    /// [`Split::shadow_from_world`] for a given depth convention. All conventions draw the same
    /// map: y is flipped if NDC's y points down, and OpenGL's z lies in [−1,1] (`z' = 2z − w`),
    /// which its depth range maps back to \[0,1\].
    #[must_use]
    pub fn shadow_from_world_in(&self, convention: DepthConvention) -> DMat4 {
        let to_convention = match convention {
            DepthConvention::ZeroToOne => DMat4::IDENTITY,
            DepthConvention::ZeroToOneYDown => DMat4::from_diagonal(DVec4::new(1.0, -1.0, 1.0, 1.0)),
            DepthConvention::MinusOneToOne => DMat4::from_cols(DVec4::X, DVec4::Y, 2.0 * DVec4::Z, DVec4::W - DVec4::Z),
        };
        to_convention * self.shadow_from_world()
    }

    /// Matrix from world to the map as a texture, for a given depth convention: u and v in \[0,1\],
    /// v down, or up for OpenGL, and the stored depth, in \[0,1\] for all. To be divided by w,
    /// which is 1 in a plain map.
    #[must_use]
    pub fn texture_from_world(&self, convention: DepthConvention) -> DMat4 {
        let up = match convention {
            DepthConvention::ZeroToOne | DepthConvention::ZeroToOneYDown => -0.5,
            DepthConvention::MinusOneToOne => 0.5,
        };
        let texture_from_shadow =
            DMat4::from_cols(0.5 * DVec4::X, up * DVec4::Y, DVec4::Z, DVec4::new(0.5, 0.5, 0.0, 1.0));
        texture_from_shadow * self.shadow_from_world()
    }

    /// [`Split::shadow_from_world_in`] for points relative to `origin`, a world point near the
    /// camera. Entries stay small enough for `f32` 100 km from the world's origin.
    #[must_use]
    pub fn shadow_from_relative(&self, origin: DVec3, convention: DepthConvention) -> DMat4 {
        self.shadow_from_world_in(convention) * DMat4::from_translation(origin)
    }

    /// [`Split::texture_from_world`] for points relative to `origin`.
    #[must_use]
    pub fn texture_from_relative(&self, origin: DVec3, convention: DepthConvention) -> DMat4 {
        self.texture_from_world(convention) * DMat4::from_translation(origin)
    }

    fn plain_shadow_from_world(&self) -> DMat4 {
        let half = 0.5 * f64::from(self.size);
        let u = self.u_axis / (self.texel_m.x * half);
        let v = -self.v_axis / (self.texel_m.y * half);
        let range = self.depth_far - self.depth_near;
        let d = self.depth_axis / range;
        DMat4::from_cols(
            DVec4::new(u.x, v.x, d.x, 0.0),
            DVec4::new(u.y, v.y, d.y, 0.0),
            DVec4::new(u.z, v.z, d.z, 0.0),
            DVec4::new(-self.min_texel.x / half - 1.0, self.min_texel.y / half + 1.0, -self.depth_near / range, 1.0),
        )
    }

    /// Texels (u, v) by which this map has moved since `earlier`, a map of the same split. A point
    /// at texel `t` of `earlier` lies at `t` minus this shift now, with equal depth. `None` if the
    /// two maps do not share a grid: a step was taken in between, the map is not stabilised, or the
    /// light is not a sun.
    #[must_use]
    pub fn texels_moved_since(&self, earlier: &Self) -> Option<DVec2> {
        let grid = |s: &Self| {
            (s.size, s.u_axis, s.v_axis, s.depth_axis, s.texel_m, s.depth_near, s.depth_far, s.warp.is_some())
        };
        let shift = self.min_texel - earlier.min_texel;
        let shared = grid(self) == grid(earlier) && self.warp.is_none() && shift.fract() == DVec2::ZERO;
        shared.then_some(shift)
    }

    /// Returns whether a world point lies inside the map, at least `margin` texels from its edge,
    /// and within its depth range.
    #[must_use]
    pub fn contains(&self, point: DVec3, margin: f64) -> bool {
        self.lies_over(point, margin) && (0.0..=1.0).contains(&self.map_from_world(point).z)
    }

    /// Returns whether a world point lies over the map's rectangle, at least `margin` texels from
    /// its edge, at any depth.
    pub(crate) fn lies_over(&self, point: DVec3, margin: f64) -> bool {
        let at = self.map_from_world(point);
        let inside = margin..=f64::from(self.size) - margin;
        inside.contains(&at.x) && inside.contains(&at.y)
    }

    /// Jacobian of the map's coordinates: its rows are the gradients of u and v by the position in
    /// the world, in texels per metre. Both lie across the light. They are equal everywhere in a
    /// plain map.
    #[must_use]
    pub fn texel_jacobian(&self, point: DVec3) -> [DVec3; 2] {
        let Some(shadow_from_world) = self.warp else {
            return [self.u_axis / self.texel_m.x, self.v_axis / self.texel_m.y];
        };
        let at = shadow_from_world * point.extend(1.0);
        let [x, y, w] = [0, 1, 3].map(|row| shadow_from_world.row(row).truncate());
        let texels = 0.5 * f64::from(self.size) / at.w;
        [texels * (x - w * (at.x / at.w)), -texels * (y - w * (at.y / at.w))]
    }

    /// Edges of a texel along u and v at a world point, as vectors across the light in metres: the
    /// steps that change u alone and v alone, by one.
    #[must_use]
    pub fn texel_axes_m(&self, point: DVec3) -> [DVec3; 2] {
        let [u, v] = self.texel_jacobian(point);
        let travel = self.light_direction_at(point);
        let (along_u, along_v) = (v.cross(travel), travel.cross(u));
        [along_u / u.dot(along_u), along_v / v.dot(along_v)]
    }

    /// Lengths of a texel's edges along u and v at a world point, in metres.
    #[must_use]
    pub fn texel_size_m(&self, point: DVec3) -> DVec2 {
        let [u, v] = self.texel_axes_m(point);
        DVec2::new(u.length(), v.length())
    }
}
