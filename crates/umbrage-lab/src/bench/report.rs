//! Results of a benchmark, as they are written to JSON.

use serde::Serialize;

use super::summary::Summary;

/// All results.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Name of the device.
    pub adapter: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel of the picture.
    pub samples: String,
    /// Number of rounds that count.
    pub rounds: u32,
    /// Settings of all techniques that do not override them.
    pub with: String,
    /// Results of each scene.
    pub scenes: Vec<SceneReport>,
    /// Results of each number of objects, for GPU Gems' Figure 10-9.
    pub crowds: Vec<CrowdReport>,
}

/// Results of one scene.
#[derive(Debug, Serialize)]
pub struct SceneReport {
    /// Name or file of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Number of triangles in the scene, counting instances.
    pub triangles: usize,
    /// Results of each technique; the first is the baseline.
    pub rows: Vec<Row>,
    /// Results of each pair of generation and storage; the first is the baseline.
    pub paths: Vec<Row>,
}

/// Results of one number of objects.
#[derive(Debug, Serialize)]
pub struct CrowdReport {
    /// Number of objects.
    pub objects: u32,
    /// Results of each path.
    pub rows: Vec<Row>,
}

/// Results of one technique on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Label of the technique.
    pub technique: String,
    /// Technique as it is typed.
    pub spec: String,
    /// Number of maps.
    pub splits: usize,
    /// Name of the way in which the maps are drawn.
    pub generation: String,
    /// Name of the way in which the maps are stored.
    pub storage: String,
    /// Time of the planner on the CPU, in microseconds.
    pub plan_us: Option<Summary>,
    /// Time of all maps in milliseconds, by GPU timestamps.
    pub shadow_ms: Option<Summary>,
    /// Time of the whole frame in milliseconds, by GPU timestamps.
    pub frame_ms: Option<Summary>,
    /// Time of the whole frame in milliseconds of wall-clock time, with all work of the CPU.
    pub wall_ms: Option<Summary>,
    /// Time in milliseconds of the frame by shaders without shadows, by GPU timestamps.
    pub frame_without_ms: Option<Summary>,
    /// Time in milliseconds of the frame by shaders without shadows, by the wall clock.
    pub wall_without_ms: Option<Summary>,
    /// CPU time of all threads for the whole frame, in milliseconds.
    pub cpu_ms: Option<Summary>,
    /// CPU time of all threads for the frame by shaders without shadows, in milliseconds.
    pub cpu_without_ms: Option<Summary>,
    /// Wall-clock time in milliseconds from an open device and a loaded scene to the first picture.
    pub first_picture_ms: f64,
    /// CPU time of all threads until the first picture, in milliseconds.
    pub first_picture_cpu_ms: f64,
    /// Time of the frame with shadows minus that by shaders without, in milliseconds.
    pub cost_ms: Option<Summary>,
    /// Time of the frame over the baseline's frame of the same round.
    pub frame_ratio: Option<Summary>,
    /// Time of the maps over the baseline's maps of the same round.
    pub shadow_ratio: Option<Summary>,
    /// Ratio of frame times in the paper's Table 1.
    pub paper_ratio: Option<f64>,
    /// Number of map reads per fragment of the picture: texels, or filtered samples of filters that
    /// blur first.
    pub samples: u32,
    /// Number of caster-split pairs.
    pub pairs: u64,
    /// Number of draw calls into the maps.
    pub draws: u64,
    /// Number of triangles submitted to the maps.
    pub triangles: u64,
    /// Bytes of the maps.
    pub map_bytes: u64,
    /// Counts of exact edges for a picture; `None` with sampled edges.
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
    /// Number of vertex shader invocations.
    pub vertices: u64,
    /// Number of triangles after clipping.
    pub primitives: u64,
    /// Number of fragment shader invocations.
    pub fragments: u64,
}
