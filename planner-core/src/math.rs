//! The only door to floating-point functions: `libm` by path, so that host and
//! target agree in the last bit. (`std`'s `sin` and its kin do not.)

/// Sine of an angle in radians.
pub(crate) fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine of an angle in radians.
pub(crate) fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// The largest integer not above `x`.
pub(crate) fn floor(x: f32) -> f32 {
    libm::floorf(x)
}
