// What all passes of the eye share: the frame, and where a point is in the picture.

@group(0) @binding(0) var<uniform> frame: Frame;

fn clip_of(from_eye: vec3f) -> vec4f {
    return frame.clip_from_eye * vec4f(from_eye, 1.0);
}

// Least coverage that is drawn: with several samples coverage decides how many, with one it is all or nothing, 0.5.
override LEAST_COVERAGE: f32 = 0.0;

// The colour of an alpha-tested surface, with alpha as its coverage sees it. Call in uniform control flow.
fn tested_color(uv: vec2f, vertex_color: vec4f) -> vec4f {
    return material.base_color * vertex_color * textureSample(base_color_texture, coverage_sampler, uv);
}

// Alpha as coverage: a step one pixel wide around the cutoff. Call in uniform control flow.
fn coverage_of(alpha: f32) -> f32 {
    return (alpha - material.alpha_cutoff) / max(fwidth(alpha), 1e-4) + 0.5;
}
