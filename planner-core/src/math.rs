//! The only door to floating-point functions.
//!
//! Host `std` and `libm` differ in the last bit for some inputs, so every function
//! here names its implementation by path: the same input then gives the same bits
//! on every target. `+ - * /` and comparisons are IEEE 754 everywhere and need no
//! door.
//!
//! With the feature `micromath` sine, cosine, exponential and arctangent are that
//! crate's approximations: less flash and less time, above all without a
//! floating-point unit; docs/survey-figures.md has figures. They too are the same bits on
//! every target, but other bits than `libm`'s. What must not be approximate stays exact:
//! square root and rounding, since the length of a step, the distance between robots
//! and the column of a point depend on them, and so is the direction of a beam.

#[cfg(feature = "micromath")]
use approximate as backend;
#[cfg(not(feature = "micromath"))]
use exact as backend;

pub(crate) use backend::{exp, heading, sin_cos};

/// Square root; NaN below zero.
pub(crate) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// The largest whole number not above `x`.
pub(crate) fn floor(x: f32) -> f32 {
    libm::floorf(x)
}

/// Length of the vector `(x, y)`.
pub(crate) fn length(x: f32, y: f32) -> f32 {
    sqrt(x * x + y * y)
}

/// Sine and cosine of an angle in radians, each within 1e-6, with either backend. In
/// single precision alone: `libm` reckons in doubles, in thousands of instructions on a
/// chip that has singles only. Beyond 8,192 radians within the rounding of the angle.
///
/// π/2 in three parts and the polynomials: Cephes, `sinf.c`.
pub(crate) fn direction(angle: f32) -> (f32, f32) {
    let angle = if angle.abs() > 8192.0 {
        libm::fmodf(angle, core::f32::consts::TAU)
    } else {
        angle
    };
    let quarters = floor(angle * core::f32::consts::FRAC_2_PI + 0.5);
    let x = ((angle - quarters * 1.570_312_5) - quarters * 4.837_513e-4) - quarters * 7.549_79e-8;
    let z = x * x;
    let sin = x + x * z * (-1.666_665_5e-1 + z * (8.332_161e-3 - z * 1.951_529_6e-4));
    let cos = 1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    match quarters as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(not(feature = "micromath"))]
mod exact {
    /// Sine and cosine of an angle in radians.
    pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
        libm::sincosf(angle)
    }

    /// e to the power `x`.
    pub(crate) fn exp(x: f32) -> f32 {
        libm::expf(x)
    }

    /// Angle of the vector `(x, y)` from the x axis, in `(-π, π]`; 0 for no vector.
    pub(crate) fn heading(x: f32, y: f32) -> f32 {
        libm::atan2f(y, x)
    }
}

#[cfg(feature = "micromath")]
mod approximate {
    // By its own type: where there is `std`, its methods would hide the trait's.
    use micromath::F32;

    /// Sine and cosine of an angle in radians, each within 0.002, of a vector of
    /// length 1 all the same: a step is never longer than it may be.
    pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
        let (sin, cos) = (F32(angle).sin().0, F32(angle).cos().0);
        let length = super::length(sin, cos);
        (sin / length, cos / length)
    }

    /// e to the power `x`, within 1 %.
    pub(crate) fn exp(x: f32) -> f32 {
        F32(x).exp().0
    }

    /// Angle of the vector `(x, y)` from the x axis, within 0.005; 0 for no vector.
    pub(crate) fn heading(x: f32, y: f32) -> f32 {
        if x == 0.0 && y == 0.0 {
            return 0.0;
        }
        F32(y).atan2(F32(x)).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both backends keep what the docs promise, `libm` trivially.
    #[test]
    fn functions_are_near_the_exact_ones() {
        for i in -3000i16..3000 {
            let x = f32::from(i) * 0.005;
            let (sin, cos) = sin_cos(x);
            assert!((sin - libm::sinf(x)).abs() < 2e-3, "{x}");
            assert!((cos - libm::cosf(x)).abs() < 2e-3, "{x}");
            assert!((length(sin, cos) - 1.0).abs() < 1e-6, "{x}");
            if x <= 0.0 {
                assert!(
                    (exp(x) - libm::expf(x)).abs() < 0.01 * libm::expf(x) + 1e-6,
                    "{x}"
                );
            }
            let (sin, cos) = (libm::sinf(x), libm::cosf(x));
            for length in [1e-3, 1.0, 200.0] {
                let angle = heading(length * cos, length * sin);
                let exact = libm::atan2f(sin, cos);
                // The two ends of the range are the same direction.
                let off = libm::fabsf(angle - exact);
                let off = off.min(libm::fabsf(off - core::f32::consts::TAU));
                assert!(off < 5e-3, "{x} {angle} {exact}");
            }
        }
        assert_eq!(heading(0.0, 0.0), 0.0);
    }

    /// Between whole numbers and at the borders of the quarters, of any size.
    #[test]
    fn directions_are_near_the_exact_ones() {
        let quarters = (-6000i16..6000).map(|i| f32::from(i) * core::f32::consts::FRAC_PI_4);
        let even = (-9000i16..9000).map(|i| f32::from(i) * 0.91);
        for angle in quarters
            .chain(even)
            .chain([0.0, -0.0, 1e-30, 0.7855, -3e-4])
        {
            let (sin, cos) = direction(angle);
            assert!((sin - libm::sinf(angle)).abs() < 1e-6, "{angle} {sin}");
            assert!((cos - libm::cosf(angle)).abs() < 1e-6, "{angle} {cos}");
        }
        for angle in [8193.0, -1e5, 1e9, f32::MAX] {
            let (sin, cos) = direction(angle);
            assert!((length(sin, cos) - 1.0).abs() < 1e-5, "{angle}");
        }
        assert!((direction(8193.0).0 - libm::sinf(8193.0)).abs() < 1e-3);
        for angle in [f32::INFINITY, f32::NAN] {
            let (sin, cos) = direction(angle);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }

    /// A digest of their bits: the same on every machine that this test runs on, and
    /// another one after an update that decides otherwise.
    #[test]
    fn functions_give_the_same_bits_everywhere() {
        let (mut digest, mut directions) = (0u32, 0u32);
        for i in -3000i16..3000 {
            let x = f32::from(i) * 0.005;
            let (sin, cos) = sin_cos(x);
            for value in [sin, cos, exp(x), heading(x, 1.5 - x), sqrt(x.abs())] {
                digest = digest.rotate_left(5) ^ value.to_bits();
            }
            let (sin, cos) = direction(x);
            for value in [sin, cos] {
                directions = directions.rotate_left(5) ^ value.to_bits();
            }
        }
        assert_eq!(directions, 0x3504_73fd, "{directions:#x}");
        let expected = match cfg!(feature = "micromath") {
            false => 0x153f_8a23,
            true => 0x9871_6419,
        };
        assert_eq!(digest, expected, "{digest:#x}");
    }
}
