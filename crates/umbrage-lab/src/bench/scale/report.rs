//! Results over the number of objects, as they are written to JSON.

use serde::Serialize;

use super::job::Case;
use crate::bench::summary::Summary;

/// All results.
#[derive(Debug, Serialize)]
pub struct ScaleReport {
    /// Name of the device.
    pub adapter: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of measured frames of each case.
    pub rounds: u32,
    /// Technique of the shadows.
    pub technique: String,
    /// Results of each number of objects.
    pub sizes: Vec<SizeReport>,
}

/// Results of one number of objects.
#[derive(Debug, Serialize)]
pub struct SizeReport {
    /// Number of trees that were asked for.
    pub trees: u32,
    /// Number of all objects, with those of the ground.
    pub objects: usize,
    /// Milliseconds from the name of the world to its pose.
    pub open_ms: f64,
    /// Results of each case.
    pub cases: Vec<CaseReport>,
    /// Results of culling on the GPU, for a camera that walks; `None` without compute shaders.
    pub by_gpu: Option<GpuReport>,
}

/// Results of culling on the GPU at one number of objects.
#[derive(Clone, Debug, Serialize)]
pub struct GpuReport {
    /// Time in microseconds on the CPU of the planner, which is given the ground's tiles, and of
    /// the upload of the tests.
    pub plan_us: Option<Summary>,
    /// Milliseconds of the compute pass, from its submission until the device is idle.
    pub cull_ms: Option<Summary>,
    /// Number of pairs of instances and splits that passed.
    pub pairs: u64,
    /// Number of triangles of the draws.
    pub triangles: u64,
    /// Bytes of boxes, lists and arguments.
    pub bytes: u64,
}

/// Results of one case at one number of objects.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// Case that was measured.
    pub case: Case,
    /// Time in microseconds on the CPU of the planner and of the bookkeeping of kept maps.
    pub plan_us: Option<Summary>,
    /// Number of pairs of casters and splits in the plan's lists.
    pub pairs: Option<Summary>,
    /// Number of triangles drawn into maps, and into their kept parts.
    pub triangles: Option<Summary>,
    /// Number of triangles of the first frame, in which all maps are drawn.
    pub first_triangles: u64,
    /// Time of all maps in milliseconds, by GPU timestamps.
    pub shadow_ms: Option<Summary>,
    /// Time of the whole frame in milliseconds, by GPU timestamps.
    pub frame_ms: Option<Summary>,
    /// Time in milliseconds of the frame by shaders without shadows, by GPU timestamps.
    pub frame_without_ms: Option<Summary>,
}
