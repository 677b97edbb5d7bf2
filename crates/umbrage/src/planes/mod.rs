//! Where the planes between splits stand.

pub(crate) mod cells;
pub(crate) mod metric;
pub(crate) mod optimal;
pub(crate) mod scheme;
pub(crate) mod visible;
