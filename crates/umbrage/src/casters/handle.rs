//! Handles of casters. Errors carry them, so this file needs none.

use std::fmt;

/// Names a caster of a [`crate::CasterSet`] until it is removed. A handle of a removed caster never
/// names another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CasterHandle {
    pub(super) index: u32,
    pub(super) generation: u8,
}

impl fmt::Display for CasterHandle {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}v{}", self.index, self.generation)
    }
}
