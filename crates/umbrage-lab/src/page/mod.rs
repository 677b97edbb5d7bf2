//! Report pages ([`html`]) and the charts on them ([`plot`]).

mod escape;
pub mod html;
pub mod plot;
