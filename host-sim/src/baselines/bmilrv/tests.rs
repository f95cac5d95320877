use std::sync::Arc;

use planner_core::radio::LinkConfig;
use planner_core::{Cell, Direction, RobotId};
use proptest::prelude::*;

use super::board::Mark;
use super::{Bmilrv, Marks};
use crate::fleet::{Fleet, Rules};
use crate::medium;
use crate::scenario::{Conditions, Event, Faults};
use crate::sensor::Sensor;
use crate::world::{Family, Starts, World, generate, paper};

/// A fleet, and the marks that it shares.
struct Watched {
    world: Arc<World>,
    marks: Marks,
    fleet: Fleet<8, 8>,
    rendezvous: Cell,
    reachable: Vec<Cell>,
}

impl Watched {
    fn new(world: World, robots: u8, start: &Starts, range: u8, faults: Faults) -> Self {
        let world = Arc::new(world);
        let starts = world.place(robots.into(), start, false).unwrap();
        let marks = Marks::new(world.extent(), starts[0]);
        let (board, extent) = (marks.clone(), world.extent());
        let build = Box::new(move |id, start| {
            let robot = Bmilrv::new(board.clone(), id, extent, start, LinkConfig::new());
            Box::new(robot.unwrap()) as _
        });
        let rules = Rules {
            faults,
            ..Rules::default()
        };
        let sensor = Arc::new(Sensor::new(world.clone(), range));
        let medium = medium::build(&Conditions::new(0, 0), world.clone());
        let fleet = Fleet::new(sensor, medium, rules, build, &starts);
        Self {
            marks,
            fleet,
            rendezvous: starts[0],
            reachable: world.reachable(&starts).cells().collect(),
            world,
        }
    }

    /// Robots, the rendezvous and every reachable unexplored cell lie in one
    /// connected set of cells that are not closed.
    fn check_law(&self) {
        let marks = self.marks.lock();
        let is_open = |cell| self.world.is_free(cell) && marks.mark(cell) != Mark::Closed;
        let mut joined = vec![false; self.world.extent().cells() as usize];
        let mut todo = vec![self.rendezvous];
        while let Some(cell) = todo.pop() {
            if is_open(cell) && !std::mem::replace(&mut joined[marks.index(cell).unwrap()], true) {
                todo.extend(Direction::ALL.map(|direction| cell.step(direction)));
            }
        }
        let unexplored = self
            .reachable
            .iter()
            .copied()
            .filter(|&cell| marks.mark(cell) == Mark::Unexplored);
        let robots = self.fleet.robots().iter().filter(|robot| robot.alive);
        let robots = robots.map(|robot| robot.position);
        for cell in robots.chain(unexplored).chain([self.rendezvous]) {
            assert!(
                is_open(cell),
                "tick {}: {cell} is closed",
                self.fleet.ticks()
            );
            assert!(
                joined[marks.index(cell).unwrap()],
                "tick {}: {cell} is cut off",
                self.fleet.ticks()
            );
        }
    }

    /// Runs to the end, with a look at the law after every tick.
    fn run(&mut self) {
        let limit = 2000 + 100 * self.world.free_cells().count() as u32;
        while !self.fleet.has_stopped() {
            self.fleet.tick();
            self.check_law();
            assert!(
                self.fleet.ticks() < limit,
                "no end; robots at {:?} in\n{:?}\n{}",
                self.fleet
                    .robots()
                    .iter()
                    .map(|robot| robot.position)
                    .collect::<Vec<_>>(),
                self.world,
                self.marks.lock().picture()
            );
        }
        assert!(self.fleet.violations().is_empty());
        for robot in self.fleet.robots().iter().filter(|robot| robot.alive) {
            assert_eq!(robot.position, self.rendezvous);
            let map = robot.planner.map();
            assert!(self.reachable.iter().all(|&cell| map.is_known(cell)));
        }
    }
}

#[test]
fn every_robot_ends_at_the_rendezvous_of_the_papers_maps() {
    for world in [
        paper::labyrinth1(1),
        paper::labyrinth2(1),
        paper::circle(),
        paper::blocks(),
    ] {
        for robots in [1, 3, 5] {
            let start = world.default_starts();
            Watched::new(world.clone(), robots, &start, 5, Faults::default()).run();
        }
    }
}

#[test]
fn a_robot_that_dies_does_not_stop_the_others() {
    for tick in [5, 150] {
        let death = Event {
            robot: RobotId(0),
            tick,
        };
        let faults = Faults {
            deaths: vec![death],
            ..Faults::default()
        };
        Watched::new(paper::blocks(), 3, &Starts::Corner, 5, faults).run();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_law_holds_and_there_is_an_end(
        family in prop::sample::select(Family::ALL.to_vec()),
        (width, height) in (5u16..24, 5u16..24),
        seed in any::<u64>(),
        robots in 1u8..8,
        range in 1u8..8,
    ) {
        let world = generate(family, width, height, seed).unwrap();
        Watched::new(world, robots, &Starts::Random(seed), range, Faults::default()).run();
    }
}
