//! What lies over a place along the light: parts of boxes in a shaft.

use glam::DVec3;

use crate::DirectionalLight;
use crate::bounds::Placed;

/// A square shaft along the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaft {
    center: DVec3,
    direction: DVec3,
    /// Half the extent of the shaft's box around its square along each world axis, metres.
    aside: DVec3,
    /// Half its width, metres.
    pub half: f64,
}

impl Shaft {
    /// A shaft of half the width `half` around the light's ray through `center`.
    pub fn new(center: DVec3, half: f64, light: &DirectionalLight) -> Self {
        let (u, v) = light.map_axes();
        Self { center, direction: light.direction(), aside: half * (u.abs() + v.abs()), half }
    }

    /// Metres along the light of what lies `along` metres behind the centre.
    pub fn depth(&self, along: f64) -> f64 {
        self.direction.dot(self.center) + along
    }

    /// Between which depths along the light a box lies in the shaft (conservatively); `None` if it
    /// does not.
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

/// Where a box begins along the light, metres.
pub(super) fn first_depth(placed: &Placed, direction: DVec3) -> f64 {
    direction.dot(placed.center) - direction.abs().dot(placed.half)
}
