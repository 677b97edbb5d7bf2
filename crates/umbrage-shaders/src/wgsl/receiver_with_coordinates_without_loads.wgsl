struct UmbrageQuery {
    position: vec3f,
    normal: vec3f,
    light: u32,
    pixel: vec2f,
    dx: vec3f,
    dy: vec3f,
    split: i32
}

struct UmbrageShadow {
    visibility: f32,
    split: i32,
    tint: vec3f,
    light: vec3f
}

fn umbrage_query(position: vec3f, normal: vec3f) -> UmbrageQuery {
    var query: UmbrageQuery;
    query.position = position;
    query.normal = normal;
    query.light = 0u;
    query.pixel = vec2f(-1.0);
    query.split = -1;
    return query;
}

fn umbrage_fragment_query(position: vec3f, normal: vec3f, dx: vec3f, dy: vec3f, pixel: vec2f) -> UmbrageQuery {
    var query = umbrage_query(position, normal);
    query.pixel = pixel;
    query.dx = dx;
    query.dy = dy;
    return query;
}

fn umbrage_visibility(position: vec3f, normal: vec3f) -> f32 {
    return umbrage_shadow(umbrage_query(position, normal)).visibility;
}

fn umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow {
    return umbrage_shadow_from_coordinates(query, umbrage_shadow_coordinates(query.position));
}

fn umbrage_shadow_from_coordinates(query: UmbrageQuery, coordinates: UmbrageShadowCoordinates) -> UmbrageShadow {
    var point = umbrage_point(query);
    point.coordinates = coordinates;
    return umbrage_answer(query, point);
}

fn umbrage_light_of(light: u32, visibility: f32) -> vec3f {
    return mix(umbrage_frames[light].shadow_colour, vec3f(1.0), visibility);
}

fn umbrage_in_slice(position: vec3f) -> bool {
    @if(!sliced)
    return true;
    @if(sliced)
    {
        let depth = umbrage_frame_view_depth(0u, position);
        let slice = umbrage_frames[0].slice + umbrage_zero(depth);
        let count = umbrage_frames[0].split_count;
        return slice >= count || slice == min(umbrage_select_split_at(0u, depth), count - 1u);
    }
}

const UMBRAGE_BLEND: u32 = 0u;

const UMBRAGE_DITHER: u32 = 1u;

@if(exact && counted)
fn umbrage_edge_counts() -> vec4u {
    return umbrage_edges_counts;
}

@if(bounds)
fn umbrage_is_undecided() -> bool {
    return umbrage_filter_is_undecided;
}

fn umbrage_point(query: UmbrageQuery) -> UmbragePoint {
    var point: UmbragePoint;
    point.position = query.position;
    point.normal = query.normal;
    point.noise = select(umbrage_filter_gradient_noise(query.pixel), 0.5, query.pixel.x < 0.0);
    @if(exact)
    {
        point.dx = query.dx;
        point.dy = query.dy;
    }
    return point;
}

fn umbrage_answer(query: UmbrageQuery, point: UmbragePoint) -> UmbrageShadow {
    let first = umbrage_frame_first_frame(query.light);
    let is_alone = query.split >= 0;
    var frame = umbrage_frame_frame_at(query.light, point.position);
    if is_alone {
        let faces = max(umbrage_frames[first].face_count, 1u);
        frame = first + min(u32(query.split) / max(umbrage_frames[first].split_count, 1u), faces - 1u);
    }
    let facing = umbrage_frame_faces_light(point.normal, umbrage_frame_to_light(frame, point.position));
    let unshaded = select(0.0, 1.0, facing);
    let nobody = UmbrageShadow(unshaded, -1, vec3f(1.0), umbrage_light_of(frame, unshaded));
    let depth = umbrage_frame_view_depth(frame, point.position);
    let split_count = umbrage_frames[frame].split_count + umbrage_zero(depth);
    let before = (frame - first) * split_count;
    var choice = UmbrageChoice(u32(max(query.split, 0)) - before, 0u, 0.0);
    if !is_alone {
        let enabled = umbrage_frames[frame].enabled + umbrage_zero(depth);
        if enabled == 0u || !umbrage_frame_illuminates(frame, point.position) {
            return nobody;
        }
        choice = umbrage_select_choose(frame, depth, point);
        if choice.index == split_count {
            return nobody;
        }
    }
    var index = choice.index;
    @if(dithered)
    {
        @if(any_transition)
        let dithers = umbrage_frames[frame].transition + umbrage_zero(depth) == UMBRAGE_DITHER;
        @if(!any_transition)
        let dithers = true;
        index = select(choice.index, choice.next, dithers && choice.share > point.noise);
    }
    var visibility = 0.0;
    var tint = umbrage_tint_of_split(index);
    @if(blended)
    {
        @if(any_transition)
        let blends = umbrage_frames[frame].transition + umbrage_zero(depth) == UMBRAGE_BLEND;
        @if(!any_transition)
        let blends = true;
        let last = select(0u, 1u, blends && choice.share > 0.0);
        var i = 0u;
        loop {
            let found = umbrage_shade_visibility(frame, select(index, choice.next, i == 1u), point);
            visibility = select(mix(visibility, found, choice.share), found, i == 0u);
            if i == last {
                break;
            }
            i++;
        }
        tint = select(tint, mix(tint, umbrage_tint_of_split(choice.next), choice.share), last == 1u);
    }
    @if(!blended)
    {
        visibility = umbrage_shade_visibility(frame, index, point);
    }
    var strength = umbrage_frames[frame].strength;
    if depth > umbrage_frames[frame].fade_begin {
        let end = umbrage_frames[frame].splits[split_count - 1u].far;
        strength *= clamp((end - depth) / (end - umbrage_frames[frame].fade_begin), 0.0, 1.0);
    }
    if facing && !is_alone {
        visibility = mix(1.0, visibility, strength);
    }
    let shown_tint = select(vec3f(1.0), tint, umbrage_frames[frame].tint != 0u);
    return UmbrageShadow(visibility, i32(before + index), shown_tint, umbrage_light_of(frame, visibility));
}

const UMBRAGE_BIAS_MAX_SLOPE: f32 = 50.0;

const UMBRAGE_BIAS_TEXEL_BIAS: f32 = 0.25;

const UMBRAGE_BIAS_CORNER_SLOPE: f32 = 0.5;

const UMBRAGE_BIAS_FOLD: f32 = 0.03;

