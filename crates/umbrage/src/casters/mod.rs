//! A kept set of casters, which a planner is given instead of lists where there are many.

mod curve;
mod gathered;
mod handle;
mod journal;
mod kind;
mod loose;
mod ordered_list;
mod packed;
mod set;
mod slots;
pub(crate) mod tree;
mod view;

pub(crate) use gathered::{Gathered, Group, Most, spread};
pub use handle::CasterHandle;
pub(crate) use journal::Change;
pub use kind::Layers;
pub(crate) use kind::Role;
pub(crate) use ordered_list::OrderedList;
pub use set::{Caster, CasterSet, Motion};
pub use tree::Visited;
pub(crate) use tree::{Counter, Near, WIDE};
pub(crate) use view::Crowd;
