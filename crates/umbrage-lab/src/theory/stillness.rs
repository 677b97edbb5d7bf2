//! Flicker of shadows and its prevention: \[PCSM\] Figures 4.1.3, 4.1.4 and 4.1.6.

use glam::{DQuat, DVec2, DVec3};
use umbrage::config::{Crop, ExtentSteps, Preset, Range, Stability};
use umbrage::{DirectionalLight, Planner, PlannerOptions, ShadowConfig, ShadowPlan, Split, View};

use super::{
    Result,
    example::{Plane, map_corners},
    setting::Setting,
};
use crate::{
    page::html::{Cell, Column, Figure, Section, Table},
    page::plot::{Anchor, Axis, Chart, Colour, Diagram, Series, Shape, Stroke, Style},
};

/// Number of frames of the walk.
const FRAMES: u32 = 600;
/// Metres and radians by which the camera moves and turns in a frame.
const STRIDE: (f64, f64) = (0.15, 0.003);
/// Index of the split that the drawings show.
const SHOWN: usize = 1;
/// Number of splits.
const SPLITS: usize = 4;
/// Texels around the point of interest that a drawing shows.
const REACH: f64 = 3.0;

/// Kinds of stabilisation, with their colours in every drawing.
const KINDS: [(&str, Stability, Colour); 4] = [
    ("unstabilised", Stability::tight(), Colour::Series(1)),
    ("exact", Stability::Exact, Colour::Series(0)),
    (
        "approximate, steps of 2^(1/24)",
        Stability::Approximate { steps: ExtentSteps::PerDoubling(24) },
        Colour::Series(2),
    ),
    ("approximate, 64 levels", Stability::Approximate { steps: ExtentSteps::Levels(64) }, Colour::Series(3)),
];

/// Returns the view of a frame: it moves and turns.
fn view(setting: &Setting, frame: u32) -> Result<View> {
    let first = setting.view()?;
    let ahead = DQuat::from_rotation_y(STRIDE.1 * f64::from(frame)) * DVec3::NEG_Z;
    let eye = DVec3::NEG_Z * STRIDE.0 * f64::from(frame);
    Ok(View::look_at_upright(eye, eye + ahead, *first.frustum())?)
}

/// Plans all frames of a walk.
pub(super) fn plans(setting: &Setting, stability: Stability, frames: u32) -> Result<Vec<ShadowPlan>> {
    let config = ShadowConfig {
        map_sizes: vec![setting.map_size; SPLITS],
        range: Range::Metres { near: setting.near, far: setting.far },
        crop: Crop::SceneIndependent,
        stability,
        ..Preset::Papers.config()
    };
    let options = PlannerOptions { image_size: setting.image_size, ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&config, options)?;
    let sun = DirectionalLight::new(DVec3::new(0.5, -1.0, -0.3))?;
    let everything = setting.surroundings();
    let plan = |k| Ok(planner.plan(&view(setting, k)?, &sun, &[everything], &[everything])?.clone());
    (0..frames).map(plan).collect()
}

/// Returns the number of times that a map changes its texels from one plan to the next.
fn steps(plans: &[ShadowPlan]) -> usize {
    let pairs = plans.windows(2).flat_map(|pair| pair[0].splits.iter().zip(&pair[1].splits));
    pairs.filter(|(before, now)| now.texels_moved_since(before).is_none()).count()
}

fn mean_edge(split: &Split) -> f64 {
    split.texel_m.element_product().sqrt()
}

/// Makes the section of the page.
pub(super) fn section(setting: &Setting) -> Result<Section> {
    let walks: Vec<Vec<ShadowPlan>> =
        KINDS.iter().map(|(_, kind, _)| plans(setting, kind.clone(), FRAMES)).collect::<Result<_>>()?;

    let mut grids = Vec::new();
    for (walk, (name, _, colour)) in walks.iter().zip(KINDS).take(3) {
        grids.push(Figure::svg(
            texels_around(&format!("Texels, {}", name.split(',').next().unwrap_or(name)), &walk[0], &walk[1], colour)?,
            match grids.len() {
                0 => "Two frames, 0.15 m and 0.003 rad apart: scale, place and direction of the texels change, and the point of interest \
                      with the texel that it lies in ([PCSM] Figure 4.1.3, bottom row).",
                1 => "The second frame's texels are the first one's.",
                _ => "Here too, until a step is taken.",
            },
        ));
    }

    let mut sizes = Chart::new(
        format!("Texel edge in split {SHOWN} along a walk with turns"),
        Axis::linear("frame").range(0.0, f64::from(FRAMES)),
        Axis::linear("texel edge, m (geometric mean)"),
    )
    .size(680.0, 300.0);
    let mut table = Table::new(
        format!(
            "{FRAMES} frames of {} m and {} rad; maps of {}². A step changes every texel of one map at once; between steps none changes.",
            STRIDE.0, STRIDE.1, setting.map_size
        ),
        vec![
            Column::text("kind"),
            Column::number("texel edge, times the tight one"),
            Column::number(format!("steps, of {}", (FRAMES as usize - 1) * SPLITS)),
        ],
    );
    for (walk, (name, _, colour)) in walks.iter().zip(KINDS) {
        let edge = |(k, plan): (usize, &ShadowPlan)| (k as f64, mean_edge(&plan.splits[SHOWN]));
        let curve = walk.iter().enumerate().map(edge).collect();
        sizes = sizes.series(Series::new(name, Style::Line, curve).colour(colour));
        let pairs = walk.iter().zip(&walks[0]).flat_map(|(plan, tight)| plan.splits.iter().zip(&tight.splits));
        let (sum, count) = pairs
            .fold((0.0, 0.0), |(sum, count), (split, tight)| (sum + mean_edge(split) / mean_edge(tight), count + 1.0));
        table = table.row(vec![name.into(), Cell::Number(sum / count, 2), Cell::Number(steps(walk) as f64, 0)]);
    }

    Ok(Section::new("Flicker, and what keeps shadows still")
        .text(
            "A tight map is another map in every frame, so every edge of a shadow falls into other texels, though neither the sun nor \
             anything else moved. Two things must stand still: how large a texel is (the scale problem of [PCSM]) and where its corners lie \
             (the offset problem).",
        )
        .figures(&grids)
        .figure(&Figure::svg(
            fits(&walks)?,
            format!(
                "Split {SHOWN} as the light sees it ([PCSM] Figure 4.1.4). The sphere's square is the same from wherever one looks, and wastes \
                 what lies outside the slice. The approximate rectangle stands on one of 16 directions that are fixed to the light."
            ),
        ))
        .figure(&Figure::svg(
            sizes.to_svg()?,
            "The tight map follows every turn; the sphere never does; the others take steps ([PCSM] Figure 4.1.6). The source's levels are equal \
             parts of the whole range's sphere, without hysteresis.",
        ))
        .table(&table))
}

