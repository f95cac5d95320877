//! Robots that have not heard each other of late decide alike from alike maps, and
//! would go the same way: each leans its own way instead.

use crate::cell::Cell;
use crate::robot::RobotId;

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

/// What a frontier cell gains for robot `id` on `from` by where it lies: a cell further
/// in the robot's direction is worth half a step, up to six steps, or as much less
/// behind it.
pub(crate) fn gain(id: RobotId, from: Cell, cell: Cell) -> i32 {
    let way = WAYS.get(usize::from(id.0) % WAYS.len());
    let (x, y) = way.copied().unwrap_or_default();
    let along =
        i32::from(cell.x.saturating_sub(from.x)) * x + i32::from(cell.y.saturating_sub(from.y)) * y;
    (along / 2).clamp(-LARGEST_GAIN, LARGEST_GAIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_robots_lean_eight_ways() {
        let here = Cell::new(20, 20);
        let favourite = |id| {
            let to = |&way: &usize| {
                let (x, y) = WAYS[way];
                gain(RobotId(id), here, Cell::new(20 + x as i16, 20 + y as i16))
            };
            (0..8).max_by_key(to).unwrap()
        };
        let ways: std::vec::Vec<_> = (0..8).map(favourite).collect();
        assert_eq!(ways, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(favourite(0), favourite(8));
    }

    #[test]
    fn a_gain_is_limited_and_symmetric() {
        let gain = |x, y| gain(RobotId(0), Cell::new(20, 20), Cell::new(x, y));
        assert_eq!(gain(22, 20), 4);
        assert_eq!(gain(18, 23), -4);
        assert_eq!(gain(i16::MAX, 0), LARGEST_GAIN);
        assert_eq!(gain(i16::MIN, 0), -LARGEST_GAIN);
    }
}
