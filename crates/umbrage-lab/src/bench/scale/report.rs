//! The figures over the number of objects, as they go into JSON.

use serde::Serialize;

use super::job::Case;
use crate::bench::summary::Summary;

/// Everything that was measured.
#[derive(Debug, Serialize)]
pub struct ScaleReport {
    /// The device.
    pub adapter: String,
    /// Pixels.
    pub size: [u32; 2],
    /// Frames that count, of each case.
    pub rounds: u32,
    /// How shadows were made.
    pub technique: String,
    /// One per number of objects.
    pub sizes: Vec<SizeReport>,
}

/// A number of objects.
#[derive(Debug, Serialize)]
pub struct SizeReport {
    /// Trees that were asked for.
    pub trees: u32,
    /// All objects, with the ground's.
    pub objects: usize,
    /// From the name of the world to its pose, milliseconds.
    pub open_ms: f64,
    /// One per case.
    pub cases: Vec<CaseReport>,
    /// What culling them on the GPU takes, for a camera that walks; none without compute shaders.
    pub by_gpu: Option<GpuReport>,
}

/// Culling on the GPU at a number of objects.
#[derive(Clone, Debug, Serialize)]
pub struct GpuReport {
    /// The planner, which knows of the ground's tiles, and the tests' upload, microseconds on the
    /// CPU.
    pub plan_us: Option<Summary>,
    /// The compute pass, from its submission until the device is idle, milliseconds.
    pub cull_ms: Option<Summary>,
    /// Pairs of instances and splits that passed.
    pub pairs: u64,
    /// Triangles of the draws.
    pub triangles: u64,
    /// Bytes of boxes, lists and arguments.
    pub bytes: u64,
}

/// A case at a number of objects.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// What happens from frame to frame.
    pub case: Case,
    /// The planner and the books of kept maps, microseconds on the CPU.
    pub plan_us: Option<Summary>,
    /// Pairs of casters and splits in the plan's lists.
    pub pairs: Option<Summary>,
    /// Triangles drawn into maps and what is kept of them.
    pub triangles: Option<Summary>,
    /// Triangles of the first frame, in which all maps are drawn.
    pub first_triangles: u64,
    /// All maps, GPU timestamps.
    pub shadow_ms: Option<Summary>,
    /// The whole frame, GPU timestamps.
    pub frame_ms: Option<Summary>,
    /// The frame by shaders without shadows, GPU timestamps.
    pub frame_without_ms: Option<Summary>,
}
