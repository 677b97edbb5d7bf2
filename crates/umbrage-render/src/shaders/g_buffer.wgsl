// Pictures of several samples per pixel whose first light comes from masks, behind forward.wgsl: surfaces are drawn without
// shadows, each sample's surface is asked for once, and then the picture is put together.

struct GBuffer {
    // Linear light that no shadow takes away: the sky's, the ground's and the surface's own. Alpha is the coverage.
    @location(0) kept: vec4f,
    // Linear light of the first lamp where nothing shades it.
    @location(1) direct: vec4f,
    // The question to the maps: a normal (octahedral, x and y) and the depth at the pixel's centre (low and high half of its
    // bits). 0 where there is nothing to ask: no surface, or one that is turned away.
    @location(2) question: vec4u,
}

@fragment
fn fs_surface_opaque(in: Surface, @builtin(front_facing) front: bool) -> GBuffer {
    return surface_of(in, front, base_color(in), 1.0);
}

@fragment
fn fs_surface_masked(in: Surface, @builtin(front_facing) front: bool) -> GBuffer {
    let color = tested_color(in.uv, in.color);
    let coverage = coverage_of(color.a);
    let surface = surface_of(in, front, color, min(coverage, 1.0));
    if coverage <= LEAST_COVERAGE {
        discard;
    }
    return surface;
}

fn surface_of(in: Surface, front: bool, base: vec4f, coverage: f32) -> GBuffer {
    // The most that a target of 16 bits holds.
    const MOST: vec3f = vec3f(65504.0);
    let geometric = geometric_normal(in.from_eye);
    let smooth_normal = shading_normal(in.normal, front);
    let to_light = towards(frame.lamps[0], in.position);
    let kept = base.rgb * ambient_light(smooth_normal) + material.emissive;
    let direct = base.rgb * direct_light(frame.lamps[0], in.position, to_light, smooth_normal);
    let normal = octahedral(lookup_normal(geometric, smooth_normal, to_light));
    // Depth is continued to the pixel's centre, where it may leave its range.
    let depth = bitcast<u32>(clamp(in.clip.z, 1e-30, 1.0));
    let question = vec4u(normal, depth & 0xffffu, depth >> 16u);
    let is_asked = any(direct > vec3f(0.0));
    return GBuffer(vec4f(min(kept, MOST), coverage), vec4f(min(direct, MOST), 0.0), select(vec4u(0u), question, is_asked));
}

// A unit vector on the faces of an octahedron, unfolded (Meyer et al., 2010): within 4e-5 of the vector.
fn octahedral(normal: vec3f) -> vec2u {
    let flat = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    // An even number of steps, so that axes are exact.
    return vec2u(round((select(flat, folded, normal.z < 0.0) * 0.5 + 0.5) * 65534.0));
}

fn normal_of(question: vec4u) -> vec3f {
    let flat = vec2f(question.xy) / 32767.0 - 1.0;
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return normalize(vec3f(select(flat, folded, z < 0.0), z));
}

fn depth_of(question: vec4u) -> f32 {
    return bitcast<f32>(question.z | (question.w << 16u));
}

struct EachSample {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) sample: u32,
}

// One triangle over the whole image; the instance is the sample.
@vertex
fn vs_sample(@builtin(vertex_index) index: u32, @builtin(instance_index) sample: u32) -> EachSample {
    return EachSample(vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0), sample);
}

@group(2) @binding(0) var questions: texture_multisampled_2d<u32>;

struct Asked {
    @location(0) normal: vec4f,
    @builtin(frag_depth) depth: f32,
}

// Depth and normals of one sample of each pixel, for a mask.
@fragment
fn fs_asked(in: EachSample) -> Asked {
    let question = textureLoad(questions, vec2i(in.clip.xy), i32(in.sample));
    return Asked(vec4f(normal_of(question), 0.0), depth_of(question));
}

// Samples that need no answer of their own: 1 where there is nothing to ask, below 0 where an earlier sample of the pixel
// has the answer: -1 for the first sample, -2 for the second.
@fragment
fn fs_answered(in: EachSample) -> @location(0) vec4f {
    let pixel = vec2i(in.clip.xy);
    let own = textureLoad(questions, pixel, i32(in.sample));
    var answer = select(0.0, 1.0, depth_of(own) == 0.0);
    for (var i = 2i; i >= 0i; i--) {
        let is_one = i < i32(in.sample) && is_one_surface(own, textureLoad(questions, pixel, i));
        answer = select(answer, -1.0 - f32(i), is_one && answer <= 0.0);
    }
    if answer == 0.0 {
        discard;
    }
    return vec4f(answer);
}

// Whether two samples of a pixel ask one question: they show one triangle. Triangles whose normals differ by a few degrees
// have shadows of their own under a low sun.
fn is_one_surface(a: vec4u, b: vec4u) -> bool {
    return all(a == b);
}

@group(2) @binding(1) var kept_light: texture_multisampled_2d<f32>;
@group(2) @binding(2) var direct_light_texture: texture_multisampled_2d<f32>;
@group(2) @binding(3) var answers: texture_2d_array<f32>;

struct Shown {
    @location(0) color: vec4f,
    @builtin(sample_mask) mask: u32,
}

// One sample of each pixel of the picture.
@fragment
fn fs_shown(in: EachSample) -> Shown {
    let pixel = vec2i(in.clip.xy);
    let sample = i32(in.sample);
    var visibility = textureLoad(answers, pixel, sample, 0).r;
    // An earlier sample may refer to one before it.
    for (var i = 0; i < 3; i++) {
        let earlier = max(i32(-1.0 - visibility), 0);
        visibility = select(visibility, textureLoad(answers, pixel, earlier, 0).r, visibility < 0.0);
    }
    let direct = textureLoad(direct_light_texture, pixel, sample).rgb * mix(frame.shadow_colour, vec3f(1.0), visibility);
    return Shown(vec4f(tone_mapped(textureLoad(kept_light, pixel, sample).rgb + direct), 1.0), 1u << in.sample);
}
