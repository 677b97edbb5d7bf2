//! Warps: perspective reparameterisations of a directional light's map (PSM, LiSPSM, TSM), for one
//! map or inside a split.
//!
//! Each is a matrix to shadow NDC in which receivers near the camera get more texels. Light stays
//! parallel to the map's depth: a point and its casters share a texel, and the casters, nearer to
//! the light, have smaller depth. All three are compared with the plain map of the same fit; none
//! can be stabilised, as the warp follows the camera.

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::{Projection, View, maths};

/// Distribution of a map's texels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Warp {
    /// Even: one texel has the same length everywhere.
    #[default]
    None,
    /// Perspective shadow maps: a map of the camera's own post-perspective space. M. Stamminger, G.
    /// Drettakis, *Perspective Shadow Maps*, SIGGRAPH 2002. The virtual camera slides back until
    /// every caster is in front of it, as there and in S. Kozlov, *GPU Gems*, chapter 14.
    /// Deviations: both perspectives are one matrix, so that nothing is divided twice and points
    /// behind the camera keep their order; depth is linear along the light; and the warp fades as
    /// view and light become parallel, where the source's map degenerates.
    Psm,
    /// Light space perspective shadow maps, `n_opt = (z_n + √(z_n z_f)) / sin γ` with γ between
    /// view and light. M. Wimmer, D. Scherzer, W. Purgathofer, *Light Space Perspective Shadow
    /// Maps*, EGSR 2004.
    Lispsm,
    /// Trapezoidal shadow maps: the first `focus` of the slice's depth gets 80 % of the map. T.
    /// Martin, T.-S. Tan, *Anti-aliasing and Continuity with Trapezoidal Shadow Maps*, EGSR 2004.
    /// Deviation: the trapezoid opens to a rectangle by sin γ as view and light become parallel,
    /// where the source's degenerates.
    Tsm {
        /// Share of the slice's depth range, 0 to 1.
        focus: f64,
    },
}

impl Warp {
    /// Word and help of each warp.
    pub const WORDS: &'static [crate::config::Word] = &[
        crate::config::Word { word: "none", help: "Evenly" },
        crate::config::Word { word: "psm", help: "As a perspective shadow map" },
        crate::config::Word { word: "lispsm", help: "As a light space perspective shadow map" },
        crate::config::Word { word: "tsm", help: "As a trapezoidal shadow map" },
    ];

    /// The warp's word in config files and on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Psm => "psm",
            Self::Lispsm => "lispsm",
            Self::Tsm { .. } => "tsm",
        }
    }
}

impl std::str::FromStr for Warp {
    type Err = String;

    /// The warp of this word; a trapezoid has the usual focus of 0.3.
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => Ok(Self::None),
            "psm" => Ok(Self::Psm),
            "lispsm" => Ok(Self::Lispsm),
            "tsm" => Ok(Self::Tsm { focus: USUAL_FOCUS }),
            _ => Err(crate::config::unknown("warp", text, Self::WORDS)),
        }
    }
}

/// Default share of the depth range that a trapezoidal map focuses on.
const USUAL_FOCUS: f64 = 0.3;

/// Position of a trapezoid's focus line: the near 80 % of the map, as NDC from +1 (near) to −1
/// (far).
const FOCUS_LINE: f64 = -0.6;

/// Projection distance in slice lengths beyond which `f32` shows no warp at all.
const NO_WARP: f64 = 1e6;

/// Geometry that a warped map has to show.
#[derive(Clone, Copy, Debug)]
pub struct WarpTarget<'a> {
    /// The camera.
    pub view: &'a View,
    /// Range of view depths of the slice in metres.
    pub slice: (f64, f64),
    /// Direction in which light travels, a unit vector.
    pub light: DVec3,
    /// World points whose convex hull contains every receiver of the slice. All of them fall inside
    /// the map.
    pub receivers: &'a [DVec3],
    /// World points whose convex hull contains every caster. Those that can shade a receiver keep a
    /// depth of 0 or more.
    pub casters: &'a [DVec3],
    /// Share of the map's half edge that is kept free for the filter.
    pub margin: f64,
}

