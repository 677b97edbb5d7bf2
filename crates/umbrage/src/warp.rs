//! Warps: perspective reparameterisations of a directional light's map (PSM, LiSPSM, TSM), for one map or inside a split.
//!
//! Each is a matrix to shadow NDC in which receivers near the eye get more texels. Light stays parallel to the map's depth: what
//! shades a point shares its texel, nearer to the light at smaller depth. All three are compared with the plain map of the
//! same fit; none can be stabilised, as the warp follows the camera.

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::{Projection, View};

/// How a map spreads its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Warp {
    /// Evenly: one texel is the same length everywhere.
    #[default]
    None,
    /// Perspective shadow maps: a map of the camera's own post-perspective space.
    /// M. Stamminger, G. Drettakis, *Perspective Shadow Maps*, SIGGRAPH 2002. Our deviation: the virtual camera slides back until
    /// every caster is in front of it (S. Kozlov, *GPU Gems*, chapter 14).
    Psm,
    /// Light space perspective shadow maps, `n_opt = (z_n + √(z_n z_f)) / sin γ` with γ between view and light.
    /// M. Wimmer, D. Scherzer, W. Purgathofer, *Light Space Perspective Shadow Maps*, EGSR 2004.
    Lispsm,
    /// Trapezoidal shadow maps: the first `focus` of the slice's depth gets 80 % of the map.
    /// T. Martin, T.-S. Tan, *Anti-aliasing and Continuity with Trapezoidal Shadow Maps*, EGSR 2004. Our deviation: the trapezoid
    /// opens to a rectangle by sin γ as view and light become parallel, where the source's degenerates.
    Tsm {
        /// Share of the slice's depth range, 0 to 1.
        focus: f64,
    },
}

/// Where the focus line of a trapezoid lands: the near 80 % of the map, as NDC from +1 (near) to −1 (far).
const FOCUS_LINE: f64 = -0.6;

/// A projection distance beyond this many slice lengths is no warp at all to `f32`.
const NO_WARP: f64 = 1e6;

/// What a warp has to show.
#[derive(Clone, Copy, Debug)]
pub struct WarpTarget<'a> {
    /// The camera.
    pub view: &'a View,
    /// View depths of the slice, metres.
    pub slice: (f64, f64),
    /// The way light travels, a unit vector.
    pub light: DVec3,
    /// World points whose convex hull holds every receiver of the slice. All of them land inside the map.
    pub receivers: &'a [DVec3],
    /// World points whose convex hull holds every caster. All that can shade a receiver keep a depth of 0 or more.
    pub casters: &'a [DVec3],
    /// Share of the map's half edge that is kept free for the filter.
    pub margin: f64,
}

impl Warp {
    /// The matrix to shadow NDC (x, y in [−1,1], z in [0,1] from the light on), to be divided by w.
    ///
    /// Returns `None` if there is nothing to show, or nothing but a point.
    #[must_use]
    pub fn shadow_from_world(self, target: &WarpTarget<'_>) -> Option<DMat4> {
        let (near, far) = target.slice;
        let perspective = target.view.frustum().projection == Projection::Perspective;
        let sine = target.view.forward().cross(target.light).length();
        let frame = LightFrame::new(target);
        let (begin, end) = bounds(target.receivers.iter().map(|&p| frame.along(p)))?;
        let length = end - begin;
        let distance = match self {
            // An orthographic camera has no perspective to undo.
            _ if !perspective => f64::INFINITY,
            Self::None => f64::INFINITY,
            Self::Psm => match psm(target) {
                Some(matrix) => return Some(matrix),
                None => f64::INFINITY,
            },
            Self::Lispsm => (near + (near * far).sqrt()) / sine,
            Self::Tsm { focus } => {
                // The focus point lies on the line through the centres of the near and far faces, as the light sees it.
                let axis = |d: f64| frame.along(target.view.eye() + target.view.forward() * d);
                let focus_at = (axis(near + focus * (far - near)) - begin).clamp(0.0, length);
                let denominator = length - 2.0 * focus_at - length * FOCUS_LINE;
                let open = length * focus_at * (1.0 + FOCUS_LINE) / denominator;
                if denominator > 0.0 && open > 0.0 { open / sine } else { f64::INFINITY }
            }
        };
        let distance = if distance < NO_WARP * length { Some(distance) } else { None };
        frame.fitted(target, begin, distance)
    }
}

