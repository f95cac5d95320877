//! CAO's local model of an unknown objective: a polynomial of up to degree 3 in
//! position, fitted to a few measurements [Renzaglia2019 §4.1, eq. 3 to 5].
//!
//! With fewer measurements than monomials the least-squares problem of eq. 5 has
//! no unique solution, so a small ridge is added, and the system is solved in its
//! dual form: for `N` rows Φ the matrix K = ΦΦᵀ + λI is `N`×`N` instead of 20×20,
//! and ϑ = Φᵀ K⁻¹ y is the same minimiser at a quarter of the work.

mod history;
mod polynomial;

pub(crate) use history::History;
pub use polynomial::{Degree, TERMS};

use nalgebra::{SMatrix, SVector};
use polynomial::monomials;

use crate::point::Point;

/// One measurement of the objective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where it was taken.
    pub at: Point,
    /// What it was.
    pub value: f32,
    /// How much its squared residual counts; 1 in eq. 5.
    pub weight: f32,
}

/// The coordinates that the fit is done in: `(p - origin) * scale`. A good frame
/// keeps the samples within the unit ball; with raw coordinates the f32 system is
/// nearly always singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// What becomes 0.
    pub origin: Point,
    /// Per unit of length.
    pub scale: f32,
}

/// The fitted polynomial Ĵ [Renzaglia2019 eq. 3].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    frame: Frame,
    coefficients: [f32; TERMS],
}

impl Model {
    /// Fits a polynomial of `degree` to the first `N` of `samples`, with the ridge
    /// `ridge` > 0 added to the diagonal of K.
    ///
    /// `None` if there is no sample, if anything is not finite, or if K is not
    /// positive definite within f32. A returned model has finite coefficients.
    ///
    /// Cost: N²·20/2 multiplications for K, N³/6 for its factor.
    // [Renzaglia2019 eq. 5]
    pub fn fit<const N: usize>(
        samples: &[Sample],
        frame: Frame,
        degree: Degree,
        ridge: f32,
    ) -> Option<Self> {
        if samples.is_empty() || ridge.is_nan() || ridge <= 0.0 {
            return None;
        }
        // Rows without a sample stay zero: they add λ to the diagonal of K and
        // nothing to the result.
        let mut rows = SMatrix::<f32, N, TERMS>::zeros();
        let mut values = SVector::<f32, N>::zeros();
        for ((mut row, value), sample) in rows.row_iter_mut().zip(values.iter_mut()).zip(samples) {
            let root = crate::math::sqrt(sample.weight);
            let terms = monomials(frame, sample.at, degree);
            for (entry, term) in row.iter_mut().zip(terms) {
                *entry = term * root;
            }
            *value = sample.value * root;
        }
        let kernel = rows * rows.transpose() + SMatrix::<f32, N, N>::identity() * ridge;
        let dual = kernel.cholesky()?.solve(&values);
        let coefficients: [f32; TERMS] = (rows.transpose() * dual).into();
        coefficients.iter().all(|c| c.is_finite()).then_some(Self {
            frame,
            coefficients,
        })
    }

    /// Ĵ at `point`. May overflow to infinity far outside the samples.
    ///
    /// Cost: 36 multiplications.
    pub fn value(&self, point: Point) -> f32 {
        monomials(self.frame, point, Degree::Cubic)
            .iter()
            .zip(self.coefficients)
            .map(|(term, coefficient)| term * coefficient)
            .sum()
    }
}

#[cfg(test)]
mod tests;
