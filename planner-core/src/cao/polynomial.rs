//! The monomials φ of eq. 4.

use super::Frame;
use crate::point::Point;

/// Number of monomials of degree at most 3 in three variables.
pub const TERMS: usize = 20;

/// Highest degree of the polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Degree {
    /// 4 terms.
    Linear,
    /// 10 terms.
    Quadratic,
    /// 20 terms, as published.
    Cubic,
}

impl Degree {
    /// Number of terms; φ lists them by degree, so a lower degree is a prefix.
    pub const fn terms(self) -> usize {
        match self {
            Self::Linear => 4,
            Self::Quadratic => 10,
            Self::Cubic => TERMS,
        }
    }
}

/// φ at `point`; the terms above `degree` are 0.
// [Renzaglia2019 eq. 4]
pub(super) fn monomials(frame: Frame, point: Point, degree: Degree) -> [f32; TERMS] {
    let x = (point.x - frame.origin.x) * frame.scale;
    let y = (point.y - frame.origin.y) * frame.scale;
    let z = (point.z - frame.origin.z) * frame.scale;
    let (xx, xy, xz, yy, yz, zz) = (x * x, x * y, x * z, y * y, y * z, z * z);
    let mut terms = [
        1.0, //
        x,
        y,
        z, //
        xx,
        xy,
        xz,
        yy,
        yz,
        zz, //
        xx * x,
        xx * y,
        xx * z,
        xy * y,
        xy * z,
        xz * z,
        yy * y,
        yy * z,
        yz * z,
        zz * z,
    ];
    for term in terms.iter_mut().skip(degree.terms()) {
        *term = 0.0;
    }
    terms
}
