//! What a frame's plan is made from.

use glam::DVec3;

use super::options::check_image_size;
use crate::bounds::Placed;
use crate::casters::{BoxTree, Counter, Crowd, Role};
use crate::{Aabb, CasterSet, Error, Layers, Light, Result, View};

/// The boxes of a plan's casters or receivers: a list of them, which is read again in every
/// frame, or a set that keeps them.
///
/// Slices, arrays, vectors and sets turn into it by themselves.
#[derive(Clone, Copy, Debug)]
pub enum Boxes<'a> {
    /// World boxes. Plans call casters by their places in this list.
    List(&'a [Aabb]),
    /// Those of a set that share a layer with [`PlanInputs::layers`]. Plans call casters by their
    /// keys.
    Set(&'a CasterSet),
}

impl<'a> From<&'a [Aabb]> for Boxes<'a> {
    fn from(list: &'a [Aabb]) -> Self {
        Self::List(list)
    }
}

impl<'a, const N: usize> From<&'a [Aabb; N]> for Boxes<'a> {
    fn from(list: &'a [Aabb; N]) -> Self {
        Self::List(list)
    }
}

impl<'a> From<&'a Vec<Aabb>> for Boxes<'a> {
    fn from(list: &'a Vec<Aabb>) -> Self {
        Self::List(list)
    }
}

impl<'a> From<&'a CasterSet> for Boxes<'a> {
    fn from(set: &'a CasterSet) -> Self {
        Self::Set(set)
    }
}

impl<'a> Boxes<'a> {
    /// How many entries a list has; 0 for a set, which names its casters by keys.
    pub(super) fn listed(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Set(_) => 0,
        }
    }

    /// Whether both are one and the same list.
    pub(super) fn is_same_list(&self, other: &Self) -> bool {
        matches!((self, other), (Self::List(one), Self::List(other)) if std::ptr::eq(*one, *other))
    }

    /// Checks a list and copies it into a tree.
    pub(super) fn place(&self, name: &'static str, tree: &mut BoxTree) -> Result<()> {
        if let Self::List(list) = self {
            check_boxes(list, name)?;
            tree.fill(list.iter().map(|&bounds| Placed::from(bounds)));
        }
        Ok(())
    }

    /// As the planner reads them.
    pub(super) fn crowd<'b>(
        &self,
        tree: &'b BoxTree,
        asks: (Layers, Role),
        eye: DVec3,
        counter: &'b Counter,
    ) -> Crowd<'b>
    where
        'a: 'b,
    {
        match self {
            Self::List(_) => Crowd::of_list(tree, eye, counter),
            Self::Set(set) => Crowd::of_set(set, asks, eye, counter),
        }
    }
}

/// The inputs of the planner for one frame.
///
/// ```
/// # use umbrage::{Aabb, DirectionalLight, Frustum, PlanInputs, View};
/// # use umbrage::glam::DVec3;
/// # let view = View::look_at_upright(DVec3::Y, DVec3::X, Frustum::perspective(1.0, 1.5, 0.1, 100.0)?)?;
/// # let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
/// # let boxes = [Aabb::new(DVec3::ZERO, DVec3::ONE)];
/// let inputs = PlanInputs { image_size: [1280, 720], ..PlanInputs::new(&view, sun, &boxes, &boxes) };
/// # Ok::<(), umbrage::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PlanInputs<'a> {
    /// The camera.
    pub view: &'a View,
    /// The light.
    pub light: Light,
    /// World boxes of what casts shadows, as a list or a set. A plan's caster indices refer to
    /// this list, or are the set's keys.
    pub casters: Boxes<'a>,
    /// World boxes of what shows shadows, as a list or a set; most objects are in both. Casters
    /// serve as receivers where there is none here, or none in view.
    pub receivers: Boxes<'a>,
    /// Which casters and receivers of sets take part: those that are on one of these layers. All of
    /// a list do.
    pub layers: Layers,
    /// World boxes that hold all that is drawn of the receivers in view and leave less air than the
    /// receivers' own: [`crate::ShadowPlan::casts_into`] then rejects parts of casters that have
    /// none of them behind. `None`: not known. For [`crate::config::Crop::SceneDependent`].
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// World boxes that hold all that an earlier picture showed, from its depth. Planes are then
    /// placed, and all maps but the last fitted, for what was seen instead of for all receivers in
    /// view; the last map serves whatever has come into view since. `None`: not known. For
    /// [`crate::config::FitTo::Depth`]; ignored otherwise.
    pub seen: Option<&'a [Aabb]>,
    /// Pixels across the picture: a split is widened by one 2×2 pixel quad at its near side.
    pub image_size: [u32; 2],
}

impl<'a> PlanInputs<'a> {
    /// Inputs for a picture of 1920 × 1080 pixels, without receiver clusters, of all layers.
    #[must_use]
    pub fn new(
        view: &'a View,
        light: impl Into<Light>,
        casters: impl Into<Boxes<'a>>,
        receivers: impl Into<Boxes<'a>>,
    ) -> Self {
        Self {
            view,
            light: light.into(),
            casters: casters.into(),
            receivers: receivers.into(),
            layers: Layers::ALL,
            receiver_clusters: None,
            seen: None,
            image_size: [1920, 1080],
        }
    }

    /// Checks what can be wrong with lists and sizes.
    pub(super) fn check(&self) -> Result<()> {
        check_image_size(self.image_size)?;
        check_boxes(self.seen.unwrap_or_default(), "seen")?;
        check_boxes(self.receiver_clusters.unwrap_or_default(), "receiver_clusters")
    }
}

fn check_boxes(boxes: &[Aabb], list: &'static str) -> Result<()> {
    match boxes.iter().enumerate().find(|(_, bounds)| !bounds.is_accepted()) {
        Some((index, bounds)) => Err(Error::InvalidBounds { list, index, min: bounds.min, max: bounds.max }),
        None => Ok(()),
    }
}
