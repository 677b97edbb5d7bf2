//! The receiver's decisions on the CPU, in `f32` and with the names of `shaders/lib` and
//! `shaders/pass`, for tests.

use crate::layout::{Frame, Split};

pub mod bias;
pub mod crease;
pub mod edges;
pub mod moments;

/// `kernel::MOST_BLOCKER_M`: metres from a surface within which casters give it the full penumbra
/// of the sun.
pub const MOST_BLOCKER_M: f32 = 200.0;

/// `kernel::DISC_RADIUS`: radius in texels of a disc without a given width.
pub const DISC_RADIUS: f32 = 3.0;

/// `kernel::integral`: the share of a tent of half width `r` around 0 that lies left of `x`.
#[must_use]
pub fn tent_integral(x: f32, r: f32) -> f32 {
    let y = (x / r).clamp(-1.0, 1.0);
    0.5 + y - 0.5 * y * y.abs()
}

/// `kernel::pair` of a tent along one axis: the position of the hardware tap over texels `first`
/// and `first + 1`, and its weight.
#[must_use]
pub fn tent_tap(first: f32, centre: f32, r: f32) -> (f32, f32) {
    let left = first - centre;
    let (below, between, above) = (tent_integral(left, r), tent_integral(left + 1.0, r), tent_integral(left + 2.0, r));
    let weight = above - below;
    (first + 0.5 + (above - between) / weight.max(1e-9), weight)
}

/// `kernel::half_width` along one axis: half the kernel in texels, from its width and the texel in
/// metres; `own` if `width_m` is 0. At least 1 texel for a given width, and at most `most`, the
/// reach of the taps.
#[must_use]
pub fn half_width(width_m: f32, texel_m: f32, own: f32, most: f32) -> f32 {
    if width_m > 0.0 { (0.5 * width_m / texel_m).clamp(1.0, most) } else { own.min(most) }
}

/// `disc::vogel`: point `i` of `count` on Vogel's spiral over the unit disc.
#[must_use]
pub fn vogel(i: u32, count: u32, turn: f32) -> [f32; 2] {
    let angle = i as f32 * 2.399_963_2 + turn;
    let radius = ((i as f32 + 0.5) / count as f32).sqrt();
    [radius * angle.cos(), radius * angle.sin()]
}

/// `filter::gradient_noise`: noise in `[0, 1)` for a pixel.
#[must_use]
pub fn gradient_noise(pixel: [f32; 2]) -> f32 {
    let inner = pixel[0] * 0.067_110_56 + pixel[1] * 0.005_837_15;
    (52.982_92 * inner.fract()).fract()
}

/// `map::from_world`: texels and depth of a position relative to the frame's origin.
#[must_use]
pub fn map_from_world(split: &Split, position: [f32; 3]) -> [f32; 3] {
    if split.w_row != [0.0; 4] {
        let w = along(split.w_row, position);
        if w <= 0.0 {
            return [-1.0, -1.0, 1.0];
        }
        let [u, v, depth] = [split.u_row, split.v_row, split.depth_row].map(|row| along(row, position) / w);
        return [u, v, depth + split.depth_offset];
    }
    [
        along(split.u_row, position) + split.texel_offset[0],
        along(split.v_row, position) + split.texel_offset[1],
        along(split.depth_row, position),
    ]
}

/// `umbrage_split_at`: the split whose slice contains a view depth, `None` beyond the last.
#[must_use]
pub fn split_at(frame: &Frame, view_depth: f32) -> Option<usize> {
    frame.splits[..frame.split_count as usize].iter().position(|split| view_depth < split.far)
}

/// `umbrage_frame_at`: index of the frame of light `light` that serves a position.
#[must_use]
pub fn frame_at(frames: &[Frame], light: usize, position: [f32; 3]) -> usize {
    let first = frames[light].first_frame as usize;
    let from: [f32; 3] = std::array::from_fn(|axis| position[axis] - frames[first].light_position[axis]);
    let size = from.map(f32::abs);
    let axis = if size[0] >= size[1] && size[0] >= size[2] {
        0
    } else if size[1] >= size[2] {
        1
    } else {
        2
    };
    let face = 2 * axis + usize::from(from[axis] < 0.0);
    first + face.min(frames[first].face_count.max(1) as usize - 1)
}

fn along(row: [f32; 4], position: [f32; 3]) -> f32 {
    row[0] * position[0] + row[1] * position[1] + row[2] * position[2] + row[3]
}
