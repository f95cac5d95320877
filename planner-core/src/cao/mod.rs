//! CAO's local model of an unknown objective: a polynomial of up to degree 3 in
//! position, fitted to a few measurements [Renzaglia2019 §4.1, eq. 3 to 5].
//!
//! With fewer measurements than monomials the least-squares problem of eq. 5 has
//! no unique solution, so a small ridge is added, and the system is solved in its
//! dual form: for `N` rows Φ the matrix K = ΦΦᵀ + λI is `N`×`N` instead of 20×20,
//! and ϑ = Φᵀ K⁻¹ y is the same minimiser at a quarter of the work.

mod cholesky;
mod history;
mod polynomial;

pub(crate) use history::History;
pub use polynomial::{Degree, TERMS};

use polynomial::monomials;

use crate::math;
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
        let is_usable = ridge > 0.0 && ridge.is_finite();
        if samples.is_empty() || !is_usable {
            return None;
        }
        // Rows without a sample stay zero: they add λ to the diagonal of K and
        // nothing to the result.
        let mut rows = [[0.0; TERMS]; N];
        let mut values = [0.0; N];
        for ((row, value), sample) in rows.iter_mut().zip(&mut values).zip(samples) {
            let root = math::sqrt(sample.weight);
            *row = monomials(frame, sample.at, degree).map(|term| term * root);
            *value = sample.value * root;
        }
        let mut kernel: cholesky::Matrix<N> = [[0.0; N]; N];
        for (j, (column, right)) in kernel.iter_mut().zip(&rows).enumerate() {
            for (entry, left) in column.iter_mut().zip(&rows).skip(j) {
                *entry = left.iter().zip(right).map(|(a, b)| a * b).sum();
            }
            if let Some(diagonal) = column.get_mut(j) {
                *diagonal += ridge;
            }
        }
        let dual = cholesky::solve(kernel, values)?;
        let mut coefficients = [0.0; TERMS];
        for (row, factor) in rows.iter().zip(dual) {
            for (coefficient, term) in coefficients.iter_mut().zip(row) {
                *coefficient += term * factor;
            }
        }
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
