//! Symmetric systems of a few equations, by Cholesky's factor.

use crate::math;

/// A matrix, column by column.
pub(super) type Matrix<const N: usize> = [[f32; N]; N];

/// The `x` of `matrix · x = right`. Of the matrix, which is symmetric, only the lower
/// triangle is read. `None` if it is not positive definite within f32.
///
/// Cost: N³/6 multiplications for the factor, N² for both triangles.
pub(super) fn solve<const N: usize>(
    mut matrix: Matrix<N>,
    mut right: [f32; N],
) -> Option<[f32; N]> {
    factorise(&mut matrix)?;
    for (i, column) in matrix.iter().enumerate() {
        let (known, rest) = right.get_mut(i..)?.split_first_mut()?;
        let (diagonal, below) = column.get(i..)?.split_first()?;
        *known /= diagonal;
        subtract(rest, *known, below);
    }
    for (i, column) in matrix.iter().enumerate().rev() {
        let (unknown, known) = right.get_mut(i..)?.split_first_mut()?;
        let (diagonal, below) = column.get(i..)?.split_first()?;
        *unknown = (*unknown - dot(below, known)) / diagonal;
    }
    Some(right)
}

/// Puts the factor L of `matrix` = LLᵀ into its lower triangle.
fn factorise<const N: usize>(matrix: &mut Matrix<N>) -> Option<()> {
    for j in 0..N {
        let (before, column) = matrix.split_at_mut_checked(j)?;
        let column = column.first_mut()?.get_mut(j..)?;
        for left in before {
            let left = left.get(j..)?;
            subtract(column, *left.first()?, left);
        }
        let (diagonal, below) = column.split_first_mut()?;
        *diagonal = math::sqrt(Some(*diagonal).filter(|square| *square > 0.0)?);
        below.iter_mut().for_each(|entry| *entry /= *diagonal);
    }
    Some(())
}

/// Takes `factor` times the others off the entries.
fn subtract(entries: &mut [f32], factor: f32, others: &[f32]) {
    for (entry, other) in entries.iter_mut().zip(others) {
        *entry -= factor * other;
    }
}

/// Σ aᵢ·bᵢ; whole eights in sums side by side, as vector units do it.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks(), b.as_chunks());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip::<&[f32; 8]>(a).zip::<&[f32; 8]>(b) {
            *sum += a * b;
        }
    }
    let [s0, s1, s2, s3, s4, s5, s6, s7] = sums;
    let whole = [s0 + s4, s1 + s5, s2 + s6, s3 + s7];
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| a * b);
    whole
        .into_iter()
        .chain(rest)
        .fold(0.0, |sum, term| sum + term)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With the factor 5, 3, 1 on the diagonal and whole numbers all is exact.
    #[test]
    fn the_solution_solves() {
        let matrix = [[25.0, 15.0, -5.0], [15.0, 18.0, 0.0], [-5.0, 0.0, 11.0]];
        assert_eq!(solve(matrix, [35.0, 33.0, 6.0]), Some([1.0, 1.0, 1.0]));
    }

    #[test]
    fn what_is_not_positive_definite_has_none() {
        for matrix in [[[0.0; 2]; 2], [[1.0, 2.0], [2.0, 1.0]], [[f32::NAN; 2]; 2]] {
            assert_eq!(solve(matrix, [1.0, 1.0]), None);
        }
    }

    #[test]
    fn long_sums_are_whole() {
        let numbers: [f32; 19] = core::array::from_fn(|i| i as f32);
        for length in 0..=19 {
            let squares = numbers[..length].iter().map(|a| a * a).sum::<f32>();
            assert_eq!(dot(&numbers[..length], &numbers[..length]), squares);
        }
    }
}
