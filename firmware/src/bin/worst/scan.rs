//! From a range scan to a sighting.

use core::f32::consts::TAU;
use core::fmt::{self, Write as _};

use cortex_m_semihosting::hio;
use firmware::Stopwatch;
use planner_core::sight::{Beam, Bearing, MAX_RADIUS, Pose, RangeScan, RangeSensor};

use crate::Most;

/// Scans of each number of beams that are tried, each turned and placed otherwise.
const SCANS: u8 = 48;

/// Measures, and prints `name: value` lines.
pub(crate) fn measure(stopwatch: &Stopwatch) -> fmt::Result {
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    for count in [4, 16, 64] {
        let most = convert(stopwatch, count);
        writeln!(out, "worst_sighting_{count}_beams: {}", most.instructions())?;
    }
    Ok(())
}

/// Beams all around, as far as a sighting reaches: they hit at its very end, or nothing.
fn convert(stopwatch: &Stopwatch, count: u8) -> Most {
    let mut most = Most::default();
    let reach = f32::from(MAX_RADIUS);
    let mut beams = [Beam {
        bearing: Bearing::AHEAD,
        range: f32::INFINITY,
    }; 64];
    for (index, beam) in (0..count).zip(&mut beams) {
        beam.bearing = Bearing::from_radians(TAU * f32::from(index) / f32::from(count));
    }
    for number in 0..SCANS {
        let share = f32::from(number) / f32::from(SCANS);
        for beam in &mut beams {
            beam.range = if number % 2 == 0 {
                f32::INFINITY
            } else {
                reach
            };
        }
        let scan = RangeScan {
            pose: Pose {
                x: 64.0 + share,
                y: 64.0 + 7.0 * share % 1.0,
                // Diagonals cross most cells; the rest is tried for good measure, and
                // every eighth of the circle.
                heading: TAU / 8.0 * (f32::from(number % 8) - 4.0 + share / 4.0),
            },
            sensor: RangeSensor::new(reach + 1.0),
            beams: beams.iter().take(count.into()).copied(),
        };
        let sighting = most.of(stopwatch, || scan.sighting());
        core::hint::black_box(sighting.is_ok());
    }
    most
}
