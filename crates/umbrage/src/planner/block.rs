//! Blocks on a sun's own axes: the extent of a still map.

use glam::DVec3;

use crate::DirectionalLight;
use crate::bounds::Placed;
use crate::casters::Most;

/// A block on the light's own axes, along the map's two axes and along the light, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    pub center: DVec3,
    pub half: DVec3,
}

impl Block {
    /// The block around a sphere in the world.
    pub fn around_sphere(center: DVec3, radius: f64, light: &DirectionalLight) -> Self {
        Self { center: axes(light).map(|axis| axis.dot(center)).into(), half: DVec3::splat(radius) }
    }

    /// The block around the boxes that pass a monotone test; `None` if there are none, or none with
    /// any extent.
    pub fn around(boxes: &impl Most, test: impl Fn(&Placed) -> bool, light: &DirectionalLight) -> Option<Self> {
        let axes = axes(light);
        let end = |axis: DVec3, sign: f64| {
            boxes.most(|it| match test(it) {
                true => sign * axis.dot(it.center) + axis.abs().dot(it.half),
                false => f64::NEG_INFINITY,
            })
        };
        let (lo, hi) = (DVec3::from(axes.map(|axis| -end(axis, -1.0))), DVec3::from(axes.map(|axis| end(axis, 1.0))));
        let half = 0.5 * (hi - lo);
        // What has no width (a wall seen edge-on by the light) still gets texels of some size.
        let half = half.max(DVec3::splat(1e-3 * half.max_element()));
        (half.max_element() > 0.0).then(|| Self { center: 0.5 * (lo + hi), half })
    }

    /// This block, with each axis that is at least as long as that of `other` replaced by it.
    pub fn no_longer_than(self, other: &Self) -> Self {
        let longer = self.half.cmpge(other.half);
        Self {
            center: DVec3::select(longer, other.center, self.center),
            half: DVec3::select(longer, other.half, self.half),
        }
    }
}

fn axes(light: &DirectionalLight) -> [DVec3; 3] {
    let (u, v) = light.map_axes();
    [u, v, light.direction()]
}
