// The sky behind all surfaces.

struct SkyPixel {
    @builtin(position) clip: vec4f,
    @location(0) ray: vec3f,
}

// One triangle over the whole image, infinitely far away.
@vertex
fn vs_sky(@builtin(vertex_index) index: u32) -> SkyPixel {
    let ndc = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return SkyPixel(vec4f(ndc, 0.0, 1.0), frame.ray_center + ndc.x * frame.ray_right + ndc.y * frame.ray_up);
}

@fragment
fn fs_sky(in: SkyPixel) -> @location(0) vec4f {
    let ray = normalize(in.ray);
    let horizon = vec3f(0.68, 0.78, 0.90);
    let zenith = vec3f(0.16, 0.32, 0.66);
    let below = mix(vec3f(0.52, 0.53, 0.55), vec3f(0.30, 0.31, 0.33), smoothstep(0.0, 0.9, -ray.y));
    let up = mix(horizon, zenith, smoothstep(0.0, 0.9, pow(max(ray.y, 0.0), 0.6)));
    let sky = mix(up, below, smoothstep(0.0, 0.12, -ray.y));
    // The sun is half a degree wide; its glow is for the eye only.
    let towards_sun = dot(ray, frame.to_sun);
    let glow = 0.25 * pow(max(towards_sun, 0.0), 64.0) + 4.0 * smoothstep(0.99996, 0.99998, towards_sun);
    return vec4f(tone_mapped(frame.daylight * sky + vec3f(1.0, 0.93, 0.8) * glow), 1.0);
}
