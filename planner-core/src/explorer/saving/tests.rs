//! Saves of robots in the midst of small worlds.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Direction;
use crate::explorer::Config;
use crate::explorer::ahead::Ahead;
use crate::explorer::evidence::Evidence;
use crate::explorer::mission::Budget;
use crate::explorer::others::Others;
use crate::explorer::tests::scene::{Scene, scene};
use crate::explorer::tests::soak;
use crate::planner::Planner;
use crate::robot::{Action, Motion, Wait};

type Small = Explorer<3, 3>;

fn saved(robot: &Small, page: usize) -> Vec<u8> {
    let (mut flash, mut page) = (Vec::new(), std::vec![0xffu8; page]);
    loop {
        match robot.save(flash.len(), &mut page) {
            0 => break flash,
            written => flash.extend(&page[..written]),
        }
    }
}

impl Small {
    /// Drops plan, hints, searches, votes and what is set aside, one by one.
    fn drop_all_but_the_map(&mut self) {
        let link = (self.link.sequence(), self.link.hearsay().cells);
        self.link
            .reset(self.config.link, self.id, self.around.map.extent());
        self.link.restore(link.0, link.1);
        self.role = Role::new(self.role.rank, self.role.home);
        self.around.aside.reset();
        self.around.visits.clear();
        self.evidence = Evidence::new();
        self.others = Others::new();
        self.far.cancel();
        self.budget = Budget::new();
        self.budget.doubt();
        self.last_goal = None;
        (self.far_again, self.patrol_again) = (0, 0);
        self.far_is_doubtful = false;
        (self.stepping, self.is_astray) = (false, false);
        (self.looks, self.holds, self.doubts) = (0, 0, 0);
        self.ahead = Ahead::new();
        self.was_told_shut = false;
    }
}

/// What a robot alone did in each tick, and how it ended. In tick `at` it is interrupted.
fn run(scene: &Scene, at: u32, interrupt: impl Fn(&mut Small)) -> (Vec<Action>, Small) {
    let mut place = scene.start[0];
    let mut robot = Small::new(scene.config, RobotId(3), scene.extent, place).unwrap();
    let (mut heading, mut actions) = (Direction::East, Vec::new());
    for tick in 0..20_000 {
        if tick == at {
            interrupt(&mut robot);
        }
        robot.observe(&scene.look(place, heading));
        let action = robot.tick();
        actions.push(action);
        match action {
            Action::Move(step) => {
                heading = step;
                let to = place.step(step);
                let refusal = scene.refuses(to).filter(|_| tick < 4 * at);
                if refusal.is_none() {
                    place = to;
                }
                robot.report(refusal.unwrap_or(Motion::Moved));
            }
            Action::Wait => {
                if let Some(Wait::Look(side)) = robot.waiting() {
                    heading = side;
                }
            }
            Action::Stop(_) if tick > at => break,
            Action::Stop(_) => {}
        }
    }
    (actions, robot)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: soak().cases.div_ceil(10), ..soak() })]

    /// The same as a robot that drops in that tick what is not saved, and complete.
    #[test]
    fn a_robot_goes_on_from_a_save(scene in scene(true), at in 0u32..150, page in 1usize..300) {
        let restored = run(&scene, at, |robot| {
            let bytes = saved(robot, page);
            assert_eq!(bytes.len(), robot.saved_bytes());
            let start = Cell::new(0, 0);
            let mut new = Small::new(robot.config, robot.id, robot.map().extent(), start).unwrap();
            new.restore(&bytes).unwrap();
            assert!(new.map() == robot.map());
            assert_eq!(new.map().frontiers(), robot.map().frontiers());
            assert_eq!(new.map().unknown_cells(), robot.map().unknown_cells());
            assert_eq!(new.map().free_edge_cells(), robot.map().free_edge_cells());
            assert_eq!(new.map().shut().places(), robot.map().shut().places());
            assert_eq!(new.map().shut().cells(), robot.map().shut().cells());
            *robot = new;
            assert_eq!(saved(robot, 1000).len(), bytes.len());
        });
        let (actions, robot) = run(&scene, at, Small::drop_all_but_the_map);
        prop_assert_eq!(&restored.0, &actions);
        prop_assert!(restored.1.map() == robot.map());
        let is_missing = |cell: &Cell| !robot.map().is_known(*cell);
        let passes = |cell| !scene.is_silent(cell) && scene.refuses(cell).is_none();
        let reachable = scene.reachable(scene.start[0], passes);
        prop_assert!(matches!(actions.last(), Some(Action::Stop(_))), "it goes on for ever");
        prop_assert_eq!(reachable.iter().find(|cell| is_missing(cell)), None);
    }

    #[test]
    fn a_damaged_save_is_refused_whole(
        scene in scene(false), at in 0u32..60,
        damage in prop::collection::vec((any::<prop::sample::Index>(), 1u8..), 1..4),
        left in any::<prop::sample::Index>(),
    ) {
        run(&scene, at, |robot| {
            let good = saved(robot, 64);
            let mut bad = good.clone();
            damage.iter().for_each(|(at, bits)| bad[at.index(good.len())] ^= bits);
            if bad == good {
                return;
            }
            let start = scene.start[0];
            let mut other = Small::new(robot.config, robot.id, scene.extent, start).unwrap();
            let before = saved(&other, 64);
            assert!(other.restore(&bad).is_err());
            assert!(other.restore(&good[..left.index(good.len())]).is_err());
            assert_eq!(saved(&other, 64), before);
        });
    }
}

