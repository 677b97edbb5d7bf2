//! Set of the scene's objects as casters, for kept maps and for thousands of objects.

use glam::DAffine3;
use umbrage::config::Cache;
use umbrage::{Caster, CasterHandle, CasterSet, Motion};
use umbrage_scene::{Object, Pose};

use super::{Frame, Renderer};
use crate::Result;

/// Number of objects above which a scene is held as a set, even if its maps are not kept.
const MANY: usize = 4096;

/// Options of drawing maps that are kept between frames ([`Cache::Kept`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptMaps {
    /// Most texels that may be drawn in a frame: see [`umbrage_wgpu::Inputs::kept_texels`].
    pub texels: Option<u64>,
    /// True if all is drawn anew: see [`umbrage_wgpu::Inputs::redraws_kept`].
    pub redraws: bool,
}

/// The objects of a pose, kept from frame to frame. Keys are indices into the pose.
#[derive(Default)]
pub(super) struct WorldSet {
    pub set: CasterSet,
    members: Vec<Member>,
}

impl Renderer {
    /// Sets the options of drawing kept maps.
    pub fn set_kept(&mut self, kept: KeptMaps) {
        self.kept = kept;
    }

    /// Returns whether maps are kept. Casters are then those of a set, and plans name them by their
    /// indices in the pose.
    pub(super) fn keeps_maps(&self) -> bool {
        self.shadows.config().cache == Cache::Kept
    }

    /// Returns whether the objects of a pose are casters of a set, which plans name by their
    /// indices.
    pub(super) fn uses_set(&self, pose: &Pose) -> bool {
        self.keeps_maps() || is_many(pose)
    }

    /// Returns whether a plan may name an object as a caster.
    pub(super) fn is_listed(&self, pose: &Pose, object: &Object) -> bool {
        self.uses_set(pose) || self.casts(object)
    }

    /// Returns the result of a frame. If the frame failed, kept maps are forgotten, because it is
    /// unknown which were drawn.
    pub(super) fn or_forget<T>(&mut self, drawn: Result<T>) -> Result<T> {
        if drawn.is_err() {
            self.shadows.forget_kept();
        }
        drawn
    }

    /// Updates the set to a frame's pose, if there is a set.
    ///
    /// # Errors
    /// [`crate::Error::Plan`] for invalid boxes.
    pub(super) fn follow(&mut self, frame: &Frame<'_>) -> Result<()> {
        if !self.uses_set(frame.pose) {
            return Ok(());
        }
        let mut world = std::mem::take(&mut self.world);
        let followed = world.follow(frame.pose, frame.moved, |object| self.casts(object));
        self.world = world;
        followed
    }

    /// Returns the objects that may differ from those of the last frame.
    pub(super) fn new_objects<'f>(&self, frame: &Frame<'f>) -> Changed<'f> {
        let is_followed = self.uses_set(frame.pose) && self.world.members.len() == frame.pose.objects.len();
        match frame.moved {
            Some(moved) if is_followed => Changed::These(moved),
            _ => Changed::Any(frame.pose.objects.len()),
        }
    }
}

/// Returns whether a pose has too many objects to list them in every frame.
pub(super) fn is_many(pose: &Pose) -> bool {
    pose.objects.len() > MANY
}

/// Objects that may differ from those of the last frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum Changed<'a> {
    /// Any of so many objects.
    Any(usize),
    /// The objects with these indices.
    These(&'a [u32]),
}

impl Changed<'_> {
    /// Iterates over the indices of the objects.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        let (all, these) = match *self {
            Self::Any(count) => (0..count, &[][..]),
            Self::These(these) => (0..0, these),
        };
        all.chain(these.iter().map(|&object| object as usize))
    }
}

/// State of an object in the set.
struct Member {
    handle: CasterHandle,
    caster: Caster,
    mesh: u32,
    /// Hash of the object's transform, by [`digest`].
    placed: u64,
}

impl WorldSet {
    /// Updates the set to a pose. `casts` returns whether an object is drawn into maps. Skinned
    /// objects count as moving, others as static, and the set is notified when a static one is
    /// moved. Only `moved` objects are examined, if given.
    pub fn follow(&mut self, pose: &Pose, moved: Option<&[u32]>, casts: impl Fn(&Object) -> bool) -> Result<()> {
        let caster = |(key, object): (usize, &Object)| {
            let motion = if object.skinned.is_some() { Motion::Moving } else { Motion::Static };
            Caster { motion, casts: casts(object), ..Caster::new(object.bounds, key as u32) }
        };
        if self.members.len() != pose.objects.len() {
            let casters: Vec<Caster> = pose.objects.iter().enumerate().map(caster).collect();
            self.set.clear();
            self.members.clear();
            let handles = self.set.insert_all(casters.iter().copied())?;
            let members = handles.into_iter().zip(casters).zip(&pose.objects);
            self.members.extend(members.map(|((handle, caster), object)| Member::new(handle, caster, object)));
            return Ok(());
        }
        let changed = moved.map_or(Changed::Any(pose.objects.len()), Changed::These);
        for key in changed.iter() {
            let (Some(member), Some(object)) = (self.members.get_mut(key), pose.objects.get(key)) else { continue };
            let caster = caster((key, object));
            let is_moved = member.placed != digest(&object.world_from_local);
            let (is_same_box, is_other) = (member.caster.bounds == caster.bounds, member.mesh != object.mesh as u32);
            if is_other || member.caster != (Caster { bounds: member.caster.bounds, ..caster }) {
                self.set.replace(member.handle, caster)?;
            } else if !is_same_box {
                self.set.set_bounds(member.handle, caster.bounds)?;
            } else if is_moved {
                self.set.reshape(member.handle)?;
            }
            *member = Member::new(member.handle, caster, object);
        }
        Ok(())
    }
}

impl Member {
    fn new(handle: CasterHandle, caster: Caster, object: &Object) -> Self {
        Self { handle, caster, mesh: object.mesh as u32, placed: digest(&object.world_from_local) }
    }
}

/// Hashes a transform to 64 bits, to detect changes (FNV-1a over its numbers).
fn digest(transform: &DAffine3) -> u64 {
    let fold = |hash: u64, part: f64| (hash ^ part.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
    transform.to_cols_array().into_iter().fold(0xcbf2_9ce4_8422_2325, fold)
}
