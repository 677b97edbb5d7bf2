//! A sun's plan in stages: scope → range → planes → casters → fit → snap → depth. Each stage is a
//! value that later stages read; no stage reads a later one.

use glam::DVec3;

use super::casters::{Listed, Scene};
use super::covered;
use super::depth::{self, WorldDepths};
use super::fit::MapSize;
use super::frame::{Frame, Sun};
use super::goals::{self, Goals};
use super::in_view::InView;
use super::layout::{Layout, LayoutBuffers, SplitFrame};
use super::picked::Picked;
use super::scope::Scope;
use super::snap;
use super::warped::WarpPoints;
use crate::bounds::Placed;
use crate::config::{Crop, Range, Selection};
use crate::held::Held;
use crate::{DirectionalLight, Result, ShadowPlan, Split, Warp};

/// Buffers that are reused from call to call.
#[derive(Clone, Debug, Default)]
pub(super) struct SunBuffers {
    in_view: InView,
    listed: Picked,
    layout: LayoutBuffers,
    warp_points: WarpPoints,
}

/// Fills a plan that has begun.
pub(super) fn plan(
    frame: &Frame<'_>,
    light: &DirectionalLight,
    held: &mut Held,
    buffers: &mut SunBuffers,
    plan: &mut ShadowPlan,
) -> Result<()> {
    frame.config.selection.metric().check_view(frame.view)?;
    let SunBuffers { in_view, listed: casters, layout: layout_buffers, warp_points } = buffers;
    let sun = Sun::new(light, frame);
    let scope = Scope::new(frame, &sun);
    let layout = Layout::new((frame, &sun), &scope, held, in_view, layout_buffers)?;
    let world = WorldDepths::measure(frame, &sun, &scope, &layout, &mut held.depths);
    describe(frame, &sun, &layout, plan);
    let by_map = frame.config.selection == Selection::Map;
    let shown = by_map.then(|| Scene::of_view(frame, &sun, &layout, in_view));
    for index in 0..frame.config.splits() {
        let split = SplitFrame { frame, sun: &sun, layout: &layout, index };
        let size = MapSize::new(&split, &held.rectangle[index]);
        let goals = Goals::measure(&split, &size, (in_view, casters));
        let mut scene = Scene::of_split(&split, in_view);
        let listed = Listed::new(&split, &size, &mut scene, &in_view.casters, casters);
        let has_casters = !casters.is_empty();
        let map = snap::placed(&split, &scene, &size, (&listed, has_casters), &mut held.rectangle[index]);
        if let Some(goals) = &goals {
            goals.set(&split, has_casters, &mut held.rectangle[index]);
        }
        let (map, first) = match &shown {
            Some(all) if has_casters => {
                let all = (&all.volume, all.depths());
                covered::serving_all_it_covers(&sun, (map, listed.first), all, (&in_view.casters, casters), plan)
            }
            _ => (map, listed.first),
        };
        let mut map = depth::ranged(frame, map, first, &size, world);
        if frame.config.drop_small_casters && split.warp() == Warp::None {
            let texels_per_m = [map.u_axis / map.texel_m.x, map.v_axis / map.texel_m.y];
            let dropped = casters.retain(&in_view.casters, |caster| !is_small(caster, texels_per_m));
            plan.dropped_casters.push(dropped);
        }
        warp(&split, &scene, (in_view, casters), warp_points, &mut map);
        plan.add_listed(map, &mut in_view.casters, casters.places());
        plan.coverage.volumes.push(scene.volume);
    }
    goals::limit((frame, &sun), &layout, &mut held.rectangle);
    plan.coverage.shown = shown.map(|scene| scene.volume);
    Ok(())
}

/// Writes the values that all splits of a plan share.
fn describe(frame: &Frame<'_>, sun: &Sun<'_>, layout: &Layout, plan: &mut ShadowPlan) {
    let (config, view) = (frame.config, frame.view);
    let metric = config.selection.metric();
    plan.planes.clear();
    plan.planes.extend(layout.planes());
    plan.selection = config.selection;
    plan.blend = config.blend();
    // Behind the last receiver and beyond the camera's far plane there is nothing to fade into.
    let last_shown = view.frustum().far / metric.least_depth_share(view);
    let fades = matches!(config.range, Range::Metres { far, .. } if far < last_shown);
    let (near, far) = (layout.range.near, layout.range.far);
    plan.fade_begin = if fades { far - config.far_fade * (far - near) } else { plan.planes[layout.row.splits] };
    plan.coverage.fan = Some(sun.fan);
}

/// Length in texels along both axes of a map below which the shadow of a caster is small. Below one
/// texel it covers the centre of one texel at most. A higher value loses shadows that a filter
/// would have shown as a faint dot.
const SMALL_TEXELS: f64 = 0.5;

/// Returns whether the whole shadow of a caster is small in a map with these axes, in texels per
/// metre.
pub(crate) fn is_small(caster: &Placed, texels_per_m: [DVec3; 2]) -> bool {
    texels_per_m.iter().all(|axis| 2.0 * axis.abs().dot(caster.half) < SMALL_TEXELS)
}

/// Warps the map of a split that has a warp and casters.
fn warp(
    split: &SplitFrame<'_>,
    scene: &Scene,
    (in_view, listed): (&mut InView, &Picked),
    points: &mut WarpPoints,
    map: &mut Split,
) {
    let (frame, warp) = (split.frame, split.warp());
    if warp == Warp::None || listed.is_empty() {
        return;
    }
    let receivers = (frame.config.crop == Crop::SceneDependent).then(|| in_view.receivers.in_order());
    points.receivers_of(&scene.volume.slice, receivers);
    let casters = in_view.casters.ordered(listed.places());
    points.casters_of(&scene.volume.swept, scene.volume.margin, casters);
    points.warp(map, warp, frame.view, frame.margin, frame.config.crop);
}
