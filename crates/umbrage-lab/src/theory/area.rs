//! Σ Area(B_i)/Area(B) over the light's direction: \[PSSM06\] Figure 5 and section 3.4, which
//! claims that the sum is never more than the whole. It can be more.

use glam::{DVec2, DVec3};
use umbrage::config::{Crop, Preset, Range, SplitScheme, Stability, Transition};
use umbrage::{DirectionalLight, FilterReach, MAX_SPLITS, Planner, PlannerOptions, ShadowConfig, View, slice_sphere};

use super::{
    Result,
    aliasing::{planes, schemes},
    setting::Setting,
};
use crate::{
    page::html::{Cell, Column, Figure, Section, Table},
    page::plot::{Axis, Chart, Colour, Mark, Series, Style},
};

/// Degrees between plotted directions.
const STEP: f64 = 1.0;
/// Number of splits where one number is needed.
const SPLITS: usize = 4;
/// Texels across a map that is only measured: so many that its margin is negligible.
const FINE: u32 = 1 << 16;

/// Plane in which the light turns away from the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turn {
    /// Vertical plane: at 0° the light travels along the view, at 90° straight down.
    Down,
    /// Horizontal plane: at 90° the light travels from left to right.
    Sideways,
}

/// Enclosure of a slice in the light's plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Enclosure {
    /// The axis-aligned box in a light space whose u follows the view, as \[PSSM06\] Figure 5 draws
    /// it.
    Box,
    /// The rectangle of least area, as the planner fits it.
    Least,
    /// The square around the sphere around the slice, as the planner fits it when shadows stand
    /// still.
    Sphere,
}

/// Returns the light whose direction is `degrees` away from the view's.
pub(super) fn light(view: &View, turn: Turn, degrees: f64) -> Result<DirectionalLight> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let axes = view.world_from_view_rotation();
    let aside = match turn {
        Turn::Down => -axes.y_axis,
        Turn::Sideways => axes.x_axis,
    };
    Ok(DirectionalLight::new(cos * view.forward() + sin * aside)?)
}

/// Returns the area in square metres of the box around the slice [a, b], in the light's plane, with
/// its u axis along the view.
fn box_area(view: &View, light: &DirectionalLight, a: f64, b: f64) -> f64 {
    let direction = light.direction();
    let along = view.forward() - view.forward().dot(direction) * direction;
    // Looking along the light there is no "along"; any axis of the camera's serves.
    let u: DVec3 = if along.length() > 1e-6 { along.normalize() } else { view.world_from_view_rotation().x_axis };
    let v = direction.cross(u);
    let mut lo = DVec2::INFINITY;
    let mut hi = DVec2::NEG_INFINITY;
    for corner in view.slice_corners(a, b) {
        let at = DVec2::new(u.dot(corner), v.dot(corner));
        (lo, hi) = (lo.min(at), hi.max(at));
    }
    (hi - lo).element_product()
}

/// Returns the area in square metres of the rectangle that the planner lays around each slice.
fn least_areas(setting: &Setting, view: &View, light: &DirectionalLight, planes: &[f64]) -> Result<Vec<f64>> {
    let settings = ShadowConfig {
        map_sizes: vec![FINE; planes.len() - 1],
        scheme: SplitScheme::Manual { planes: planes[1..planes.len() - 1].to_vec() },
        range: Range::Metres { near: planes[0], far: planes[planes.len() - 1] },
        crop: Crop::SceneIndependent,
        stability: Stability::tight(),
        transition: Transition::Hard,
        ..Preset::Papers.config()
    };
    let everything = setting.surroundings();
    let reach = FilterReach { radius_texels: 0.0, radius_m: None };
    let options = PlannerOptions { filter_reach: Some(reach), image_size: [FINE; 2], ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&settings, options)?;
    let plan = planner.plan(view, light, &[everything], &[everything])?;
    Ok(plan.splits.iter().map(|split| (split.texel_m * f64::from(split.size)).element_product()).collect())
}

/// Returns `Σ Area(B_i) / Area(B)` for the slices between `planes`.
pub(super) fn ratio(
    setting: &Setting,
    view: &View,
    light: &DirectionalLight,
    planes: &[f64],
    enclosure: Enclosure,
) -> Result<f64> {
    let (near, far) = (planes[0], planes[planes.len() - 1]);
    let sum =
        |area: &dyn Fn(f64, f64) -> f64| planes.windows(2).map(|p| area(p[0], p[1])).sum::<f64>() / area(near, far);
    Ok(match enclosure {
        Enclosure::Box => sum(&|a, b| box_area(view, light, a, b)),
        Enclosure::Sphere => sum(&|a, b| slice_sphere(view.frustum(), a, b).radius.powi(2)),
        Enclosure::Least => {
            let parts = least_areas(setting, view, light, planes)?;
            parts.iter().sum::<f64>() / least_areas(setting, view, light, &[near, far])?[0]
        }
    })
}