impl Warp {
    /// Matrix from world to shadow NDC (x, y in [−1,1], z in \[0,1\] from the light on), to be
    /// divided by w.
    ///
    /// Returns `None` if there is no receiver, or only a point.
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
                Some(rows) => return frame.fitted(target, rows),
                None => f64::INFINITY,
            },
            Self::Lispsm => (near + (near * far).sqrt()) / sine,
            Self::Tsm { focus } => {
                // The focus point lies on the line through the centres of the near and far faces,
                // as the light sees it.
                let axis = |d: f64| frame.along(target.view.eye() + target.view.forward() * d);
                let focus_at = (axis(near + focus * (far - near)) - begin).clamp(0.0, length);
                let denominator = length - 2.0 * focus_at - length * FOCUS_LINE;
                let open = length * focus_at * (1.0 + FOCUS_LINE) / denominator;
                if denominator > 0.0 && open > 0.0 { open / sine } else { f64::INFINITY }
            }
        };
        let rows = if distance < NO_WARP * length { frame.perspective(begin, distance) } else { frame.parallel() };
        frame.fitted(target, rows)
    }
}

/// The light's space, turned so that one axis follows the view: across, along (ahead as seen from
/// the light), depth.
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

    /// Rows of `(x, y, w)`, relative to the camera, of the map whose projection centre lies
    /// `distance` before `begin` along the view.
    fn perspective(&self, begin: f64, distance: f64) -> [DVec4; 3] {
        // w grows from `distance` at the near end of the receivers; y falls from there as the
        // trapezoid's −1/w does.
        [self.across.extend(0.0), DVec4::NEG_W, self.ahead.extend(distance - begin)]
    }

    /// Rows of a parallel projection.
    fn parallel(&self) -> [DVec4; 3] {
        [self.across.extend(0.0), self.ahead.extend(0.0), DVec4::W]
    }

    /// The matrix with these rows, fitted to the receivers. w may not change along the light and
    /// has to be positive at all receivers.
    fn fitted(&self, target: &WarpTarget<'_>, [x, y, w]: [DVec4; 3]) -> Option<DMat4> {
        let relative = |p: &DVec3| (*p - self.eye).extend(1.0);
        let (w_lo, w_hi) = bounds(target.receivers.iter().map(|p| w.dot(relative(p))))?;
        if w_lo.is_nan() || w_lo <= 0.0 {
            return None;
        }
        let w = w / w_hi;
        let project = |row: DVec4, p: &DVec3| row.dot(relative(p)) / w.dot(relative(p));
        let (x_lo, x_hi) = bounds(target.receivers.iter().map(|p| project(x, p)))?;
        let (y_lo, y_hi) = bounds(target.receivers.iter().map(|p| project(y, p)))?;
        // Depth starts at the first point of all, so that nothing that can shade lies before it; w
        // is the same all along a ray.
        let first = target
            .receivers
            .iter()
            .chain(target.casters)
            .map(|&p| self.depth.dot(p - self.eye))
            .fold(f64::INFINITY, f64::min);
        let z = self.depth.extend(-first);
        let (_, z_hi) = bounds(target.receivers.iter().map(|p| project(z, p)))?;
        let inside = 1.0 - target.margin;
        let scale = |lo: f64, hi: f64| 2.0 * inside / (hi - lo).max(1e-9 * (1.0 + hi.abs()));
        let (sx, sy) = (scale(x_lo, x_hi), scale(y_lo, y_hi));
        let rows = [sx * (x - w * (0.5 * (x_lo + x_hi))), sy * (y - w * (0.5 * (y_lo + y_hi))), z / z_hi.max(1e-9), w];
        let shadow_from_relative = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        let matrix = shadow_from_relative * DMat4::from_translation(-self.eye);
        matrix.is_finite().then_some(matrix)
    }
}

