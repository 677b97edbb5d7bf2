//! Wireframes of the view's splits and the light's frusta.

use glam::DVec3;
use umbrage::config::Crop;
use umbrage::{Aabb, ShadowPlan};

use super::{
    Result,
    example::{BOX_EDGES, Example, Plane, SPLITS, map_corners},
};
use crate::{
    page::html::{Figure, Section},
    page::plot::{Anchor, Colour, Diagram, Shape, Stroke},
};

/// Viewing direction of the drawing's observer.
const GAZE: DVec3 = DVec3::new(-0.42, -0.42, -0.80);

fn observer() -> Plane {
    let forward = GAZE.normalize();
    let right = forward.cross(DVec3::Y).normalize();
    Plane { right, up: right.cross(forward) }
}

/// Makes the section of the page.
pub(super) fn section() -> Result<Section> {
    let example = Example::new()?;
    let plan = example.plan(Crop::SceneDependent)?;
    let mut figures =
        vec![Figure::svg(all_splits(&example, &plan)?, "The slices Vᵢ of the view, nearest first, over the ground.")];
    for split in 0..SPLITS {
        let casters = plan.casters(split).len();
        let range = &plan.splits[split];
        figures.push(Figure::svg(
            one_split(&example, &plan, split)?,
            format!(
                "Slice {split}, {:.0} to {:.0} m, {casters} caster{}, and the light's frustum, dashed. It reaches up to the \
                 first caster, in sight or not.",
                range.near,
                range.far,
                if casters == 1 { "" } else { "s" }
            ),
        ));
    }
    Ok(Section::new("View splits and light frusta")
        .text(
            "The view is cut into slices parallel to the picture plane; for every slice the light gets a frustum of its own \
             (a box, as the sun's rays are parallel). Drawn for the scene above with the dependent fit.",
        )
        .figures(&figures))
}

fn all_splits(example: &Example, plan: &ShadowPlan) -> Result<String> {
    let plane = observer();
    let mut diagram = base("All slices", example, plan, plane);
    diagram.legend = (0..SPLITS).map(|i| (format!("slice {i}"), Colour::Split(i), Some(0.3))).collect();
    boxes(&mut diagram, example, plane, |_| None);
    // From the back to the front, so that near slices lie over far ones.
    for split in (0..SPLITS).rev() {
        slice(&mut diagram, example, plan, split, plane);
    }
    eye(&mut diagram, example, plane);
    Ok(diagram.to_svg()?)
}

fn one_split(example: &Example, plan: &ShadowPlan, split: usize) -> Result<String> {
    let plane = observer();
    let colour = Colour::Split(split);
    let mut diagram = base(&format!("Split {split}"), example, plan, plane);
    diagram.legend = vec![
        ("slice".into(), colour, Some(0.3)),
        ("casters".into(), colour, Some(0.7)),
        ("light's frustum".into(), Colour::Ink, None),
    ];
    let casters = plan.casters(split);
    boxes(&mut diagram, example, plane, |index| casters.contains(&(index as u32)).then_some(colour));
    slice(&mut diagram, example, plan, split, plane);
    if !casters.is_empty() {
        let map = map_corners(&plan.splits[split]);
        for (a, b) in BOX_EDGES {
            diagram.shapes.push(Shape::Line {
                points: plane.points([map[a], map[b]]),
                stroke: Stroke::dashed(Colour::Ink, 1.4),
                arrow: false,
            });
        }
    }
    eye(&mut diagram, example, plane);
    Ok(diagram.to_svg()?)
}

/// Draws the ground and the whole view, in a frame that all drawings share.
fn base(title: &str, example: &Example, plan: &ShadowPlan, plane: Plane) -> Diagram {
    let mut diagram = Diagram::new(title);
    diagram.width = 560.0;
    let frustum = example.view.frustum();
    let everything = plan
        .splits
        .iter()
        .flat_map(map_corners)
        .chain(example.view.slice_corners(frustum.near, frustum.far))
        .chain(example.ground.corners());
    let points = plane.points(everything);
    let lo = points.iter().fold((f64::INFINITY, f64::INFINITY), |at, p| (at.0.min(p.0), at.1.min(p.1)));
    let hi = points.iter().fold((f64::NEG_INFINITY, f64::NEG_INFINITY), |at, p| (at.0.max(p.0), at.1.max(p.1)));
    diagram.frame = Some((lo, hi));
    diagram.shapes.push(Shape::Polygon {
        corners: plane.outline(example.ground.corners()),
        fill: Some((Colour::Grid, 0.55)),
        outline: Some(Stroke::new(Colour::Grid, 1.0)),
    });
    diagram
}

/// Draws the boxes, far ones first, three faces each. `colour_of` singles some out.
fn boxes(diagram: &mut Diagram, example: &Example, plane: Plane, colour_of: impl Fn(usize) -> Option<Colour>) {
    let mut order: Vec<usize> = (0..example.boxes.len()).collect();
    let distance = |index: &usize| GAZE.dot(example.boxes[*index].center());
    order.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    for index in order {
        let colour = colour_of(index);
        for (face, opacity) in faces(&example.boxes[index]) {
            let corners = plane.points(face);
            // Paper under the colour: what is behind a box does not shine through.
            diagram.shapes.push(Shape::Polygon {
                corners: corners.clone(),
                fill: Some((Colour::Paper, 1.0)),
                outline: None,
            });
            diagram.shapes.push(Shape::Polygon {
                corners,
                fill: Some((colour.unwrap_or(Colour::Quiet), if colour.is_some() { opacity } else { 0.4 * opacity })),
                outline: Some(Stroke::new(colour.unwrap_or(Colour::Quiet), 0.9)),
            });
        }
    }
}

/// Returns the three faces that the observer sees, with the darkness of each: the top, the one
/// towards +x and the one towards +z.
fn faces(bounds: &Aabb) -> [([DVec3; 4], f64); 3] {
    let c = bounds.corners();
    let face = |corners: [usize; 4]| corners.map(|i| c[i]);
    [(face([2, 3, 7, 6]), 0.45), (face([1, 3, 7, 5]), 0.85), (face([4, 5, 7, 6]), 0.65)]
}

fn slice(diagram: &mut Diagram, example: &Example, plan: &ShadowPlan, split: usize, plane: Plane) {
    let colour = Colour::Split(split);
    let corners = example.view.slice_corners(plan.splits[split].near, plan.splits[split].far);
    diagram.shapes.push(Shape::Polygon { corners: plane.outline(corners), fill: Some((colour, 0.18)), outline: None });
    for (a, b) in BOX_EDGES {
        diagram.shapes.push(Shape::Line {
            points: plane.points([corners[a], corners[b]]),
            stroke: Stroke::new(colour, 1.5),
            arrow: false,
        });
    }
}

fn eye(diagram: &mut Diagram, example: &Example, plane: Plane) {
    diagram.shapes.push(Shape::Text {
        at: plane.point(example.view.eye()),
        text: "eye".into(),
        colour: Colour::Ink,
        anchor: Anchor::Above,
    });
}
