//! umbrage's demonstration renderer: an example of an application around `umbrage-wgpu`, which the
//! command and the viewer draw with. It has forward shading and a few lights, and needs no window.
//!
//! [`Gpu`] opens a device, [`Renderer`] uploads a [`umbrage_scene::Scene`] once and then draws
//! [`Frame`]s of it: pictures, visibility masks, depth maps and answers at given points, with
//! [`FrameStats`] beside them.

mod attachments;
mod capture;
mod casters;
mod coarser;
mod contact;
mod cull;
mod cut;
mod draw_list;
mod edge_counts;
mod error;
#[cfg(not(target_arch = "wasm32"))]
mod fade;
mod formats;
mod forward;
mod geometry;
mod gpu;
mod lamps;
mod layouts;
mod maps;
mod materials;
mod mipmaps;
mod named;
mod names;
mod probe;
mod renderer;
mod shaders;
mod shadow_mesh;
mod stats;
mod surfaces;
mod targets;
mod through_mask;
mod timing;
mod view_list;
mod waiting;

pub use edge_counts::{EdgeCause, EdgeCount, EdgeCounts, EdgeSums};
pub use error::{Error, Result};
pub use forward::Samples;
pub use gpu::{Gpu, GpuOptions, device_descriptor};
pub use lamps::{Lamp, MOST_LAMPS};
pub use probe::{ProbeAnswer, ProbePoint};
pub use renderer::{Frame, KeptMaps, Outputs, RenderSettings, Rendered, Renderer};
pub use stats::{FrameStats, LightStats, SplitStats};
pub use timing::PassCounts;
pub use umbrage_wgpu::LightMaps;
