//! What stands in a world for a while: people, shut doors, robots where robots see each
//! other, and what the user puts there.

use planner_core::explorer::body_cells;
use planner_core::{Cell, Direction, RobotId};

use crate::dice::Lot;
use crate::scenario::{Faults, Trouble};
use crate::world::World;

/// A door stays open, and shut, for so many ticks at least...
const LEAST_STAY: u32 = 50;
/// ... and for fewer than so many more.
const MORE_STAY: u32 = 100;

/// Kinds of chance that have nothing to do with each other.
enum Of {
    Doors = 16,
    People,
    Steps,
}

/// Who and what stands where in a tick.
#[derive(Debug)]
pub(super) struct Bodies {
    lot: Lot,
    people: Vec<Cell>,
    doors: Vec<Door>,
    /// Cells of the doors that are shut, and of what the user has put there.
    shut: Vec<Cell>,
    /// Where each robot is, if robots see each other.
    robots: Vec<Cell>,
    /// The same in the next tick.
    robots_next: Vec<Cell>,
    /// Cells that they reach beyond their own.
    clearance: u8,
    faults: Faults,
    tick: u32,
}

#[derive(Debug)]
struct Door {
    at: Cell,
    open: u32,
    shut: u32,
    phase: u32,
}

impl Door {
    fn new(lot: Lot, at: Cell) -> Self {
        let stay = |number| LEAST_STAY + lot.of(number).below(MORE_STAY);
        let (open, shut) = (stay(0), stay(1));
        let phase = lot.of(2).below(open + shut);
        Self {
            at,
            open,
            shut,
            phase,
        }
    }

    fn is_shut(&self, tick: u32) -> bool {
        tick.wrapping_add(self.phase) % (self.open + self.shut) >= self.open
    }
}

impl Bodies {
    pub(super) fn new(
        trouble: &Trouble,
        seed: u64,
        faults: &Faults,
        world: &World,
        starts: &[Cell],
        clearance: u8,
    ) -> Self {
        let lot = Lot::new(seed);
        let robots = match trouble.see_robots {
            true => starts.to_vec(),
            false => Vec::new(),
        };
        let mut bodies = Self {
            lot,
            people: people(lot.of(Of::People as u64), trouble.people, world, starts),
            doors: doors(lot.of(Of::Doors as u64), trouble.doors, world, starts),
            shut: Vec::new(),
            robots_next: robots.clone(),
            robots,
            clearance,
            faults: faults.clone(),
            tick: 0,
        };
        bodies.turn_doors();
        bodies
    }

    /// Whether nothing ever stands in the way.
    pub(super) fn are_none(&self) -> bool {
        self.people.is_empty()
            && self.doors.is_empty()
            && self.robots.is_empty()
            && self.faults.shut.is_empty()
    }

    /// The next tick begins: people walk, doors turn, robots are where they went.
    pub(super) fn begin(&mut self, tick: u32, world: &World) {
        self.tick = tick;
        self.robots.copy_from_slice(&self.robots_next);
        self.turn_doors();
        for (person, number) in self.people.iter_mut().zip(0u64..) {
            let lot = self.lot.of(Of::Steps as u64).of(tick.into()).of(number);
            let to = person.step(Direction::from_index(lot.below(4) as u8));
            if world.is_free(to) && !self.shut.contains(&to) {
                *person = to;
            }
        }
    }

    fn turn_doors(&mut self) {
        let shut = self.doors.iter().filter(|door| door.is_shut(self.tick));
        self.shut = shut.map(|door| door.at).chain(self.put()).collect();
    }

    /// Cells that the user has shut.
    fn put(&self) -> impl Iterator<Item = Cell> + '_ {
        let spans = self.faults.shut.iter();
        let hold = spans.filter(|of| of.holds(of.cell, self.tick));
        hold.map(|of| of.cell)
    }

    /// A robot is there from the next tick on.
    pub(super) fn follow(&mut self, robot: usize, at: Cell) {
        if let Some(next) = self.robots_next.get_mut(robot) {
            *next = at;
        }
    }

    /// Where people are.
    pub(super) fn people(&self) -> impl Iterator<Item = Cell> + '_ {
        self.people.iter().copied()
    }

    /// Every door, and whether it is shut; and what the user has put there, as shut.
    pub(super) fn doors(&self) -> impl Iterator<Item = (Cell, bool)> + '_ {
        let doors = self.doors.iter();
        doors
            .map(|door| (door.at, door.is_shut(self.tick)))
            .chain(self.put().map(|at| (at, true)))
    }

    /// Whether a person or a shut door is in the way.
    pub(super) fn block(&self, cell: Cell) -> bool {
        self.shut.contains(&cell) || self.people().any(|at| at == cell)
    }

    /// What `robot` sees as blocked.
    pub(super) fn seen_by(&self, robot: usize) -> impl Iterator<Item = Cell> + '_ {
        let has_come = |other| self.faults.has_come(RobotId(other), self.tick);
        let others = self
            .robots
            .iter()
            .zip(0u8..)
            .filter(move |(_, other)| usize::from(*other) != robot && has_come(*other));
        let others = others.flat_map(|(&at, _)| body_cells(self.clearance, at));
        self.people().chain(self.shut.iter().copied()).chain(others)
    }
}

/// People on cells that can be reached from a start.
fn people(lot: Lot, count: u16, world: &World, starts: &[Cell]) -> Vec<Cell> {
    if count == 0 {
        return Vec::new();
    }
    let cells: Vec<Cell> = world.reachable(starts).cells().collect();
    let person = |number| {
        let index = lot.of(number).below(cells.len() as u32);
        cells.get(index as usize).copied()
    };
    (0..count.into()).filter_map(person).collect()
}

