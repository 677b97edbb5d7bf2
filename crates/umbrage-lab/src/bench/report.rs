//! The figures, as they go into JSON.

use serde::Serialize;

use super::summary::Summary;

/// Everything that was measured.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The device.
    pub adapter: String,
    /// Pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: String,
    /// Rounds that count.
    pub rounds: u32,
    /// Settings of all techniques that do not say otherwise.
    pub with: String,
    /// One per scene.
    pub scenes: Vec<SceneReport>,
    /// GPU Gems' Figure 10-9: one per number of objects.
    pub crowds: Vec<CrowdReport>,
}

/// One scene's table.
#[derive(Debug, Serialize)]
pub struct SceneReport {
    /// Its name or file.
    pub scene: String,
    /// The camera.
    pub camera: String,
    /// Triangles in the scene, instances counted.
    pub triangles: usize,
    /// One per technique; the first is the baseline.
    pub rows: Vec<Row>,
    /// One per pair of generation and storage; the first is the baseline.
    pub paths: Vec<Row>,
}

/// A number of objects.
#[derive(Debug, Serialize)]
pub struct CrowdReport {
    /// How many.
    pub objects: u32,
    /// One per path.
    pub rows: Vec<Row>,
}

/// One technique on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// As it is called.
    pub technique: String,
    /// As it is typed.
    pub spec: String,
    /// How many maps.
    pub splits: usize,
    /// How they are drawn.
    pub generation: String,
    /// How they are stored.
    pub storage: String,
    /// The planner, microseconds on the CPU.
    pub plan_us: Option<Summary>,
    /// All maps, GPU timestamps.
    pub shadow_ms: Option<Summary>,
    /// The whole frame, GPU timestamps.
    pub frame_ms: Option<Summary>,
    /// The whole frame with everything the CPU does, wall clock.
    pub wall_ms: Option<Summary>,
    /// The frame by shaders without shadows, GPU timestamps.
    pub frame_without_ms: Option<Summary>,
    /// The frame by shaders without shadows, wall clock.
    pub wall_without_ms: Option<Summary>,
    /// CPU time of all threads for the whole frame.
    pub cpu_ms: Option<Summary>,
    /// CPU time of all threads for the frame by shaders without shadows.
    pub cpu_without_ms: Option<Summary>,
    /// From an open device and a loaded scene to the first picture, wall clock, milliseconds.
    pub first_picture_ms: f64,
    /// CPU time of all threads until the first picture, milliseconds.
    pub first_picture_cpu_ms: f64,
    /// Frame with shadows minus the frame by shaders without.
    pub cost_ms: Option<Summary>,
    /// Frame over the baseline's frame of the same round.
    pub frame_ratio: Option<Summary>,
    /// Maps over the baseline's maps of the same round.
    pub shadow_ratio: Option<Summary>,
    /// Frame over frame in the paper's Table 1.
    pub paper_ratio: Option<f64>,
    /// What a fragment of the picture reads of a map: texels, or filtered samples of filters that
    /// blur first.
    pub samples: u32,
    /// Caster-split pairs.
    pub pairs: u64,
    /// Draws into the maps.
    pub draws: u64,
    /// Triangles sent into the maps.
    pub triangles: u64,
    /// Bytes of the maps.
    pub map_bytes: u64,
    /// What exact edges did for a picture; none where edges are sampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<crate::edges::EdgesReport>,
    /// Pipeline statistics of the maps.
    pub shadow_counts: Option<Counts>,
    /// Pipeline statistics of the picture.
    pub view_counts: Option<Counts>,
}

/// Pipeline statistics.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// Runs of the vertex shader.
    pub vertices: u64,
    /// Triangles after clipping.
    pub primitives: u64,
    /// Runs of the fragment shader.
    pub fragments: u64,
}
