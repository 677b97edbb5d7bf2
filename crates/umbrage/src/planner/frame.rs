//! Values that all maps of a frame share.

use glam::DVec3;

use super::inputs::PlanInputs;
use super::options::PlannerOptions;
use crate::bounds::Placed;
use crate::casters::{Crowd, Most};
use crate::config::{FitTo, Stability};
use crate::geometry::region::Fan;
use crate::geometry::volume::{Lies, Slice};
use crate::margin::{EDGE_TEXELS, FilterReach};
use crate::{DirectionalLight, Frustum, ShadowConfig, View};

/// One frame's inputs, checked.
#[derive(Clone, Copy)]
pub(super) struct Frame<'a> {
    pub config: &'a ShadowConfig,
    /// True if casters before the near plane are flattened onto it.
    pub depth_clamp: bool,
    /// Reach of the filter.
    pub reach: FilterReach,
    pub view: &'a View,
    pub image_size: [u32; 2],
    pub casters: Crowd<'a>,
    pub receivers: Crowd<'a>,
    /// Geometry that an earlier image showed, if it is known and maps may be fitted to it.
    pub seen: Option<Crowd<'a>>,
    /// Most texels that a map keeps free around the points that it serves.
    pub margin: f64,
}

impl<'a> Frame<'a> {
    pub fn new(
        (config, options): (&'a ShadowConfig, &PlannerOptions),
        inputs: &PlanInputs<'a>,
        (casters, receivers, seen): (Crowd<'a>, Crowd<'a>, Option<Crowd<'a>>),
    ) -> Self {
        let reach = options.reach(config);
        Self {
            config,
            depth_clamp: options.depth_clamp,
            reach,
            view: inputs.view,
            image_size: inputs.image_size,
            casters,
            receivers,
            seen: seen.filter(|_| config.fit_to == FitTo::Depth),
            margin: reach.radius_texels + EDGE_TEXELS,
        }
    }

    /// Returns whether maps are stabilised, exactly or approximately.
    pub fn stands_still(&self) -> bool {
        self.config.is_stabilised()
    }

    /// Upper bound of a map's margin as a share of its width.
    pub fn margin_share(&self) -> f64 {
        let smallest = self.config.map_sizes.iter().copied().min().unwrap_or(1);
        2.0 * self.margin / f64::from(smallest).max(2.0 * self.margin + 2.0)
    }
}

/// Returns whether a view may show any of some boxes.
pub(super) fn shows_any(view: &View, boxes: &Crowd<'_>) -> bool {
    let Frustum { near, far, .. } = *view.frustum();
    let distance = |placed: &Placed| ((placed.center - view.eye()).abs() + placed.half).length();
    let far = if far.is_finite() { far } else { boxes.most(distance).max(0.0) };
    let whole = Slice::new(view, near, far.max(1.01 * near + 0.01));
    boxes.any(|placed| whole.classify(placed.center, placed.half) != Lies::Outside)
}

/// A sun, and the directions across its light along which bounds are measured.
#[derive(Clone, Copy)]
pub(super) struct Sun<'a> {
    pub light: &'a DirectionalLight,
    pub direction: DVec3,
    pub fan: Fan,
}

/// Sine of the angle between view and light below which the view has no direction of its own across
/// the light.
const LEAST_SINE: f64 = 1e-3;

impl<'a> Sun<'a> {
    /// The sun of a frame. The first direction is that of the view across the light, so that tight
    /// maps turn with the view; approximately stabilised maps need a direction that is fixed to the
    /// light.
    pub fn new(light: &'a DirectionalLight, frame: &Frame<'_>) -> Self {
        let direction = light.direction();
        let forward = frame.view.forward();
        let across = forward - forward.dot(direction) * direction;
        let (map_u, _) = light.map_axes();
        let first = match frame.config.stability {
            Stability::Tight { .. } | Stability::Exact if across.length() > LEAST_SINE => across.normalize(),
            _ => map_u,
        };
        Self { light, direction, fan: Fan::new(first, direction) }
    }
}
