//! Slices of the view, for applications that draw the image slice by slice because all splits use
//! one map.

use glam::{DMat4, DVec4};
use umbrage::{ShadowPlan, View};

/// One slice of the image: its range of clip depths, and its part of the depth buffer. \[PSSM06\]
/// and \[GG3-10\] draw slices front to back, each with the viewport's depth range of its own;
/// \[GG3-10\]'s Listing 10-3 gives that range in view depths where clip depths are needed. Depth is
/// reversed, so a slice from `C_i` to `C_{i+1}` has `[z(C_{i+1}), z(C_i)]`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Slice {
    /// Index of the split whose map the slice reads.
    pub split: usize,
    /// Least and greatest depth of the slice's viewport, for `RenderPass::set_viewport`.
    pub depth_range: [f32; 2],
    scale: f64,
    offset: f64,
}

impl Slice {
    /// Room on both sides of a slice, as a share of its depth range. `umbrage_in_slice` decides
    /// exactly to which slice a pixel belongs, and the clipper must not cut before. A lower value
    /// leaves holes between slices, a higher one shades pixels in vain.
    const ROOM: f64 = 1.0 / 1024.0;

    /// The slices of a plan for a view, nearest first. A split outside the view's own near and far
    /// has no slice.
    #[must_use]
    pub fn all(plan: &ShadowPlan, view: &View) -> Vec<Self> {
        let clip_from_eye = view.clip_from_relative(view.eye());
        let z = |depth: f64| {
            let clip = clip_from_eye * (view.forward() * depth).extend(1.0);
            (clip.z / clip.w).clamp(0.0, 1.0)
        };
        let count = plan.splits.len();
        let slice = |(split, it): (usize, &umbrage::Split)| {
            // What is nearer than the first split or farther than the last one is drawn with them.
            let front = if split == 0 { 1.0 } else { z(it.near) };
            let back = if split + 1 == count { 0.0 } else { z(it.far) };
            let room = Self::ROOM * (front - back);
            let (front, back) = ((front + room).min(1.0), (back - room).max(0.0));
            (front > back).then(|| Self {
                split,
                depth_range: [back as f32, front as f32],
                scale: 1.0 / (front - back),
                offset: -back / (front - back),
            })
        };
        plan.splits.iter().enumerate().filter_map(slice).collect()
    }

    /// The application's matrix to clip space, with reversed depth, changed so that this slice
    /// fills depth 0 to 1; the viewport's depth range restores the original depth. Pipelines with
    /// `unclipped_depth` leave triangles whole, so that an image drawn in slices equals one drawn
    /// at once.
    #[must_use]
    pub fn clip_from(&self, clip: DMat4) -> DMat4 {
        let rows = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, self.scale, 0.0), {
            DVec4::new(0.0, 0.0, self.offset, 1.0)
        });
        rows * clip
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::config::{Preset, Range};
    use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig};

    use super::*;

    #[test]
    fn slices_give_every_depth_back_and_leave_no_gap() {
        let frustum = Frustum::perspective(1.0, 1.3, 0.5, 900.0).expect("valid");
        let view = View::look_at(DVec3::new(5.0, 3.0, 9.0), DVec3::ZERO, DVec3::Y, frustum).expect("valid");
        let range = Range::Metres { near: 1.0, far: 300.0 };
        let mut planner = Planner::new(&ShadowConfig { range, ..Preset::Papers.config() }).expect("valid");
        let bounds = [Aabb::new(DVec3::splat(-400.0), DVec3::new(400.0, 0.0, 400.0))];
        let sun = DirectionalLight::new(DVec3::NEG_Y).expect("a direction");
        let plan = planner.plan(&view, &sun, &bounds, &bounds).expect("a plan").clone();
        let clip = view.clip_from_relative(view.eye());
        let slices = Slice::all(&plan, &view);
        assert_eq!(slices.len(), 4);
        assert_eq!((slices[0].depth_range[1], slices[3].depth_range[0]), (1.0, 0.0));
        for i in 1..4000 {
            let depth = 0.5 * 1800f64.powf(f64::from(i) / 4000.0);
            let aside = 0.1 * view.forward().cross(DVec3::Y);
            let point = ((view.forward() + aside) * depth).extend(1.0);
            let whole = clip * point;
            let mut inside = 0;
            for slice in &slices {
                let part = slice.clip_from(clip) * point;
                assert_eq!((part.x, part.y, part.w), (whole.x, whole.y, whole.w));
                let z = part.z / part.w;
                let [back, front] = slice.depth_range.map(f64::from);
                assert!((back + z * (front - back) - whole.z / whole.w).abs() < 1e-7);
                inside += usize::from((0.0..=1.0).contains(&z));
            }
            assert!((1..=2).contains(&inside), "{inside} slices hold depth {depth}");
        }
    }
}
