//! Robots that have not heard each other of late decide alike from alike maps, and
//! would go the same way: each leans its own way instead.

use crate::cell::Cell;
use crate::planner::RobotId;

/// By id, four long each.
const WAYS: [(i32, i32); 8] = [
    (4, 0),
    (-4, 0),
    (0, 4),
    (0, -4),
    (3, 3),
    (-3, -3),
    (3, -3),
    (-3, 3),
];

/// The largest gain, in the unit of the near decision's score.
pub(crate) const LARGEST_GAIN: i32 = 24;

/// A preference for frontiers on one side of the robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lean {
    from: Cell,
    towards: (i32, i32),
}

impl Lean {
    /// The way of robot `id`, which stands on `from`.
    pub(crate) fn of(id: RobotId, from: Cell) -> Self {
        let way = WAYS.get(usize::from(id.0) % WAYS.len());
        Self {
            from,
            towards: way.copied().unwrap_or_default(),
        }
    }

    /// What a frontier cell gains by where it lies: a cell further in the robot's
    /// direction is worth half a step, up to six steps, or as much less behind it.
    pub(crate) fn gain(&self, cell: Cell) -> i32 {
        let along = i32::from(cell.x.saturating_sub(self.from.x)) * self.towards.0
            + i32::from(cell.y.saturating_sub(self.from.y)) * self.towards.1;
        (along / 2).clamp(-LARGEST_GAIN, LARGEST_GAIN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_robots_lean_eight_ways() {
        let here = Cell::new(20, 20);
        let favourite = |id| {
            let lean = Lean::of(RobotId(id), here);
            let gain = |&way: &usize| {
                let (x, y) = WAYS[way];
                lean.gain(Cell::new(20 + x as i16, 20 + y as i16))
            };
            (0..8).max_by_key(gain).unwrap()
        };
        let ways: std::vec::Vec<_> = (0..8).map(favourite).collect();
        assert_eq!(ways, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(favourite(0), favourite(8));
    }

    #[test]
    fn a_gain_is_limited_and_symmetric() {
        let lean = Lean::of(RobotId(0), Cell::new(20, 20));
        assert_eq!(lean.gain(Cell::new(22, 20)), 4);
        assert_eq!(lean.gain(Cell::new(18, 23)), -4);
        assert_eq!(lean.gain(Cell::new(i16::MAX, 0)), LARGEST_GAIN);
        assert_eq!(lean.gain(Cell::new(i16::MIN, 0)), -LARGEST_GAIN);
    }
}
