//! The receiver's decisions on the CPU, in `f32` and under the names that `shaders/lib` and `shaders/pass` use, for tests.

use crate::layout::{Frame, Split};

/// `filter::tent_integral`: the share of a tent of half width `r` around 0 that lies left of `x`.
#[must_use]
pub fn tent_integral(x: f32, r: f32) -> f32 {
    let y = (x / r).clamp(-1.0, 1.0);
    0.5 + y - 0.5 * y * y.abs()
}

/// `filter::tent_tap` along one axis: the place of the hardware tap over texels `first` and `first + 1`, and its weight.
#[must_use]
pub fn tent_tap(first: f32, centre: f32, r: f32) -> (f32, f32) {
    let left = first - centre;
    let (below, between, above) = (tent_integral(left, r), tent_integral(left + 1.0, r), tent_integral(left + 2.0, r));
    let weight = above - below;
    (first + 0.5 + (above - between) / weight, weight)
}

/// `map::from_world`: texels and depth of a position relative to the frame's origin.
#[must_use]
pub fn map_from_world(split: &Split, position: [f32; 3]) -> [f32; 3] {
    let along = |row: [f32; 4]| row[0] * position[0] + row[1] * position[1] + row[2] * position[2] + row[3];
    [along(split.u_row) + split.texel_offset[0], along(split.v_row) + split.texel_offset[1], along(split.depth_row)]
}

/// `map::covers`: whether a map answers for a place in it.
#[must_use]
pub fn covers(split: &Split, at: [f32; 3]) -> bool {
    let slack = split.texel_m[0].max(split.texel_m[1]) / split.depth_range_m;
    (0.0..=split.size).contains(&at[0])
        && (0.0..=split.size).contains(&at[1])
        && (-slack..=1.0 + slack).contains(&at[2])
}

/// `umbrage_split_at`: the split whose slice holds a view depth, `None` beyond the last.
#[must_use]
pub fn split_at(frame: &Frame, view_depth: f32) -> Option<usize> {
    frame.splits[..frame.split_count as usize].iter().position(|split| view_depth < split.far)
}

/// The split that `umbrage_shadow` answers from: the slice's own, or the first later one whose map covers the position.
#[must_use]
pub fn answering_split(frame: &Frame, position: [f32; 3]) -> Option<usize> {
    let plane = frame.view_depth_plane;
    let depth = plane[0] * position[0] + plane[1] * position[1] + plane[2] * position[2] + plane[3];
    let slice = split_at(frame, depth)?;
    (slice..frame.split_count as usize).find(|&i| covers(&frame.splits[i], map_from_world(&frame.splits[i], position)))
}
