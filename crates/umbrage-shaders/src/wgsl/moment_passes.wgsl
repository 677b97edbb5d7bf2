override KIND: u32;

override POSITIVE_EXPONENT: f32;

override NEGATIVE_EXPONENT: f32;

@group(0) @binding(0)
var<uniform> one: UmbrageMomentPass;

@group(0) @binding(2)
var moments: texture_2d<f32>;

@group(0) @binding(1)
var depths: texture_depth_2d;

@vertex
fn vs_all(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn from_stored(depth: f32) -> vec4f {
    let z = clamp(one.split.depth.x * depth + one.split.depth.y, -1.0, 1.0);
    return umbrage_moments_of_depth(KIND, vec2f(POSITIVE_EXPONENT, NEGATIVE_EXPONENT), z);
}

@fragment
fn fs_convert(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return from_stored(textureLoad(depths, vec2i(pixel.xy), 0));
}

fn blurred(pixel: vec4f, step: vec2i, radius: f32) -> vec4f {
    let middle = vec2i(pixel.xy);
    let outside = umbrage_moments_of_depth(KIND, vec2f(POSITIVE_EXPONENT, NEGATIVE_EXPONENT), 1.0);
    let size = i32(one.size);
    let reach = i32(umbrage_moments_blur_reach(radius)) + select(0, 1, pixel.x > 3e38);
    var sum = vec4f(0.0);
    for (var k = -reach; k <= reach; k++) {
        let texel = middle + k * step;
        let inside = all(texel >= vec2i(0)) && all(texel < vec2i(size));
        let found = textureLoad(moments, clamp(texel, vec2i(0), vec2i(size - 1)), 0);
        sum += umbrage_moments_blur_weight(f32(k), radius) * select(outside, found, inside);
    }
    return sum;
}

@fragment
fn fs_blur_u(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return blurred(pixel, vec2i(1, 0), one.split.radius.x);
}

@fragment
fn fs_blur_v(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return blurred(pixel, vec2i(0, 1), one.split.radius.y);
}

@fragment
fn fs_halve(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let edge = vec2f(textureDimensions(moments));
    let covered = edge / max(floor(edge * 0.5), vec2f(1.0));
    let begin = floor(pixel.xy) * covered;
    let end = begin + covered;
    let first = floor(begin);
    var sum = vec4f(0.0);
    for (var y = 0; y < 3; y++) {
        for (var x = 0; x < 3; x++) {
            let texel = first + vec2f(f32(x), f32(y));
            let part = max(min(texel + 1.0, end) - max(texel, begin), vec2f(0.0));
            if part.x * part.y > 0.0 {
                sum += part.x * part.y * textureLoad(moments, vec2i(min(texel, edge - 1.0)), 0);
            }
        }
    }
    return sum / (covered.x * covered.y);
}

struct UmbrageMomentSplit {
    depth: vec2f,
    radius: vec2f,
    @size(16)
    quads: u32
}

struct UmbrageMomentPass {
    split: UmbrageMomentSplit,
    size: f32
}

const UMBRAGE_MOMENTS_ESM: u32 = 16u;

const UMBRAGE_MOMENTS_VSM: u32 = 17u;

const UMBRAGE_MOMENTS_EVSM2: u32 = 18u;

const UMBRAGE_MOMENTS_MSM: u32 = 20u;

fn umbrage_moments_of_depth(kind: u32, exponents: vec2f, z: f32) -> vec4f {
    if kind == UMBRAGE_MOMENTS_VSM {
        return vec4f(z, z * z, 0.0, 0.0);
    }
    if kind == UMBRAGE_MOMENTS_MSM {
        let square = z * z;
        return vec4f(z, square, z * square, square * square);
    }
    let warped = exp(exponents.x * z);
    if kind == UMBRAGE_MOMENTS_ESM {
        return vec4f(warped, 0.0, 0.0, 0.0);
    }
    if kind == UMBRAGE_MOMENTS_EVSM2 {
        return vec4f(warped, warped * warped, 0.0, 0.0);
    }
    let negative = -exp(-exponents.y * z);
    return vec4f(warped, warped * warped, negative, negative * negative);
}

fn umbrage_moments_blur_reach(radius: f32) -> f32 {
    return floor(sqrt(radius * radius + 0.5));
}

fn umbrage_moments_blur_weight(k: f32, radius: f32) -> f32 {
    let n = umbrage_moments_blur_reach(radius);
    let share = (radius * radius + 0.5 - n * n) / (2.0 * n + 1.0);
    return mix(max(1.0 - abs(k) / n, 0.0) / n, max(1.0 - abs(k) / (n + 1.0), 0.0) / (n + 1.0), share);
}
