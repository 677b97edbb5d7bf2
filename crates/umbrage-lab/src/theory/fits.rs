//! Comparison of the scene-independent with the scene-dependent fit: \[GG3-10\] Figures 10-5 and
//! 10-6.

use glam::DVec3;
use umbrage::config::{Crop, Preset, Range, Stability};
use umbrage::{Aabb, DirectionalLight, Planner, PlannerOptions, ShadowConfig, ShadowPlan};
use umbrage_scene::{camera_view, light_direction, procedural::World};

use super::{
    Error, Result,
    example::{Example, Plane, map_corners},
    setting::Setting,
};
use crate::{
    page::html::{Cell, Column, Figure, Section, Table},
    page::plot::{Anchor, Axis, BarChart, BarSeries, Colour, Diagram, Mark, Shape, Stroke},
};

/// Index of the split that the diagrams show.
const SHOWN: usize = 1;
/// Number of splits on the worlds.
const SPLITS: usize = 4;
/// Name of the camera of the worlds.
const CAMERA: &str = "middle";
/// Number of cells across a drawn map: groups of texels, large enough to be visible.
const CELLS: u32 = 16;

/// Area of a texel in each split with either fit, in square metres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TexelAreas {
    pub independent: Vec<f64>,
    pub dependent: Vec<f64>,
}

/// Measures both fits of a world for its camera.
pub(super) fn texel_areas(world: World, setting: &Setting) -> Result<TexelAreas> {
    let scene = world.build();
    let pose = scene.pose(0.0)?;
    let camera = scene.cameras.iter().position(|camera| camera.name == CAMERA);
    let camera = camera.ok_or(Error::NoCamera { world: world.name(), camera: CAMERA })?;
    let [width, height] = setting.image_size;
    let view = camera_view(
        &scene,
        &pose,
        camera,
        f64::from(width) / f64::from(height),
        Some(setting.near),
        Some(setting.far),
    )?;
    let sun = DirectionalLight::new(light_direction(&scene, &pose, 0)?)?;
    let receivers: Vec<Aabb> = pose.objects.iter().map(|object| object.bounds).collect();
    let casters: Vec<Aabb> = pose.objects.iter().filter(|object| object.casts).map(|object| object.bounds).collect();
    let areas = |crop: Crop| -> Result<Vec<f64>> {
        let settings = ShadowConfig {
            map_sizes: vec![setting.map_size; SPLITS],
            crop,
            stability: Stability::tight(),
            range: Range::Metres { near: setting.near, far: setting.far },
            ..Preset::Papers.config()
        };
        let options = PlannerOptions { image_size: setting.image_size, ..PlannerOptions::default() };
        let mut planner = Planner::with_options(&settings, options)?;
        let plan = planner.plan(&view, &sun, &casters, &receivers)?;
        // A split without a caster needs no map.
        let area =
            |split: &umbrage::Split| if split.casters.is_empty() { f64::NAN } else { split.texel_m.element_product() };
        Ok(plan.splits.iter().map(area).collect())
    };
    Ok(TexelAreas { independent: areas(Crop::SceneIndependent)?, dependent: areas(Crop::SceneDependent)? })
}

