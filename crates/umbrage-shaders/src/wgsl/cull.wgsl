const ROUNDING: f32 = 1e-6;

const MOST_CELLS: f32 = 12.0;

const LEVEL: f32 = 1e-9;

const EDGE: u32 = 64u;

@group(0) @binding(0)
var<uniform> frame: UmbrageCullFrame;

@group(0) @binding(1)
var<storage, read> splits: array<UmbrageCullSplit>;

@group(0) @binding(2)
var<storage, read> planes: array<vec4f>;

@group(0) @binding(3)
var<storage, read> lowest: array<f32>;

@group(0) @binding(4)
var<storage, read> boxes: array<UmbrageCullBox>;

@group(0) @binding(5)
var<storage, read> meshes: array<UmbrageCullMesh>;

@group(0) @binding(6)
var<storage, read_write> draws: array<UmbrageCullDraw>;

@group(0) @binding(7)
var<storage, read_write> ids: array<u32>;

@compute @workgroup_size(64)
fn cull(@builtin(global_invocation_id) id: vec3u) {
    let instance = id.x;
    if instance >= frame.instances {
        return;
    }
    let own = boxes[instance];
    if own.skip != 0u || own.mesh >= frame.meshes {
        return;
    }
    let mesh = meshes[own.mesh];
    for (var split = 0u; split < frame.splits; split++) {
        if !passes(split, own.center, own.half) {
            continue;
        }
        let draw = split * frame.meshes + own.mesh;
        let place = atomicAdd(&draws[draw].instance_count, 1u);
        if place < mesh.room {
            ids[split * frame.room + mesh.first + place] = instance;
        }
        else {
            atomicSub(&draws[draw].instance_count, 1u);
        }
    }
}

fn passes(index: u32, center: vec3f, half: vec3f) -> bool {
    let end = splits[index].first_plane + splits[index].plane_count;
    for (var i = splits[index].first_plane; i < end; i++) {
        let plane = planes[i];
        let room = ROUNDING * (dot(abs(plane.xyz), abs(center) + half) + abs(plane.w));
        if dot(plane.xyz, center) - dot(abs(plane.xyz), half) > plane.w + room {
            return false;
        }
    }
    return !is_below(index, center, half) && lies_before_some(index, center, half);
}

fn is_below(index: u32, center: vec3f, half: vec3f) -> bool {
    if splits[index].has_receivers == 0u {
        return false;
    }
    let direction = splits[index].direction;
    let least = splits[index].receivers_min;
    let most = splits[index].receivers_max;
    let beyond = select(center - half - most, least - (center + half), direction < vec3f(-LEVEL));
    let room = ROUNDING * (abs(center) + half + abs(least) + abs(most));
    let is_flat = 2.0 * half <= vec3f(splits[index].slack);
    let wanted = select(splits[index].margin + room, vec3f(-splits[index].slack), is_flat);
    return any((abs(direction) > vec3f(LEVEL)) & (beyond >= wanted));
}

fn lies_before_some(index: u32, center: vec3f, half: vec3f) -> bool {
    let axis = splits[index].mask_axis;
    if axis > 2u {
        return true;
    }
    let slope = splits[index].mask_slope;
    let cell = splits[index].mask_cell;
    let begin = splits[index].mask_begin;
    let next = (axis + 1u) % 3u;
    let after = (axis + 2u) % 3u;
    let height = splits[index].mask_sign * center[axis];
    let at = vec2f(center[next], center[after]) + slope * height;
    let reach = vec2f(half[next], half[after]) + abs(slope) * half[axis];
    let room = ROUNDING * (abs(at) + reach + abs(begin) + abs(slope) * abs(height)) + 0.001 * cell;
    var lo = floor((at - reach - room - begin) / cell);
    var hi = floor((at + reach + room - begin) / cell);
    let last = f32(EDGE - 1u);
    if any(hi < vec2f(0.0)) || any(lo > vec2f(last)) {
        return false;
    }
    lo = max(lo, vec2f(0.0));
    hi = min(hi, vec2f(last));
    if any(hi - lo > vec2f(MOST_CELLS)) {
        return true;
    }
    let top = height + half[axis];
    let highest = top + ROUNDING * (abs(top) + half[axis]);
    for (var row = u32(lo.y); row <= u32(hi.y); row++) {
        for (var column = u32(lo.x); column <= u32(hi.x); column++) {
            if lowest[(index * EDGE + row) * EDGE + column] < highest {
                return true;
            }
        }
    }
    return false;
}

struct UmbrageCullFrame {
    instances: u32,
    splits: u32,
    meshes: u32,
    room: u32
}

struct UmbrageCullSplit {
    direction: vec3f,
    first_plane: u32,
    receivers_min: vec3f,
    plane_count: u32,
    receivers_max: vec3f,
    has_receivers: u32,
    slack: f32,
    margin: f32,
    mask_axis: u32,
    mask_sign: f32,
    mask_begin: vec2f,
    mask_cell: vec2f,
    mask_slope: vec2f
}

struct UmbrageCullBox {
    center: vec3f,
    mesh: u32,
    half: vec3f,
    skip: u32
}

struct UmbrageCullMesh {
    first: u32,
    room: u32
}

struct UmbrageCullDraw {
    index_count: u32,
    instance_count: atomic<u32>,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32
}
