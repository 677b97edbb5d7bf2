//! Transcendental functions that give the same bits on every machine.
//!
//! The standard library leaves `sin`, `powf` and similar functions to the C library of the system,
//! whose last bits differ between systems. A plan must not differ: the planner compares maps with
//! earlier plans, and recorded plans, tests and peers of a network compare bits. The functions here
//! are those of `libm`, which are compiled into the program. `sqrt`, `floor`, `round` and
//! `to_radians` are exactly defined and are those of the standard library; `clippy.toml` lists the
//! functions that must not be called in this crate.

use glam::DVec3;

/// 2 to the power of `x`.
pub(crate) fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// The logarithm of `x` to base 2.
pub(crate) fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// `base` to the power of `exponent`.
pub(crate) fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// The tangent of an angle in radians.
pub(crate) fn tan(angle: f64) -> f64 {
    libm::tan(angle)
}

/// The cosine of an angle in radians.
pub(crate) fn cos(angle: f64) -> f64 {
    libm::cos(angle)
}

/// Sine and cosine of an angle in radians.
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// Length of the hypotenuse over two legs. Neither leg may be so large or so small that its square
/// overflows or vanishes; legs of views are between 10^-9 and 10^12.
pub(crate) fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Angle between two unit vectors in radians; also precise for small angles.
pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Logarithm of `x` to base 2, rounded down. Subnormal numbers and 0 count as 2^-1023, infinity as
/// 2^1024.
pub(crate) fn doubling(x: f64) -> i32 {
    let exponent = x.to_bits() >> (f64::MANTISSA_DIGITS - 1) & 0x7ff;
    exponent as i32 - (f64::MAX_EXP - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bits are those of `libm`, on every machine that runs this test.
    #[test]
    fn bits_are_the_same_everywhere() {
        let bits = [
            exp2(0.3),
            log2(10.0),
            pow(1000.0, 0.25),
            tan(0.7),
            cos(0.7),
            sin_cos(2.0).0,
            sin_cos(2.0).1,
            angle_between(DVec3::X, DVec3::new(0.6, 0.8, 0.0)),
        ]
        .map(f64::to_bits);
        assert_eq!(bits.map(|it| format!("{it:016x}")), BITS);
    }

    const BITS: [&str; 8] = [
        "3ff3b2c47bff8329",
        "400a934f0979a371",
        "40167e600b234626",
        "3feaf406c2fc78ae",
        "3fe87996529f9d93",
        "3fed18f6ead1b446",
        "bfdaa22657537205",
        "3fedac670561bb50",
    ];

    #[test]
    fn powers_of_two_are_exact() {
        for k in -60..60 {
            let power = exp2(f64::from(k));
            assert_eq!((power, log2(power)), (2f64.powi(k), f64::from(k)));
            assert_eq!(doubling(power), k);
            assert_eq!(doubling(power.next_down()), k - 1);
            assert_eq!(doubling(1.5 * power), k);
        }
        assert_eq!((doubling(0.0), doubling(f64::INFINITY)), (-1023, 1024));
    }

    #[test]
    fn small_angles_are_precise() {
        for angle in [1e-9, 1e-5, 0.1, 1.0, 3.0] {
            let (sin, cos) = sin_cos(angle);
            let found = angle_between(DVec3::X, DVec3::new(cos, sin, 0.0));
            assert!((found - angle).abs() <= 1e-15 * angle.max(0.5), "{found} instead of {angle}");
        }
    }
}
