//! The three split schemes over depth and the aliasing that they yield: \[PSSM06\] Figure 4,
//! \[GG3-10\] Figure 10-4.

use glam::DVec3;
use umbrage::config::{Crop, Filter, Preset, Range, SplitScheme, Stability, Transition};
use umbrage::{DirectionalLight, Planner, PlannerOptions, ShadowConfig, ShadowPlan, View, split_planes};

use super::{Result, setting::Setting};
use crate::{
    page::html::{Cell, Column, Figure, Section, Table},
    page::plot::{Anchor, Axis, Chart, Colour, Diagram, Mark, Series, Shape, Style},
};

/// Number of splits in these plots, as in the papers.
const SPLITS: usize = 4;
/// Number of samples of a curve over depth.
const SAMPLES: usize = 480;

/// Returns the three schemes of the papers, with λ = 0.5 for the practical one.
pub(super) fn schemes() -> [(&'static str, SplitScheme); 3] {
    [
        ("uniform", SplitScheme::Uniform),
        ("logarithmic", SplitScheme::Logarithmic),
        ("practical, λ = 0.5", SplitScheme::practical()),
    ]
}

/// Returns the split planes `C_0 ..= C_m`.
pub(super) fn planes(scheme: &SplitScheme, near: f64, far: f64, splits: usize) -> Result<Vec<f64>> {
    let mut planes = Vec::with_capacity(splits + 1);
    split_planes(scheme, near, far, splits, &mut planes)?;
    Ok(planes)
}

/// Returns the split of a view depth inside the range. A plane belongs to the split that it ends.
fn split_of(planes: &[f64], z: f64) -> usize {
    planes[1..planes.len() - 1].partition_point(|&plane| plane < z)
}

/// Returns the place in shadow-map space, 0 to 1 over the whole range, when every split gets 1/m of
/// the resolution, spread evenly over its own share: `s = (i + (z − C_i)/(C_{i+1} − C_i)) / m`.
pub(super) fn s_of(planes: &[f64], z: f64) -> f64 {
    let i = split_of(planes, z);
    let m = (planes.len() - 1) as f64;
    (i as f64 + (z - planes[i]) / (planes[i + 1] - planes[i])) / m
}

/// Returns the perspective aliasing at view depth `z` in split `i`: \[PSSM06\] eq. (1) without its
/// angles, `dp/ds = n/z · dz/ds`, with `dz/ds = m (C_{i+1} − C_i)`. (The source gives a split i/m
/// of the resolution; 1/m is meant.)
pub(super) fn dp_ds(planes: &[f64], i: usize, z: f64) -> f64 {
    let m = (planes.len() - 1) as f64;
    planes[0] / z * m * (planes[i + 1] - planes[i])
}

/// Returns the lower bound of every scheme over the whole range: \[PSSM06\] eq. (2), `dp/ds = n
/// ln(f/n)` at every depth.
pub(super) fn optimum(near: f64, far: f64) -> f64 {
    near * (far / near).ln()
}

/// Samples a curve over each split, with a gap between splits.
fn over_splits(planes: &[f64], value: impl Fn(usize, f64) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for (i, pair) in planes.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let steps = SAMPLES / (planes.len() - 1);
        points.extend((0..=steps).map(|k| {
            let z = a * (b / a).powf(k as f64 / steps as f64);
            (z, value(i, z))
        }));
        points.push((f64::NAN, f64::NAN));
    }
    points.pop();
    points
}

/// Plans for a sun at right angles to the view, as in the papers' figures: a camera that looks
/// level over a plain at noon.
pub(super) fn plan_at_noon(
    setting: &Setting,
    scheme: SplitScheme,
    map_sizes: Vec<u32>,
    stability: Stability,
) -> Result<(View, ShadowPlan)> {
    let view = setting.view()?;
    let settings = ShadowConfig {
        map_sizes,
        scheme,
        range: Range::Metres { near: setting.near, far: setting.far },
        crop: Crop::SceneIndependent,
        stability,
        filter: Filter::Hard,
        transition: Transition::Hard,
        ..Preset::Papers.config()
    };
    let noon = DirectionalLight::new(DVec3::NEG_Y)?;
    let everything = setting.surroundings();
    let options = PlannerOptions { image_size: setting.image_size, ..PlannerOptions::default() };
    let plan = Planner::with_options(&settings, options)?.plan(&view, &noon, &[everything], &[everything])?.clone();
    Ok((view, plan))
}

