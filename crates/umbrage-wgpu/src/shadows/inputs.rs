//! What a frame is prepared from.

use glam::DVec3;
use umbrage::{Aabb, Light, View};

/// What a frame is prepared from. Positions are world metres.
///
/// ```no_run
/// # use umbrage_wgpu::{Inputs, umbrage::{Aabb, Light, View}};
/// # fn example(view: &View, lights: &[Light], casters: &[Aabb]) {
/// let inputs = Inputs { casters, image_size: [1280, 720], ..Inputs::new(view, lights) };
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// The camera.
    pub view: &'a View,
    /// One light for each that the maps were made for, in that order.
    pub lights: &'a [Light],
    /// Bounds of what throws shadows. [`crate::ShadowMap::casters`] speaks of them by index.
    pub casters: &'a [Aabb],
    /// Bounds of what shows shadows, most casters among them. Where the list is empty, or holds nothing
    /// that is in view, casters serve as receivers.
    pub receivers: &'a [Aabb],
    /// Bounds that hold all that is drawn of the receivers in view and leave less air than
    /// [`Inputs::receivers`]: [`umbrage::ShadowPlan::casts_into`] then rejects more parts of casters. `None`:
    /// not known.
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// World point that positions in the application's shaders are relative to. Keep it within a
    /// kilometre or two of the eye and move it in whole steps: static shadows stand still between two
    /// steps.
    pub origin: DVec3,
    /// Pixels of the picture, across and down.
    pub image_size: [u32; 2],
    /// Which of several views this is; 0 where there is one.
    pub view_slot: u32,
    /// Whether there are shadows. Without them there is nothing to draw, every surface that faces a
    /// light is lit, and what stabilised maps hold stays as it was.
    pub enabled: bool,
    /// Whether `umbrage_shadow` answers with a debug colour for each split.
    pub tint: bool,
}

impl<'a> Inputs<'a> {
    /// A frame without casters and receivers, of 1920 × 1080 pixels, relative to the world's origin.
    #[must_use]
    pub fn new(view: &'a View, lights: &'a [Light]) -> Self {
        Self {
            view,
            lights,
            casters: &[],
            receivers: &[],
            receiver_clusters: None,
            origin: DVec3::ZERO,
            image_size: [1920, 1080],
            view_slot: 0,
            enabled: true,
            tint: false,
        }
    }

    /// The receivers, or the casters in their place where no receiver is in view.
    pub(crate) fn receivers_in_view(&self) -> &'a [Aabb] {
        let sees = |boxes: &[Aabb]| boxes.iter().any(|it| may_be_seen(self.view, it));
        let stand_in = self.receivers.is_empty() || (!sees(self.receivers) && sees(self.casters));
        if stand_in { self.casters } else { self.receivers }
    }
}

/// False only if a box lies outside of what the camera shows.
fn may_be_seen(view: &View, bounds: &Aabb) -> bool {
    if !bounds.is_valid() {
        // The planner says so.
        return true;
    }
    let (eye, lens) = (view.eye(), view.frustum());
    let clip = view.clip_from_relative(eye);
    let corners = bounds.corners().map(|corner| clip * (corner - eye).extend(1.0));
    let depths = bounds.corners().map(|corner| view.view_depth(corner));
    let beside = [|x: f64, w: f64| x > w, |x: f64, w: f64| x < -w];
    let is_beside = |axis: usize| beside.iter().any(|beyond| corners.iter().all(|c| beyond(c[axis], c.w)));
    let behind = depths.iter().all(|&depth| depth < lens.near) || depths.iter().all(|&depth| depth > lens.far);
    !(behind || is_beside(0) || is_beside(1))
}

#[cfg(test)]
mod tests {
    use umbrage::{DirectionalLight, Frustum};

    use super::*;

    fn at(center: DVec3) -> Aabb {
        Aabb::new(center - DVec3::ONE, center + DVec3::ONE)
    }

    #[test]
    fn casters_stand_in_where_no_receiver_is_in_view() {
        let lens = Frustum::perspective(1.0, 1.0, 0.5, 100.0).expect("a lens");
        let view = View::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, lens).expect("a view");
        let lights = [DirectionalLight::new(DVec3::NEG_Y).expect("a sun").into()];
        let before = at(DVec3::NEG_Z * 20.0);
        let chosen = |casters: &[Aabb], receivers: &[Aabb]| {
            let inputs = Inputs { casters, receivers, ..Inputs::new(&view, &lights) };
            inputs.receivers_in_view().to_vec()
        };
        assert_eq!(chosen(&[before], &[]), [before]);
        for unseen in [DVec3::Z * 20.0, DVec3::X * 40.0 - DVec3::Z * 20.0, DVec3::NEG_Z * 200.0].map(at) {
            assert_eq!(chosen(&[before], &[unseen]), [before], "{unseen:?}");
            assert_eq!(chosen(&[unseen], &[before]), [before], "{unseen:?}");
            // Nothing is in view: nothing has to be shaded.
            assert_eq!(chosen(&[unseen], &[unseen]), [unseen], "{unseen:?}");
        }
        // Around the eye.
        assert_eq!(chosen(&[before], &[at(DVec3::ZERO)]), [at(DVec3::ZERO)]);
    }
}
