//! Tests of the rays through the public doors, on scenes made by hand.

mod brute_force;
mod closed_forms;
mod precision;
pub(crate) mod scenes;
mod soft;
mod surfaces;
