@group(0) @binding(0)
var<uniform> window: UmbrageKeptWindow;

@group(0) @binding(1)
var kept: texture_depth_2d;

@vertex
fn vs_all(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 1.0, 1.0);
}

@fragment
fn fs_copy(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    let place = window.begin + vec2i(pixel.xy) - window.corner;
    let around = select(place, place - window.edge, place >= vec2i(window.edge));
    return textureLoad(kept, around, 0);
}

struct UmbrageKeptWindow {
    begin: vec2i,
    corner: vec2i,
    edge: i32
}
