// Visibility at given points, by the very functions that shade the scene. One pixel is one point.

// xyz: relative to the origin, in metres. w: 0 to let the view choose the split, else the split's number plus 1.
@group(0) @binding(0) var points: texture_2d<f32>;
// xyz: the surface's geometric unit normal.
@group(0) @binding(1) var normals: texture_2d<f32>;

@vertex
fn vs_all(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

// Red: visibility. Green: the split that answered, −1 if none.
@fragment
fn fs_probe(@builtin(position) pixel: vec4f) -> @location(0) vec2f {
    let at = vec2i(pixel.xy);
    let point = textureLoad(points, at, 0);
    let normal = textureLoad(normals, at, 0).xyz;
    var query = umbrage_query(point.xyz, normal);
    query.split = i32(point.w) - 1;
    let shadow = umbrage_shadow(query);
    return vec2f(shadow.visibility, f32(shadow.split));
}
