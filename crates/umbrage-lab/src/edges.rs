//! Counts of exact edges, for reports.

use serde::{Deserialize, Serialize};
use umbrage_render::{EdgeCause, EdgeSums};

/// Counts of exact edges for the pixels of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct EdgesReport {
    /// Number of pixels for which a map was read.
    pub points: u64,
    /// Share of these pixels that depth alone did not decide.
    pub undecided: f64,
    /// Number of boxes of runs tested per undecided pixel; `None` if there is no such pixel.
    pub boxes_per_undecided: Option<f64>,
    /// Number of triangles tested per undecided pixel; `None` if there is no such pixel.
    pub triangles_per_undecided: Option<f64>,
    /// Shares of all these pixels, by the cause of the decision.
    pub by_cause: ByCause,
}

/// A number for each cause of a decision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct ByCause {
    /// Lit: no texel around the point is dark.
    pub lit: f64,
    /// Dark: all texels that count are dark.
    pub dark: f64,
    /// Lit: triangles were tested and none is hit.
    pub missed: f64,
    /// Dark: triangles were tested and one is hit.
    pub hit: f64,
    /// Decided by the filter: a caster has no id.
    pub filter: f64,
}

impl ByCause {
    /// Calls `number` for each cause.
    pub fn of(number: impl Fn(EdgeCause) -> f64) -> Self {
        Self {
            lit: number(EdgeCause::Lit),
            dark: number(EdgeCause::Dark),
            missed: number(EdgeCause::Missed),
            hit: number(EdgeCause::Hit),
            filter: number(EdgeCause::Filter),
        }
    }
}

impl From<EdgeSums> for EdgesReport {
    fn from(sums: EdgeSums) -> Self {
        let (points, tested) = (sums.points.max(1) as f64, sums.tested());
        let per_tested = |count: u64| (tested > 0).then(|| count as f64 / tested as f64);
        Self {
            points: sums.points,
            undecided: tested as f64 / points,
            boxes_per_undecided: per_tested(sums.runs),
            triangles_per_undecided: per_tested(sums.triangles),
            by_cause: ByCause::of(|cause| sums.of(cause) as f64 / points),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_become_shares() {
        let report: EdgesReport = EdgeSums { points: 100, by_cause: [60, 30, 4, 5, 1], runs: 20, triangles: 60 }.into();
        assert_eq!((report.undecided, report.by_cause.dark, report.by_cause.filter), (0.1, 0.3, 0.01));
        assert_eq!((report.boxes_per_undecided, report.triangles_per_undecided), (Some(2.0), Some(6.0)));
        let nothing: EdgesReport = EdgeSums::default().into();
        assert_eq!((nothing.undecided, nothing.boxes_per_undecided), (0.0, None));
    }
}
