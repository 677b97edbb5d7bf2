//! Rectangles of whole texels or cells.

/// A rectangle of a grid: from `min` to `max`, which is not included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The first column and row.
    pub min: [i64; 2],
    /// One past the last column and row.
    pub max: [i64; 2],
}

impl Area {
    /// A square.
    pub(super) fn square(min: [i64; 2], edge: i64) -> Self {
        Self { min, max: min.map(|at| at + edge) }
    }

    /// Returns whether the rectangles share a texel.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.min[axis] < other.max[axis] && other.min[axis] < self.max[axis])
    }

    /// Number of columns and of rows.
    #[must_use]
    pub fn edges(&self) -> [u32; 2] {
        [0, 1].map(|axis| (self.max[axis] - self.min[axis]) as u32)
    }

    /// Number of texels.
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.edges().map(u64::from).iter().product()
    }

    /// Iterates over every column and row, row after row.
    pub(super) fn each(self) -> impl Iterator<Item = [i64; 2]> {
        (self.min[1]..self.max[1]).flat_map(move |y| (self.min[0]..self.max[0]).map(move |x| [x, y]))
    }
}
