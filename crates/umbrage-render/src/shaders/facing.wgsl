// The picture's depth with normals, for a mask of what the first light reaches: those that a picture without a mask asks
// with. Positions come from the arithmetic of the passes that shade, so that these find their own depth again, bit for bit.

struct Facing {
    @invariant @builtin(position) clip: vec4f,
    // Relative to the origin.
    @location(0) position: vec3f,
    // Relative to the eye.
    @location(1) from_eye: vec3f,
    @location(2) normal: vec3f,
    @location(3) uv: vec2f,
    @location(4) alpha: f32,
}

@vertex
fn vs_facing(
    @location(0) local: vec3f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
    @location(3) normal: vec3f,
    instance: Instance,
) -> Facing {
    let position = position_from_local(instance, local);
    let from_eye = position - frame.eye;
    return Facing(clip_of(from_eye), position, from_eye, normal_from_local(instance, normal), uv, color.a);
}

@fragment
fn fs_facing(in: Facing, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return facing_of(in, front);
}

@fragment
fn fs_facing_masked(in: Facing, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let coverage = coverage_of(tested_color(in.uv, vec4f(in.alpha)).a);
    let normal = facing_of(in, front);
    if coverage <= LEAST_COVERAGE {
        discard;
    }
    return normal;
}

fn facing_of(in: Facing, front: bool) -> vec4f {
    let geometric = geometric_normal(in.from_eye);
    let smooth_normal = shading_normal(in.normal, front);
    return vec4f(lookup_normal(geometric, smooth_normal, towards(frame.lamps[0], in.position)), 0.0);
}