const UMBRAGE_BIAS_MOST_CORNER_SLOPE: f32 = 12.0;

const UMBRAGE_BIAS_MOST_STEEP: f32 = 12.0;

const UMBRAGE_BIAS_PAST: f32 = 2.0;

const UMBRAGE_BIAS_PAST_TEXELS: f32 = 8.0;

const UMBRAGE_BIAS_ROUNDING: f32 = 1.9073486328125e-6;

const UMBRAGE_BIAS_SNAP_TEXELS: f32 = 0.00390625;

const UMBRAGE_BIAS_CREASE_SLOPE: f32 = 1.9;

const UMBRAGE_BIAS_CREASE_SHARE: f32 = 0.9;

const UMBRAGE_BIAS_OWN_TEXELS: f32 = 0.05;

struct UmbrageTolerance {
    bend: f32,
    past: f32,
    steep: f32,
    arrival: f32,
    crease: f32,
    own: f32,
    constant: f32,
    rounding: f32
}

struct UmbrageReceiver {
    texel: vec2f,
    depth: f32,
    slope: vec2f,
    tilt: vec2f,
    texel_m: vec2f,
    range_m: f32,
    linear: vec2f,
    tolerance: UmbrageTolerance,
    crease: UmbrageCrease
}

struct UmbrageMapPoint {
    texel: vec2f,
    depth: f32,
    along_u: vec3f,
    along_v: vec3f,
    texel_m: vec2f,
    tilt: vec2f,
    range_m: f32,
    rounding_m: f32,
    linear: vec2f
}

fn umbrage_bias_receiver_at(at: UmbrageMapPoint, normal: vec3f, to_light: vec3f) -> UmbrageReceiver {
    let cosine = dot(normal, to_light);
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    let steepness = 1.0 / max(cosine, sine / UMBRAGE_BIAS_MAX_SLOPE);
    let tangent = sine * steepness;
    let slope = vec2f(dot(normal, at.along_u), dot(normal, at.along_v)) * steepness;
    let longer = max(at.texel_m.x, at.texel_m.y);
    let bias_m = longer * (UMBRAGE_BIAS_TEXEL_BIAS + UMBRAGE_BIAS_SNAP_TEXELS * tangent) + at.rounding_m;
    var result: UmbrageReceiver;
    result.texel = at.texel;
    result.depth = at.depth - bias_m / at.range_m;
    result.slope = slope * at.texel_m / at.range_m;
    result.tilt = at.tilt;
    result.texel_m = at.texel_m;
    result.range_m = at.range_m;
    result.linear = at.linear;
    result.tolerance = umbrage_bias_tolerance(tangent, at.texel_m, at.range_m);
    result.tolerance.constant = bias_m / at.range_m;
    result.tolerance.rounding = at.rounding_m / at.range_m;
    result.tolerance.own = (UMBRAGE_BIAS_OWN_TEXELS * longer + at.rounding_m) / at.range_m;
    return result;
}

fn umbrage_bias_tolerance(tangent: f32, texel_m: vec2f, range_m: f32) -> UmbrageTolerance {
    let corner = clamp(UMBRAGE_BIAS_FOLD * (1.0 + tangent * tangent), UMBRAGE_BIAS_CORNER_SLOPE, UMBRAGE_BIAS_MOST_CORNER_SLOPE);
    let longer = max(texel_m.x, texel_m.y);
    var result: UmbrageTolerance;
    result.bend = corner * min(texel_m.x, texel_m.y) / range_m;
    result.past = UMBRAGE_BIAS_PAST * (1.0 + corner) * longer / range_m;
    result.steep = max(UMBRAGE_BIAS_MOST_STEEP - tangent, 0.0) / range_m;
    result.arrival = UMBRAGE_BIAS_PAST_TEXELS * longer / range_m;
    result.crease = max(UMBRAGE_BIAS_CREASE_SLOPE, UMBRAGE_BIAS_CREASE_SHARE * tangent) / range_m;
    return result;
}

fn umbrage_bias_plain_point(split: UmbrageSplit, place: vec3f, position: vec3f) -> UmbrageMapPoint {
    let largest = max(max(abs(position.x), abs(position.y)), abs(position.z));
    var result: UmbrageMapPoint;
    result.texel = place.xy;
    result.depth = place.z;
    result.along_u = split.u_row.xyz * split.texel_m.x;
    result.along_v = split.v_row.xyz * split.texel_m.y;
    result.texel_m = split.texel_m;
    result.tilt = vec2f(0.0);
    result.range_m = split.depth_range_m;
    result.rounding_m = UMBRAGE_BIAS_ROUNDING * (largest + split.depth_range_m) + split.depth_step_m;
    result.linear = vec2f(0.0);
    return result;
}

@if(slope_bias)
fn umbrage_bias_without_plane(at: UmbrageReceiver, reach: vec2f) -> UmbrageReceiver {
    var result = at;
    result.depth -= dot(abs(at.slope), reach);
    result.slope = vec2f(0.0);
    result.tolerance.bend = 0.0;
    result.tolerance.steep = 0.0;
    result.tolerance.crease = 1e30;
    result.tolerance.rounding = 1e30;
    return result;
}

fn umbrage_bias_level(at: UmbrageReceiver, offset: vec2f) -> f32 {
    @if(warped)
    return at.depth + dot(at.tilt, offset);
    @if(!warped)
    return at.depth;
}

fn umbrage_bias_reference(at: UmbrageReceiver, offset: vec2f, reach: vec2f) -> f32 {
    return umbrage_bias_bent(at, offset, reach, at.tolerance.bend * length(offset));
}

fn umbrage_bias_bent(at: UmbrageReceiver, offset: vec2f, reach: vec2f, nearer: f32) -> f32 {
    let lowest = dot(at.slope, offset) - dot(abs(at.slope), reach);
    @if(warped)
    let nearest = umbrage_bias_level(at, offset) - dot(abs(at.tilt), reach);
    @if(!warped)
    let nearest = umbrage_bias_level(at, offset);
    return umbrage_bias_as_stored(at, nearest + min(lowest - nearer, 0.0));
}

fn umbrage_bias_as_stored(at: UmbrageReceiver, depth: f32) -> f32 {
    @if(!linear)
    return clamp(depth, 0.0, 1.0);
    @if(linear)
    {
        let held = clamp(depth, -at.linear.x, 1.0 - at.linear.x);
        return select(held, umbrage_bias_linear_depth(at.linear, at.linear.y / max(-held, 1e-30)), at.linear.y > 0.0);
    }
}

