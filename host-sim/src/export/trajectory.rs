//! Ways as trajectories that the high-level commander of a Crazyflie loads: one line a
//! segment, its duration and the eight coefficients of the polynomials of x, y, z and yaw,
//! as the tools of `uav_trajectories` read and write them.
//!
//! Every leg begins and ends at rest, so that all turns are flown to, in a straight line. The
//! first one is the take-off, from the ground under the start; a way that leads back there ends
//! with the landing.

use std::io::{self, Write};

use super::Way;

/// The first line.
const HEADER: &str = "duration,\
    x^0,x^1,x^2,x^3,x^4,x^5,x^6,x^7,\
    y^0,y^1,y^2,y^3,y^4,y^5,y^6,y^7,\
    z^0,z^1,z^2,z^3,z^4,z^5,z^6,z^7,\
    yaw^0,yaw^1,yaw^2,yaw^3,yaw^4,yaw^5,yaw^6,yaw^7";

/// Of the way from 0 to 1 in a unit of time: from rest to rest, without acceleration and
/// jerk at both ends.
const REST_TO_REST: [f64; 8] = [0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0];

/// Its greatest speed, in the middle.
const PEAK: f64 = 35.0 / 16.0;

/// A part of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Seconds.
    pub duration: f64,
    /// Coefficients of x, y and z in metres, the constant first.
    pub axes: [[f64; 8]; 3],
}

/// The segments of a way in metres that is nowhere flown faster than `speed`, in metres a
/// second.
pub fn segments(way: &[[f64; 3]], speed: f64) -> Vec<Segment> {
    let segment = |leg: &[[f64; 3]]| {
        let (from, to) = (leg[0], leg[1]);
        let sides = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let length = sides.iter().map(|side| side * side).sum::<f64>().sqrt();
        let duration = PEAK * length / speed;
        let axes = [0, 1, 2].map(|axis| {
            let mut time = 1.0;
            let mut axes = REST_TO_REST.map(|share| {
                // Without a negative 0.
                let coefficient = sides[axis] * share / time + 0.0;
                time *= duration;
                coefficient
            });
            axes[0] = from[axis];
            axes
        });
        Segment { duration, axes }
    };
    way.windows(2).map(segment).collect()
}

/// Writes the way of one robot as a trajectory; its yaw stays 0.
///
/// # Errors
/// Those of `to`.
pub fn trajectory(way: &Way, speed: f64, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "{HEADER}")?;
    let ground = way.places.first().map(|&[x, y, _]| [x, y, way.ground]);
    let places = ground.iter().chain(&way.places).copied();
    let mut places: Vec<_> = places.chain(way.landing()).collect();
    places.dedup();
    for Segment { duration, axes } in segments(&places, speed) {
        write!(to, "{duration}")?;
        for coefficient in axes.as_flattened() {
            write!(to, ",{coefficient}")?;
        }
        writeln!(to, "{}", ",0".repeat(8))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Value and derivatives of a polynomial, up to the third.
    fn at(polynomial: [f64; 8], time: f64) -> [f64; 4] {
        let mut derivative = polynomial;
        std::array::from_fn(|_| {
            let value = derivative.iter().rev().fold(0.0, |sum, c| sum * time + c);
            for power in 1..8 {
                derivative[power - 1] = derivative[power] * power as f64;
            }
            derivative[7] = 0.0;
            value
        })
    }

    fn way() -> impl Strategy<Value = Vec<[f64; 3]>> {
        let point = prop::array::uniform3(-50.0..50.0f64);
        prop::collection::vec(point, 2..9)
    }

    proptest! {
        #[test]
        fn a_trajectory_is_smooth_straight_and_never_too_fast(
            way in way(), speed in 0.1..10.0f64,
        ) {
            let segments = segments(&way, speed);
            prop_assert_eq!(segments.len(), way.len() - 1);
            for (segment, leg) in segments.iter().zip(way.windows(2)) {
                let end = segment.duration;
                for ((polynomial, from), to) in segment.axes.iter().zip(leg[0]).zip(leg[1]) {
                    let (first, last) = (at(*polynomial, 0.0), at(*polynomial, end));
                    prop_assert!((first[0] - from).abs() < 1e-9);
                    prop_assert!((last[0] - to).abs() < 1e-9);
                    for derivative in 1..4 {
                        prop_assert!(first[derivative].abs() < 1e-9);
                        prop_assert!(last[derivative].abs() < 1e-7 * speed.powi(3).max(1.0));
                    }
                }
                let mut fastest = 0.0f64;
                for step in 0..=64 {
                    let time = end * f64::from(step) / 64.0;
                    let of = segment.axes.map(|axis| at(axis, time));
                    let speed = of.iter().map(|it| it[1] * it[1]).sum::<f64>().sqrt();
                    fastest = fastest.max(speed);
                    // On the line between both ends.
                    let share = |axis: usize| of[axis][0] - leg[0][axis];
                    let side = |axis: usize| leg[1][axis] - leg[0][axis];
                    prop_assert!((share(0) * side(1) - share(1) * side(0)).abs() < 1e-6);
                    prop_assert!((share(0) * side(2) - share(2) * side(0)).abs() < 1e-6);
                }
                prop_assert!(fastest <= speed * (1.0 + 1e-9));
                prop_assert!(fastest >= speed * (1.0 - 1e-9), "it could be faster");
            }
        }
    }

    #[test]
    fn a_line_has_a_duration_and_four_times_eight_numbers() {
        let mut file = Vec::new();
        let mut way = Way {
            places: vec![[1.0, 2.0, 0.5], [1.0, 2.0, 16.5]],
            ground: 0.5,
            is_ground_known: true,
            cell: 1.0,
        };
        trajectory(&way, 35.0, &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[0].split(',').count(), 33);
        assert_eq!(
            lines[1],
            "1,1,0,0,0,0,0,0,0,2,0,0,0,0,0,0,0,0.5,0,0,0,560,-1344,1120,-320,0,0,0,0,0,0,0,0"
        );
        assert_eq!(lines.len(), 2);
        // From the ground, back home, and down again.
        way.ground = -0.5;
        way.places.push(way.places[0]);
        let mut file = Vec::new();
        trajectory(&way, 35.0, &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        assert_eq!(text.lines().count(), 1 + 4);
    }
}
