//! Times and workloads of passes, measured by the GPU itself where it can.

use crate::capture::read_buffer;
use crate::{Gpu, Result};

/// Number of passes of a frame beside those of its maps: the depth for contact shadows, the mask,
/// and the picture, which may be ten: its surfaces, for each of four samples the questions and
/// their mask, and itself.
const VIEW_PASSES: u32 = 12;
/// Most passes for each map. Drawn slice by slice, a map's pass is followed by those of the mask
/// and the picture; for translucent surfaces the map and the picture are drawn once more.
const PASSES_OF_A_MAP: u32 = 5;
/// Bytes between the answers of two passes: the alignment of resolved queries.
const STRIDE: u64 = wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT;

const STATISTICS: wgpu::PipelineStatisticsTypes = wgpu::PipelineStatisticsTypes::VERTEX_SHADER_INVOCATIONS
    .union(wgpu::PipelineStatisticsTypes::CLIPPER_PRIMITIVES_OUT)
    .union(wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS);

/// Workload of a pass, in counts that depend little on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PassCounts {
    /// Number of vertex shader invocations.
    pub vertices: u64,
    /// Number of triangles left after clipping.
    pub primitives: u64,
    /// Number of fragment shader invocations. Opaque casters have no fragment shader, but some
    /// drivers count their pixels all the same.
    pub fragments: u64,
}

impl std::ops::AddAssign for PassCounts {
    fn add_assign(&mut self, other: Self) {
        self.vertices += other.vertices;
        self.primitives += other.primitives;
        self.fragments += other.fragments;
    }
}

/// Begin and end of each pass of a frame, and its counts. Passes are in the order in which they are
/// recorded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measured {
    /// Begin and end of each pass, in milliseconds since the first pass began; `None` without
    /// timestamp queries.
    pub spans_ms: Option<Vec<[f64; 2]>>,
    /// Counts of each pass; `None` without pipeline statistics.
    pub counts: Option<Vec<PassCounts>>,
}

/// The queries of one frame. Passes take slots in the order in which they are recorded.
pub(crate) struct Timer {
    timestamps: Option<Queries>,
    statistics: Option<Queries>,
    used: u32,
    slots: Vec<Slot>,
}

struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
}

/// A pass that is being measured.
#[derive(Clone, Copy)]
pub(crate) struct Slot {
    /// Index of the pass in the frame.
    pub pass: u32,
    /// Index of the pass's first query of pipeline statistics.
    query: u32,
}

impl Timer {
    /// Makes the queries for frames of up to `maps` maps.
    pub fn new(gpu: &Gpu, maps: usize) -> Self {
        let most = PASSES_OF_A_MAP * maps as u32 + VIEW_PASSES;
        let has = |feature| gpu.device.features().contains(feature);
        let statistics = wgpu::QueryType::PipelineStatistics(STATISTICS);
        Self {
            timestamps: has(wgpu::Features::TIMESTAMP_QUERY)
                .then(|| Queries::new(gpu, wgpu::QueryType::Timestamp, 2 * most, u64::from(2 * most) * 8)),
            statistics: has(wgpu::Features::PIPELINE_STATISTICS_QUERY)
                .then(|| Queries::new(gpu, statistics, most, u64::from(most) * STRIDE)),
            used: 0,
            slots: Vec::new(),
        }
    }

    /// Returns whether the GPU times passes.
    pub fn has_timestamps(&self) -> bool {
        self.timestamps.is_some()
    }

    /// Clears the measurements of the last frame.
    pub fn restart(&mut self) {
        self.used = 0;
        self.slots.clear();
    }

    /// Takes the slot of the next pass, which draws `views` layers at once.
    pub fn next(&mut self, views: usize) -> Slot {
        // A query in a multiview pass uses as many as there are views.
        let slot = Slot { pass: self.slots.len() as u32, query: self.used };
        self.used += views as u32;
        self.slots.push(slot);
        slot
    }

    /// Returns the timestamp writes for the pass's descriptor.
    pub fn timestamp_writes(&self, slot: Slot) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.timestamps.as_ref().map(|queries| wgpu::RenderPassTimestampWrites {
            query_set: &queries.set,
            beginning_of_pass_write_index: Some(2 * slot.pass),
            end_of_pass_write_index: Some(2 * slot.pass + 1),
        })
    }

    /// Runs `draw` and counts its work.
    pub fn counted<T>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        slot: Slot,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>) -> T,
    ) -> T {
        if let Some(queries) = &self.statistics {
            pass.begin_pipeline_statistics_query(&queries.set, slot.query);
        }
        let result = draw(pass);
        if self.statistics.is_some() {
            pass.end_pipeline_statistics_query();
        }
        result
    }

    /// Records the copy of the answers to a readable buffer, after all passes.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        if self.slots.is_empty() {
            return;
        }
        if let Some(queries) = &self.timestamps {
            queries.record(encoder, std::iter::once(0..2 * self.slots.len() as u32));
        }
        if let Some(queries) = &self.statistics {
            // One by one: of the queries of a multiview pass the first has the sum, and not every
            // driver answers for the others.
            queries.record(encoder, self.slots.iter().map(|slot| slot.query..slot.query + 1));
        }
    }

    /// Waits for the answers.
    pub async fn read(&self, gpu: &Gpu) -> Result<Measured> {
        let passes = self.slots.len();
        if passes == 0 {
            return Ok(Measured::default());
        }
        let ms_per_tick = f64::from(gpu.queue.get_timestamp_period()) * 1e-6;
        let spans_ms = match &self.timestamps {
            None => None,
            Some(queries) => {
                let ticks = queries.read(gpu).await?;
                let start = ticks[0];
                let since_start = |tick: u64| tick.saturating_sub(start) as f64 * ms_per_tick;
                Some(ticks.chunks(2).take(passes).map(|span| [since_start(span[0]), since_start(span[1])]).collect())
            }
        };
        let counts = match &self.statistics {
            None => None,
            Some(queries) => {
                let numbers = queries.read(gpu).await?;
                // In the order of the bits of PipelineStatisticsTypes.
                let count = |n: &[u64]| PassCounts { vertices: n[0], primitives: n[1], fragments: n[2] };
                Some(numbers.chunks(STRIDE as usize / size_of::<u64>()).take(passes).map(count).collect())
            }
        };
        Ok(Measured { spans_ms, counts })
    }
}

impl Queries {
    fn new(gpu: &Gpu, ty: wgpu::QueryType, count: u32, bytes: u64) -> Self {
        let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor { label: Some("Timer::queries"), ty, count });
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            set,
            resolved: buffer("Timer::resolved", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: buffer("Timer::readable", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        }
    }

    /// Resolves ranges of queries, each [`STRIDE`] after the last.
    fn record(&self, encoder: &mut wgpu::CommandEncoder, ranges: impl Iterator<Item = std::ops::Range<u32>>) {
        for (range, offset) in ranges.zip((0..).step_by(STRIDE as usize)) {
            encoder.resolve_query_set(&self.set, range, &self.resolved, offset);
        }
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, self.readable.size());
    }

    async fn read(&self, gpu: &Gpu) -> Result<Vec<u64>> {
        Ok(bytemuck::pod_collect_to_vec(&read_buffer(gpu, &self.readable).await?))
    }
}