fn umbrage_bias_linear_depth(linear: vec2f, w: f32) -> f32 {
    let near = linear.y / linear.x;
    return clamp((w - near) * (linear.x * (linear.x - 1.0) / linear.y), 0.0, 1.0);
}

struct UmbrageCrease {
    height: f32,
    rise: vec2f,
    unsure: f32
}

fn umbrage_crease_is_there(crease: UmbrageCrease) -> bool {
    return any(crease.rise != vec2f(0.0));
}

const UMBRAGE_DISC_DISC_TAPS: u32 = 32u;

const UMBRAGE_DISC_TAP_SPREAD: f32 = 0.6666667;

const UMBRAGE_DISC_GOLDEN_ANGLE: f32 = 2.3999632;

@if(disc)
fn umbrage_disc_vogel(i: u32, count: u32, turn: f32) -> vec2f {
    let angle = f32(i) * UMBRAGE_DISC_GOLDEN_ANGLE + turn;
    return sqrt((f32(i) + 0.5) / f32(count)) * vec2f(cos(angle), sin(angle));
}

@if(disc)
fn umbrage_disc_shares(layer: UmbrageLayer, at: UmbrageReceiver, centre: vec2f, wide: vec2f, turn: f32) -> vec3f {
    let spread = sqrt(max(wide * wide - UMBRAGE_DISC_TAP_SPREAD, vec2f(0.0)));
    var seen = vec4f(0.0);
    for (var i = 0u; i < UMBRAGE_DISC_DISC_TAPS; i++) {
        let texel = centre + spread * umbrage_disc_vogel(i, UMBRAGE_DISC_DISC_TAPS, turn);
        let first = floor(texel - 0.5);
        seen += umbrage_texel_four(layer, at, first, texel - 0.5 - first);
    }
    return seen.xyz / max(seen.w, 1.0);
}

@if(pcss)
fn umbrage_disc_penumbra(layer: UmbrageLayer, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f) -> vec2f {
    return umbrage_kernel_half_width(softness.width_m, at.texel_m, UMBRAGE_KERNEL_DISC_RADIUS, softness.most);
}

@if(exact)
struct UmbrageRun {
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
    min: vec3f,
    triangles: u32,
    max: vec3f,
    first: u32
}

@if(exact)
struct UmbrageRay {
    origin: vec3f,
    normal: vec3f,
    to_eye: vec3f,
    to_light: vec3f,
    length_m: f32,
    dx: vec3f,
    dy: vec3f
}

@if(exact && counted)
var<private> umbrage_edges_counts: vec4u;

@if(exact)
const UMBRAGE_EDGES_LEAST_M: f32 = 0.002;

@if(exact)
const UMBRAGE_EDGES_PARALLEL: f32 = 0.866;

@if(exact)
const UMBRAGE_EDGES_SLACK_TEXELS: f32 = 0.25;

@if(exact)
const UMBRAGE_EDGES_STEEPEST: f32 = 20.0;

@if(exact)
const UMBRAGE_EDGES_LOST: f32 = 9.5367431640625e-7;

@if(exact)
const UMBRAGE_EDGES_STEPS_RIGHT: u32 = 139617u;

@if(exact)
const UMBRAGE_EDGES_STEPS_DOWN: u32 = 164373u;

@if(exact)
fn umbrage_edges_step_of(i: u32) -> vec2i {
    return vec2i(vec2u(UMBRAGE_EDGES_STEPS_RIGHT >> (2u * i), UMBRAGE_EDGES_STEPS_DOWN >> (2u * i)) & vec2u(3u)) - 1;
}

@if(exact)
fn umbrage_edges_place_of(i: u32) -> vec2f {
    let sixteenths = vec2u(UMBRAGE_EDGE_RIGHT >> (4u * i), UMBRAGE_EDGE_BELOW >> (4u * i)) & vec2u(15u);
    return (vec2f(sixteenths) - 8.0) / 16.0;
}

@if(exact)
fn umbrage_edges_four_of(beyond: vec2<bool>) -> u32 {
    let right = select(0u, 1u, beyond.x);
    let below = select(0u, 1u, beyond.y);
    return 1u | (1u << (1u + right)) | (1u << (3u + below)) | (1u << (5u + right + 2u * below));
}

@if(exact)
fn umbrage_edges_decided(layer: UmbrageLayer, at: UmbrageReceiver, centre: vec2f, ray: UmbrageRay) -> f32 {
    let middle = floor(centre + layer.offset);
    let dark = umbrage_edges_dark_round(layer, at, middle);
    if dark == 0u {
        @if(counted)
        umbrage_edges_count(1u, 0u, 0u);
        return 1.0;
    }
    let four = umbrage_edges_four_of(fract(centre + layer.offset) >= vec2f(0.5));
    let enough = select(four, 511u, UMBRAGE_EDGE_SAMPLES > 1u);
    if (dark & enough) == enough {
        @if(counted)
        umbrage_edges_count(2u, 0u, 0u);
        return 0.0;
    }
    var asked = array<u32, 9>();
    var without_name = false;
    var lit = (1u << UMBRAGE_EDGE_SAMPLES) - 1u;
    for (var i = 0u; i < 9u; i++) {
        let id = umbrage_map_id(layer.index, umbrage_edges_texel_round(layer, middle, i));
        if id == 0u {
            without_name = without_name || (dark & four & (1u << i)) != 0u;
            continue;
        }
        var is_new = true;
        for (var j = 0u; j < i; j++) {
            is_new = is_new && asked[j] != id;
        }
        asked[i] = id;
        if is_new {
            lit = umbrage_edges_lit_past(id, ray, lit);
            if lit == 0u {
                break;
            }
        }
    }
    let share = f32(countOneBits(lit)) / f32(UMBRAGE_EDGE_SAMPLES);
    let is_open = without_name && lit != 0u;
    @if(counted)
    umbrage_edges_count(select(select(3u, 4u, share < 1.0), 5u, is_open), 0u, 0u);
    return select(share, -share, is_open);
}

@if(exact && counted)
fn umbrage_edges_count(cause: u32, runs: u32, triangles: u32) {
    umbrage_edges_counts = vec4u(max(umbrage_edges_counts.x, cause), umbrage_edges_counts.y + select(0u, 1u, cause > 0u), umbrage_edges_counts.zw + vec2u(runs, triangles));
}

