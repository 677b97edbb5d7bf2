// The picture's depth, before anything is shaded: positions come from the arithmetic of the passes that shade, so that these find
// their own depth again, bit for bit.

struct Outline {
    @invariant @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) alpha: f32,
}

@vertex
fn vs_solid(@location(0) local: vec3f, instance: Instance) -> @invariant @builtin(position) vec4f {
    return clip_of(position_from_local(instance, local) - frame.eye);
}

@vertex
fn vs_outline(
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    instance: Instance,
) -> Outline {
    return Outline(clip_of(position_from_local(instance, local) - frame.eye), uv, color.a);
}

// For passes with a colour that is not written.
@fragment
fn fs_solid() {
}

// The test of masks and of contact shadows.
@fragment
fn fs_exact(in: Outline) {
    if tested_alpha(in.uv, in.alpha) < material.alpha_cutoff {
        discard;
    }
}

// The picture's: alpha decides how many samples are covered.
@fragment
fn fs_coverage(in: Outline) -> @location(0) vec4f {
    let coverage = coverage_of(tested_color(in.uv, vec4f(in.alpha)).a);
    if coverage <= LEAST_COVERAGE {
        discard;
    }
    return vec4f(0.0, 0.0, 0.0, min(coverage, 1.0));
}
