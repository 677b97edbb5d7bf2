//! umbrage's laboratory: judging shadows, drawing them side by side, measuring their cost and
//! showing the theory behind them.
//!
//! * [`technique`]: how shadows are made, as options, as settings and under a name;
//! * [`scene_request`] and [`scene_setup`]: what is looked at, asked for and opened;
//! * [`session`]: a device with the scene on it;
//! * [`compare`] judges techniques by rays, [`tune`] searches the best for a budget, [`mod@bench`]
//!   measures what they cost, [`theory`] draws what the papers derive, [`gallery`] what the
//!   defaults draw;
//! * [`page`]: report pages and their charts;
//! * [`output`] makes files appear whole or not at all, [`failure`] says whose fault it is that
//!   there are none.
//!
//! Without the feature `judge`, which is on by default, there are requests, scenes, views and
//! lights alone.
//!
//! Messages name the options of the command `umbrage`, which is what a user of the laboratory
//! types.

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