@if(exact)
fn umbrage_edges_texel_round(layer: UmbrageLayer, middle: vec2f, i: u32) -> vec2i {
    return clamp(vec2i(middle) + umbrage_edges_step_of(i), layer.first, layer.last);
}

@if(exact)
fn umbrage_edges_dark_round(layer: UmbrageLayer, at: UmbrageReceiver, middle: vec2f) -> u32 {
    let most = UMBRAGE_EDGES_STEEPEST * at.texel_m / at.range_m;
    let slope = clamp(at.slope, -most, most);
    let slack = UMBRAGE_EDGES_SLACK_TEXELS * min(at.texel_m.x, at.texel_m.y) / at.range_m;
    var dark = 0u;
    for (var i = 0u; i < 9u; i++) {
        let texel = umbrage_edges_texel_round(layer, middle, i);
        let offset = vec2f(texel) + 0.5 - layer.offset - at.texel;
        let plane = umbrage_bias_as_stored(at, umbrage_bias_level(at, offset) + dot(slope, offset) - slack);
        dark |= select(0u, 1u << i, umbrage_map_load(layer.index, texel) < plane);
    }
    return dark;
}

@if(exact)
fn umbrage_edges_lit_past(id: u32, ray: UmbrageRay, lit: u32) -> u32 {
    let run = umbrage_run(id);
    let point = vec4f(ray.origin, 1.0);
    let origin = vec3f(dot(run.row_x, point), dot(run.row_y, point), dot(run.row_z, point));
    let to_light = umbrage_edges_own(run, ray.to_light);
    let largest = max(max(abs(ray.origin.x), abs(ray.origin.y)), abs(ray.origin.z));
    let own_largest = max(max(abs(origin.x), abs(origin.y)), abs(origin.z));
    let lost = UMBRAGE_EDGES_LOST * (largest * length(to_light) + own_largest);
    let dx = umbrage_edges_own(run, ray.dx);
    let dy = umbrage_edges_own(run, ray.dy);
    let pixel = select(vec3f(0.0), 0.5 * (abs(dx) + abs(dy)), UMBRAGE_EDGE_SAMPLES > 1u);
    @if(counted)
    umbrage_edges_count(0u, 1u, 0u);
    if !umbrage_edges_meets_box(run, origin, to_light, pixel + lost, ray.length_m) {
        return lit;
    }
    let surface = UmbrageSurface(umbrage_edges_plane_of(run, ray.normal), umbrage_edges_own(run, ray.to_eye), to_light);
    let axis = umbrage_edges_dominant(to_light);
    let along = umbrage_edges_turned(to_light, axis);
    let shear = along.xy / along.z;
    var left = lit;
    for (var i = 0u; i < run.triangles && left != 0u; i++) {
        let a = umbrage_edges_turned(umbrage_corner(run, 3u * i) - origin, axis);
        let b = umbrage_edges_turned(umbrage_corner(run, 3u * i + 1u) - origin, axis);
        let c = umbrage_edges_turned(umbrage_corner(run, 3u * i + 2u) - origin, axis);
        @if(counted)
        umbrage_edges_count(0u, 0u, 1u);
        for (var k = 0u; k < UMBRAGE_EDGE_SAMPLES; k++) {
            let place = umbrage_edges_place_of(k);
            let aside = umbrage_edges_turned(place.x * dx + place.y * dy, axis);
            let at = array<vec3f, 3>(a - aside, b - aside, c - aside);
            let shades = umbrage_edges_is_before(at, umbrage_edges_turned_surface(surface, axis), shear, vec2f(ray.length_m, lost));
            left &= ~select(0u, 1u << k, shades);
        }
    }
    return left;
}

@if(exact)
fn umbrage_edges_own(run: UmbrageRun, v: vec3f) -> vec3f {
    return vec3f(dot(run.row_x.xyz, v), dot(run.row_y.xyz, v), dot(run.row_z.xyz, v));
}

@if(exact)
struct UmbrageSurface {
    normal: vec3f,
    to_eye: vec3f,
    to_light: vec3f
}

@if(exact)
fn umbrage_edges_plane_of(run: UmbrageRun, normal: vec3f) -> vec3f {
    let aside = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.x) > 0.7);
    let u = cross(normal, aside);
    let plane = cross(umbrage_edges_own(run, u), umbrage_edges_own(run, cross(normal, u)));
    return select(-plane, plane, dot(plane, umbrage_edges_own(run, normal)) > 0.0);
}

@if(exact)
fn umbrage_edges_turned_surface(surface: UmbrageSurface, axis: u32) -> UmbrageSurface {
    return UmbrageSurface(umbrage_edges_turned(surface.normal, axis), umbrage_edges_turned(surface.to_eye, axis), umbrage_edges_turned(surface.to_light, axis));
}

@if(exact)
fn umbrage_edges_meets_box(run: UmbrageRun, origin: vec3f, direction: vec3f, by: vec3f, length_m: f32) -> bool {
    let inverse = 1.0 / select(direction, vec3f(1e-20), abs(direction) < vec3f(1e-20));
    let one = (run.min - by - origin) * inverse;
    let other = (run.max + by - origin) * inverse;
    let enters = min(one, other);
    let leaves = max(one, other);
    return max(max(enters.x, enters.y), max(enters.z, 0.0)) <= min(min(leaves.x, leaves.y), min(leaves.z, length_m));
}

@if(exact)
fn umbrage_edges_dominant(v: vec3f) -> u32 {
    let size = abs(v);
    let by_x = size.x >= size.y && size.x >= size.z;
    return select(select(2u, 1u, size.y >= size.z), 0u, by_x);
}