/// Returns the pixels that one texel spans on a surface that faces the camera, over depth, from the
/// planned matrices.
pub(super) fn predicted(setting: &Setting, view: &View, plan: &ShadowPlan) -> Vec<(f64, f64)> {
    over_splits(&plan.planes, |i, z| plan.splits[i].pixels_per_texel(view, setting.image_size[1], z))
}

/// Makes the section of the page.
pub(super) fn section(setting: &Setting) -> Result<Section> {
    let Setting { near, far, .. } = *setting;
    let bound = optimum(near, far);
    let all: Vec<(&str, SplitScheme, Vec<f64>)> = schemes()
        .into_iter()
        .map(|(name, scheme)| planes(&scheme, near, far, SPLITS).map(|planes| (name, scheme, planes)))
        .collect::<Result<_>>()?;

    let mut space = Chart::new(
        "Where a depth lies in the maps",
        Axis::log("view depth z, m").range(near, far),
        Axis::linear("s, share of the resolution used up to z").range(0.0, 1.0),
    )
    .size(560.0, 300.0);
    let mut aliasing = Chart::new(
        "Perspective aliasing of the three schemes",
        Axis::log("view depth z, m").range(near, far),
        Axis::log("dp/ds"),
    )
    .size(560.0, 300.0);
    for (index, (name, _, planes)) in all.iter().enumerate() {
        let colour = Colour::Series(index);
        let curve = over_splits(planes, |_, z| s_of(planes, z));
        space = space.series(Series::new(*name, Style::Line, curve).colour(colour));
        let at_planes = planes.iter().map(|&z| (z, s_of(planes, z))).collect();
        space = space.series(Series::new("", Style::Points, at_planes).colour(colour));
        let curve = over_splits(planes, |i, z| dp_ds(planes, i, z));
        aliasing = aliasing.series(Series::new(*name, Style::Line, curve).colour(colour));
    }
    let whole = [near, far];
    let optimal = over_splits(&whole, |_, z| (z / near).ln() / (far / near).ln());
    space = space.series(Series::new("optimum, eq. (2)", Style::Dashed, optimal).colour(Colour::Ink));
    let level = over_splits(&whole, |_, _| bound);
    aliasing = aliasing.series(Series::new("optimum, n ln(f/n)", Style::Dashed, level).colour(Colour::Ink));

    let mut table = Table::new(
        format!(
            "Planes in metres and the worst aliasing in each split, as a multiple of the optimum; n = {near}, f = {far}, m = {SPLITS}."
        ),
        vec![
            Column::text("scheme"),
            Column::number("C₁"),
            Column::number("C₂"),
            Column::number("C₃"),
            Column::number("split 0"),
            Column::number("split 1"),
            Column::number("split 2"),
            Column::number("split 3"),
        ],
    );
    for (name, _, planes) in &all {
        let inner = planes[1..SPLITS].iter().map(|&c| Cell::Number(c, 1));
        let worst = (0..SPLITS).map(|i| Cell::Number(dp_ds(planes, i, planes[i]) / bound, 2));
        table = table.row([Cell::from(*name)].into_iter().chain(inner).chain(worst).collect());
    }

    let (size, whole_size) = (setting.map_size, setting.map_size * 2);
    let mut pixels = Chart::new(
        format!("Predicted from the planned matrices, {SPLITS} maps of {size}²"),
        Axis::log("view depth z, m").range(near, far),
        Axis::log("pixels per texel (its larger edge)"),
    )
    .mark(Mark::Y(1.0, "1 texel = 1 pixel".into()));
    for (index, (name, scheme, _)) in all.iter().enumerate() {
        let (view, plan) = plan_at_noon(setting, scheme.clone(), vec![size; SPLITS], Stability::tight())?;
        let series = Series::new(*name, Style::Line, predicted(setting, &view, &plan));
        pixels = pixels.series(series.colour(Colour::Series(index)));
    }
    let (view, plan) = plan_at_noon(setting, SplitScheme::practical(), vec![size; SPLITS], Stability::Exact)?;
    let still = Series::new("practical, standing still", Style::Dashed, predicted(setting, &view, &plan));
    let (view, plan) = plan_at_noon(setting, SplitScheme::Uniform, vec![whole_size], Stability::tight())?;
    let single = Series::new(format!("one map of {whole_size}²"), Style::Line, predicted(setting, &view, &plan));
    pixels = pixels.series(still.colour(Colour::Series(2))).series(single.colour(Colour::Series(7)));

    Ok(Section::new("Split schemes and aliasing")
        .text(
            "How much of the shadow map's resolution goes to which depth decides how coarse shadows look there. The \
             logarithmic scheme spends it so that every split aliases alike; the uniform one leaves the foreground to \
             a single map, as if there were no splits at all; the practical one lies between.",
        )
        .figure(&Figure::svg(
            strips(setting, &all)?,
            format!(
                "The slices of the view over depth, {near} to {far} m, m = {SPLITS} ([PSSM06] Figure 4, [GG3-10] Figure 10-4). The first \
                 two logarithmic slices are so short that hardly an object fits in: that is what is wrong with this scheme.",
            ),
        ))
        .figures(&[
            Figure::svg(
                space.to_svg()?,
                "Dots are split planes. The dashed line is what a single map would need and cannot do; splits approach it \
                 by straight pieces. On this axis straight pieces bend.",
            ),
            Figure::svg(
                aliasing.to_svg()?,
                "dp/ds = n/z · dz/ds ([PSSM06] eq. 1, perspective part): how many pixels one texel spans, but for a constant. \
                 Uniform falls as 1/z however many splits there are. Logarithmic is the same saw tooth in every split, about \
                 the optimum.",
            ),
        ])
        .table(&table)
        .figure(&Figure::svg(
            pixels.to_svg()?,
            format!(
                "From the matrices themselves, sun straight above a level view, {}. Here the maps' width counts too, and at the \
                 far end of every split it is the larger edge, so all schemes meet there; below the dotted line a texel \
                 hides in a pixel. One map of {whole_size}² takes as much memory as {SPLITS} of {size}².",
                setting.describe()
            ),
        )))
}

