//! Rooms with doors: a hall that is divided by walls again and again.

use planner_core::{Cell, Extent};

use super::super::grid::Grid;
use crate::dice::Dice;

/// Least side of a room.
const SMALLEST_ROOM: i16 = 3;
/// A room whose sides are both at most this may stay undivided.
const LARGE_ROOM: i16 = 12;
/// Chance in per cent that a room may stay as it is, or that a wall gets
/// a second door.
const CHANCE: u16 = 30;

/// Rooms inside a wall; each wall between two of them has one door or two.
pub(super) fn rooms(extent: Extent, dice: &mut Dice) -> Grid {
    let (right, bottom) = (extent.width as i16 - 1, extent.height as i16 - 1);
    let mut grid = Grid::from_fn(extent, |cell| {
        cell.x == 0 || cell.y == 0 || cell.x == right || cell.y == bottom
    });
    let mut rooms = vec![Room {
        left: 1,
        top: 1,
        right: right - 1,
        bottom: bottom - 1,
    }];
    while let Some(room) = rooms.pop() {
        rooms.extend(room.divide(&mut grid, dice).into_iter().flatten());
    }
    grid
}

/// A free rectangle; the sides belong to it.
#[derive(Clone, Copy)]
struct Room {
    left: i16,
    top: i16,
    right: i16,
    bottom: i16,
}

impl Room {
    /// Builds a wall with doors across the room and gives its two halves, or
    /// nothing if the room stays whole.
    fn divide(self, grid: &mut Grid, dice: &mut Dice) -> Option<[Self; 2]> {
        let (width, height) = (self.right - self.left + 1, self.bottom - self.top + 1);
        if width.max(height) <= LARGE_ROOM && dice.chance(CHANCE) {
            return None;
        }
        let upright = width > height || (width == height && dice.chance(50));
        if upright {
            self.divide_upright(grid, dice, |cell| cell)
        } else {
            let halves = self.turned().divide_upright(grid, dice, turned);
            halves.map(|halves| halves.map(Self::turned))
        }
    }

    /// [`Room::divide`] by an upright wall; `place` says where the cells of
    /// this room are on the grid.
    fn divide_upright(
        self,
        grid: &mut Grid,
        dice: &mut Dice,
        place: impl Fn(Cell) -> Cell,
    ) -> Option<[Self; 2]> {
        // A wall must not end in front of a door of the walls that it meets.
        let columns = self.left + SMALLEST_ROOM..=self.right - SMALLEST_ROOM;
        let columns: Vec<i16> = columns
            .filter(|&x| {
                [self.top - 1, self.bottom + 1]
                    .into_iter()
                    .all(|y| !grid.is_free(place(Cell::new(x, y))))
            })
            .collect();
        let wall = dice.pick(&columns)?;
        for y in self.top..=self.bottom {
            grid.set_blocked(place(Cell::new(wall, y)), true);
        }
        for _ in 0..1 + u32::from(dice.chance(CHANCE)) {
            let door = dice.between(self.top as u16, self.bottom as u16) as i16;
            grid.set_blocked(place(Cell::new(wall, door)), false);
        }
        Some([
            Self {
                right: wall - 1,
                ..self
            },
            Self {
                left: wall + 1,
                ..self
            },
        ])
    }

    /// This room with x and y exchanged.
    fn turned(self) -> Self {
        Self {
            left: self.top,
            top: self.left,
            right: self.bottom,
            bottom: self.right,
        }
    }
}

fn turned(cell: Cell) -> Cell {
    Cell::new(cell.y, cell.x)
}