@if(exact)
fn umbrage_edges_turned(v: vec3f, axis: u32) -> vec3f {
    return select(select(v, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

@if(exact)
fn umbrage_edges_is_before(corners: array<vec3f, 3>, surface: UmbrageSurface, shear: vec2f, bounds: vec2f) -> bool {
    let a = corners[0];
    let b = corners[1];
    let c = corners[2];
    let p = a.xy - shear * a.z;
    let q = b.xy - shear * b.z;
    let r = c.xy - shear * c.z;
    let weights = vec3f(r.x * q.y - r.y * q.x, p.x * r.y - p.y * r.x, q.x * p.y - q.y * p.x);
    let normal = cross(b - a, c - a);
    let reach = max(max(length(a), length(b)), length(c));
    let lost = bounds.y + UMBRAGE_EDGES_LOST * reach;
    let highest = max(max(dot(surface.normal, a), dot(surface.normal, b)), dot(surface.normal, c));
    let is_parallel = abs(dot(normal, surface.normal)) > UMBRAGE_EDGES_PARALLEL * length(normal) * length(surface.normal);
    let rises = !is_parallel && highest > lost * length(surface.normal);
    if abs(dot(normal, a)) <= lost * length(normal) {
        let passed = vec3f(2.0 * lost * reach);
        let is_met = all(weights >= -passed) || all(weights <= passed);
        return is_met && rises && dot(normal, surface.to_eye) * dot(normal, surface.to_light) < 0.0;
    }
    let twice_area = weights.x + weights.y + weights.z;
    let is_under = all(weights >= vec3f(0.0)) || all(weights <= vec3f(0.0));
    if !is_under || twice_area == 0.0 {
        return false;
    }
    let metres = dot(weights, vec3f(a.z, b.z, c.z)) / (twice_area * surface.to_light.z);
    return metres > select(UMBRAGE_EDGES_LEAST_M, 0.0, rises) && metres < bounds.x;
}

const UMBRAGE_FILTER_LEAST_LIGHT: f32 = 0.2;

const UMBRAGE_FILTER_DOUBTED_LIGHT: f32 = 0.5;

const UMBRAGE_FILTER_SHUT: f32 = 0.6;

const UMBRAGE_FILTER_LEAST_OWN: f32 = 0.02;

@if(bounds)
var<private> umbrage_filter_is_undecided: bool;

@if(bounds)
fn umbrage_filter_lit_by_bounds(layer: UmbrageLayer, kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f) -> f32 {
    let plain = UMBRAGE_KERNEL_UNSURE;
    umbrage_filter_is_undecided = umbrage_filter_is_undecided || plain == UMBRAGE_KERNEL_UNSURE;
    return plain;
}

@if(!bounds)
fn umbrage_filter_lit_share(layer: UmbrageLayer, kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f) -> f32 {
    var asked = at;
    var seen = vec3f(0.0);
    var lit = 0.0;
    var is_behind = false;
    let plain = UMBRAGE_KERNEL_UNSURE;
    for (var i = 0; i < 2; i++) {
        seen = umbrage_filter_share_of_kernel(layer, kind, softness, asked, centre, plain == UMBRAGE_KERNEL_UNSURE);
        lit = select(lit, seen.x, i == 0);
        let is_done = i == 1 || seen.x == 0.0 || seen.z == 0.0;
        is_behind = is_behind || umbrage_crease_is_there(asked.crease);
        if is_done || !umbrage_crease_is_there(asked.crease) {
            break;
        }
    }
    let is_shut = seen.z >= UMBRAGE_FILTER_SHUT;
    let is_corner = is_behind && is_shut;
    let is_lit = seen.x >= select(0.0, UMBRAGE_FILTER_LEAST_LIGHT, is_corner);
    let is_doubted = seen.z > 0.0 && (seen.x <= UMBRAGE_FILTER_DOUBTED_LIGHT || is_corner);
    var has_own = seen.y >= UMBRAGE_FILTER_LEAST_OWN;
    let is_seen_lit = !is_doubted || has_own;
    return select(select(0.0, min(lit, 1.0), is_lit && is_seen_lit), plain, plain != UMBRAGE_KERNEL_UNSURE);
}

fn umbrage_filter_share_of_kernel(layer: UmbrageLayer, kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f, is_asked: bool) -> vec3f {
    @if(hard)
    {
        if kind == UMBRAGE_KERNEL_HARD {
            let texel = floor(centre) + 0.5;
            return umbrage_texel_of_comparison(umbrage_texel_compare(layer, texel, umbrage_bias_reference(at, texel - at.texel, vec2f(0.0))));
        }
    }
    @if(pcss)
    {
        if kind == UMBRAGE_KERNEL_PCSS {
            return umbrage_disc_shares(layer, at, centre, umbrage_disc_penumbra(layer, softness, at, centre), softness.turn);
        }
    }
    @if(disc)
    {
        if kind == UMBRAGE_KERNEL_DISC {
            let wide = umbrage_kernel_half_width(softness.width_m, at.texel_m, UMBRAGE_KERNEL_DISC_RADIUS, softness.most);
            return umbrage_disc_shares(layer, at, centre, wide, softness.turn);
        }
    }
    @if(square)
    {
        return umbrage_square_shares(layer, kind, softness, at, centre, is_asked);
    }
    @if(!square)
    return umbrage_texel_of_comparison(1.0);
}

fn umbrage_filter_gradient_noise(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}

const UMBRAGE_KERNEL_HARD: u32 = 0u;

const UMBRAGE_KERNEL_PCF2: u32 = 1u;

const UMBRAGE_KERNEL_CASTANO5: u32 = 5u;

const UMBRAGE_KERNEL_DISC: u32 = 8u;

const UMBRAGE_KERNEL_PCSS: u32 = 9u;

const UMBRAGE_KERNEL_LEAST_RADIUS: f32 = 1.0;

const UMBRAGE_KERNEL_DISC_RADIUS: f32 = 3.0;

const UMBRAGE_KERNEL_MOST_BLOCKER_M: f32 = 200.0;

fn umbrage_kernel_radius(kind: u32) -> f32 {
    return array<f32, 10>(0.5, 1.0, 1.5, 2.5, 3.5, 2.5, 0.0, 0.0, 16.0, 16.0)[min(kind, UMBRAGE_KERNEL_PCSS)];
}

fn umbrage_kernel_widest(kind: u32, reach: f32) -> f32 {
    return select(umbrage_kernel_radius(kind), reach - 1.0, kind >= UMBRAGE_KERNEL_DISC);
}

@if(slope_bias)
fn umbrage_kernel_reach(kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver) -> vec2f {
    @if(pcss)
    {
        if kind == UMBRAGE_KERNEL_PCSS {
            return umbrage_kernel_search_radius(softness, at) + 1.0;
        }
    }
    if kind == UMBRAGE_KERNEL_DISC {
        return umbrage_kernel_half_width(softness.width_m, at.texel_m, UMBRAGE_KERNEL_DISC_RADIUS, softness.most) + 1.0;
    }
    if kind <= UMBRAGE_KERNEL_PCF2 {
        return vec2f(umbrage_kernel_radius(kind));
    }
    return umbrage_kernel_half_width(softness.width_m, at.texel_m, umbrage_kernel_radius(kind), umbrage_kernel_radius(kind)) + 0.5;
}

@if(pcss)
fn umbrage_kernel_search_radius(softness: UmbrageSoftness, at: UmbrageReceiver) -> vec2f {
    let farthest_m = clamp(at.depth * at.range_m, 0.0, UMBRAGE_KERNEL_MOST_BLOCKER_M);
    return clamp(softness.sun_tangent * farthest_m / at.texel_m, vec2f(UMBRAGE_KERNEL_LEAST_RADIUS), vec2f(softness.most));
}

struct UmbrageSoftness {
    width_m: f32,
    sun_tangent: f32,
    turn: f32,
    most: f32
}

fn umbrage_kernel_half_width(width_m: f32, texel_m: vec2f, own: f32, most: f32) -> vec2f {
    let wanted = 0.5 * width_m / texel_m;
    return select(vec2f(min(own, most)), clamp(wanted, vec2f(UMBRAGE_KERNEL_LEAST_RADIUS), vec2f(most)), width_m > 0.0);
}

const UMBRAGE_KERNEL_UNSURE: f32 = -1.0;

@if(tent)
fn umbrage_kernel_integral(x: vec2f, r: vec2f) -> vec2f {
    let y = clamp(x / r, vec2f(-1.0), vec2f(1.0));
    return 0.5 + y - 0.5 * y * abs(y);
}

@if(castano5)
fn umbrage_kernel_castano(x: vec2f) -> vec2f {
    let tents = max(3.0 - abs(x), vec2f(0.0)) + max(2.0 - abs(x), vec2f(0.0)) - max(1.0 - abs(x), vec2f(0.0));
    return tents / 12.0;
}

@if(square)
fn umbrage_kernel_weight_of(kind: u32, left: vec2f, centre: vec2f, half: vec2f) -> vec2f {
    @if(pcf2)
    {
        if kind == UMBRAGE_KERNEL_PCF2 {
            return max(1.0 - abs(left + 0.5 - centre), vec2f(0.0));
        }
    }
    @if(castano5)
    {
        if kind == UMBRAGE_KERNEL_CASTANO5 {
            return umbrage_kernel_castano(left + 0.5 - centre);
        }
    }
    @if(tent)
    return umbrage_kernel_integral(left + 1.0 - centre, half) - umbrage_kernel_integral(left - centre, half);
    @if(!tent)
    return vec2f(0.0);
}

@if(square)
struct UmbrageTap {
    texel: vec2f,
    weight: vec2f
}

@if(square)
fn umbrage_kernel_pair(kind: u32, first: vec2f, centre: vec2f, half: vec2f) -> UmbrageTap {
    let second = umbrage_kernel_weight_of(kind, first + 1.0, centre, half);
    let weight = umbrage_kernel_weight_of(kind, first, centre, half) + second;
    return UmbrageTap(first + 0.5 + second / max(weight, vec2f(1e-9)), weight);
}

struct UmbrageSplit {
    u_row: vec4f,
    v_row: vec4f,
    depth_row: vec4f,
    w_row: vec4f,
    texel_offset: vec2f,
    texel_m: vec2f,
    size: f32,
    far: f32,
    blend_begin: f32,
    depth_range_m: f32,
    depth_step_m: f32,
    is_empty: u32,
    viewport_texels: f32,
    guard_texels: f32,
    corner: vec2f,
    layer_texels: vec2f,
    layer: u32,
    depth_offset: f32,
    is_linear: u32,
    filter_radius_texels: f32
}

struct UmbrageFrame {
    view_depth_plane: vec4f,
    to_light: vec3f,
    strength: f32,
    light_position: vec3f,
    light_range_m: f32,
    fade_begin: f32,
    split_count: u32,
    filter_kind: u32,
    enabled: u32,
    tint: u32,
    filter_width_m: f32,
    sun_tangent: f32,
    turn_per_pixel: f32,
    transition: u32,
    cone_cosine: f32,
    first_frame: u32,
    face_count: u32,
    shadow_colour: vec3f,
    bias_kind: u32,
    eye: vec3f,
    is_radial: u32,
    selection: u32,
    map_blend: f32,
    slice: u32,
    splits: array<UmbrageSplit, 8>
}

fn umbrage_map_place_from_world(split: UmbrageSplit, position: vec3f) -> vec3f {
    let point = vec4f(position, 1.0);
    return vec3f(dot(split.u_row, point), dot(split.v_row, point), dot(split.depth_row, point));
}

fn umbrage_map_covers(split: UmbrageSplit, at: vec3f) -> bool {
    return all(at.xy >= vec2f(0.0)) && all(at.xy <= vec2f(split.size));
}

@if(square)
struct UmbrageSquare {
    corner: vec2f,
    side: i32,
    half: vec2f
}

@if(square)
fn umbrage_square_square_of(kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f) -> UmbrageSquare {
    @if(pcf2)
    {
        if kind == UMBRAGE_KERNEL_PCF2 {
            return UmbrageSquare(floor(centre - 0.5), 2, vec2f(1.0));
        }
    }
    let half = umbrage_kernel_half_width(softness.width_m, at.texel_m, umbrage_kernel_radius(kind), umbrage_kernel_radius(kind));
    return UmbrageSquare(floor(centre - half), 2 * i32(umbrage_kernel_radius(kind) + 0.5), half);
}

@if(square)
fn umbrage_square_shares(layer: UmbrageLayer, kind: u32, softness: UmbrageSoftness, at: UmbrageReceiver, centre: vec2f, is_asked: bool) -> vec3f {
    let texels = umbrage_square_square_of(kind, softness, at, centre);
    let taps = texels.side / 2;
    var seen = vec3f(0.0);
    for (var j = 0; j < taps; j++) {
        for (var i = 0; i < taps; i++) {
            let first = texels.corner + 2.0 * vec2f(f32(i), f32(j));
            let tap = umbrage_kernel_pair(kind, first, centre, texels.half);
            seen += tap.weight.x * tap.weight.y * umbrage_texel_four(layer, at, first, tap.texel - 0.5 - first).xyz;
        }
    }
    return seen;
}

struct UmbrageLayer {
    index: u32,
    texels: vec2f,
    offset: vec2f,
    first: vec2i,
    last: vec2i
}

fn umbrage_texel_compare(layer: UmbrageLayer, texel: vec2f, depth: f32) -> f32 {
    return umbrage_map_compare(layer.index, texel + layer.offset, layer.texels, depth);
}

fn umbrage_texel_of_comparison(lit: f32) -> vec3f {
    return vec3f(lit, lit, 0.0);
}

@if(texels)
fn umbrage_texel_four(layer: UmbrageLayer, at: UmbrageReceiver, first: vec2f, second: vec2f) -> vec4f {
    let lit = umbrage_texel_compare(layer, first + 0.5 + second, umbrage_bias_reference(at, first + 1.0 - at.texel, vec2f(0.5)));
    return vec4f(umbrage_texel_of_comparison(lit), 1.0);
}

fn umbrage_tint_of_split(index: u32) -> vec3f {
    return array<vec3f, 8>(vec3f(1.0, 0.45, 0.45), vec3f(0.45, 1.0, 0.45), vec3f(0.45, 0.6, 1.0), vec3f(1.0, 1.0, 0.4), vec3f(1.0, 0.45, 1.0), vec3f(0.4, 1.0, 1.0), vec3f(1.0, 0.7, 0.35), vec3f(0.7, 0.5, 1.0))[min(index, 7u)];
}

struct UmbrageShadowCoordinates {
    first: vec3f,
    second: vec3f,
    third: vec3f,
    fourth: vec3f
}

fn umbrage_shadow_coordinates(position: vec3f) -> UmbrageShadowCoordinates {
    return UmbrageShadowCoordinates(umbrage_map_place_from_world(umbrage_frames[0].splits[0], position), umbrage_map_place_from_world(umbrage_frames[0].splits[1], position), umbrage_map_place_from_world(umbrage_frames[0].splits[2], position), umbrage_map_place_from_world(umbrage_frames[0].splits[3], position));
}

fn umbrage_coordinates_in_split(coordinates: UmbrageShadowCoordinates, index: u32) -> vec3f {
    let near = select(coordinates.first, coordinates.second, index == 1u);
    return select(near, select(coordinates.third, coordinates.fourth, index == 3u), index >= 2u);
}

@group(UMBRAGE_RECEIVER_GROUP) @binding(0)
var<uniform> umbrage_frames: array<UmbrageFrame, UMBRAGE_FRAMES>;

struct UmbragePoint {
    position: vec3f,
    normal: vec3f,
    noise: f32,
    @if(exact)
    dx: vec3f,
    @if(exact)
    dy: vec3f,
    coordinates: UmbrageShadowCoordinates
}

fn umbrage_frame_view_depth(frame: u32, position: vec3f) -> f32 {
    @if(planar)
    let planar = dot(umbrage_frames[frame].view_depth_plane, vec4f(position, 1.0));
    @if(radial)
    let radial = distance(umbrage_frames[frame].eye, position);
    @if(planar && radial)
    return select(planar, radial, umbrage_frames[frame].is_radial != 0u);
    @if(!radial)
    return planar;
    @if(!planar)
    return radial;
}

fn umbrage_frame_frame_at(light: u32, position: vec3f) -> u32 {
    let first = umbrage_frame_first_frame(light);
    @if(!faces)
    return first;
    @if(faces)
    {
        let from_light = position - umbrage_frames[first].light_position;
        let size = abs(from_light);
        let by_x = size.x >= size.y && size.x >= size.z;
        let axis = select(select(2u, 1u, size.y >= size.z), 0u, by_x);
        let along = select(select(from_light.z, from_light.y, axis == 1u), from_light.x, by_x);
        let face = 2u * axis + select(0u, 1u, along < 0.0);
        return first + min(face, max(umbrage_frames[first].face_count, 1u) - 1u);
    }
}

fn umbrage_frame_first_frame(light: u32) -> u32 {
    return select(umbrage_frames[light].first_frame, 0u, UMBRAGE_FRAMES == 1u);
}

fn umbrage_frame_to_light(frame: u32, position: vec3f) -> vec3f {
    @if(!local)
    return umbrage_frames[frame].to_light;
    @if(local)
    {
        let towards = umbrage_frames[frame].light_position - position;
        let unit = towards / max(length(towards), 1e-20);
        return select(umbrage_frames[frame].to_light, unit, umbrage_frames[frame].light_range_m > 0.0);
    }
}

const UMBRAGE_FRAME_LEAST_FACING: f32 = 0.0005;

fn umbrage_frame_faces_light(normal: vec3f, to_light: vec3f) -> bool {
    return dot(normal, to_light) > UMBRAGE_FRAME_LEAST_FACING;
}

fn umbrage_frame_illuminates(frame: u32, position: vec3f) -> bool {
    @if(!local)
    return true;
    @if(local)
    {
        let from_light = position - umbrage_frames[frame].light_position;
        let distance = length(from_light);
        let along = -dot(umbrage_frames[frame].to_light, from_light);
        let range = umbrage_frames[frame].light_range_m;
        let is_inside = (distance <= range) & (along >= umbrage_frames[frame].cone_cosine * distance);
        return (range == 0.0) | is_inside;
    }
}

fn umbrage_zero(metres: f32) -> u32 {
    return select(0u, 1u, metres > 3e38);
}

const UMBRAGE_SELECT_BY_MAP: u32 = 1u;

struct UmbrageChoice {
    index: u32,
    next: u32,
    share: f32
}

fn umbrage_select_choose(frame: u32, depth: f32, point: UmbragePoint) -> UmbrageChoice {
    let split_count = umbrage_frames[frame].split_count + umbrage_zero(depth);
    let slice = umbrage_select_split_at(frame, depth);
    if slice == split_count {
        return UmbrageChoice(slice, slice, 0.0);
    }
    @if(by_depth && by_map)
    {
        if umbrage_frames[frame].selection + umbrage_zero(depth) == UMBRAGE_SELECT_BY_MAP {
            return umbrage_select_choose_by_map(frame, point);
        }
    }
    @if(by_depth)
    return umbrage_select_choose_by_depth(frame, depth, slice);
    @if(!by_depth)
    return umbrage_select_choose_by_map(frame, point);
}

@if(by_depth)
fn umbrage_select_choose_by_depth(frame: u32, depth: f32, slice: u32) -> UmbrageChoice {
    let next = slice + 1u;
    let band_begin = umbrage_frames[frame].splits[slice].blend_begin;
    var share = 0.0;
    if next < umbrage_frames[frame].split_count + umbrage_zero(depth) && depth > band_begin {
        share = clamp((depth - band_begin) / (umbrage_frames[frame].splits[slice].far - band_begin), 0.0, 1.0);
    }
    return UmbrageChoice(slice, next, share);
}

@if(by_map)
fn umbrage_select_choose_by_map(frame: u32, point: UmbragePoint) -> UmbrageChoice {
    let split_count = umbrage_frames[frame].split_count + umbrage_zero(point.position.x);
    let map_blend = umbrage_frames[frame].map_blend;
    var choice = UmbrageChoice(split_count, split_count, 0.0);
    var i = 0u;
    loop {
        let within = umbrage_select_inside(frame, i, point);
        let contains = (within >= 0.0) & (i < split_count);
        let is_first = contains & (choice.index == split_count);
        let band = 0.5 * map_blend * umbrage_frames[frame].splits[i].size;
        choice.next = select(choice.next, i, contains & (choice.index < i));
        choice.share = select(choice.share, select(1.0 - within / band, 0.0, within >= band), is_first);
        choice.index = select(choice.index, i, is_first);
        i++;
        let is_alone = (choice.index < i) & (choice.share == 0.0);
        if is_alone | (choice.next < i) | (i >= split_count) {
            break;
        }
    }
    choice.share = select(choice.share, 0.0, choice.next == split_count);
    return choice;
}

@if(by_map)
fn umbrage_select_inside(frame: u32, index: u32, point: UmbragePoint) -> f32 {
    let split = umbrage_frames[frame].splits[index];
    let at = umbrage_select_place_in_map(split, index, point);
    let margin = split.filter_radius_texels;
    let room = min(at.xy - margin, split.size - margin - at.xy);
    return select(min(room.x, room.y), -1.0, (split.is_empty != 0u) | (at.z > 1.0));
}

fn umbrage_select_place_in_map(split: UmbrageSplit, index: u32, point: UmbragePoint) -> vec3f {
    return umbrage_coordinates_in_split(point.coordinates, index) + vec3f(split.texel_offset, 0.0);
}

fn umbrage_select_split_at(frame: u32, depth: f32) -> u32 {
    let split_count = umbrage_frames[frame].split_count + umbrage_zero(depth);
    var index = 0u;
    for (var i = 0u; i < UMBRAGE_SPLITS; i++) {
        index += select(0u, 1u, (i < split_count) & (depth >= umbrage_frames[frame].splits[i].far));
    }
    return index;
}

const UMBRAGE_SHADE_SLOPE_BIAS: u32 = 1u;

fn umbrage_shade_visibility(frame: u32, index: u32, point: UmbragePoint) -> f32 {
    let position = point.position;
    let towards_light = umbrage_frame_to_light(frame, position);
    if !umbrage_frame_faces_light(point.normal, towards_light) {
        return 0.0;
    }
    if index >= umbrage_frames[frame].split_count + umbrage_zero(position.x) {
        return 1.0;
    }
    @if(sliced)
    {
        let slice = umbrage_frames[frame].slice + umbrage_zero(position.x);
        if slice != index && slice < umbrage_frames[frame].split_count {
            return 1.0;
        }
    }
    let split = umbrage_frames[frame].splits[index + umbrage_zero(position.x)];
    if split.is_empty != 0u || !umbrage_map_covers(split, umbrage_select_place_in_map(split, index, point)) {
        return 1.0;
    }
    let map_point = umbrage_bias_plain_point(split, umbrage_coordinates_in_split(point.coordinates, index), position);
    let at = umbrage_bias_receiver_at(map_point, point.normal, towards_light);
    return umbrage_shade_lit_share(frame, split, index, at, point, towards_light);
}

fn umbrage_shade_lit_share(frame: u32, split: UmbrageSplit, index: u32, plane: UmbrageReceiver, point: UmbragePoint, towards_light: vec3f) -> f32 {
    @if(any_filter)
    let kind = umbrage_frames[frame].filter_kind + umbrage_zero(plane.texel.x);
    @if(!any_filter)
    let kind = UMBRAGE_FILTER;
    let margin = split.filter_radius_texels;
    let first = vec2f(margin) - split.texel_offset;
    let last = vec2f(split.size - margin - 0.00390625) - split.texel_offset;
    let map_first = vec2i(split.corner);
    let map_last = map_first + vec2i(i32(split.size) - 1);
    let layer = UmbrageLayer(split.layer, split.layer_texels, split.texel_offset + split.corner, map_first, map_last);
    @if(exact)
    var found = 0.0;
    @if(exact)
    {
        found = umbrage_edges_decided(layer, plane, clamp(plane.texel, first, last), umbrage_shade_ray_of(frame, plane, point, towards_light));
        if found >= 0.0 {
            return found;
        }
    }
    let turn = umbrage_frames[frame].turn_per_pixel * (point.noise - 0.5);
    let frame_width_m = umbrage_frames[frame].filter_width_m;
    let most = umbrage_kernel_widest(kind, margin);
    let softness = UmbrageSoftness(frame_width_m, umbrage_frames[frame].sun_tangent, turn, most);
    var at = plane;
    @if(plane_bias && slope_bias)
    {
        if umbrage_frames[frame].bias_kind + umbrage_zero(plane.texel.x) == UMBRAGE_SHADE_SLOPE_BIAS {
            at = umbrage_bias_without_plane(at, umbrage_kernel_reach(kind, softness, at));
        }
    }
    @if(!plane_bias)
    {
        at = umbrage_bias_without_plane(at, umbrage_kernel_reach(kind, softness, at));
    }
    @if(bounds)
    let lit = umbrage_filter_lit_by_bounds(layer, kind, softness, at, clamp(at.texel, first, last));
    @if(!bounds)
    let lit = umbrage_filter_lit_share(layer, kind, softness, at, clamp(at.texel, first, last));
    @if(exact)
    return select(0.0, -found, lit >= 0.5);
    @if(!exact)
    return lit;
}

@if(exact)
fn umbrage_shade_ray_of(frame: u32, at: UmbrageReceiver, point: UmbragePoint, towards_light: vec3f) -> UmbrageRay {
    @if(!local)
    let metres = 3e38;
    @if(local)
    let metres = select(3e38, distance(umbrage_frames[frame].light_position, point.position), umbrage_frames[frame].light_range_m > 0.0);
    let longest = 2.0 * max(at.texel_m.x, at.texel_m.y);
    let dx = point.dx * min(1.0, longest / max(length(cross(point.dx, towards_light)), 1e-20));
    let dy = point.dy * min(1.0, longest / max(length(cross(point.dy, towards_light)), 1e-20));
    let to_eye = umbrage_frames[frame].eye - point.position;
    return UmbrageRay(point.position, point.normal, to_eye, towards_light, metres, dx, dy);
}
