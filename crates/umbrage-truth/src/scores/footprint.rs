//! m: the number of pixels that a texel covers on the screen.

use glam::{DMat2, DVec2, DVec3};
use umbrage::{Projection, View};

use super::Domain;
use super::domain::check_size;
use super::stats::percentile;
use crate::{Hit, Result, TruthMask};

/// Change of a map's texel coordinates with the world position at one point: the rows of
/// `∂(texel)/∂(world)`, in texels per metre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelGradient {
    /// Gradient of the horizontal texel coordinate, in texels per metre.
    pub u: DVec3,
    /// Gradient of the vertical texel coordinate, in texels per metre.
    pub v: DVec3,
    /// Larger edge of a texel in metres, t_w.
    pub width: f64,
}

impl TexelGradient {
    /// Gradient of an orthographic map with unit axes and metres per texel along them. It is the
    /// same at every point.
    #[must_use]
    pub fn orthographic(u_axis: DVec3, v_axis: DVec3, texel_m: DVec2) -> Self {
        Self { u: u_axis / texel_m.x, v: v_axis / texel_m.y, width: texel_m.max_element() }
    }
}

/// Pixels per texel over a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Median of m, in pixels per texel.
    pub median: f64,
    /// 99th percentile of m, in pixels per texel.
    pub p99: f64,
    /// Median of the perspective part m_p, in pixels per texel.
    pub perspective_median: f64,
    /// 99th percentile of the perspective part m_p, in pixels per texel.
    pub perspective_p99: f64,
    /// Number of pixels of Ω_f that a map covers.
    pub pixels: usize,
}

/// Computes m and m_p over the pixels of Ω_f that a map covers. `gradient` returns, for a world
/// point and its view depth, the texel gradient of the map that covers it, or `None` if no map
/// does. Returns `None` if no pixel is covered.
///
/// # Errors
/// [`crate::Error::SizeMismatch`] if the mask belongs to another frame.
pub fn texel_footprint(
    view: &View,
    mask: &TruthMask,
    domain: &Domain,
    gradient: impl Fn(DVec3, f64) -> Option<TexelGradient>,
) -> Result<Option<Footprint>> {
    check_size("the mask", mask.size(), domain.size())?;
    let (mut whole, mut perspective) = (Vec::new(), Vec::new());
    for &pixel in domain.pixels() {
        let Some(hit) = mask.hits()[pixel] else { continue };
        let Some(map) = gradient(hit.position, hit.depth) else { continue };
        whole.push(pixels_per_texel(view, domain.size(), pixel, &hit, &map));
        let frustum = view.frustum();
        let image_height_m = (frustum.top - frustum.bottom) * frustum.scale_at(hit.depth);
        perspective.push(map.width * domain.size()[1] as f64 / image_height_m);
    }
    let pixels = whole.len();
    Ok((|| {
        Some(Footprint {
            median: percentile(&mut whole, 0.5)?,
            p99: percentile(&mut whole, 0.99)?,
            perspective_median: percentile(&mut perspective, 0.5)?,
            perspective_p99: percentile(&mut perspective, 0.99)?,
            pixels,
        })
    })())
}

/// Returns m of one pixel, whose ray met `hit` and whose map has the gradient `map` there.
pub(super) fn pixels_per_texel(view: &View, size: [usize; 2], pixel: usize, hit: &Hit, map: &TexelGradient) -> f64 {
    let [dx, dy] = world_from_pixel(view, size, pixel, hit.normal, hit.depth);
    let texel_from_pixel =
        DMat2::from_cols(DVec2::new(map.u.dot(dx), map.v.dot(dx)), DVec2::new(map.u.dot(dy), map.v.dot(dy)));
    1.0 / least_singular_value(texel_from_pixel)
}

/// Returns `∂(world)/∂(pixel)` along x and y, on the plane of the receiver in a pixel.
fn world_from_pixel(view: &View, size: [usize; 2], pixel: usize, normal: DVec3, depth: f64) -> [DVec3; 2] {
    let [width, height] = size.map(|n| n as f64);
    let at = ((pixel % size[0]) as f64 + 0.5, (pixel / size[0]) as f64 + 0.5);
    let (_, direction) = view.ray_through(at.0 / width, at.1 / height);
    let frustum = view.frustum();
    let axes = view.world_from_view_rotation();
    let right = axes.x_axis * (frustum.right - frustum.left) / width;
    let down = -axes.y_axis * (frustum.top - frustum.bottom) / height;
    // One pixel on, the ray's point at this depth moves by `step`; the plane then moves it along
    // the ray.
    let scale = match frustum.projection {
        Projection::Perspective => depth,
        Projection::Orthographic => 1.0,
    };
    [right, down].map(|axis| {
        let step = scale * axis;
        step - direction * (normal.dot(step) / normal.dot(direction))
    })
}

/// Returns the smaller singular value of a 2 × 2 matrix: with squared norm s and determinant d, `σ²
/// = (s − √(s² − 4 d²)) / 2 = 2 d² / (s + √(s² − 4 d²))`.
fn least_singular_value(m: DMat2) -> f64 {
    let s = m.x_axis.length_squared() + m.y_axis.length_squared();
    let d = m.determinant();
    let root = (s * s - 4.0 * d * d).max(0.0).sqrt();
    if s > 0.0 { d.abs() * (2.0 / (s + root)).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_of_known_matrices() {
        for (a, b) in [(3.0, 0.5), (1.0, 1.0), (2.0, 0.0), (1e6, 1e-6)] {
            for angle in [0.0, 0.3, 2.0] {
                let turned = DMat2::from_angle(angle) * DMat2::from_diagonal(DVec2::new(a, b)) * DMat2::from_angle(1.1);
                assert!((least_singular_value(turned) - b).abs() < 1e-9 * (1.0 + a), "{a} {b} {angle}");
            }
        }
        assert_eq!(least_singular_value(DMat2::ZERO), 0.0);
    }
}
