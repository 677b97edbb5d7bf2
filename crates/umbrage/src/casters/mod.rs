//! A kept set of casters, which a planner is given instead of lists where there are many.

mod curve;
mod journal;
mod kind;
mod loose;
mod packed;
mod set;
mod slots;
pub(crate) mod tree;
mod view;

pub(crate) use journal::Change;
pub use kind::Layers;
pub(crate) use kind::Role;
pub use set::{Caster, CasterSet, Motion};
pub use slots::CasterHandle;
pub use tree::Visited;
pub(crate) use tree::{BoxTree, Counter, Near};
pub(crate) use view::{Crowd, Gathered, Group, Most};