/// Rows of `(x, y, w)` for a map of the camera's post-perspective cube, relative to the frame's
/// eye. `None` if the cube has no depth.
///
/// In that space the light has a source (or a sink) at a finite point, just beyond the far plane;
/// the map is its image of the cube. The nearer the light comes to the view's axis, the nearer that
/// point comes to the cube's far side, and the image degenerates. Its plane is then turned towards
/// the far plane, just far enough to keep w within `(near/far)^sin γ`, with γ the angle between
/// view and light. Turned all the way, the two perspectives cancel and the map is plain.
fn psm(target: &WarpTarget<'_>) -> Option<[DVec4; 3]> {
    let view = target.view;
    let (near, far) = target.slice;
    // Slide the virtual eye back until every caster and receiver is at least `near` in front of it.
    let all = || target.receivers.iter().chain(target.casters).map(|&p| view.view_depth(p));
    let (first, last) = bounds(all())?;
    let slide = (near - first).max(0.0);
    let (n, f) = (near, last.max(far) + slide);
    let rotation = view.world_from_view_rotation().transpose();
    let view_from_relative = DMat4::from_mat3_translation(rotation, DVec3::NEG_Z * slide);
    // A plain perspective with w = depth and z from 0 at the nearest point to 1 at the slice's end.
    let scale = f / (f - n);
    let clip_from_view =
        DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, -scale, -1.0), DVec4::new(0.0, 0.0, -n * scale, 0.0));
    let post_from_relative = clip_from_view * view_from_relative;
    let post4 = |p: DVec3| post_from_relative * (p - view.eye()).extend(1.0);
    let sum = target.receivers.iter().map(|&p| post4(p)).map(|p| p.truncate() / p.w).sum::<DVec3>();
    let centre = sum / target.receivers.len() as f64;
    let to_light = post_from_relative * (-target.light).extend(0.0);
    // The light's source or sink; rays are parallel there where the light is parallel to the
    // picture.
    let meeting = (to_light.w.abs() > 1e-9).then(|| to_light.truncate() / to_light.w);
    let along_rays = meeting.map_or(to_light.truncate(), |point| point - centre).try_normalize()?;
    let across = along_rays.cross(DVec3::Z).try_normalize().unwrap_or_else(|| along_rays.any_orthonormal_vector());
    let up = across.cross(along_rays);
    let row = |axis: DVec3| axis.extend(-axis.dot(centre));
    // 1 at the centre, 0 where the rays meet.
    let w = meeting.map_or(DVec4::W, |point| {
        let reach = along_rays.dot(point - centre);
        (-along_rays).extend(along_rays.dot(point)) / reach
    });
    let in_world = |row: DVec4| post_from_relative.transpose() * row;
    let perspective = in_world(w);
    // The same with the far plane for its picture plane, `(scale − z) / (scale − centre.z)`, is a
    // constant in the world.
    let plain = n * scale / (scale - centre.z);
    let (least, most) = bounds(target.receivers.iter().map(|&p| perspective.dot((p - view.eye()).extend(1.0))))?;
    // Light across the view may have all of the camera's own perspective, from near to far; light
    // along it none.
    let share = maths::pow(n / f, view.forward().cross(target.light).length());
    let lacking = share * most - least;
    let turn = if lacking > 0.0 { lacking / (lacking + plain * (1.0 - share)) } else { 0.0 };
    let w = perspective * (1.0 - turn) + DVec4::W * (plain * turn);
    Some([in_world(row(across)), in_world(row(up)), w])
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    (lo <= hi).then_some((lo, hi))
}

/// Texels of a warped map per metre of `direction` at a world point, for u and v: the derivative of
/// the projection, for bias and analysis.
#[must_use]
pub fn texels_along(shadow_from_world: &DMat4, size: u32, point: DVec3, direction: DVec3) -> DVec2 {
    let (at, step) = (*shadow_from_world * point.extend(1.0), *shadow_from_world * direction.extend(0.0));
    let derivative = (step.truncate() * at.w - at.truncate() * step.w) / (at.w * at.w);
    0.5 * f64::from(size) * derivative.truncate()
}