/// Makes the section of the page.
pub(super) fn section(setting: &Setting) -> Result<Section> {
    let example = Example::new()?;
    let plans = [Crop::SceneIndependent, Crop::SceneDependent].map(|crop| example.plan(crop));
    let [independent, dependent] = plans;
    let (independent, dependent) = (independent?, dependent?);

    let side = Plane { right: DVec3::X, up: DVec3::Y };
    // Both seen from the light with the same way up, so that they can be compared.
    let split = &independent.splits[SHOWN];
    let from_light = Plane { right: split.u_axis, up: -split.v_axis };
    let titled = |title: &str, plan: &ShadowPlan| -> Result<[String; 2]> {
        Ok([
            side_view(&format!("{title}, from the side"), &example, plan, &independent, side)?,
            light_view(&format!("{title}, as the light sees it"), &example, plan, &independent, from_light)?,
        ])
    };
    let [side_a, light_a] = titled("Scene-independent", &independent)?;
    let [side_b, light_b] = titled("Scene-dependent", &dependent)?;
    let texel = |plan: &ShadowPlan| (1e4 * plan.splits[SHOWN].texel_m.element_product()).sqrt();

    let section = Section::new("Scene-independent against scene-dependent fit")
        .text(
            "The independent fit lays the map around the slice alone, sky and gaps included ([GG3-10] Figure 10-5). The dependent one \
             asks what is there: it cuts the slice down to its receivers, then to the part of them that some caster can \
             shade, and puts the near and far planes before the first caster and behind the last receiver ([GG3-10] Figure 10-6).",
        )
        .figures(&[
            Figure::svg(
                side_a,
                "The slice in colour; what its map sees, dashed. Casters of the slice are filled: the balloon is out of \
                 sight, but not out of the light.",
            ),
            Figure::svg(
                side_b,
                "The same slice. Nothing receives a shadow in the sky, so the map does not look there.",
            ),
            Figure::svg(light_a, format!("The map with its slice, {CELLS} × {CELLS} groups of texels. Mean texel edge {:.1} cm.", texel(&independent))),
            Figure::svg(light_b, format!("The same number of texels on what matters. Mean texel edge {:.1} cm.", texel(&dependent))),
        ]);

    let mut bars = BarChart::new(
        "Texel area of the dependent fit, as a share of the independent fit's",
        Axis::linear("dependent / independent").range(0.0, 1.0),
        World::PAPER.iter().map(|world| world.title().to_string()).collect(),
    )
    .mark(Mark::X(1.0, "equal".into()));
    let mut table = Table::new(
        format!(
            "Mean texel edge in centimetres: the square root of a texel's area. {SPLITS} maps of {}².",
            setting.map_size
        ),
        std::iter::once(Column::text("world"))
            .chain(std::iter::once(Column::text("fit")))
            .chain((0..SPLITS).map(|i| Column::number(format!("split {i}"))))
            .collect(),
    );
    let areas: Vec<TexelAreas> =
        World::PAPER.iter().map(|&world| texel_areas(world, setting)).collect::<Result<_>>()?;
    for split in 0..SPLITS {
        let shares = areas.iter().map(|areas| areas.dependent[split] / areas.independent[split]).collect();
        bars = bars.series(BarSeries::new(format!("split {split}"), shares).colour(Colour::Split(split)));
    }
    for (world, areas) in World::PAPER.iter().zip(&areas) {
        for (fit, areas) in [("independent", &areas.independent), ("dependent", &areas.dependent)] {
            let edges = areas.iter().map(|area| Cell::Number(100.0 * area.sqrt(), 1));
            table = table.row([Cell::from(world.title()), fit.into()].into_iter().chain(edges).collect());
        }
    }
    Ok(section
        .heading("On the four worlds")
        .figure(&Figure::svg(
            bars.to_svg()?,
            format!(
                "Each world's own camera `{CAMERA}` and sun at time 0, {} to {} m, practical scheme, not stabilised, default filter and \
                 blend. Shorter is better; a dash marks a split in which nothing can cast a shadow.",
                setting.near, setting.far
            ),
        ))
        .table(&table))
}

/// Returns the part of the world that the drawings of both fits show.
fn frame(example: &Example, reference: &ShadowPlan, plane: Plane) -> ((f64, f64), (f64, f64)) {
    let map = map_corners(&reference.splits[SHOWN]);
    let boxes = example.boxes.iter().flat_map(|b| b.corners());
    let all = plane.points(map.into_iter().chain(boxes));
    let fold = |pick: fn(f64, f64) -> f64, start: f64| {
        all.iter().fold((start, start), |at, p| (pick(at.0, p.0), pick(at.1, p.1)))
    };
    let (lo, hi) = (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY));
    let room = 0.02 * (hi.0 - lo.0);
    ((lo.0 - room, lo.1 - room), (hi.0 + room, hi.1 + room))
}

fn scene(diagram: &mut Diagram, example: &Example, plan: &ShadowPlan, plane: Plane) {
    let colour = Colour::Split(SHOWN);
    let (near, far) = (plan.splits[SHOWN].near, plan.splits[SHOWN].far);
    let frustum = example.view.frustum();
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(example.view.slice_corners(frustum.near, frustum.far)),
        fill: None,
        outline: Some(Stroke::new(Colour::Quiet, 1.0)),
    });
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(example.view.slice_corners(near, far)),
        fill: Some((colour, 0.22)),
        outline: Some(Stroke::new(colour, 1.4)),
    });
    for (index, bounds) in example.boxes.iter().enumerate() {
        let casts = plan.casters(SHOWN).contains(&(index as u32));
        let (fill, line) = if casts { ((colour, 0.75), colour) } else { ((Colour::Grid, 0.9), Colour::Quiet) };
        diagram.shapes.push(Shape::Polygon {
            corners: plane.outline(bounds.corners()),
            fill: Some(fill),
            outline: Some(Stroke::new(line, 1.2)),
        });
    }
}

