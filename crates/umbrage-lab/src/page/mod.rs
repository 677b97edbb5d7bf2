//! Report pages ([`html`]) and the charts on them ([`plot`]).

pub mod html;
pub mod plot;
