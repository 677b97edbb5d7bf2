//! What a frame was made of and what it cost.

use std::sync::Arc;

use umbrage::ShadowPlan;

use crate::timing::PassCounts;

/// One split of a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitStats {
    /// View depth in metres where it begins.
    pub near: f64,
    /// View depth in metres where it ends.
    pub far: f64,
    /// The larger edge of one texel in metres; in a warped map in the middle of its receivers.
    pub texel_m: f64,
    /// Whether its map is warped.
    pub warped: bool,
    /// Objects in its list: mesh nodes or instances, not primitives.
    pub casters: usize,
    /// Milliseconds on the GPU of the passes that draw its map, which may draw others with it;
    /// `None` without timestamp queries.
    pub gpu_ms: Option<f64>,
    /// Draw calls that draw into its map; instances share one, and so may splits.
    pub draws: u32,
    /// Triangles of its casters. In a pass of its own those that are drawn: parts of large meshes
    /// that do not reach it are not.
    pub triangles: u64,
    /// Bytes of its map.
    pub bytes: u64,
}

/// One light of a frame beside the first.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LightStats {
    /// The plan that its maps were drawn by.
    pub plan: Arc<ShadowPlan>,
    /// Nearest first; of a point light those of its first face, then those of the next.
    pub splits: Vec<SplitStats>,
}

/// What a frame was made of and what it cost.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FrameStats {
    /// The plan that the first light's maps were drawn by.
    pub plan: Arc<ShadowPlan>,
    /// Milliseconds on the CPU of `umbrage_wgpu::Shadows::prepare`: planning, listing casters,
    /// handing both to the GPU.
    pub plan_ms: f64,
    /// Milliseconds from the beginning of the first map to the end of the last, on the GPU; 0 if
    /// none was drawn.
    pub shadow_ms: f64,
    /// Milliseconds from the beginning of the first pass to the end of the last, on the GPU.
    pub frame_ms: f64,
    /// Of the first light, nearest first; of a point light those of its first face, then those of
    /// the next.
    pub splits: Vec<SplitStats>,
    /// Draw calls into all maps.
    pub shadow_draws: u32,
    /// Triangles submitted to all maps, counting every instance; multiview draws each of them into
    /// several.
    pub shadow_triangles: u64,
    /// The other lights.
    pub more_lights: Vec<LightStats>,
    /// Objects that the view may show.
    pub objects_in_view: usize,
    /// Draw calls of picture and mask together.
    pub view_draws: u32,
    /// Triangles of picture and mask together.
    pub view_triangles: u64,
    /// What drawing the maps took; `None` where the device does not count.
    pub shadow_counts: Option<PassCounts>,
    /// What drawing picture and mask took; `None` where the device does not count.
    pub view_counts: Option<PassCounts>,
    /// Bytes of all shadow maps.
    pub bytes: u64,
    /// How the maps are drawn.
    pub generation: &'static str,
    /// How the maps are stored.
    pub storage: &'static str,
    /// Fallbacks taken.
    pub notes: Vec<String>,
}
