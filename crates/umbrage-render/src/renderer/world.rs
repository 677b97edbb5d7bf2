//! The scene's objects as a set of casters, for maps of which something is kept.

use glam::DAffine3;
use umbrage::config::Cache;
use umbrage::{Caster, CasterHandle, CasterSet, Motion};
use umbrage_scene::{Object, Pose};

use super::Renderer;
use crate::Result;

/// How maps are drawn of which something is kept ([`Cache::Kept`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptMaps {
    /// Texels that may be drawn in a frame: see [`umbrage_wgpu::Inputs::kept_texels`].
    pub texels: Option<u64>,
    /// Whether all is drawn anew: see [`umbrage_wgpu::Inputs::redraws_kept`].
    pub redraws: bool,
}

/// The objects of a pose, kept from frame to frame; keys are their numbers in the pose.
#[derive(Default)]
pub(super) struct WorldSet {
    pub set: CasterSet,
    members: Vec<Member>,
}

impl Renderer {
    /// Chooses how maps are drawn of which something is kept.
    pub fn set_kept(&mut self, kept: KeptMaps) {
        self.kept = kept;
    }

    /// Whether something is kept of maps: casters are then those of a set, and plans name them by
    /// their numbers in the pose.
    pub(super) fn keeps_maps(&self) -> bool {
        self.shadows.config().cache == Cache::Kept
    }

    /// Whether a plan may name an object as a caster.
    pub(super) fn is_listed(&self, object: &umbrage_scene::Object) -> bool {
        self.keeps_maps() || self.casts(object)
    }

    /// What a frame came to. Of one that failed it is not known which maps were drawn.
    pub(super) fn or_forget<T>(&mut self, drawn: Result<T>) -> Result<T> {
        if drawn.is_err() {
            self.shadows.forget_kept();
        }
        drawn
    }

    /// Makes the set follow the pose.
    ///
    /// # Errors
    /// [`crate::Error::Plan`] for boxes that are none.
    pub(super) fn follow(&mut self, pose: &Pose) -> Result<()> {
        let mut world = std::mem::take(&mut self.world);
        let followed = world.follow(pose, |object| self.casts(object));
        self.world = world;
        followed
    }
}

/// An object as the set knows it.
struct Member {
    handle: CasterHandle,
    caster: Caster,
    mesh: usize,
    world_from_local: DAffine3,
}

impl WorldSet {
    /// Follows a pose. `casts` says which objects are drawn into maps. Skinned objects move; others
    /// are static, and the set is told when they are moved all the same.
    pub fn follow(&mut self, pose: &Pose, casts: impl Fn(&Object) -> bool) -> Result<()> {
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
        for (member, (key, object)) in self.members.iter_mut().zip(pose.objects.iter().enumerate()) {
            let caster = caster((key, object));
            let is_moved = member.world_from_local != object.world_from_local;
            let (is_same_box, is_other) = (member.caster.bounds == caster.bounds, member.mesh != object.mesh);
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
        Self { handle, caster, mesh: object.mesh, world_from_local: object.world_from_local }
    }
}
