struct UmbrageQuery {
    position: vec3f,
    normal: vec3f,
    light: u32,
    pixel: vec2f,
    dx: vec3f,
    dy: vec3f,
    split: i32,
    quad_split: i32
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
    {
        query.quad_split = -1;
    }
    return query;
}

fn umbrage_fragment_query(position: vec3f, normal: vec3f, dx: vec3f, dy: vec3f, pixel: vec2f) -> UmbrageQuery {
    var query = umbrage_query(position, normal);
    query.pixel = pixel;
    query.dx = dx;
    query.dy = dy;
    {
        let own = umbrage_select_split_at(0u, umbrage_frame_view_depth(0u, position));
        let by_quads = umbrage_moments.splits[min(own, 7u)].quads != 0u;
        query.quad_split = select(-1, umbrage_select_split_of_quad(own, pixel), by_quads);
    }
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
    {
        point.dx = query.dx;
        point.dy = query.dy;
    }
    {
        point.slice = query.quad_split;
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

struct UmbrageCrease {
    height: f32,
    rise: vec2f,
    unsure: f32
}

@if(exact && counted)
var<private> umbrage_edges_counts: vec4u;

@if(bounds)
var<private> umbrage_filter_is_undecided: bool;

fn umbrage_filter_gradient_noise(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
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

const UMBRAGE_MOMENTS_ESM: u32 = 16u;

const UMBRAGE_MOMENTS_VSM: u32 = 17u;

const UMBRAGE_MOMENTS_EVSM2: u32 = 18u;

const UMBRAGE_MOMENTS_MSM: u32 = 20u;

const UMBRAGE_MOMENTS_LEAST_VARIANCE: f32 = 5e-7;

const UMBRAGE_MOMENTS_MOMENT_BIAS: f32 = 1e-6;

const UMBRAGE_MOMENTS_PLANE_BIAS: f32 = 2.0;

const UMBRAGE_MOMENTS_MOST_WARPED_SPREAD: f32 = 0.05;

fn umbrage_moments_chebyshev(mean: f32, square: f32, least_variance: f32, t: f32) -> f32 {
    if t <= mean {
        return 1.0;
    }
    let variance = max(square - mean * mean, least_variance);
    let beyond = t - mean;
    return variance / (variance + beyond * beyond);
}

@if(msm)
fn umbrage_moments_hamburger(moments: vec4f, t: f32) -> f32 {
    let b = mix(moments, vec4f(0.0, 2.0 / 3.0, 0.0, 2.0 / 3.0), UMBRAGE_MOMENTS_MOMENT_BIAS);
    let d2 = max(b.y - b.x * b.x, 1e-9);
    let l = (b.z - b.x * b.y) / d2;
    let d3 = max(b.w - b.y * b.y - l * l * d2, 1e-12);
    let y = t - b.x;
    let z = (t * t - b.y - l * y) / d3;
    let c1 = y / d2 - l * z;
    let c0 = 1.0 - c1 * b.x - z * b.y;
    let half = 0.5 * (c1 + select(-1.0, 1.0, c1 >= 0.0) * sqrt(max(c1 * c1 - 4.0 * z * c0, 0.0)));
    let one = -c0 / select(half, 1e-12, half == 0.0);
    let other = -half / select(z, 1e-12, z == 0.0);
    let first = min(one, other);
    let second = max(one, other);
    if t <= first {
        return 1.0;
    }
    if t <= second {
        let weight = (t * second - b.x * (t + second) + b.y) / ((t - first) * max(second - first, 1e-9));
        return clamp(1.0 - weight, 0.0, 1.0);
    }
    let weight = (first * second - b.x * (first + second) + b.y) / ((t - first) * (t - second));
    return clamp(weight, 0.0, 1.0);
}

struct UmbrageSpread {
    texel: f32,
    plane: f32,
    bias: f32
}

fn umbrage_moments_spread_of(at: UmbrageReceiver, scale: f32, radius: vec2f, dx: vec2f, dy: vec2f) -> UmbrageSpread {
    let slope = at.slope * at.slope;
    let bias = UMBRAGE_BIAS_TEXEL_BIAS * max(at.texel_m.x, at.texel_m.y) / at.range_m;
    let filtered = radius * radius / 6.0 + (dx * dx + dy * dy) / 12.0;
    let texel = sqrt((slope.x + slope.y) / 12.0 + bias * bias);
    return UmbrageSpread(scale * texel, scale * sqrt(dot(slope, filtered)), scale * bias);
}

fn umbrage_moments_lit_share(kind: u32, exponents: vec2f, moments: vec4f, t: f32, spread: UmbrageSpread) -> f32 {
    @if(vsm)
    {
        if kind == UMBRAGE_MOMENTS_VSM {
            return umbrage_moments_chebyshev(moments.x, moments.y, max(spread.texel * spread.texel, UMBRAGE_MOMENTS_LEAST_VARIANCE), t);
        }
    }
    @if(msm)
    {
        if kind == UMBRAGE_MOMENTS_MSM {
            return umbrage_moments_hamburger(moments, t - UMBRAGE_MOMENTS_PLANE_BIAS * spread.plane);
        }
    }
    let unbiased = t + spread.bias;
    let warped = exp(exponents.x * unbiased);
    if kind == UMBRAGE_MOMENTS_ESM {
        return clamp(moments.x / warped, 0.0, 1.0);
    }
    let positive_spread = min(spread.texel * exponents.x, UMBRAGE_MOMENTS_MOST_WARPED_SPREAD) * warped;
    let positive = umbrage_moments_chebyshev(moments.x, moments.y, positive_spread * positive_spread, warped);
    if kind == UMBRAGE_MOMENTS_EVSM2 {
        return positive;
    }
    let negative = -exp(-exponents.y * unbiased);
    let negative_spread = min(spread.texel * exponents.y, UMBRAGE_MOMENTS_MOST_WARPED_SPREAD) * negative;
    return min(positive, umbrage_moments_chebyshev(moments.z, moments.w, negative_spread * negative_spread, negative));
}

fn umbrage_moments_without_bleeding(lit: f32, bleeding: f32) -> f32 {
    return clamp((lit - bleeding) / (1.0 - bleeding), 0.0, 1.0);
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
    dx: vec3f,
    dy: vec3f,
    slice: i32,
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
    let slice = select(u32(max(point.slice, 0)), umbrage_select_split_at(frame, depth), point.slice < 0);
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

fn umbrage_select_split_of_quad(own: u32, pixel: vec2f) -> i32 {
    let here = f32(own);
    let towards = 1.0 - 2.0 * vec2f(vec2u(pixel) & vec2u(1u));
    let beside = here + towards.x * dpdxFine(here);
    let row = max(here, beside);
    let other_row = row + towards.y * dpdyFine(row);
    let count = umbrage_frames[0].split_count;
    let most = select(count - 1u, own, own >= count);
    return i32(min(u32(round(max(row, other_row))), most));
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
    let own = umbrage_moments.splits[index];
    var at = plane;
    @if(plane_bias && slope_bias)
    {
        if umbrage_frames[frame].bias_kind + umbrage_zero(plane.texel.x) == UMBRAGE_SHADE_SLOPE_BIAS {
            at = umbrage_bias_without_plane(at, own.radius + 1.0);
        }
    }
    @if(!plane_bias)
    {
        at = umbrage_bias_without_plane(at, own.radius + 1.0);
    }
    let texel = clamp(at.texel + split.texel_offset, vec2f(0.5), vec2f(split.size - 0.5)) + split.corner;
    let most = split.layer_texels;
    let dx = clamp(vec2f(dot(split.u_row.xyz, point.dx), dot(split.v_row.xyz, point.dx)), -most, most);
    let dy = clamp(vec2f(dot(split.u_row.xyz, point.dy), dot(split.v_row.xyz, point.dy)), -most, most);
    let found = umbrage_map_moments(split.layer, texel, split.layer_texels, dx, dy);
    let t = clamp(own.depth.x * at.depth + own.depth.y, -1.0, 1.0);
    let spread = umbrage_moments_spread_of(at, own.depth.x, own.radius, dx, dy);
    @if(any_filter)
    let kind = umbrage_frames[frame].filter_kind + umbrage_zero(at.texel.x);
    @if(!any_filter)
    let kind = UMBRAGE_FILTER;
    let lit = umbrage_moments_lit_share(kind, umbrage_moments.exponents, found, t, spread);
    return umbrage_moments_without_bleeding(lit, umbrage_moments.bleeding);
}
