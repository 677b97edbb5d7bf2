//! Frustum culling of objects for the view.

use glam::DVec3;
use umbrage::{Aabb, View};

/// Returns whether any part of a box may be inside the view: false only if all its corners are
/// outside of one and the same side.
pub(crate) fn may_be_seen(view: &View, bounds: &Aabb) -> bool {
    let frustum = view.frustum();
    // How far outside a corner is, for each of the six sides; positive is outside.
    let outside = bounds.corners().map(|corner| {
        let p: DVec3 = view.view_from_world_point(corner);
        let depth = -p.z;
        let scale = frustum.scale_at(depth);
        [
            frustum.left * scale - p.x,
            p.x - frustum.right * scale,
            frustum.bottom * scale - p.y,
            p.y - frustum.top * scale,
            frustum.near - depth,
            depth - frustum.far,
        ]
    });
    (0..6).all(|side| outside.iter().any(|corner| corner[side] <= 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage::Frustum;

    fn view() -> View {
        let frustum = Frustum::perspective(1.0, 1.5, 1.0, f64::INFINITY).expect("valid");
        View::look_at_upright(DVec3::new(3.0, 2.0, 1.0), DVec3::new(-4.0, 1.0, 9.0), frustum).expect("valid")
    }

    fn cube(center: DVec3, half: f64) -> Aabb {
        Aabb::new(center - half, center + half)
    }

    #[test]
    fn what_is_in_front_is_seen_and_what_is_behind_is_not() {
        let view = view();
        let ahead = view.world_from_view_point(DVec3::new(0.0, 0.0, -50.0));
        let behind = view.world_from_view_point(DVec3::new(0.0, 0.0, 50.0));
        assert!(may_be_seen(&view, &cube(ahead, 1.0)));
        assert!(!may_be_seen(&view, &cube(behind, 1.0)));
        assert!(may_be_seen(&view, &cube(behind, 100.0)), "a box around the eye");
    }

    #[test]
    fn no_box_that_holds_a_visible_point_is_left_out() {
        let view = view();
        let f = *view.frustum();
        for i in 0..1000_u32 {
            let share = |step: u32| f64::from(i.wrapping_mul(step) % 997) / 996.0;
            let depth = 1.0 + 500.0 * share(31);
            let x = (f.left + (f.right - f.left) * share(57)) * depth;
            let y = (f.bottom + (f.top - f.bottom) * share(83)) * depth;
            let point = view.world_from_view_point(DVec3::new(x, y, -depth));
            let half = 20.0 * share(11);
            let offset = (DVec3::new(share(3), share(5), share(7)) - 0.5) * 2.0 * half;
            // Rounding may put a point on the very edge outside by some 1e-12 m.
            let bounds = Aabb::new(point + offset - half - 1e-9, point + offset + half + 1e-9);
            assert!(may_be_seen(&view, &bounds), "{i}: {bounds:?}");
        }
    }
}