/// Draws Figure 4: one strip per scheme, cut at its planes.
fn strips(setting: &Setting, all: &[(&str, SplitScheme, Vec<f64>)]) -> Result<String> {
    let mut diagram = Diagram::new("Where the schemes cut the view");
    diagram.unit = Some("m".into());
    diagram.legend = (0..SPLITS).map(|i| (format!("split {i}"), Colour::Split(i), Some(0.75))).collect();
    // Depth is shown to scale; a strip's height is chosen for the eye.
    let (height, pitch) = (0.06 * setting.far, 0.085 * setting.far);
    for (row, (name, _, planes)) in all.iter().enumerate() {
        let y = -(row as f64) * pitch;
        for (i, pair) in planes.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            diagram.shapes.push(Shape::Polygon {
                corners: vec![(a, y), (b, y), (b, y - height), (a, y - height)],
                fill: Some((Colour::Split(i), 0.75)),
                outline: None,
            });
        }
        diagram.shapes.push(Shape::Text {
            at: (0.0, y - 0.5 * height),
            text: (*name).into(),
            colour: Colour::Ink,
            anchor: Anchor::Left,
        });
    }
    diagram.frame = Some(((-0.2 * setting.far, -2.0 * pitch - height), (setting.far, 0.0)));
    Ok(diagram.to_svg()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(scheme: SplitScheme, m: usize) -> Vec<f64> {
        planes(&scheme, 1.0, 800.0, m).expect("valid planes")
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
    }

    #[test]
    fn logarithmic_splits_alias_alike_in_every_split() {
        for m in 1..=8 {
            let planes = of(SplitScheme::Logarithmic, m);
            let ratio = 800f64.powf(1.0 / m as f64);
            for i in 0..m {
                let (worst, least) = (dp_ds(&planes, i, planes[i]), dp_ds(&planes, i, planes[i + 1]));
                assert!(near(worst, m as f64 * (ratio - 1.0)), "split {i} of {m}: {worst}");
                assert!(near(least, m as f64 * (1.0 - 1.0 / ratio)), "split {i} of {m}: {least}");
                assert!(least < optimum(1.0, 800.0) && optimum(1.0, 800.0) < worst);
            }
        }
    }

    #[test]
    fn many_logarithmic_splits_reach_the_optimum() {
        let planes = of(SplitScheme::Logarithmic, 4096);
        for i in [0, 1000, 4095] {
            let ratio = dp_ds(&planes, i, planes[i]) / optimum(1.0, 800.0);
            assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        }
    }

    #[test]
    fn uniform_splits_alias_as_one_map_whatever_their_number() {
        for m in 1..=8 {
            let planes = of(SplitScheme::Uniform, m);
            for z in [1.0, 3.0, 77.0, 500.0, 800.0] {
                let product = dp_ds(&planes, split_of(&planes, z), z) * z;
                assert!(near(product, 799.0), "n (f − n) = 799, but z dp/ds = {product} at {z} m with {m} splits");
            }
        }
    }

    #[test]
    fn the_practical_scheme_lies_between() {
        let [uniform, logarithmic, practical] = schemes().map(|(_, scheme)| of(scheme, 4));
        for (i, z) in [(0, 1.0), (3, 800.0)] {
            let [a, b, c] = [&uniform, &logarithmic, &practical].map(|planes| dp_ds(planes, i, z));
            assert!((a.min(b)..=a.max(b)).contains(&c), "{a} {b} {c}");
        }
        assert!(dp_ds(&uniform, 0, 1.0) > 40.0 * dp_ds(&logarithmic, 0, 1.0));
    }

    /// No scheme creates resolution; it only distributes it: `∫ ds = ∫ n / (z dp/ds) dz = 1`.
    #[test]
    fn every_scheme_spends_the_same_resolution() {
        for (name, scheme) in schemes() {
            let planes = of(scheme, 4);
            let points = over_splits(&planes, |i, z| 1.0 / (z * dp_ds(&planes, i, z)));
            let sum: f64 = points
                .windows(2)
                .map(|p| 0.5 * (p[1].0 - p[0].0) * (p[0].1 + p[1].1))
                .filter(|area| !area.is_nan())
                .sum();
            assert!((sum - 1.0).abs() < 1e-9, "{name}: {sum}");
            assert!(near(s_of(&planes, 800.0), 1.0) && s_of(&planes, 1.0) == 0.0);
        }
    }

    /// Under a sun at noon the map of a level view is as wide as the slice's far end, so there `m_p
    /// = W / size` for every split of every scheme, and m_p falls as 1/z inside a split.
    #[test]
    fn the_matrices_say_what_the_theory_says() {
        let setting = Setting::default();
        for (name, scheme) in schemes() {
            let (view, plan) = plan_at_noon(&setting, scheme, vec![512; 4], Stability::tight()).expect("a plan");
            for split in &plan.splits {
                let at = |z: f64| split.pixels_per_texel(&view, 600, z);
                assert!(near(at(split.near) * split.near, at(split.far) * split.far));
                // Two texels on each side are margin; the rectangle may stand askew and be a little
                // smaller.
                let expected = 800.0 / (512.0 - 4.0);
                assert!(
                    (0.8 * expected..=1.001 * expected).contains(&at(split.far)),
                    "{name}: {} {expected}",
                    at(split.far)
                );
            }
        }
    }
}
