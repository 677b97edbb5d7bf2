//! Placement of planes by a formula, and the range of view depths that each map has to serve.

use crate::config::{SplitMetric, SplitScheme, check_range};
use crate::{Error, Result, View, maths};

/// Computes the `m + 1` planes `C_0 ..= C_m` between `near` and `far` (view depths in metres) into
/// `planes`.
///
/// `C_i = λ C_i^log + (1 − λ) C_i^uni + δ_i` for the inner planes; `C_0 = near` and `C_m = far`
/// exactly. Source: *Parallel-Split Shadow Maps* eq. 4 to 7, where δ moves all planes; here the
/// ends stay.
///
/// # Errors
/// [`Error::InvalidSetting`] naming `shadow-range`, `delta` or `planes` if the planes would not
/// rise strictly, and `scheme` for [`SplitScheme::Optimal`], whose planes need a scene.
pub fn split_planes(scheme: &SplitScheme, near: f64, far: f64, splits: usize, planes: &mut Vec<f64>) -> Result<()> {
    check_range(near, far)?;
    let m = splits as f64;
    let share = |i: usize| i as f64 / m;
    let logarithmic = |i: usize| near * maths::pow(far / near, share(i));
    let uniform = |i: usize| near + (far - near) * share(i);
    planes.clear();
    planes.push(near);
    for i in 1..splits {
        planes.push(match scheme {
            SplitScheme::Uniform => uniform(i),
            SplitScheme::Logarithmic => logarithmic(i),
            SplitScheme::Practical { lambda, delta } => {
                let offset = if delta.len() == 1 { delta[0] } else { delta.get(i - 1).copied().unwrap_or(0.0) };
                lambda * logarithmic(i) + (1.0 - lambda) * uniform(i) + offset
            }
            SplitScheme::Manual { planes: inner } => inner[i - 1],
            SplitScheme::Optimal => {
                return Err(Error::setting(
                    "scheme",
                    "optimal planes need a scene; plan one with Planner::plan, or choose a scheme of near and far alone",
                ));
            }
        });
    }
    planes.push(far);
    if let Some(pair) = planes.windows(2).find(|pair| pair[0] >= pair[1] || pair[0].is_nan() || pair[1].is_nan()) {
        let (field, remedy) = match scheme {
            SplitScheme::Manual { .. } => ("planes", "give planes that rise strictly between the range's ends"),
            SplitScheme::Practical { delta, .. } if !delta.is_empty() => ("delta", "give smaller offsets"),
            _ => ("shadow-range", "give a longer range or fewer splits"),
        };
        return Err(Error::setting(field, format!("plane {} m is followed by {} m; {remedy}", pair[0], pair[1])));
    }
    Ok(())
}

/// View depths `(from, to)` that may sample split `i`'s map: the slice, widened at its near side by
/// the previous split's blend band and one pixel quad (the pixels of a quad may differ in their
/// split). Split 0 starts at the camera's near plane, as nearer receivers use it too; the last
/// split ends at the range's or the camera's far plane.
///
/// The points at distances a to b have view depths from a cos θ to b, where θ is the angle of the
/// view's farthest corner.
pub(crate) fn coverage(
    view: &View,
    planes: &[f64],
    i: usize,
    blend: f64,
    image_size: [u32; 2],
    metric: SplitMetric,
) -> (f64, f64) {
    let camera_near = view.frustum().near;
    let from = if i == 0 {
        camera_near
    } else {
        let band_begin = blend_begin(planes, i - 1, blend);
        let begin = band_begin - quad(view, band_begin, image_size);
        (begin * metric.least_depth_share(view)).max(camera_near)
    };
    (from, planes[i + 1].min(view.frustum().far))
}

/// View depth at which split `i` begins to blend into the next; its far plane if it does not blend.
pub(crate) fn blend_begin(planes: &[f64], i: usize, blend: f64) -> f64 {
    let last = i + 2 == planes.len();
    let band = if last { 0.0 } else { blend * (planes[i + 1] - planes[i]) };
    planes[i + 1] - band
}

/// The footprint of two pixels at view depth `d`, in metres.
fn quad(view: &View, d: f64, image_size: [u32; 2]) -> f64 {
    let f = view.frustum();
    let pixel = ((f.right - f.left) / f64::from(image_size[0])).max((f.top - f.bottom) / f64::from(image_size[1]));
    2.0 * pixel * f.scale_at(d)
}
