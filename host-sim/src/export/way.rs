//! Ways in metres: where robots started, turned and ended.

use planner_core::Point;
use planner_core::volume::Voxel;

use crate::record::heights::Trace;
use crate::record::voxels::VoxelTrace;
use crate::scenario::Conditions;

/// Cosine of the largest angle between two flights in the same direction: rounding.
const STRAIGHT: f64 = 1.0 - 1e-9;

/// The way of one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Where it started, turned and ended.
    pub places: Vec<[f64; 3]>,
    /// Height of what is under its start.
    pub ground: f64,
    /// Whether anything is known to be there.
    pub is_ground_known: bool,
    /// Side of a cell: how near to a place counts as there.
    pub cell: f64,
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

/// The ways of a robot among voxels, one for each time that it was sent out with its energy; none
/// if the scene has no metres.
pub fn among_voxels(trace: &VoxelTrace, robot: usize) -> Vec<Way> {
    let Some(frame) = trace.scene.frame() else {
        return Vec::new();
    };
    let way: Vec<_> = (trace.ways[robot].iter())
        .map(|&voxel| frame.middle(voxel))
        .collect();
    let start = trace.ways[robot][0];
    let below = (0..start.z).rev().map(|z| Voxel { z, ..start });
    let floor = below.take_while(|at| !trace.scene.is_solid(*at)).last();
    let [_, _, middle] = frame.middle(floor.unwrap_or(start));
    let rests = rests(&trace.scenario.conditions, robot);
    let sorties = sorties(&way, rests.map(|tick| tick as usize), frame.voxel_size);
    let of = |places| Way {
        places,
        ground: middle - frame.voxel_size / 2.0,
        is_ground_known: trace.scene.ground_under(start).is_some(),
        cell: frame.voxel_size,
    };
    sorties.into_iter().map(of).collect()
}

/// The ways of a robot over heights, one for each time that it was sent out with its energy; none
/// if the terrain has no metres.
pub fn over_heights(trace: &Trace, robot: usize) -> Vec<Way> {
    let (Some(scale), Some(&start)) = (trace.terrain.scale(), trace.starts.get(robot)) else {
        return Vec::new();
    };
    let way = trace.way(robot, u32::MAX).into_iter();
    let way: Vec<_> = way.map(|at| scale.metres(at)).collect();
    let height = trace.terrain.height(start.cell()).unwrap_or_default();
    let [_, _, ground] = scale.metres(Point {
        z: height.cells(),
        ..start
    });
    let flown = |tick| trace.of(robot).take_while(move |record| record.tick < tick);
    let rests = rests(&trace.scenario.conditions, robot).map(|tick| flown(tick).count());
    let of = |places| Way {
        places,
        ground,
        is_ground_known: true,
        cell: scale.cell,
    };
    let sorties = sorties(&way, rests, scale.cell);
    sorties.into_iter().map(of).collect()
}

/// The ticks in which a robot got as much energy again.
fn rests(conditions: &Conditions, robot: usize) -> impl Iterator<Item = u32> {
    let is_limited = conditions.mission.energy > 0;
    let resumes = conditions.faults.resumes.iter();
    let own = resumes.filter(move |event| is_limited && usize::from(event.robot.0) == robot);
    own.map(|event| event.tick)
}

/// A way cut in two wherever the robot rested at its start, each part from there. What ends no
/// farther than a cell from it ends there.
fn sorties(way: &[[f64; 3]], rests: impl Iterator<Item = usize>, cell: f64) -> Vec<Vec<[f64; 3]>> {
    let Some(&start) = way.first() else {
        return Vec::new();
    };
    let is_near = |at: [f64; 3]| {
        let sides = [0, 1, 2].map(|axis| at[axis] - start[axis]);
        // Rounding.
        sides.iter().map(|side| side * side).sum::<f64>().sqrt() <= cell * (1.0 + 1e-6)
    };
    let is_home = |rest: &usize| way.get(*rest).is_some_and(|&at| is_near(at));
    let mut ends: Vec<usize> = rests.filter(is_home).collect();
    ends.sort_unstable();
    ends.push(way.len() - 1);
    let mut sorties = Vec::new();
    let mut from = 0;
    for to in ends {
        let flown = way[from..=to].iter().copied();
        let back = Some(start).filter(|_| is_near(way[to]));
        let places = turns([start].into_iter().chain(flown).chain(back));
        if places.len() > 1 {
            sorties.push(places);
        }
        from = to;
    }
    if sorties.is_empty() {
        sorties.push(vec![start]);
    }
    sorties
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

    /// Wind leaves a robot beside its start, where its energy is restored and it goes on.
    #[test]
    fn a_way_is_one_for_each_charge_and_ends_at_home() {
        let at = |x: i32| [f64::from(x) * 0.1, 0.0, 1.0];
        let way = [0, 1, 2, 3, 2, 1, 1, 2, 3].map(at);
        let cut = |rests: &[usize]| sorties(&way, rests.iter().copied(), 0.1);
        assert_eq!(cut(&[]), [vec![at(0), at(3), at(1), at(3)]]);
        let two = [vec![at(0), at(3), at(0)], vec![at(0), at(3)]];
        assert_eq!(cut(&[6]), two);
        // Not where it was elsewhere, nor after the end.
        assert_eq!(cut(&[3, 6, 40]), two);
        assert_eq!(sorties(&[at(0)], std::iter::empty(), 0.1), [[at(0)]]);
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
