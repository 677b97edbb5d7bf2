// What all passes of the scene share: the frame, the material and the vertex. Positions are in metres, relative to the
// frame's origin (a world point near the eye that moves in whole steps) unless their name says otherwise.

struct Frame {
    // Positions relative to the eye (world axes) to clip space, reversed depth. Relative to the eye, so that nothing cancels.
    clip_from_eye: mat4x4f,
    // The eye, relative to the origin.
    eye: vec3f,
    // 1 for an orthographic view, 0 for a perspective one.
    is_orthographic: f32,
    // Where the camera looks, a unit vector.
    forward: vec3f,
    lamp_count: u32,
    // Towards the first sun, a unit vector; 0 if there is none.
    to_sun: vec3f,
    // How bright the sky is: 1 by day, less without a sun.
    daylight: f32,
    // The ray through the middle of the image is `ray_center`; a step of 1 in NDC x and y adds the other two.
    ray_center: vec3f,
    // The camera's own planes, as view depths in metres.
    near: f32,
    ray_right: vec3f,
    far: f32,
    ray_up: vec3f,
    // What light of a place in full shadow is multiplied by.
    shadow_colour: vec3f,
    lamps: array<Lamp, 8>,
}

// A light; range is 0 for a sun.
struct Lamp {
    // Relative to the origin.
    position: vec3f,
    range: f32,
    // Towards a sun; against a spot light's axis.
    to_light: vec3f,
    outer_cosine: f32,
    // Linear RGB.
    color: vec3f,
    inner_cosine: f32,
}

struct Material {
    // Linear RGBA.
    base_color: vec4f,
    // Linear RGB.
    emissive: vec3f,
    // Least alpha that counts; 0 where alpha is not tested.
    alpha_cutoff: f32,
}

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
// Trilinear, anisotropic: for the picture.
@group(1) @binding(2) var smooth_sampler: sampler;
// Bilinear on level 0: for decisions that the eye, the sun and the judge have to make alike.
@group(1) @binding(3) var exact_sampler: sampler;
// Trilinear alone: for the picture's coverage, which is asked of every leaf, hidden or not.
@group(1) @binding(4) var coverage_sampler: sampler;

// Rows of the affine transform from the mesh to the frame's origin.
struct Instance {
    @location(4) row_x: vec4f,
    @location(5) row_y: vec4f,
    @location(6) row_z: vec4f,
    // Which splits and which tile a caster's instance is for; see `umbrage_cast`.
    @location(7) code: u32,
}

fn position_from_local(instance: Instance, local: vec3f) -> vec3f {
    let p = vec4f(local, 1.0);
    return vec3f(dot(instance.row_x, p), dot(instance.row_y, p), dot(instance.row_z, p));
}

// Normals transform by the inverse transpose: the cofactors, turned around where the transform mirrors.
fn normal_from_local(instance: Instance, local: vec3f) -> vec3f {
    let x = instance.row_x.xyz;
    let y = instance.row_y.xyz;
    let z = instance.row_z.xyz;
    let cofactors_x = cross(y, z);
    let normal = vec3f(dot(cofactors_x, local), dot(cross(z, x), local), dot(cross(x, y), local));
    return select(normal, -normal, dot(x, cofactors_x) < 0.0);
}

// Alpha as the alpha test sees it: level 0, bilinear.
fn tested_alpha(uv: vec2f, vertex_alpha: f32) -> f32 {
    return material.base_color.a * vertex_alpha * textureSampleLevel(base_color_texture, exact_sampler, uv, 0.0).a;
}
