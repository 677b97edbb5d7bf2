//! Placement of the planes between splits.

pub(crate) mod cells;
pub(crate) mod metric;
pub(crate) mod optimal;
pub(crate) mod scheme;
pub(crate) mod visible;
