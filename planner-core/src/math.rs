//! The only door to floating-point functions.
//!
//! Host `std` and `libm` differ in the last bit for some inputs, so every function
//! here names its implementation by path: the same input then gives the same bits
//! on every target. `+ - * /` and comparisons are IEEE 754 everywhere and need no
//! door.
//!
//! With the feature `micromath` sine, cosine, exponential and arctangent are that
//! crate's approximations, for chips without a floating-point unit or with little
//! flash. They too are the same bits everywhere, but other bits than `libm`'s: a
//! fleet uses one of the two. Square root and rounding stay exact, since the length
//! of a step, the distance between robots and the column of a point depend on them.

/// Square root; NaN below zero.
pub(crate) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Sine and cosine of an angle in radians.
#[cfg(not(feature = "micromath"))]
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    (libm::sinf(angle), libm::cosf(angle))
}

/// Sine and cosine of an angle in radians, within 0.002; the vector has length 1 all
/// the same.
#[cfg(feature = "micromath")]
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    let angle = micromath::F32(angle);
    let (sin, cos) = (angle.sin().0, angle.cos().0);
    let length = length(sin, cos);
    (sin / length, cos / length)
}

/// e to the power `x`.
#[cfg(not(feature = "micromath"))]
pub(crate) fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// e to the power `x`, within 1 %.
#[cfg(feature = "micromath")]
pub(crate) fn exp(x: f32) -> f32 {
    micromath::F32(x).exp().0
}

/// The largest whole number not above `x`.
pub(crate) fn floor(x: f32) -> f32 {
    libm::floorf(x)
}

/// Length of the vector `(x, y)`.
pub(crate) fn length(x: f32, y: f32) -> f32 {
    sqrt(x * x + y * y)
}

/// Angle of the vector `(x, y)` from the x axis, in `(-π, π]`; 0 for no vector.
#[cfg(not(feature = "micromath"))]
pub(crate) fn heading(x: f32, y: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Angle of the vector `(x, y)` from the x axis, within 0.01 of `(-π, π]`; 0 for no
/// vector.
#[cfg(feature = "micromath")]
pub(crate) fn heading(x: f32, y: f32) -> f32 {
    if x == 0.0 && y == 0.0 {
        return 0.0;
    }
    micromath::F32(y).atan2(micromath::F32(x)).0
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
            let angle = heading(cos, sin);
            let exact = libm::atan2f(sin, cos);
            assert!((angle - exact).abs() < 0.01, "{x} {angle} {exact}");
        }
        assert_eq!(heading(0.0, 0.0), 0.0);
    }
}