/// The light's space turned so that one axis follows the view: across, along (ahead as the light sees it), depth.
struct LightFrame {
    across: DVec3,
    ahead: DVec3,
    depth: DVec3,
    eye: DVec3,
}

impl LightFrame {
    fn new(target: &WarpTarget<'_>) -> Self {
        let forward = target.view.forward();
        let ahead = (forward - forward.dot(target.light) * target.light)
            .try_normalize()
            .unwrap_or_else(|| target.light.any_orthonormal_vector());
        Self { across: target.light.cross(ahead), ahead, depth: target.light, eye: target.view.eye() }
    }

    fn along(&self, point: DVec3) -> f64 {
        self.ahead.dot(point - self.eye)
    }

    /// The map whose projection centre lies `distance` before `begin` along the view (none: a parallel projection), fitted to
    /// the receivers.
    fn fitted(&self, target: &WarpTarget<'_>, begin: f64, distance: Option<f64>) -> Option<DMat4> {
        let relative = DMat4::from_translation(-self.eye);
        let row = |axis: DVec3, offset: f64| axis.extend(offset);
        // w grows from `distance` at the near end of the receivers; y falls from there as the trapezoid's −1/w does.
        let (w, y) = match distance {
            Some(n) => (row(self.ahead, n - begin), row(DVec3::ZERO, -1.0)),
            None => (row(DVec3::ZERO, 1.0), row(self.ahead, 0.0)),
        };
        let x = row(self.across, 0.0);
        let project =
            |row: DVec4, point: DVec3| row.dot((point - self.eye).extend(1.0)) / w.dot((point - self.eye).extend(1.0));
        let (x_lo, x_hi) = bounds(target.receivers.iter().map(|&p| project(x, p)))?;
        let (y_lo, y_hi) = bounds(target.receivers.iter().map(|&p| project(y, p)))?;
        // Depth starts at the first point of all, so that nothing that can shade lies before it; w is the same all along a ray.
        let first = target
            .receivers
            .iter()
            .chain(target.casters)
            .map(|&p| self.depth.dot(p - self.eye))
            .fold(f64::INFINITY, f64::min);
        let z = row(self.depth, -first);
        let (_, z_hi) = bounds(target.receivers.iter().map(|&p| project(z, p)))?;
        let inside = 1.0 - target.margin;
        let scale = |lo: f64, hi: f64| 2.0 * inside / (hi - lo).max(1e-9 * (1.0 + hi.abs()));
        let (sx, sy) = (scale(x_lo, x_hi), scale(y_lo, y_hi));
        let rows = [sx * (x - w * (0.5 * (x_lo + x_hi))), sy * (y - w * (0.5 * (y_lo + y_hi))), z / z_hi.max(1e-9), w];
        let matrix = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose() * relative;
        matrix.is_finite().then_some(matrix)
    }
}

