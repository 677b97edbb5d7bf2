@group(UMBRAGE_RECEIVER_GROUP) @binding(1)
var umbrage_moment_maps: texture_2d_array<f32>;

@group(UMBRAGE_RECEIVER_GROUP) @binding(3)
var<uniform> umbrage_moments: UmbrageMoments;

const UMBRAGE_MOST_ANISOTROPY: f32 = 16.0;

fn umbrage_map_moments(layer: u32, texel: vec2f, layer_texels: vec2f, dx: vec2f, dy: vec2f) -> vec4f {
    let along = select(dy, dx, dot(dx, dx) >= dot(dy, dy));
    let across = min(length(dx), length(dy));
    let long = max(length(along), 1.0);
    let taps = clamp(ceil(long / max(across, 1.0)), 1.0, UMBRAGE_MOST_ANISOTROPY);
    let level = clamp(log2(long / taps), 0.0, 15.0);
    var sum = vec4f(0.0);
    for (var i = 0.0; i < taps; i += 1.0) {
        let at = texel + along * ((i + 0.5) / taps - 0.5);
        sum += umbrage_trilinear(layer, at / layer_texels, level);
    }
    return sum / taps;
}

fn umbrage_trilinear(layer: u32, at: vec2f, level: f32) -> vec4f {
    let last = f32(textureNumLevels(umbrage_moment_maps) - 1u);
    let fine = floor(min(level, last));
    let share = min(level, last) - fine;
    var found = umbrage_bilinear(layer, at, u32(fine));
    if share > 0.0 {
        found = mix(found, umbrage_bilinear(layer, at, u32(fine) + 1u), share);
    }
    return found;
}

fn umbrage_bilinear(layer: u32, at: vec2f, level: u32) -> vec4f {
    let edge = max(vec2i(textureDimensions(umbrage_moment_maps)) >> vec2u(level), vec2i(1));
    let place = at * vec2f(edge) - 0.5;
    let corner = floor(place);
    let f = place - corner;
    let last = edge - 1;
    let a = clamp(vec2i(corner), vec2i(0), last);
    let b = clamp(vec2i(corner) + 1, vec2i(0), last);
    let top = mix(textureLoad(umbrage_moment_maps, a, layer, level), textureLoad(umbrage_moment_maps, vec2i(b.x, a.y), layer, level), f.x);
    let bottom = mix(textureLoad(umbrage_moment_maps, vec2i(a.x, b.y), layer, level), textureLoad(umbrage_moment_maps, b, layer, level), f.x);
    return mix(top, bottom, f.y);
}

struct UmbrageMomentSplit {
    depth: vec2f,
    radius: vec2f,
    @size(16)
    quads: u32
}

struct UmbrageMoments {
    exponents: vec2f,
    bleeding: f32,
    splits: array<UmbrageMomentSplit, 8>
}
