//! Statistics of a frame: its contents and its cost.

use std::sync::Arc;

use umbrage::ShadowPlan;

use crate::timing::PassCounts;

/// One split of a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitStats {
    /// View depth in metres at which the split begins.
    pub near: f64,
    /// View depth in metres at which the split ends.
    pub far: f64,
    /// Larger edge of one texel in metres; for a warped map, in the middle of its receivers.
    pub texel_m: f64,
    /// True if the map is warped.
    pub warped: bool,
    /// Number of casters in the split's list: mesh nodes or instances, not primitives.
    pub casters: usize,
    /// Milliseconds on the GPU of the passes that draw the map, which may draw others with it;
    /// `None` without timestamp queries.
    pub gpu_ms: Option<f64>,
    /// Number of draw calls that draw into the map. Instances share a draw call, and so may splits.
    pub draws: u32,
    /// Number of triangles of the casters. If the split has a pass of its own, only drawn triangles
    /// count: parts of large meshes that do not reach the map are left out.
    pub triangles: u64,
    /// Bytes of the map.
    pub bytes: u64,
}

/// Statistics of one light beside the first.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LightStats {
    /// Plan of the light's maps.
    pub plan: Arc<ShadowPlan>,
    /// Splits, nearest first. A point light has those of its first face, then those of the next.
    pub splits: Vec<SplitStats>,
}

/// Contents and cost of a frame.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FrameStats {
    /// Plan of the first light's maps.
    pub plan: Arc<ShadowPlan>,
    /// Milliseconds on the CPU of `umbrage_wgpu::Shadows::prepare`: planning, listing casters, and
    /// uploading both.
    pub plan_ms: f64,
    /// Milliseconds from the beginning of the first map to the end of the last, on the GPU; 0 if
    /// none was drawn.
    pub shadow_ms: f64,
    /// Milliseconds from the beginning of the first pass to the end of the last, on the GPU.
    pub frame_ms: f64,
    /// Splits of the first light, nearest first. A point light has those of its first face, then
    /// those of the next.
    pub splits: Vec<SplitStats>,
    /// Number of draw calls into all maps.
    pub shadow_draws: u32,
    /// Number of triangles submitted to all maps, counting every instance. Multiview draws each of
    /// them into several maps.
    pub shadow_triangles: u64,
    /// Statistics of the other lights.
    pub more_lights: Vec<LightStats>,
    /// Number of objects that the view may show.
    pub objects_in_view: usize,
    /// Number of draw calls of picture and mask together.
    pub view_draws: u32,
    /// Number of triangles of picture and mask together.
    pub view_triangles: u64,
    /// Pipeline statistics of the maps' passes; `None` where the device does not count.
    pub shadow_counts: Option<PassCounts>,
    /// Pipeline statistics of picture and mask; `None` where the device does not count.
    pub view_counts: Option<PassCounts>,
    /// Bytes of all shadow maps.
    pub bytes: u64,
    /// Name of the way in which the maps are drawn.
    pub generation: &'static str,
    /// Name of the way in which the maps are stored.
    pub storage: &'static str,
    /// Fallbacks in use.
    pub notes: Vec<String>,
}
