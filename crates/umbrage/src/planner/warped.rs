//! Computes a split's warp from its receivers and casters.

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::bounds::Placed;
use crate::config::Crop;
use crate::geometry::volume::{Lies, Slice, SweptVolume};
use crate::{Split, View, Warp, WarpTarget};

/// Share of the depth range that a warped map keeps free before its first caster and behind its
/// last receiver, for rounding to `f32` and for the bias.
const DEPTH_ROOM: f64 = 1e-3;

/// Least share of a map to which its casters' crop may shrink it, so that a wall seen edge-on by
/// the light still gets texels of some size.
const LEAST_CROP: f64 = 1e-3;

/// World points whose convex hulls contain everything that a warped map has to show. Buffers are
/// reused from split to split and frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct WarpPoints {
    receivers: Vec<DVec3>,
    casters: Vec<DVec3>,
}

impl WarpPoints {
    /// Sets the receivers: those parts of the boxes that lie inside the slice, or the slice's
    /// corners.
    pub fn receivers_of<'a>(&mut self, slice: &Slice, boxes: Option<impl Iterator<Item = &'a Placed>>) {
        let points = &mut self.receivers;
        points.clear();
        let Some(boxes) = boxes else {
            points.extend(slice.corners);
            return;
        };
        for receiver in boxes {
            match slice.classify(receiver.center, receiver.half) {
                Lies::Outside => {}
                Lies::Inside => points.extend(receiver.bounds().corners()),
                Lies::Across => {
                    slice.clip_box(&receiver.bounds(), |point| points.push(point));
                }
            }
        }
    }

    /// Sets the casters: their parts within `margin` metres of the slice swept towards the light.
    pub fn casters_of<'a>(&mut self, swept: &SweptVolume, margin: f64, casters: impl Iterator<Item = &'a Placed>) {
        let points = &mut self.casters;
        points.clear();
        for caster in casters {
            swept.clip_box(&caster.bounds(), margin, |point| points.push(point));
        }
    }

    /// Gives the split its warp, which leaves `margin` texels free on all sides. The split stays
    /// plain if the warp changes nothing.
    pub fn warp(&self, split: &mut Split, warp: Warp, view: &View, margin: f64, crop: Crop) {
        let depths = self.receivers.iter().map(|&point| view.view_depth(point));
        let slice = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), d| (lo.min(d), hi.max(d)));
        let target = WarpTarget {
            view,
            slice,
            light: split.depth_axis,
            receivers: &self.receivers,
            casters: &self.casters,
            margin: 2.0 * margin / f64::from(split.size),
        };
        let Some(matrix) = warp.shadow_from_world(&target) else { return };
        if matrix.row(3).truncate() == DVec3::ZERO {
            return;
        }
        let matrix = match crop {
            Crop::SceneIndependent => matrix,
            Crop::SceneDependent => self.cropped(matrix, 1.0 - target.margin),
        };
        split.warp = Some(with_depth_room(matrix));
        let middle = self.receivers.iter().sum::<DVec3>() / self.receivers.len() as f64;
        split.texel_m = split.texel_size_m(middle);
    }

    /// The map cropped to its casters; `inside` is the half edge that points may take. A map with a
    /// caster behind its projection centre is unchanged.
    fn cropped(&self, matrix: DMat4, inside: f64) -> DMat4 {
        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for caster in &self.casters {
            let at = matrix * caster.extend(1.0);
            if at.w <= 0.0 {
                return matrix;
            }
            let ndc = at.truncate().truncate() / at.w;
            (lo, hi) = (lo.min(ndc), hi.max(ndc));
        }
        let (lo, hi) = (
            lo.clamp(DVec2::splat(-inside), DVec2::splat(inside)),
            hi.clamp(DVec2::splat(-inside), DVec2::splat(inside)),
        );
        let scale = 2.0 * inside / (hi - lo).max(DVec2::splat(2.0 * inside * LEAST_CROP));
        let middle = 0.5 * (lo + hi);
        let crop = DMat4::from_cols(
            DVec4::new(scale.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, scale.y, 0.0, 0.0),
            DVec4::Z,
            DVec4::new(-scale.x * middle.x, -scale.y * middle.y, 0.0, 1.0),
        );
        crop * matrix
    }
}

/// The matrix with a little room at both ends of its depth.
fn with_depth_room(shadow_from_world: DMat4) -> DMat4 {
    let share = 1.0 / (1.0 + 2.0 * DEPTH_ROOM);
    let room = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, share, 0.0),
        DVec4::new(0.0, 0.0, DEPTH_ROOM * share, 1.0),
    );
    room * shadow_from_world
}
