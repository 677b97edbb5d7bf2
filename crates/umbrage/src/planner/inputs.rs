//! Inputs of a frame's plan.

use glam::DVec3;

use super::options::check_image_size;
use crate::casters::{Counter, Crowd, OrderedList, Role};
use crate::{Aabb, CasterSet, Error, Layers, Light, Result, View};

/// The boxes of a plan's casters or receivers: a list, which is read again in every frame, or a set
/// that keeps them.
///
/// Slices, arrays, vectors and sets convert to it.
#[derive(Clone, Copy, Debug)]
pub enum Boxes<'a> {
    /// World boxes. Plans name casters by their index in this list.
    List(&'a [Aabb]),
    /// The boxes of a set that share a layer with [`PlanInputs::layers`]. Plans name casters by
    /// their keys.
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
    /// Number of entries of a list; 0 for a set, which names its casters by keys.
    pub(super) fn listed(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Set(_) => 0,
        }
    }

    /// Returns whether both are the same list in memory.
    pub(super) fn is_same_list(&self, other: &Self) -> bool {
        matches!((self, other), (Self::List(one), Self::List(other)) if std::ptr::eq(*one, *other))
    }

    /// Checks a list and copies it into a tree.
    pub(super) fn place(&self, name: &'static str, tree: &mut OrderedList) -> Result<()> {
        if let Self::List(list) = self {
            check_boxes(list, name)?;
            tree.fill(list);
        }
        Ok(())
    }

    /// The boxes in the form that the planner reads.
    pub(super) fn crowd<'b>(
        &self,
        tree: &'b OrderedList,
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
    /// World boxes of the casters, as a list or a set. A plan's caster indices refer to this list,
    /// or are the set's keys.
    pub casters: Boxes<'a>,
    /// World boxes of the receivers, as a list or a set; most objects are both. If there is no
    /// receiver, or none in view, the casters serve as receivers.
    pub receivers: Boxes<'a>,
    /// Layers of the casters and receivers that take part, for sets. All boxes of a list take part.
    pub layers: Layers,
    /// World boxes that enclose all visible parts of the receivers more tightly than the receivers'
    /// own boxes. [`crate::ShadowPlan::casts_into`] then also rejects parts of casters that have
    /// none of these boxes behind them. `None` if not known. For
    /// [`crate::config::Crop::SceneDependent`].
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// World boxes that enclose everything that an earlier image showed, from its depth. Planes are
    /// then placed, and all maps but the last fitted, for the geometry that was seen instead of for
    /// all receivers in view; the last map serves the geometry that has come into view since.
    /// `None` if not known. For [`crate::config::FitTo::Depth`]; ignored otherwise.
    pub seen: Option<&'a [Aabb]>,
    /// Size of the image in pixels: a split is widened by one 2×2 pixel quad at its near side.
    pub image_size: [u32; 2],
}

impl<'a> PlanInputs<'a> {
    /// Inputs for an image of 1920 × 1080 pixels, without receiver clusters, with all layers.
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

    /// Checks the lists that are not read by the planner's stages, and the image size.
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