/// Returns a ratio over the angle from 0° to 90°. It is symmetric about 90°, because a shadow map
/// seen from behind has the same area.
fn curve(setting: &Setting, view: &View, turn: Turn, planes: &[f64], enclosure: Enclosure) -> Result<Vec<(f64, f64)>> {
    (0..=(90.0 / STEP) as u32)
        .map(|k| {
            let degrees = f64::from(k) * STEP;
            Ok((degrees, ratio(setting, view, &light(view, turn, degrees)?, planes, enclosure)?))
        })
        .collect()
}

/// Returns the smallest angle from which on the curve stays at or below 1; `None` if it never does.
fn angle_below_one(curve: &[(f64, f64)]) -> Option<f64> {
    let last_above = curve.iter().rposition(|&(_, ratio)| ratio > 1.0);
    match last_above {
        None => curve.first().map(|&(angle, _)| angle),
        Some(k) => {
            let (&(a0, r0), &(a1, r1)) = (curve.get(k)?, curve.get(k + 1)?);
            Some(a0 + (a1 - a0) * (r0 - 1.0) / (r0 - r1))
        }
    }
}

/// Makes the section of the page.
pub(super) fn section(setting: &Setting) -> Result<Section> {
    let Setting { near, far, .. } = *setting;
    let view = setting.view()?;
    let practical = SplitScheme::practical();
    let angle = || Axis::linear("angle between light and view, degrees").range(0.0, 90.0);
    let sum = || Axis::linear("Σ Area(Bᵢ) / Area(B)").from_zero();
    let one = || Mark::Y(1.0, "as much as one map".into());

    let mut numbers = Chart::new("By the number of splits", angle(), sum()).mark(one()).size(680.0, 340.0);
    let mut table = Table::new(
        "Practical scheme, λ = 0.5, axis-aligned boxes, the light turning from along the view to straight down.",
        vec![
            Column::number("splits m"),
            Column::number("light along the view (0°)"),
            Column::number("light across the view (90°)"),
            Column::text("sum ≤ whole"),
        ],
    );
    for m in 2..=MAX_SPLITS {
        let planes = planes(&practical, near, far, m)?;
        let curve = curve(setting, &view, Turn::Down, &planes, Enclosure::Box)?;
        let holds = match angle_below_one(&curve) {
            Some(0.0) => "at every angle".into(),
            Some(angle) => format!("from {angle:.0}° on"),
            None => "never".to_string(),
        };
        let (along, across) = (curve[0].1, curve[curve.len() - 1].1);
        table =
            table.row(vec![Cell::Number(m as f64, 0), Cell::Number(along, 2), Cell::Number(across, 2), holds.into()]);
        numbers = numbers
            .series(Series::new(format!("m = {m}"), Style::Line, curve).colour(Colour::Step(m - 2, MAX_SPLITS - 1)));
    }

    let mut by_scheme =
        Chart::new(format!("By the scheme, m = {SPLITS}"), angle(), sum()).mark(one()).size(560.0, 300.0);
    for (name, scheme) in schemes() {
        let curve = curve(setting, &view, Turn::Down, &planes(&scheme, near, far, SPLITS)?, Enclosure::Box)?;
        by_scheme = by_scheme.series(Series::new(name, Style::Line, curve));
    }

    let mut by_fit =
        Chart::new(format!("By what encloses a slice, m = {SPLITS}"), angle(), sum()).mark(one()).size(560.0, 300.0);
    let cuts = planes(&practical, near, far, SPLITS)?;
    for (name, turn, enclosure, style, colour) in [
        ("box, light from above", Turn::Down, Enclosure::Box, Style::Line, Colour::Series(0)),
        ("box, light from the side", Turn::Sideways, Enclosure::Box, Style::Line, Colour::Series(1)),
        ("least rectangle", Turn::Down, Enclosure::Least, Style::Dashed, Colour::Ink),
        ("", Turn::Sideways, Enclosure::Least, Style::Dashed, Colour::Ink),
        ("sphere (stands still)", Turn::Down, Enclosure::Sphere, Style::Line, Colour::Series(3)),
    ] {
        by_fit = by_fit.series(Series::new(name, style, curve(setting, &view, turn, &cuts, enclosure)?).colour(colour));
    }

    Ok(Section::new("Area of the parts against the whole")
        .text(
            "The paper holds that the boxes Bᵢ around the slices are together never larger than the box B around the whole view \
             ([PSSM06] section 3.4, Figure 5). That is so when the light comes across the view, the case it draws. When light and \
             view are nearly parallel every slice's box is as wide as the slice's far end, the boxes lie over each other, and the \
             sum exceeds the whole.",
        )
        .figure(&Figure::svg(
            numbers.to_svg()?,
            format!(
                "Practical scheme, λ = 0.5, {}; the light turns from along the view (0°) to straight down (90°). At 0° the sum is \
                 Σ (Cᵢ/f)², at 90° Σ Cᵢ (Cᵢ − Cᵢ₋₁) / (f (f − n)), whatever the lens. Up to half the lens's angle, {}°, the far \
                 faces hide the rest of their slices and nothing changes.",
                setting.describe(),
                0.5 * setting.fov
            ),
        ))
        .table(&table)
        .figures(&[
            Figure::svg(
                by_scheme.to_svg()?,
                "Uniform slices overlap most when seen along the view. Logarithmic ones are so small that all but the last \
                 hardly count, which is little comfort: the last is then nearly the whole.",
            ),
            Figure::svg(
                by_fit.to_svg()?,
                "The same slices enclosed otherwise; the whole is enclosed in the same manner as its parts. In this lens the \
                 planner's least rectangles sum up as the boxes do. The sphere around a slice of so wide a lens is the one \
                 around its far face, from wherever it is seen: its sum is that of 0° always.",
            ),
        ]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64, setting: &Setting, planes: &[f64], enclosure: Enclosure) -> f64 {
        let view = setting.view().expect("a view");
        let light = light(&view, Turn::Down, degrees).expect("a light");
        ratio(setting, &view, &light, planes, enclosure).expect("a ratio")
    }

    fn practical(setting: &Setting, m: usize) -> Vec<f64> {
        planes(&SplitScheme::practical(), setting.near, setting.far, m).expect("planes")
    }

    /// The design's two numbers, 1.31 and 0.68, belong to n = 1, f = 800, λ = 0.5, m = 4, and to
    /// every lens.
    #[test]
    fn the_sum_is_1_31_along_the_view_and_0_68_across() {
        for (fov, image_size) in [(60.0, [800, 600]), (30.0, [512, 512]), (100.0, [1920, 1080])] {
            let setting = Setting { fov, image_size, ..Setting::default() };
            let planes = practical(&setting, 4);
            let (along, across) =
                (at(0.0, &setting, &planes, Enclosure::Box), at(90.0, &setting, &planes, Enclosure::Box));
            assert!((along - 1.31).abs() < 0.005, "{along}");
            assert!((across - 0.68).abs() < 0.005, "{across}");
        }
    }

    #[test]
    fn both_ends_follow_their_closed_forms() {
        let setting = Setting { near: 0.5, far: 500.0, ..Setting::default() };
        let (n, f) = (setting.near, setting.far);
        for (_, scheme) in schemes() {
            for m in 1..=MAX_SPLITS {
                let planes = planes(&scheme, n, f, m).expect("planes");
                let along: f64 = planes[1..].iter().map(|c| (c / f).powi(2)).sum();
                let across: f64 = planes.windows(2).map(|c| c[1] * (c[1] - c[0])).sum::<f64>() / (f * (f - n));
                assert!((at(0.0, &setting, &planes, Enclosure::Box) - along).abs() < 1e-9);
                assert!((at(90.0, &setting, &planes, Enclosure::Box) - across).abs() < 1e-9);
            }
        }
    }

    /// The planner's rectangle is the box along the view, and across it no larger than the box.
    #[test]
    fn the_planner_measures_the_same_areas() {
        let setting = Setting::default();
        let planes = practical(&setting, 4);
        let along = at(0.0, &setting, &planes, Enclosure::Least);
        assert!((along - at(0.0, &setting, &planes, Enclosure::Box)).abs() < 1e-3, "{along}");
        let view = setting.view().expect("a view");
        for degrees in [10.0, 45.0, 90.0] {
            let light = light(&view, Turn::Down, degrees).expect("a light");
            let fitted = least_areas(&setting, &view, &light, &planes).expect("areas");
            for (area, slice) in fitted.iter().zip(planes.windows(2)) {
                let bound = box_area(&view, &light, slice[0], slice[1]);
                assert!(*area <= bound * 1.001, "{area} m² where a box takes {bound} m² at {degrees}°");
            }
        }
    }

    #[test]
    fn one_split_is_the_whole() {
        let setting = Setting::default();
        for enclosure in [Enclosure::Box, Enclosure::Least, Enclosure::Sphere] {
            assert!((at(33.0, &setting, &[1.0, 800.0], enclosure) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_angle_is_where_the_curve_meets_one() {
        assert_eq!(angle_below_one(&[(0.0, 2.0), (1.0, 1.5), (2.0, 0.5)]), Some(1.5));
        assert_eq!(angle_below_one(&[(0.0, 1.0), (1.0, 0.5)]), Some(0.0));
        assert_eq!(angle_below_one(&[(0.0, 0.9), (1.0, 1.5)]), None);
    }
}