/// Doors in passages, those of walls one cell thick first; never on a start.
fn doors(lot: Lot, count: u16, world: &World, starts: &[Cell]) -> Vec<Door> {
    if count == 0 {
        return Vec::new();
    }
    let is_passage = |cell: Cell, along: Direction| {
        let is_free = |to: Direction| world.is_free(cell.step(to));
        let across = Direction::from_index(along as u8 + 1);
        is_free(along)
            && is_free(along.opposite())
            && !is_free(across)
            && !is_free(across.opposite())
    };
    let mut passages = Vec::new();
    for cell in world.reachable(starts).cells() {
        for along in [Direction::East, Direction::South] {
            if is_passage(cell, along) && !starts.contains(&cell) {
                let beside = [along, along.opposite()].map(|to| cell.step(to));
                let is_long = beside.iter().any(|&cell| is_passage(cell, along));
                passages.push((is_long, lot.at(cell), cell));
            }
        }
    }
    passages.sort_unstable_by_key(|&(is_long, lot, _)| (is_long, lot));
    let first = passages.into_iter().take(count.into());
    first.map(|(_, lot, cell)| Door::new(lot, cell)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Event;
    use planner_core::Extent;

    /// Three rooms in a row with a passage of one cell between two, and a corridor.
    const ROOMS: [&str; 5] = [
        "###############",
        "#....#....#...#",
        "#..............",
        "#....#....#...#",
        "###############",
    ];
    const STARTS: [Cell; 2] = [Cell::new(1, 1), Cell::new(2, 1)];

    fn world() -> World {
        let extent = Extent::new(15, 5);
        let blocked = |cell: Cell| ROOMS[cell.y as usize].as_bytes()[cell.x as usize] == b'#';
        World::from_fn("rooms", extent, blocked).unwrap()
    }

    fn bodies(trouble: Trouble, faults: &Faults) -> Bodies {
        Bodies::new(&trouble, 3, faults, &world(), &STARTS, 0)
    }

    #[test]
    fn people_walk_over_free_cells_a_step_a_tick_at_most() {
        let trouble = Trouble {
            people: 3,
            ..Trouble::default()
        };
        let world = world();
        let mut bodies = bodies(trouble, &Faults::default());
        let mut visited: Vec<Cell> = Vec::new();
        for tick in 1..500 {
            let before: Vec<Cell> = bodies.people().collect();
            assert_eq!(before.len(), 3);
            bodies.begin(tick, &world);
            for (before, now) in before.into_iter().zip(bodies.people()) {
                assert!(world.is_free(now) && bodies.block(now));
                assert!(before.distance_squared(now) <= 1);
                visited.push(now);
            }
        }
        visited.sort_unstable_by_key(|cell| (cell.y, cell.x));
        visited.dedup();
        let free = world.free_cells().count();
        assert!(visited.len() > free * 3 / 4, "{} of {free}", visited.len());
    }

    #[test]
    fn doors_are_passages_that_open_and_shut() {
        let trouble = Trouble {
            doors: 5,
            ..Trouble::default()
        };
        let mut bodies = bodies(trouble, &Faults::default());
        // No more than there are, and none in the way out at the end.
        let mut places: Vec<Cell> = bodies.doors().map(|(at, _)| at).collect();
        places.sort_unstable_by_key(|at| at.x);
        assert_eq!(places, [Cell::new(5, 2), Cell::new(10, 2)]);
        let mut shut = [0; 2];
        for tick in 1..3000 {
            bodies.begin(tick, &world());
            for ((at, is_shut), shut) in bodies.doors().zip(&mut shut) {
                assert_eq!(bodies.block(at), is_shut);
                *shut += u32::from(is_shut);
            }
        }
        assert!(
            shut.iter().all(|ticks| (750..2250).contains(ticks)),
            "{shut:?}"
        );
    }

    #[test]
    fn what_is_shut_by_hand_is_shut_for_a_while() {
        let span = "3,2@1-4".parse().unwrap();
        let faults = Faults {
            shut: vec![span],
            ..Faults::default()
        };
        let mut bodies = bodies(Trouble::default(), &faults);
        assert!(!bodies.are_none());
        for tick in 0..6 {
            if tick > 0 {
                bodies.begin(tick, &world());
            }
            let is_shut = (1..4).contains(&tick);
            assert_eq!(bodies.block(span.cell), is_shut);
            assert_eq!(bodies.seen_by(0).count(), usize::from(is_shut));
            assert_eq!(bodies.doors().count(), usize::from(is_shut));
        }
    }

    #[test]
    fn robots_see_others_that_are_there_where_they_were_when_the_tick_began() {
        let late = Event {
            robot: RobotId(1),
            tick: 2,
        };
        let faults = Faults {
            arrivals: vec![late],
            ..Faults::default()
        };
        let trouble = Trouble {
            see_robots: true,
            ..Trouble::default()
        };
        let world = world();
        let mut bodies = bodies(trouble, &faults);
        let seen = |bodies: &Bodies, robot| bodies.seen_by(robot).collect::<Vec<_>>();
        assert_eq!(seen(&bodies, 0), []);
        assert_eq!(seen(&bodies, 1), [STARTS[0]]);
        bodies.begin(1, &world);
        bodies.follow(0, Cell::new(1, 2));
        assert_eq!(seen(&bodies, 1), [STARTS[0]]);
        bodies.begin(2, &world);
        assert_eq!(seen(&bodies, 0), [STARTS[1]]);
        assert_eq!(seen(&bodies, 1), [Cell::new(1, 2)]);
        assert!(
            !bodies.block(STARTS[1]),
            "a robot in the way is the fleet's affair"
        );
    }
}
