//! Insets: the part of a view in which techniques differ most.

use super::judge::ViewTruth;

/// Ratio of the picture's width and height to those of the enlarged part.
const PARTS: usize = 8;

/// Number of steps of brightness by which errors are weighted. A wrong decision is the more visible
/// the more light the surface would get.
const BRIGHTNESS: f64 = 16.0;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left edge in pixels.
    pub x: u32,
    /// Upper edge in pixels.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

/// Returns the window in which `wrong` (one picture of wrong decisions per technique) differ most.
/// Where k of n techniques are wrong, a pixel counts k (n − k), which is greatest where half of
/// them are, times the sun's light on its surface. Where all techniques are wrong alike, the window
/// with the most errors; without errors, the one with the most true edges; without edges, none.
#[must_use]
pub fn find(judged: &ViewTruth, wrong: &[Vec<bool>]) -> Option<Rect> {
    let [width, height] = judged.domain.size();
    let window = [width.div_ceil(PARTS), height.div_ceil(PARTS)];
    let light = judged.truth.light();
    let facing = |hit: umbrage_truth::Hit| hit.normal.dot(light.to_light(hit.position));
    let brightness: Vec<u64> = judged
        .truth
        .hits()
        .iter()
        .map(|hit| hit.map_or(0, |hit| (BRIGHTNESS * facing(hit)).clamp(0.0, BRIGHTNESS).ceil() as u64))
        .collect();
    let count = |pixel: usize| wrong.iter().filter(|of| of[pixel]).count();
    let differ = |pixel: usize| (count(pixel) * (wrong.len() - count(pixel))) as u64 * brightness[pixel];
    let mut is_edge = vec![false; width * height];
    judged.domain.edges().iter().for_each(|&pixel| is_edge[pixel] = true);
    best_window([width, height], window, differ)
        .or_else(|| best_window([width, height], window, |pixel| count(pixel) as u64 * brightness[pixel]))
        .or_else(|| best_window([width, height], window, |pixel| u64::from(is_edge[pixel])))
}

/// Returns the window with the greatest sum of weights, the upper left one of equals; `None` if all
/// weights are 0.
fn best_window([width, height]: [usize; 2], window: [usize; 2], weight: impl Fn(usize) -> u64) -> Option<Rect> {
    // Sums over everything above and to the left.
    let stride = width + 1;
    let mut sums = vec![0; stride * (height + 1)];
    for y in 0..height {
        let mut row = 0;
        for x in 0..width {
            row += weight(y * width + x);
            sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
        }
    }
    let mut best = (0, [0, 0]);
    for y in 0..=height - window[1] {
        for x in 0..=width - window[0] {
            let (right, below) = (x + window[0], y + window[1]);
            let sum = sums[below * stride + right] + sums[y * stride + x]
                - sums[y * stride + right]
                - sums[below * stride + x];
            if sum > best.0 {
                best = (sum, [x, y]);
            }
        }
    }
    let (sum, [x, y]) = best;
    (sum > 0).then(|| Rect { x: x as u32, y: y as u32, width: window[0] as u32, height: window[1] as u32 })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [80, 64];

    fn spot(at: [usize; 2], radius: usize) -> impl Fn(usize) -> bool {
        move |pixel| (pixel % SIZE[0]).abs_diff(at[0]) <= radius && (pixel / SIZE[0]).abs_diff(at[1]) <= radius
    }

    #[test]
    fn the_window_lies_over_the_weight() {
        let one = spot([61, 20], 3);
        let rect = best_window(SIZE, [10, 8], |pixel| u64::from(one(pixel))).expect("a window");
        assert!((rect.x..rect.x + 10).contains(&61) && (rect.y..rect.y + 8).contains(&20), "{rect:?}");
        let corner = best_window(SIZE, [10, 8], |pixel| u64::from(pixel == SIZE[0] * SIZE[1] - 1)).expect("a window");
        assert_eq!(corner, Rect { x: 70, y: 56, width: 10, height: 8 }, "wholly inside the picture");
        assert_eq!(best_window(SIZE, [10, 8], |_| 0), None);
        assert_eq!(best_window([1, 1], [1, 1], |_| 1), Some(Rect { x: 0, y: 0, width: 1, height: 1 }));
    }

    #[test]
    fn differences_count_more_than_common_errors() {
        let judged = crate::compare::tests::chessboard_shot(SIZE.map(|edge| edge as u32));
        // Two places on the board, which the sun shines on.
        let lit: Vec<usize> =
            judged.domain.pixels().iter().copied().filter(|&pixel| judged.domain.lit(pixel)).collect();
        let place = |pixel: usize| [pixel % SIZE[0], pixel / SIZE[0]];
        let (first, last) = (place(lit[0]), place(lit[lit.len() - 1]));
        assert!(first[1] + 20 < last[1], "the places lie apart: {first:?} {last:?}");
        let picture = |of: &dyn Fn(usize) -> bool| (0..SIZE[0] * SIZE[1]).map(of).collect::<Vec<bool>>();
        let (common, single) = (spot(first, 4), spot(last, 2));
        let wrong = [picture(&|pixel| common(pixel)), picture(&|pixel| common(pixel) || single(pixel))];
        let holds = |rect: Rect, [x, y]: [usize; 2]| {
            (rect.x..rect.x + rect.width).contains(&(x as u32)) && (rect.y..rect.y + rect.height).contains(&(y as u32))
        };
        let rect = find(&judged, &wrong).expect("an inset");
        assert!(holds(rect, last), "{rect:?} {last:?}");
        let rect = find(&judged, &wrong[..1]).expect("one technique has errors but no differences");
        assert!(holds(rect, first), "{rect:?} {first:?}");
        let none = vec![vec![false; SIZE[0] * SIZE[1]]; 2];
        assert_eq!(find(&judged, &none).is_some(), !judged.domain.edges().is_empty(), "edges are better than nothing");
    }
}
