//! Decomposition of matrices into translations, rotations and scales.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::Trs;

/// Least shear (cosine between axes) that is not taken for rounding. Ours: six printed digits of a
/// rotation make 1e-6.
const LEAST_SHEAR: f64 = 1e-5;

/// Decomposes a matrix into one [`Trs`], or into two (outer, inner) if it shears, which one cannot:
/// by the singular value decomposition `M = U Σ Vᵀ` it is a rotation after a scale after a
/// rotation.
pub(super) fn decompose(parent_from_local: DAffine3) -> (Trs, Option<Trs>) {
    let m = parent_from_local.matrix3;
    let translation = parent_from_local.translation;
    let axes = [m.x_axis, m.y_axis, m.z_axis];
    let unit = axes.map(DVec3::normalize_or_zero);
    let shear = unit[0].dot(unit[1]).abs().max(unit[1].dot(unit[2]).abs()).max(unit[2].dot(unit[0]).abs());
    if shear <= LEAST_SHEAR {
        let (rotation, scale) = rotation_and_scale(axes);
        return (Trs { translation, rotation, scale }, None);
    }
    let v = eigenvectors(m.transpose() * m);
    let v = if v.determinant() < 0.0 { DMat3::from_cols(-v.x_axis, v.y_axis, v.z_axis) } else { v };
    let mv = m * v;
    let (rotation, scale) = rotation_and_scale([mv.x_axis, mv.y_axis, mv.z_axis]);
    let inner = Trs { rotation: DQuat::from_mat3(&v.transpose()).normalize(), ..Trs::IDENTITY };
    (Trs { translation, rotation, scale }, Some(inner))
}

/// Converts orthogonal axes to a rotation and lengths. The last length is negative if the axes
/// mirror. Axes may be zero.
fn rotation_and_scale(axes: [DVec3; 3]) -> (DQuat, DVec3) {
    let mut lengths = axes.map(DVec3::length);
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    let is_flat = lengths.map(|length| length <= largest * 1e-12);
    let mut unit = axes.map(DVec3::normalize_or_zero);
    match is_flat {
        [false, false, false] => {
            if unit[0].cross(unit[1]).dot(unit[2]) < 0.0 {
                unit[2] = -unit[2];
                lengths[2] = -lengths[2];
            }
        }
        [true, true, true] => unit = [DVec3::X, DVec3::Y, DVec3::Z],
        _ => {
            // The first axis with a length, then one across it: the second with a length, or any.
            let first = is_flat.iter().position(|flat| !flat).expect("some axis has a length");
            let (second, third) = ((first + 1) % 3, (first + 2) % 3);
            match (is_flat[second], is_flat[third]) {
                (false, _) => {}
                (true, false) => unit[second] = unit[third].cross(unit[first]),
                (true, true) => unit[second] = unit[first].any_orthonormal_vector(),
            }
            unit[third] = unit[first].cross(unit[second]);
        }
    }
    // Remove the shear below the threshold, so that the quaternion is that of a rotation.
    let x = unit[0];
    let z = x.cross(unit[1]).normalize();
    let rotation = DMat3::from_cols(x, z.cross(x), z);
    (DQuat::from_mat3(&rotation).normalize(), DVec3::from(lengths))
}

/// Computes orthonormal eigenvectors of a symmetric matrix by cyclic Jacobi rotations (Golub and
/// Van Loan, *Matrix Computations*, section 8.5).
fn eigenvectors(symmetric: DMat3) -> DMat3 {
    let mut a = symmetric.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    // Convergence is quadratic; eight sweeps are twice what any 3×3 matrix needs.
    for _ in 0..8 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = t.hypot(1.0).recip();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for i in 0..3 {
                (a[p][i], a[q][i]) = (c * a[p][i] - s * a[q][i], s * a[p][i] + c * a[q][i]);
                (v[p][i], v[q][i]) = (c * v[p][i] - s * v[q][i], s * v[p][i] + c * v[q][i]);
            }
        }
    }
    DMat3::from_cols_array_2d(&v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn recompose((outer, inner): (Trs, Option<Trs>)) -> DAffine3 {
        outer.to_affine() * inner.map_or(DAffine3::IDENTITY, Trs::to_affine)
    }

    fn assert_same(m: DAffine3) {
        let parts = decompose(m);
        let back = recompose(parts);
        let size = m.matrix3.to_cols_array().iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        assert!((back.matrix3 - m.matrix3).to_cols_array().iter().all(|d| d.abs() <= 2e-5 * size), "{m:?} {back:?}");
        assert_eq!(back.translation, m.translation);
        assert!(parts.0.rotation.is_normalized() && parts.1.is_none_or(|inner| inner.rotation.is_normalized()));
    }

    #[test]
    fn plain_matrices_need_one_part() {
        for scale in [DVec3::ONE, DVec3::new(2.0, 0.5, 3.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 0.0, 1.0)] {
            let rotation = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.2, 2.5);
            let m = DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::new(1.0, 2.0, 3.0));
            assert!(decompose(m).1.is_none());
            assert_same(m);
        }
        assert_same(DAffine3::from_mat3(DMat3::ZERO));
        assert_same(DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(0.0, 0.0, -2.0))));
    }

    #[test]
    fn shear_needs_two() {
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.7, 1.0, 0.0), DVec3::Z);
        assert!(decompose(DAffine3::from_mat3(shear)).1.is_some());
        assert_same(DAffine3::from_mat3(shear));
    }

    proptest! {
        #[test]
        fn any_matrix_comes_back(m in prop::array::uniform9(prop_oneof![3 => -5.0..5.0, 1 => Just(0.0), 1 => Just(1.0)])) {
            assert_same(DAffine3::from_mat3(DMat3::from_cols_array(&m)));
        }
    }
}
