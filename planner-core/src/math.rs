//! The only door to floating-point functions.
//!
//! Host `std` and `libm` differ in the last bit for some inputs, so every function
//! here names its implementation by path: the same input then gives the same bits
//! on every target. `+ - * /` and comparisons are IEEE 754 everywhere and need no
//! door.

/// Square root; NaN below zero.
pub(crate) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Sine and cosine of an angle in radians.
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    (libm::sinf(angle), libm::cosf(angle))
}

/// e to the power `x`.
pub(crate) fn exp(x: f32) -> f32 {
    libm::expf(x)
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
pub(crate) fn heading(x: f32, y: f32) -> f32 {
    libm::atan2f(y, x)
}
