//! A step of the planners that fly.

use core::fmt::{self, Write as _};

use cortex_m_semihosting::hio;
use firmware::Stopwatch;
use planner_core::Point;
use planner_core::cao::{Degree, Frame, Model, Sample};
use planner_core::rng::Rng;

use crate::Most;

/// Measures, and prints a `name: value` line.
pub(crate) fn measure(stopwatch: &Stopwatch) -> fmt::Result {
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    let step = optimise(stopwatch);
    writeln!(out, "worst_cao_step: {}", step.instructions())
}

/// CAO alone: a fit to a full history, and the best of 100 candidates.
fn optimise(stopwatch: &Stopwatch) -> Most {
    let mut most = Most::default();
    let mut rng = Rng::new(1, 0);
    let here = Point::new(50.0, 50.0, 5.0);
    for _ in 0..20 {
        let samples: [Sample; 8] = core::array::from_fn(|_| {
            let (x, y, z) = rng.direction();
            Sample {
                at: here.offset(8.0 * x, 8.0 * y, 8.0 * z),
                value: 30.0 * rng.unit(),
                weight: 1.0,
            }
        });
        most.of(stopwatch, || {
            let frame = Frame {
                origin: here,
                scale: 1.0 / 8.0,
            };
            let model = Model::fit::<8>(&samples, frame, Degree::Cubic, 8e-4)?;
            let mut best = (f32::MIN, here);
            for _ in 0..100 {
                let (x, y, z) = rng.direction();
                let to = here.offset(2.0 * x, 2.0 * y, 2.0 * z);
                let value = model.value(to);
                if value > best.0 {
                    best = (value, to);
                }
            }
            Some(core::hint::black_box(best))
        });
    }
    most
}