/// A map of the camera's post-perspective cube. `None` where the light is so nearly parallel to the view that the cube is seen from a
/// point inside it or the fit has no extent.
fn psm(target: &WarpTarget<'_>) -> Option<DMat4> {
    let view = target.view;
    let (near, far) = target.slice;
    // Slide the virtual eye back until every caster and receiver is at least `near` in front of it.
    let nearest =
        target.receivers.iter().chain(target.casters).map(|&p| view.view_depth(p)).fold(f64::INFINITY, f64::min);
    let slide = (near - nearest).max(0.0);
    let eye = view.eye() - view.forward() * slide;
    let rotation = view.world_from_view_rotation().transpose();
    let view_from_world = DMat4::from_mat3_translation(rotation, rotation * -eye);
    // A plain perspective with w = depth and z from 0 at the nearest point to 1 at the slice's end.
    let (n, f) = (near, far + slide);
    let f = target.receivers.iter().chain(target.casters).map(|&p| view.view_depth(p) + slide).fold(f, f64::max);
    let clip_from_view = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -f / (f - n), -1.0),
        DVec4::new(0.0, 0.0, -n * f / (f - n), 0.0),
    );
    let post_from_world = clip_from_view * view_from_world;
    let post = |p: DVec3| post_from_world.project_point3(p);
    // Where the rays of light meet in that space: the image of the light's direction. They run towards it if it lies behind the
    // virtual eye (w < 0 for the way to the light).
    let to_light = post_from_world * (-target.light).extend(0.0);
    let centre = target.receivers.iter().map(|&p| post(p)).sum::<DVec3>() / target.receivers.len() as f64;
    // Rays as seen from the middle of the receivers.
    let (towards_light, meeting) = if to_light.w.abs() < 1e-9 {
        (to_light.truncate().try_normalize()?, None)
    } else {
        let point = to_light.truncate() / to_light.w;
        let away = (point - centre) * to_light.w.signum();
        (away.try_normalize()?, Some(point))
    };
    let down = -towards_light;
    let across = down.any_orthonormal_vector();
    let up = across.cross(down);
    let row = |axis: DVec3| axis.extend(-axis.dot(centre));
    // Distance from the meeting point along `down`; positive on the receivers' side whichever way the rays run.
    let w = match meeting {
        None => DVec4::W,
        Some(point) => {
            let reach = down.dot(centre - point);
            let sign = reach.signum();
            (down * sign).extend(-sign * down.dot(point)) / reach.abs()
        }
    };
    let at = |row: DVec4, p: DVec3| row.dot(p.extend(1.0)) / w.dot(p.extend(1.0));
    let all = || target.receivers.iter().chain(target.casters).map(|&p| post(p));
    if all().any(|p| w.dot(p.extend(1.0)) < 1e-6) {
        return None;
    }
    let receivers = || target.receivers.iter().map(|&p| post(p));
    let (x_lo, x_hi) = bounds(receivers().map(|p| at(row(across), p)))?;
    let (y_lo, y_hi) = bounds(receivers().map(|p| at(row(up), p)))?;
    // Depth must grow along the rays: (down·p)/w does where w does not change its order, else −1/w.
    let depth_row = match meeting {
        None => row(down),
        // w grows along rays that start at the meeting point (then −1/w grows), falls along rays that end there (then 1/w grows).
        Some(_) => DVec4::W * if to_light.w > 0.0 { -1.0 } else { 1.0 },
    };
    let (z_lo, z_hi) = bounds(all().map(|p| at(depth_row, p)))?;
    if !(x_hi > x_lo && y_hi > y_lo && z_hi > z_lo) {
        return None;
    }
    let inside = 1.0 - target.margin;
    let fit = |row: DVec4, lo: f64, hi: f64| (2.0 * inside / (hi - lo)) * (row - w * (0.5 * (lo + hi)));
    let z = (depth_row - w * z_lo) / (z_hi - z_lo);
    let light = DMat4::from_cols(fit(row(across), x_lo, x_hi), fit(row(up), y_lo, y_hi), z, w).transpose();
    let matrix = light * post_from_world;
    matrix.is_finite().then_some(matrix)
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    (lo <= hi).then_some((lo, hi))
}

/// Texels per metre of a warped map at a world point, along two directions: the Jacobian's columns, for bias and analysis.
#[must_use]
pub fn texels_along(shadow_from_world: &DMat4, size: u32, point: DVec3, direction: DVec3) -> DVec2 {
    let (at, step) = (*shadow_from_world * point.extend(1.0), *shadow_from_world * direction.extend(0.0));
    let derivative = (step.truncate() * at.w - at.truncate() * step.w) / (at.w * at.w);
    0.5 * f64::from(size) * derivative.truncate()
}
