//! Shafts along the light, and the parts of boxes inside.

use glam::DVec3;

use crate::DirectionalLight;
use crate::bounds::Placed;

/// A square shaft along the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaft {
    center: DVec3,
    direction: DVec3,
    /// Half the extent along each world axis of the box around the shaft's square, in metres.
    aside: DVec3,
    /// Half the shaft's width in metres.
    pub half: f64,
}

impl Shaft {
    /// A shaft of half width `half` around the ray of light through `center`.
    pub fn new(center: DVec3, half: f64, light: &DirectionalLight) -> Self {
        let (u, v) = light.map_axes();
        Self { center, direction: light.direction(), aside: half * (u.abs() + v.abs()), half }
    }

    /// Depth along the light, in metres, of a point `along` metres behind the centre.
    pub fn depth(&self, along: f64) -> f64 {
        self.direction.dot(self.center) + along
    }

    /// Interval of depths along the light in which a box lies in the shaft (conservative); `None`
    /// if it does not.
    pub fn passage(&self, placed: &Placed) -> Option<(f64, f64)> {
        let reach = placed.half + self.aside;
        let (lo, hi) = (placed.center - reach - self.center, placed.center + reach - self.center);
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let along = self.direction[axis];
            if along.abs() < 1e-12 {
                if lo[axis] > 0.0 || hi[axis] < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (lo[axis] / along, hi[axis] / along);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        let own = (first_depth(placed, self.direction), -first_depth(placed, -self.direction));
        (enter <= leave).then(|| (own.0.max(self.depth(enter)), own.1.min(self.depth(leave))))
    }
}

/// Depth along the light at which a box begins, in metres.
pub(super) fn first_depth(placed: &Placed, direction: DVec3) -> f64 {
    direction.dot(placed.center) - direction.abs().dot(placed.half)
}
