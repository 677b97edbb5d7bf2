// Narkowicz's fit of the ACES film curve (2015), at the exposure that suits SUN.
fn tone_mapped(light: vec3f) -> vec3f {
    let x = light * 0.45;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3f(0.0), vec3f(1.0));
}
