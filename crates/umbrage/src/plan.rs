//! What the planner answers: everything a renderer needs for one light and one view.

use glam::{DMat4, DVec2, DVec3, DVec4};

/// The shadow maps of one directional light for one view.
///
/// All positions are `f64` world metres; a renderer subtracts its own origin before it goes to `f32`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowPlan {
    /// The splits, nearest first.
    pub splits: Vec<Split>,
    /// `C_0 ..= C_m`: view depths in metres.
    pub planes: Vec<f64>,
    /// The plane that measures view depth: `xyz · point + w`, in metres.
    pub view_depth_plane: DVec4,
    /// The way light travels, a unit vector.
    pub light_direction: DVec3,
    /// View depth at which the fade to lit begins; `C_m` if there is none.
    pub fade_begin: f64,
    /// Indices into the planner's caster list, split after split; see [`ShadowPlan::casters`].
    pub caster_indices: Vec<u32>,
    /// For each caster the first and the last split it is drawn in, `None` if it is drawn in none. The range is a bound:
    /// the lists are exact.
    pub split_range: Vec<Option<(u8, u8)>>,
}

impl ShadowPlan {
    /// The casters of split `index`, as indices into the list given to the planner.
    #[must_use]
    pub fn casters(&self, index: usize) -> &[u32] {
        &self.caster_indices[self.splits[index].casters.clone()]
    }
}

/// One slice of the view and the map that serves it.
///
/// The map is an orthographic picture taken along [`Split::depth_axis`]. With `p` a world point,
/// `texel = ((u_axis·p)/texel_m.x − min_texel.x, (v_axis·p)/texel_m.y − min_texel.y)` is its place in the map in texels, v down,
/// `[0, size]²`, and `depth = (depth_axis·p − depth_near)/(depth_far − depth_near)` what the map stores.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// Where the slice begins, `C_i`: a view depth in metres.
    pub near: f64,
    /// Where the slice ends, `C_{i+1}`.
    pub far: f64,
    /// View depth at which the blend into the next split begins; `far` if there is none.
    pub blend_begin: f64,
    /// The view depths that may sample this map: the slice widened by the previous split's blend band and a pixel quad.
    pub coverage: (f64, f64),
    /// Edge of the map in texels.
    pub size: u32,
    /// World direction of the map's u (to the right), a unit vector.
    pub u_axis: DVec3,
    /// World direction of the map's v (down), a unit vector.
    pub v_axis: DVec3,
    /// World direction of depth: the way light travels, a unit vector.
    pub depth_axis: DVec3,
    /// Metres per texel along u and v.
    pub texel_m: DVec2,
    /// The map's upper left corner in texels of the light's plane; whole numbers when the split is stabilised.
    pub min_texel: DVec2,
    /// Metres along `depth_axis` at depth 0.
    pub depth_near: f64,
    /// Metres along `depth_axis` at depth 1.
    pub depth_far: f64,
    /// This split's part of [`ShadowPlan::caster_indices`]. Empty: nothing throws a shadow here and the split is lit.
    pub casters: std::ops::Range<usize>,
}

impl Split {
    /// Where a world point lies in the map: texels (v down) and stored depth.
    #[must_use]
    pub fn map_from_world(&self, point: DVec3) -> DVec3 {
        let texel = DVec2::new(self.u_axis.dot(point), self.v_axis.dot(point)) / self.texel_m - self.min_texel;
        texel.extend((self.depth_axis.dot(point) - self.depth_near) / (self.depth_far - self.depth_near))
    }

    /// The same as a matrix to NDC (x right, y up, both in [−1,1], z in [0,1]).
    #[must_use]
    pub fn shadow_from_world(&self) -> DMat4 {
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

    /// Whether a world point lies inside the map, `margin` texels away from its edge.
    #[must_use]
    pub fn contains(&self, point: DVec3, margin: f64) -> bool {
        let at = self.map_from_world(point);
        let inside = margin..=f64::from(self.size) - margin;
        inside.contains(&at.x) && inside.contains(&at.y) && (0.0..=1.0).contains(&at.z)
    }
}
