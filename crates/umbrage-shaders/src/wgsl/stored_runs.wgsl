@group(UMBRAGE_RUNS_GROUP) @binding(UMBRAGE_RUNS_BINDING)
var<storage, read> umbrage_slots: array<UmbrageStoredSlot>;

@group(UMBRAGE_RUNS_GROUP) @binding(UMBRAGE_RUNS_BINDING + 1u)
var<storage, read> umbrage_runs: array<UmbrageStoredRun>;

@group(UMBRAGE_RUNS_GROUP) @binding(UMBRAGE_RUNS_BINDING + 2u)
var<storage, read> umbrage_run_indices: array<u32>;

@group(UMBRAGE_RUNS_GROUP) @binding(UMBRAGE_RUNS_BINDING + 3u)
var<storage, read> umbrage_run_positions: array<f32>;

fn umbrage_run(id: u32) -> UmbrageRun {
    let slot = umbrage_slots[(id - 1u) >> UMBRAGE_RUN_BITS];
    let stored = umbrage_runs[slot.first_run + ((id - 1u) & ((1u << UMBRAGE_RUN_BITS) - 1u))];
    return UmbrageRun(slot.row_x, slot.row_y, slot.row_z, stored.min, stored.triangles, stored.max, stored.first_index);
}

fn umbrage_corner(run: UmbrageRun, corner: u32) -> vec3f {
    let at = 3u * umbrage_run_indices[run.first + corner];
    return vec3f(umbrage_run_positions[at], umbrage_run_positions[at + 1u], umbrage_run_positions[at + 2u]);
}

struct UmbrageStoredSlot {
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
    first_run: u32
}

struct UmbrageStoredRun {
    min: vec3f,
    triangles: u32,
    max: vec3f,
    first_index: u32
}
