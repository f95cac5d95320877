//! Ways in metres: where robots started, turned and ended.

use planner_core::Point;
use planner_core::volume::Voxel;

use crate::record::heights::Trace;
use crate::record::voxels::VoxelTrace;

/// Cosine of the largest angle between two flights in the same direction: rounding.
const STRAIGHT: f64 = 1.0 - 1e-9;

/// The way of one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Where it started, turned and ended.
    pub places: Vec<[f64; 3]>,
    /// Height of what is under its start.
    pub ground: f64,
}

impl Way {
    /// Where the robot lands: on the ground under its start, if the way leads back there.
    pub fn landing(&self) -> Option<[f64; 3]> {
        match self.places[..] {
            [first, .., last] if first == last => Some([first[0], first[1], self.ground]),
            _ => None,
        }
    }
}

/// The way of a robot among voxels; `None` if the scene has no metres.
pub fn among_voxels(trace: &VoxelTrace, robot: usize) -> Option<Way> {
    let frame = trace.scene.frame()?;
    let way = trace.ways[robot].iter();
    let start = trace.ways[robot][0];
    let below = (0..start.z).rev().map(|z| Voxel { z, ..start });
    let floor = below.take_while(|at| !trace.scene.is_solid(*at)).last();
    let [_, _, middle] = frame.middle(floor.unwrap_or(start));
    Some(Way {
        places: turns(way.map(|&voxel| frame.middle(voxel))),
        ground: middle - frame.voxel_size / 2.0,
    })
}

/// The way of a robot over heights; `None` if the terrain has no metres.
pub fn over_heights(trace: &Trace, robot: usize) -> Option<Way> {
    let scale = trace.terrain.scale()?;
    let way = trace.way(robot, u32::MAX);
    let start = *way.first()?;
    let height = trace.terrain.height(start.cell())?;
    let [_, _, ground] = scale.metres(Point {
        z: height.cells(),
        ..start
    });
    Some(Way {
        places: turns(way.into_iter().map(|at| scale.metres(at))),
        ground,
    })
}

/// A way without the places where nothing turns.
fn turns(way: impl Iterator<Item = [f64; 3]>) -> Vec<[f64; 3]> {
    let mut turns: Vec<[f64; 3]> = Vec::new();
    for at in way {
        match turns[..] {
            [.., last] if last == at => continue,
            [.., before, last] if is_straight(before, last, at) => {
                turns.pop();
            }
            _ => {}
        }
        turns.push(at);
    }
    turns
}

/// Whether the way from `a` to `b` goes on to `c` in the same direction.
fn is_straight(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    let leg = |from: [f64; 3], to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let (one, two) = (leg(a, b), leg(b, c));
    dot(one, two) >= STRAIGHT * (dot(one, one) * dot(two, two)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_turns_are_kept() {
        let way = [
            [0, 0, 0],
            [0, 0, 0],
            [1, 0, 0],
            [2, 0, 0],
            [2, 0, 0],
            [3, 0, 0],
            [3, 1, 0],
            [3, 1, 1],
            [3, 1, 0],
            [3, 0, 0],
            [2, 0, 0],
        ];
        let metres = |at: [i32; 3]| at.map(|it| (f64::from(it) + 0.5) * 0.1);
        let kept = [0, 5, 6, 7, 8, 9, 10].map(|at: usize| metres(way[at]));
        assert_eq!(turns(way.into_iter().map(metres)), kept);
        assert!(turns(std::iter::empty()).is_empty());
    }

    #[test]
    fn slanting_ways_are_straight_too_and_slight_turns_are_turns() {
        let at = |step: f64| [0.3 * step, -0.7 * step, 0.1 * step];
        let way = (0..100).map(f64::from).map(at);
        assert_eq!(turns(way), [at(0.0), at(99.0)]);
        let bent = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.001, 0.0]];
        assert_eq!(turns(bent.into_iter()), bent);
    }
}
