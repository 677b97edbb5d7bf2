//! Predicted aliasing: how many pixels a shadow map's texel covers on screen, before a frame is
//! drawn.

use glam::{DMat2, DVec2, DVec3};

use crate::{Projection, Split, View};

impl Split {
    /// Perspective part of the aliasing at view depth `d`: pixels that one texel (its larger edge)
    /// spans on a surface that faces the camera, `m_p = t_w H / (2 d tan(fov_y/2))`; its inverse is
    /// texels per pixel. Above 1 the shadow's edge shows the map's texels.
    ///
    /// Source: *Parallel-Split Shadow Maps* eq. 1, `dp/ds ∝ (1/z)(dz/ds)`, with the texel's width
    /// from the split's matrix in place of the source's unit map. A warped map's texel is that of
    /// the view's axis at `d`.
    #[must_use]
    pub fn pixels_per_texel(&self, view: &View, image_height: u32, d: f64) -> f64 {
        let f = view.frustum();
        let texel = match self.warp {
            None => self.texel_m,
            Some(_) => self.texel_size_m(view.eye() + view.forward() * d),
        };
        texel.max_element() * f64::from(image_height) / ((f.top - f.bottom) * f.scale_at(d))
    }

    /// Pixels per texel at a point of a surface with unit `normal`, projection aliasing included:
    /// `1/σ_min(J)`, where `J = ∂texel/∂pixel` is taken through the receiver's plane. Infinite
    /// where the view grazes the surface.
    #[must_use]
    pub fn pixels_per_texel_at(&self, view: &View, image_size: [u32; 2], point: DVec3, normal: DVec3) -> f64 {
        let f = view.frustum();
        let in_view = view.view_from_world_point(point);
        let scale = f.scale_at(-in_view.z);
        let rotation = view.world_from_view_rotation();
        let pixel = DVec2::new(f.right - f.left, f.top - f.bottom) * scale
            / DVec2::new(f64::from(image_size[0]), f64::from(image_size[1]));
        // A step of one pixel moves the point in the image plane's direction, then along the ray
        // back onto the plane.
        let ray = match f.projection {
            Projection::Perspective => point - view.eye(),
            Projection::Orthographic => view.forward(),
        };
        let on_plane = |step: DVec3| step - ray * (normal.dot(step) / normal.dot(ray));
        let [u, v] = self.texel_jacobian(point);
        let texel = |step: DVec3| DVec2::new(u.dot(step), v.dot(step));
        let texel_from_pixel =
            DMat2::from_cols(texel(on_plane(rotation.x_axis * pixel.x)), texel(on_plane(rotation.y_axis * pixel.y)));
        let smallest = smallest_singular_value(texel_from_pixel);
        if smallest.is_finite() { 1.0 / smallest } else { f64::INFINITY }
    }
}

/// σ_min of a 2×2 matrix, from the squared norm and the determinant.
fn smallest_singular_value(m: DMat2) -> f64 {
    let sum = m.x_axis.length_squared() + m.y_axis.length_squared();
    let det = m.determinant();
    let root = (sum * sum - 4.0 * det * det).max(0.0).sqrt();
    let largest = (0.5 * (sum + root)).sqrt();
    // σ_min = |det| / σ_max loses nothing to cancellation.
    if largest > 0.0 { det.abs() / largest } else { 0.0 }
}
