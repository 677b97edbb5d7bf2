struct UmbrageContact {
    clip_from_eye: mat4x4f,
    eye_from_clip: mat4x4f,
    eye: vec3f,
    length_m: f32,
    forward: vec3f,
    thickness_m: f32,
    pixel_m: f32,
    perspective: f32
}

@group(UMBRAGE_CONTACT_GROUP) @binding(0)
var<uniform> umbrage_contact: UmbrageContact;

@group(UMBRAGE_CONTACT_GROUP) @binding(1)
var umbrage_contact_depth: texture_depth_2d;

const UMBRAGE_CONTACT_STEPS: u32 = 12u;

const UMBRAGE_CONTACT_PIXELS: f32 = 0.75;

fn umbrage_contact_visibility(position: vec3f, normal: vec3f, to_light: vec3f, noise: f32) -> f32 {
    let size = vec2f(textureDimensions(umbrage_contact_depth));
    let start = position - umbrage_contact.eye;
    let start_pixel = floor(umbrage_contact_pixel(start, size).xy);
    let depth = dot(start, umbrage_contact.forward);
    let pixel_m = umbrage_contact.pixel_m * select(1.0, depth, umbrage_contact.perspective > 0.5);
    let least = UMBRAGE_CONTACT_PIXELS * pixel_m;
    var visibility = 1.0;
    for (var i = 0u; i < UMBRAGE_CONTACT_STEPS; i++) {
        let share = (f32(i) + noise) / f32(UMBRAGE_CONTACT_STEPS);
        let at = start + to_light * (share * umbrage_contact.length_m);
        let pixel = umbrage_contact_pixel(at, size);
        let texel = clamp(floor(pixel.xy), vec2f(0.0), size - 1.0);
        let on_screen = all(vec3<bool>((texel == floor(pixel.xy)), (pixel.z > 0.0)));
        let stored = textureLoad(umbrage_contact_depth, vec2i(texel), 0);
        let ndc = vec2f(2.0, -2.0) * (texel + 0.5) / size + vec2f(-1.0, 1.0);
        let clip = umbrage_contact.eye_from_clip * vec4f(ndc, stored, 1.0);
        let seen = clip.xyz / clip.w;
        let before = dot(at - seen, umbrage_contact.forward);
        let above = dot(seen - start, normal);
        let apart = any(texel != start_pixel);
        let stands = all(vec3<bool>((before > least), (before < umbrage_contact.thickness_m), (above > least)));
        let shade = clamp(4.0 * share - 3.0, 0.0, 1.0);
        visibility = min(visibility, select(1.0, shade, all(vec3<bool>(on_screen, apart, stands))));
    }
    return select(1.0, visibility, dot(normal, to_light) > 0.0);
}

fn umbrage_contact_pixel(from_eye: vec3f, size: vec2f) -> vec3f {
    let clip = umbrage_contact.clip_from_eye * vec4f(from_eye, 1.0);
    let ndc = clip.xy / clip.w;
    return vec3f((vec2f(ndc.x, -ndc.y) * 0.5 + 0.5) * size, clip.w);
}