fn legend(diagram: &mut Diagram) {
    let colour = Colour::Split(SHOWN);
    diagram.unit = Some("m".into());
    diagram.width = 560.0;
    diagram.legend = vec![
        (format!("slice {SHOWN}"), colour, Some(0.22)),
        ("casters of its map".into(), colour, Some(0.75)),
        ("other boxes".into(), Colour::Grid, Some(0.9)),
        ("what the map sees".into(), Colour::Ink, None),
    ];
}

fn side_view(
    title: &str,
    example: &Example,
    plan: &ShadowPlan,
    reference: &ShadowPlan,
    plane: Plane,
) -> Result<String> {
    let mut diagram = Diagram::new(title);
    legend(&mut diagram);
    let (lo, hi) = frame(example, reference, plane);
    diagram.frame = Some((lo, hi));
    let ground = example.ground;
    diagram.shapes.push(Shape::Polygon {
        corners: vec![(lo.0, ground.min.y), (hi.0, ground.min.y), (hi.0, ground.max.y), (lo.0, ground.max.y)],
        fill: Some((Colour::Quiet, 0.5)),
        outline: None,
    });
    scene(&mut diagram, example, plan, plane);
    let map = map_corners(&plan.splits[SHOWN]);
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(map),
        fill: None,
        outline: Some(Stroke::dashed(Colour::Ink, 1.6)),
    });
    // Beside the sides nearest to and farthest from the light.
    let middle = |side: &[DVec3]| side.iter().copied().sum::<DVec3>() / side.len() as f64;
    let aside = 0.035 * (hi.0 - lo.0) * plan.splits[SHOWN].depth_axis;
    for (at, text) in [(middle(&map[..4]) - aside, "near"), (middle(&map[4..]) + aside, "far")] {
        let (at, text) = (plane.point(at), text.into());
        diagram.shapes.push(Shape::Text { at, text, colour: Colour::Ink, anchor: Anchor::Centre });
    }
    let eye = plane.point(example.view.eye());
    diagram.shapes.push(Shape::Text { at: eye, text: "eye".into(), colour: Colour::Ink, anchor: Anchor::Left });
    let sun = example.sun.direction();
    let length = 0.09 * (hi.0 - lo.0);
    for k in 0..3 {
        let from = (hi.0 - length * (1.2 + 0.5 * f64::from(k)), hi.1 - 0.2 * length);
        let to = (from.0 + length * sun.x, from.1 + length * sun.y);
        diagram.shapes.push(Shape::Line {
            points: vec![from, to],
            stroke: Stroke::new(Colour::Series(4), 1.8),
            arrow: true,
        });
    }
    Ok(diagram.to_svg()?)
}

fn light_view(
    title: &str,
    example: &Example,
    plan: &ShadowPlan,
    reference: &ShadowPlan,
    plane: Plane,
) -> Result<String> {
    let mut diagram = Diagram::new(title);
    legend(&mut diagram);
    diagram.frame = Some(frame(example, reference, plane));
    scene(&mut diagram, example, plan, plane);
    let [origin, along_u, along_v, ..] = map_corners(&plan.splits[SHOWN]);
    for k in 1..CELLS {
        let share = f64::from(k) / f64::from(CELLS);
        for (a, b) in [(along_u, along_v), (along_v, along_u)] {
            let from = origin + (a - origin) * share;
            let points = plane.points([from, from + (b - origin)]);
            diagram.shapes.push(Shape::Line { points, stroke: Stroke::new(Colour::Quiet, 0.4), arrow: false });
        }
    }
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(map_corners(&plan.splits[SHOWN])),
        fill: None,
        outline: Some(Stroke::dashed(Colour::Ink, 1.6)),
    });
    Ok(diagram.to_svg()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knowing_the_scene_never_makes_texels_larger() {
        let example = Example::new().expect("the example");
        let [a, b] = [Crop::SceneIndependent, Crop::SceneDependent].map(|crop| example.plan(crop).expect("a plan"));
        for (independent, dependent) in a.splits.iter().zip(&b.splits) {
            let areas = [independent, dependent].map(|split| split.texel_m.element_product());
            assert!(areas[1] <= areas[0] * (1.0 + 1e-9), "{areas:?}");
        }
        let gain = b.splits[SHOWN].texel_m.element_product() / a.splits[SHOWN].texel_m.element_product();
        assert!(gain < 0.7, "the diagram should show a gain, not {gain}");
    }

    #[test]
    fn the_dependent_fit_gains_on_every_world() {
        for world in World::PAPER {
            let areas = texel_areas(world, &Setting::default()).expect("areas");
            for (independent, dependent) in areas.independent.iter().zip(&areas.dependent) {
                assert!(*independent > 0.0);
                assert!(dependent.is_nan() || *dependent <= independent * (1.0 + 1e-9), "{}: {areas:?}", world.name());
            }
        }
    }
}
