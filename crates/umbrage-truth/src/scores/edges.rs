//! D: the distance between the edges of true and answered shadows.

use super::domain::edges_of;
use super::stats::percentile;
use super::{Answers, Domain};
use crate::Result;

/// Distance in pixels that counts for an edge without a counterpart, and the largest one that
/// counts.
pub const EDGE_DISTANCE_CAP: f64 = 64.0;

/// Distance between the true edges and the technique's, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EdgeDistance {
    /// D, the mean distance over both sets of edges, in pixels.
    pub mean: f64,
    /// 95th percentile of the edge distance over both sets, in pixels.
    pub p95: f64,
    /// Number of pixels on true edges, |B*|.
    pub true_edges: usize,
    /// Number of pixels on answered edges, |B̂|.
    pub answered_edges: usize,
}

/// Computes D of the answers; `None` if neither the truth nor the answers have an edge.
///
/// # Errors
/// As [`super::mis_shadowed`].
pub fn edge_distance(domain: &Domain, answers: &Answers) -> Result<Option<EdgeDistance>> {
    answers.check(domain)?;
    let answered = edges_of(domain, |pixel| answers.decision(domain, pixel));
    let truth = domain.edges();
    let [width, height] = domain.size();
    let (to_answered, to_truth) =
        (squared_distances(width, height, &answered), squared_distances(width, height, truth));
    let capped = |squared: f64| squared.sqrt().min(EDGE_DISTANCE_CAP);
    let mut distances: Vec<f64> = truth.iter().map(|&x| capped(to_answered[x])).collect();
    distances.extend(answered.iter().map(|&x| capped(to_truth[x])));
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    Ok(percentile(&mut distances, 0.95).map(|p95| EdgeDistance {
        mean,
        p95,
        true_edges: truth.len(),
        answered_edges: answered.len(),
    }))
}

/// Computes the squared distance in pixels from every pixel to the nearest of `seeds`, exactly;
/// infinite without seeds.
///
/// Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions" (2012): the lower
/// envelope of parabolas, first down the columns, then along the rows. (The crate `edt` is exact
/// too, but takes seconds where this takes milliseconds.)
pub(super) fn squared_distances(width: usize, height: usize, seeds: &[usize]) -> Vec<f64> {
    let mut grid = vec![f64::INFINITY; width * height];
    for &seed in seeds {
        grid[seed] = 0.0;
    }
    let mut envelope = Envelope::default();
    let mut line = vec![0.0; height];
    for x in 0..width {
        (0..height).for_each(|y| line[y] = grid[y * width + x]);
        envelope.transform(&mut line);
        (0..height).for_each(|y| grid[y * width + x] = line[y]);
    }
    for row in grid.chunks_exact_mut(width.max(1)) {
        envelope.transform(row);
    }
    grid
}

/// The lower envelope of the parabolas `(x − at)² + height`.
#[derive(Default)]
struct Envelope {
    /// `at` and `height` of each parabola, and the x from which on it is the lowest.
    parabolas: Vec<(f64, f64, f64)>,
}

impl Envelope {
    /// Replaces each value of a line by `min over y of (x − y)² + line[y]`.
    fn transform(&mut self, line: &mut [f64]) {
        self.parabolas.clear();
        for (at, &height) in line.iter().enumerate().filter(|(_, height)| height.is_finite()) {
            let at = at as f64;
            let from = loop {
                let Some(&(other, other_height, other_from)) = self.parabolas.last() else { break f64::NEG_INFINITY };
                let cross = ((height + at * at) - (other_height + other * other)) / (2.0 * (at - other));
                if cross > other_from {
                    break cross;
                }
                self.parabolas.pop();
            };
            self.parabolas.push((at, height, from));
        }
        let mut lowest = 0;
        for (x, value) in line.iter_mut().enumerate() {
            let x = x as f64;
            while self.parabolas.get(lowest + 1).is_some_and(|next| next.2 <= x) {
                lowest += 1;
            }
            if let Some(&(at, height, _)) = self.parabolas.get(lowest) {
                *value = (x - at) * (x - at) + height;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::squared_distances;

    proptest! {
        #[test]
        fn distances_are_exact(
            width in 1..40_usize,
            height in 1..40_usize,
            seeds in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
        ) {
            let seeds: Vec<usize> = seeds.iter().map(|seed| seed.index(width * height)).collect();
            let fast = squared_distances(width, height, &seeds);
            for (pixel, &distance) in fast.iter().enumerate() {
                let brute = seeds
                    .iter()
                    .map(|seed| {
                        let dx = (seed % width).abs_diff(pixel % width);
                        let dy = (seed / width).abs_diff(pixel / width);
                        (dx * dx + dy * dy) as f64
                    })
                    .fold(f64::INFINITY, f64::min);
                prop_assert_eq!(distance, brute);
            }
        }
    }
}
