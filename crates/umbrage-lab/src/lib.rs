//! umbrage's laboratory: judging shadows, drawing them side by side, measuring their cost and
//! showing the theory behind them.
//!
//! * [`technique`]: techniques of shadows as options, as settings and by name;
//! * [`scene_request`] and [`scene_setup`]: scene, camera and light as requested, and as opened;
//! * [`session`]: a device with the scene on it;
//! * [`compare`] scores techniques by rays, [`tune`] searches the best config for a budget,
//!   [`mod@bench`] measures costs, [`theory`] draws the papers' theory, [`gallery`] draws pictures
//!   with the defaults;
//! * [`page`]: report pages and their charts;
//! * [`output`] makes files appear whole or not at all, [`failure`] sorts errors by fault.
//!
//! Without the feature `judge`, which is on by default, only requests, scenes, views and lights are
//! compiled.
//!
//! Messages name the options of the command `umbrage`, because a user of the laboratory types them.

#[cfg(feature = "judge")]
pub mod bench;
pub mod choose;
#[cfg(feature = "judge")]
pub mod compare;
pub mod edges;
pub mod failure;
pub mod gallery;
#[cfg(feature = "judge")]
pub mod journal;
pub mod lights;
pub mod notes;
pub mod open;
#[cfg(feature = "judge")]
pub mod output;
#[cfg(feature = "judge")]
pub mod page;
pub mod parse;
pub mod picture;
#[cfg(feature = "judge")]
pub mod progress;
pub mod reach;
pub mod report;
pub mod scene_request;
pub mod scene_setup;
#[cfg(feature = "judge")]
pub mod session;
#[cfg(feature = "judge")]
pub mod split_views;
#[cfg(feature = "judge")]
pub mod sun_disc;
#[cfg(feature = "judge")]
pub mod technique;
#[cfg(feature = "judge")]
pub mod theory;
#[cfg(feature = "judge")]
pub mod tune;