/// Draws the grid lines of one map's texels near a point, and the texel that holds the point.
fn texels_around(title: &str, first: &ShadowPlan, second: &ShadowPlan, colour: Colour) -> Result<String> {
    let (first, second) = (&first.splits[SHOWN], &second.splits[SHOWN]);
    let plane = Plane { right: first.u_axis, up: -first.v_axis };
    let corners = map_corners(first);
    // Near the map's middle, and no texel's corner.
    let point =
        0.5 * (corners[0] + corners[3]) + 0.3 * (first.u_axis * first.texel_m.x + first.v_axis * first.texel_m.y);
    let mut diagram = Diagram::new(title);
    diagram.width = 330.0;
    diagram.unit = Some("m".into());
    let (x, y) = plane.point(point);
    let room = REACH * first.texel_m.max_element();
    diagram.frame = Some(((x - room, y - room), (x + room, y + room)));
    diagram.legend = vec![("this frame".into(), Colour::Quiet, Some(0.25)), ("the next".into(), colour, Some(0.25))];
    let grid = |split: &Split, stroke: fn(Colour, f64) -> Stroke, colour: Colour, width: f64| {
        let at = split.map_from_world(point).truncate().floor();
        let corner = |texel: DVec2| {
            let metres = (texel + split.min_texel) * split.texel_m;
            plane.point(split.u_axis * metres.x + split.v_axis * metres.y)
        };
        let far = 2.0 * REACH;
        let mut shapes = Vec::new();
        for k in 0..=(2.0 * far) as i32 {
            let line = f64::from(k) - far;
            for (from, to) in
                [(DVec2::new(line, -far), DVec2::new(line, far)), (DVec2::new(-far, line), DVec2::new(far, line))]
            {
                let points = vec![corner(at + from), corner(at + to)];
                shapes.push(Shape::Line { points, stroke: stroke(colour, width), arrow: false });
            }
        }
        let own = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| corner(at + DVec2::new(u, v)));
        shapes.insert(0, Shape::Polygon { corners: own.to_vec(), fill: Some((colour, 0.25)), outline: None });
        shapes
    };
    diagram.shapes.extend(grid(first, Stroke::new, Colour::Quiet, 1.2));
    diagram.shapes.extend(grid(second, Stroke::dashed, colour, 1.6));
    let arm = 0.06 * room;
    for (dx, dy) in [(arm, arm), (arm, -arm)] {
        diagram.shapes.push(Shape::Line {
            points: vec![(x - dx, y - dy), (x + dx, y + dy)],
            stroke: Stroke::new(Colour::Split(0), 2.4),
            arrow: false,
        });
    }
    Ok(diagram.to_svg()?)
}

/// Draws a slice and the maps of all kinds around it, seen from the light.
fn fits(walks: &[Vec<ShadowPlan>]) -> Result<String> {
    let plan = &walks[1][0];
    let split = &plan.splits[SHOWN];
    let plane = Plane { right: split.u_axis, up: -split.v_axis };
    let mut diagram = Diagram::new(format!("Maps of split {SHOWN} as the light sees them"));
    diagram.unit = Some("m".into());
    diagram.width = 560.0;
    let slice = view(&Setting::default(), 0)?.slice_corners(split.coverage.0, split.coverage.1);
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(slice),
        fill: Some((Colour::Quiet, 0.25)),
        outline: Some(Stroke::new(Colour::Quiet, 1.2)),
    });
    diagram.legend.push(("slice".into(), Colour::Quiet, Some(0.25)));
    for (walk, (name, _, colour)) in walks.iter().zip(KINDS) {
        let corners = map_corners(&walk[0].splits[SHOWN]);
        diagram.shapes.push(Shape::Polygon {
            corners: plane.outline(corners),
            fill: None,
            outline: Some(Stroke::dashed(colour, 1.8)),
        });
        diagram.legend.push((name.into(), colour, None));
    }
    let at = plane.point(slice[4]);
    diagram.shapes.push(Shape::Text { at, text: "far".into(), colour: Colour::Ink, anchor: Anchor::Above });
    Ok(diagram.to_svg()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_tells_still_from_restless() {
        let setting = Setting::default();
        let of = |kind| steps(&plans(&setting, kind, 120).expect("plans"));
        let [tight, exact, approximate, levels] = KINDS.map(|(_, kind, _)| of(kind));
        assert_eq!((tight, exact), (119 * SPLITS, 0), "every tight map changes, no exact one does");
        assert!(approximate > 0 && 10 * approximate < tight, "{approximate} of {tight}");
        assert!(levels > 0 && 5 * levels < tight, "{levels} of {tight}");
    }
}
