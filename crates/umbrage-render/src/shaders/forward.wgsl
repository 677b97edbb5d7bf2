// The scene as the eye sees it: a shaded picture, or the bare visibility mask.

const SUN: vec3f = vec3f(2.7, 2.5, 2.2);
const SKY_AMBIENT: vec3f = vec3f(0.47, 0.57, 0.72);
const GROUND_AMBIENT: vec3f = vec3f(0.25, 0.225, 0.20);

struct Vertex {
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    @location(3) normal: vec3f,
}

// The pixel's question to the first light. Call in uniform control flow.
fn query_of(in: Surface, normal: vec3f) -> UmbrageQuery {
    return umbrage_fragment_query(in.position, normal, dpdx(in.from_eye), dpdy(in.from_eye), in.clip.xy);
}

// The picture is drawn slice by slice, and triangles are not cut at the slices' borders, nor at the camera's own planes.
override SLICED: bool = false;

// Whether a pixel belongs to what is drawn now.
fn is_drawn(in: Surface) -> bool {
    let depth = dot(in.from_eye, frame.forward);
    return !SLICED || (umbrage_in_slice(in.position) && depth >= frame.near && depth <= frame.far);
}

// Red: visibility of the first light at the pixel's centre. Green: 1, a surface is here.
@fragment
fn fs_mask_opaque(in: Surface) -> @location(0) vec2f {
    let normal = geometric_normal(in.from_eye);
    let query = query_of(in, normal);
    if !is_drawn(in) {
        discard;
    }
    return mask_at(in, query);
}

@fragment
fn fs_mask_masked(in: Surface) -> @location(0) vec2f {
    let normal = geometric_normal(in.from_eye);
    let query = query_of(in, normal);
    if tested_alpha(in.uv, in.color.a) < material.alpha_cutoff || !is_drawn(in) {
        discard;
    }
    return mask_at(in, query);
}

fn mask_at(in: Surface, query: UmbrageQuery) -> vec2f {
    if dot(query.normal, towards(frame.lamps[0], in.position)) <= 0.0 {
        return vec2f(0.0, 1.0);
    }
    return vec2f(with_contact(shadow_of(in, query).visibility, in.position, query.normal), 1.0);
}

@fragment
fn fs_picture_opaque(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(in);
    let geometric = geometric_normal(in.from_eye);
    let query = query_of(in, geometric);
    if !is_drawn(in) {
        discard;
    }
    return vec4f(shaded(in, front, base, query), 1.0);
}

// After a depth pass the test is made again for surfaces that lie in each other exactly: where alpha lets
// through, the other one is seen.
@fragment
fn fs_picture_masked(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let color = tested_color(in.uv, in.color);
    let coverage = coverage_of(color.a);
    let geometric = geometric_normal(in.from_eye);
    let query = query_of(in, geometric);
    if coverage <= LEAST_COVERAGE || !is_drawn(in) {
        discard;
    }
    // Without a depth pass alpha decides here how many samples are covered; with one nobody takes it.
    return vec4f(shaded(in, front, color, query), min(coverage, 1.0));
}

@fragment
fn fs_picture_blend(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let color = base_color(in);
    let geometric = geometric_normal(in.from_eye);
    let query = query_of(in, geometric);
    if !is_drawn(in) {
        discard;
    }
    return vec4f(shaded(in, front, color, query), clamp(color.a, 0.0, 1.0));
}

fn base_color(in: Surface) -> vec4f {
    return material.base_color * in.color * textureSample(base_color_texture, smooth_sampler, in.uv);
}

// What a local light has lost on its way (see lamps.rs): 1 at the lamp, 0 at its range and at the rim of its cone.
fn falloff(lamp: Lamp, position: vec3f) -> f32 {
    let way = position - lamp.position;
    let share = length(way) / max(lamp.range, 1e-20);
    let window = max(1.0 - share * share, 0.0);
    let cosine = -dot(lamp.to_light, way) / max(length(way), 1e-20);
    let cone = select(smoothstep(lamp.outer_cosine, lamp.inner_cosine, cosine), 1.0, lamp.outer_cosine < -1.0);
    return select(1.0, cone * window * window / (1.0 + share * share / 0.09), lamp.range > 0.0);
}

// A light on a surface that nothing shades, by Lambert's law.
fn direct_light(lamp: Lamp, position: vec3f, to_light: vec3f, smooth_normal: vec3f) -> vec3f {
    return SUN * lamp.color * (max(dot(smooth_normal, to_light), 0.0) * falloff(lamp, position));
}

// A sky from above and light from the ground below.
fn ambient_light(smooth_normal: vec3f) -> vec3f {
    // Brighter on the sun's side of the sky, so that corners can be told apart in the shade.
    let side = 1.0 + 0.15 * dot(smooth_normal, frame.to_sun);
    return frame.daylight * side * mix(GROUND_AMBIENT, SKY_AMBIENT, 0.5 * smooth_normal.y + 0.5);
}

// Every light, sky and ground. Display light, tone mapped.
fn shaded(in: Surface, front: bool, base: vec4f, asked: UmbrageQuery) -> vec3f {
    let geometric = asked.normal;
    let smooth_normal = shading_normal(in.normal, front);
    var light = vec3f(0.0);
    var tint = vec3f(1.0);
    let first = towards(frame.lamps[0], in.position);
    let contact = with_contact(1.0, in.position, lookup_normal(geometric, smooth_normal, first));
    for (var i = 0u; i < frame.lamp_count + umbrage_zero(in.position.x); i++) {
        let lamp = frame.lamps[i];
        let to_light = towards(lamp, in.position);
        var query = asked;
        query.light = i;
        query.normal = lookup_normal(geometric, smooth_normal, to_light);
        let shadow = shadow_of(in, query);
        let visibility = min(shadow.visibility, select(1.0, contact, i == 0u));
        light += direct_light(lamp, in.position, to_light, smooth_normal) * umbrage_light_of(i, visibility);
        tint = select(tint, shadow.tint, i == 0u);
    }
    return tone_mapped((base.rgb * (light + ambient_light(smooth_normal)) + material.emissive) * tint);
}
