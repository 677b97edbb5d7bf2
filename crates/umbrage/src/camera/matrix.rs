//! Matrices in the types that applications use.

use glam::{DAffine3, DMat4, Mat4};

/// A 4×4 matrix from any of the types that applications use: a `glam` matrix, a plain array of
/// columns, or, with the feature `mint`, that crate's matrices of columns or rows, in `f32` or
/// `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix(pub DMat4);

impl From<DMat4> for Matrix {
    fn from(matrix: DMat4) -> Self {
        Self(matrix)
    }
}

impl From<Mat4> for Matrix {
    fn from(matrix: Mat4) -> Self {
        Self(matrix.as_dmat4())
    }
}

impl From<&DAffine3> for Matrix {
    fn from(matrix: &DAffine3) -> Self {
        Self(DMat4::from(*matrix))
    }
}

impl From<[[f64; 4]; 4]> for Matrix {
    fn from(columns: [[f64; 4]; 4]) -> Self {
        Self(DMat4::from_cols_array_2d(&columns))
    }
}

impl From<[[f32; 4]; 4]> for Matrix {
    fn from(columns: [[f32; 4]; 4]) -> Self {
        Mat4::from_cols_array_2d(&columns).into()
    }
}

impl From<[f64; 16]> for Matrix {
    fn from(columns: [f64; 16]) -> Self {
        Self(DMat4::from_cols_array(&columns))
    }
}

impl From<[f32; 16]> for Matrix {
    fn from(columns: [f32; 16]) -> Self {
        Mat4::from_cols_array(&columns).into()
    }
}

/// Entries of a projection below this share of their row's largest are rounding: some ulps of
/// `f32`.
pub(super) const ROUNDING: f64 = 1e-6;

impl Matrix {
    /// The projection with zeros in those entries that are zero in every projection but for
    /// rounding.
    pub(super) fn without_rounding(self) -> DMat4 {
        let [mut x, mut y, mut z, mut w] = [0, 1, 2, 3].map(|i| self.0.row(i));
        let clear = |entry: &mut f64, beside: f64| {
            if entry.abs() <= ROUNDING * beside.abs() {
                *entry = 0.0;
            }
        };
        clear(&mut x.y, x.x);
        clear(&mut y.x, y.y);
        let (depth, scale) = (z.z.abs().max(z.w.abs()), w.z.abs().max(w.w.abs()));
        [&mut z.x, &mut z.y].into_iter().for_each(|entry| clear(entry, depth));
        [&mut w.x, &mut w.y, &mut w.z, &mut w.w].into_iter().for_each(|entry| clear(entry, scale));
        // A perspective projection moves nothing aside, an orthographic one turns nothing with
        // depth.
        let is_perspective = w.z != 0.0;
        clear(if is_perspective { &mut x.w } else { &mut x.z }, x.x);
        clear(if is_perspective { &mut y.w } else { &mut y.z }, y.y);
        DMat4::from_cols(x, y, z, w).transpose()
    }
}
