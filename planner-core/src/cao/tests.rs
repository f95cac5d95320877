use std::vec::Vec;

use proptest::prelude::*;

use super::polynomial::monomials;
use super::*;

const ORIGIN: Frame = Frame {
    origin: Point::new(0.0, 0.0, 0.0),
    scale: 1.0,
};

fn samples_of(points: &[(f32, f32, f32, f32)]) -> Vec<Sample> {
    points
        .iter()
        .map(|&(x, y, z, value)| Sample {
            at: Point::new(x, y, z),
            value,
            weight: 1.0,
        })
        .collect()
}

/// The same minimiser by the normal equations (ΦᵀΦ + λI) ϑ = Φᵀy, in f64.
fn primal(samples: &[Sample], frame: Frame, ridge: f64) -> Vec<f64> {
    let mut normal = SMatrix::<f64, TERMS, TERMS>::identity() * ridge;
    let mut right = SVector::<f64, TERMS>::zeros();
    for sample in samples {
        let row = SVector::from(monomials(frame, sample.at, Degree::Cubic)).cast::<f64>();
        normal += row * row.transpose();
        right += row * f64::from(sample.value);
    }
    let theta = normal.cholesky().unwrap().solve(&right);
    theta.iter().copied().collect()
}

fn in_unit_ball() -> impl Strategy<Value = (f32, f32, f32, f32)> {
    (-0.57f32..0.57, -0.57f32..0.57, -0.57f32..0.57, -1.0f32..1.0)
}

proptest! {
    /// Dual f32 = primal f64, in the values that the planner compares.
    #[test]
    fn the_dual_solution_is_the_primal_one(
        points in prop::collection::vec(in_unit_ball(), 1..=8),
        probe in in_unit_ball(),
    ) {
        let samples = samples_of(&points);
        let ridge = 1e-4 * samples.len() as f32;
        let model = Model::fit::<8>(&samples, ORIGIN, Degree::Cubic, ridge).unwrap();
        let oracle = primal(&samples, ORIGIN, f64::from(ridge));
        let at = Point::new(probe.0, probe.1, probe.2);
        let expected: f64 = monomials(ORIGIN, at, Degree::Cubic)
            .iter()
            .zip(&oracle)
            .map(|(&term, theta)| f64::from(term) * theta)
            .sum();
        prop_assert!((f64::from(model.value(at)) - expected).abs() < 2e-2, "{} {expected}", model.value(at));
    }

    /// Unused rows change nothing beyond rounding.
    #[test]
    fn a_larger_capacity_is_the_same_fit(
        points in prop::collection::vec(in_unit_ball(), 1..=8),
        probe in in_unit_ball(),
    ) {
        let samples = samples_of(&points);
        let at = Point::new(probe.0, probe.1, probe.2);
        let tight = Model::fit::<8>(&samples, ORIGIN, Degree::Cubic, 1e-3).unwrap();
        let roomy = Model::fit::<16>(&samples, ORIGIN, Degree::Cubic, 1e-3).unwrap();
        prop_assert!((tight.value(at) - roomy.value(at)).abs() < 1e-3);
    }

    /// No NaN out, whatever goes in.
    #[test]
    fn a_model_is_finite_or_absent(
        points in prop::collection::vec(
            (any::<f32>(), any::<f32>(), any::<f32>(), any::<f32>()), 0..=8),
        scale in any::<f32>(),
        ridge in any::<f32>(),
    ) {
        let frame = Frame { scale, ..ORIGIN };
        if let Some(model) = Model::fit::<8>(&samples_of(&points), frame, Degree::Cubic, ridge) {
            prop_assert!(model.coefficients.iter().all(|c| c.is_finite()));
        }
    }
}

/// Histories that stand still, lie on a line or go back and forth still give a fit.
#[test]
fn degenerate_histories_are_fitted() {
    let still = [(0.0, 0.0, 0.0); 8];
    let line: [_; 8] = core::array::from_fn(|i| (i as f32 / 8.0, 0.0, 0.0));
    let back_and_forth: [_; 8] = core::array::from_fn(|i| (0.0, (i % 2) as f32, 0.5));
    for history in [still, line, back_and_forth] {
        let points: Vec<_> = history
            .iter()
            .enumerate()
            .map(|(i, &(x, y, z))| (x, y, z, i as f32 * 0.1))
            .collect();
        let samples = samples_of(&points);
        let model = Model::fit::<8>(&samples, ORIGIN, Degree::Cubic, 8e-4).unwrap();
        assert!(model.value(Point::new(0.3, 0.3, 0.3)).is_finite());
    }
}

/// With noiseless values of a plane and a tiny ridge, the plane comes back.
#[test]
fn a_plane_is_recovered() {
    let points: Vec<_> = [
        (0.5, 0.0, 0.0),
        (0.0, 0.5, 0.0),
        (0.0, 0.0, 0.5),
        (0.0, 0.0, 0.0),
    ]
    .iter()
    .map(|&(x, y, z): &(f32, f32, f32)| (x, y, z, 1.0 + 2.0 * x - y + 3.0 * z))
    .collect();
    let model = Model::fit::<8>(&samples_of(&points), ORIGIN, Degree::Linear, 1e-5).unwrap();
    let at = Point::new(0.25, 0.25, -0.25);
    assert!((model.value(at) - 0.5).abs() < 1e-3, "{}", model.value(at));
}

#[test]
fn nothing_to_fit_is_no_model() {
    assert_eq!(Model::fit::<8>(&[], ORIGIN, Degree::Cubic, 1e-3), None);
    let one = samples_of(&[(0.0, 0.0, 0.0, 1.0)]);
    assert_eq!(Model::fit::<8>(&one, ORIGIN, Degree::Cubic, 0.0), None);
    assert_eq!(Model::fit::<8>(&one, ORIGIN, Degree::Cubic, f32::NAN), None);
}