#[test]
fn another_robot_another_grid_and_no_save_are_told() {
    let extent = Extent::new(20, 12);
    let (here, id) = (Cell::new(4, 4), RobotId(7));
    let robot = Small::new(Config::new(), id, extent, here).unwrap();
    let mut bytes = saved(&robot, 100);
    let restore = |id, extent, bytes: &[u8]| {
        let mut other = Small::new(Config::new(), id, extent, Cell::new(0, 0)).unwrap();
        other.restore(bytes)?;
        Ok(other.status().position)
    };
    bytes.extend([0xff; 40]);
    assert_eq!(restore(id, extent, &bytes), Ok(here), "the rest of a page");
    let other = RobotId(8);
    assert_eq!(restore(other, extent, &bytes), Err(RestoreError::Robot(id)));
    let larger = Extent::new(20, 13);
    assert_eq!(restore(id, larger, &bytes), Err(RestoreError::Grid(extent)));
    assert_eq!(restore(id, extent, &[0xff; 64]), Err(RestoreError::NoSave));
    assert_eq!(restore(id, extent, &[]), Err(RestoreError::NoSave));
    bytes[3] = 9;
    assert_eq!(restore(id, extent, &bytes), Err(RestoreError::Version(9)));
    let large = Explorer::<8, 8>::new(Config::new(), id, Extent::new(64, 64), here).unwrap();
    assert_eq!(large.saved_bytes(), 1604);
}

/// The others take its frames for new ones, and what it knows comes with them.
#[test]
fn others_hear_a_robot_that_was_restored() {
    let extent = Extent::new(20, 12);
    let new = |id| Small::new(Config::new(), RobotId(id), extent, Cell::new(4, 4)).unwrap();
    let (mut robot, mut other) = (new(0), new(1));
    let mut frame = [0; crate::radio::MAX_LEN];
    let mut saves = Vec::new();
    for _ in 0..30 {
        saves = match saves.is_empty() {
            true => saved(&robot, 99),
            false => saves,
        };
        robot.tick();
        other.tick();
        let length = robot.transmit(&mut frame).unwrap();
        assert!(other.receive(&frame[..length]).unwrap().status.is_some());
    }
    let mut again = new(0);
    again.restore(&saves).unwrap();
    let length = again.transmit(&mut frame).unwrap();
    assert!(other.receive(&frame[..length]).unwrap().status.is_some());
}
