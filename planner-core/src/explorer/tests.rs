//! The explorer in a small world of its own: the obviously correct simulator.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::planner::{Contact, Inspect, LongSight, Planner};
use crate::robot::{Activity, Motion, Status};
use crate::sight::Sighting;
use crate::tile::{TileIndex, TileSet, every_tile};

mod limits;
pub(super) mod scene;
mod senses;

use scene::*;

type Small = Explorer<3, 3>;

/// Every robot stops; what its sensor could show it from where it could go, it knows; and
/// its reason says no more than is so.
fn assert_truthful(scene: &Scene) -> Result<Ended, TestCaseError> {
    let ended = run(scene, 100_000);
    // Without trouble there is no reason to give up. Bodies that see little and may not
    // pass each other can be in each other's way for good.
    let is_crowd_in_the_dark = scene.solid && scene.trouble.view > 0;
    // So can those that keep out of different cells.
    let kept_out = |robot: &Small| -> Vec<u64> {
        every_tile(3, 3)
            .map(|at| robot.map().kept_out(at))
            .collect()
    };
    let mut pairs = ended.robots.windows(2);
    let is_divided = scene.solid && pairs.any(|of| kept_out(&of[0]) != kept_out(&of[1]));
    let is_troubled = scene.trouble.is_any() || is_crowd_in_the_dark || is_divided;
    for ((robot, stop), &start) in ended.robots.iter().zip(&ended.stops).zip(&scene.start) {
        let stop = stop.ok_or_else(|| {
            TestCaseError::fail(std::format!(
                "still running at {}, waiting for {:?}\n{:?}\nthe plan {:?}",
                robot.around.position,
                robot.waiting(),
                robot.map(),
                robot.role
            ))
        })?;
        prop_assert!(is_troubled || stop.is_complete(), "{}", stop);
        let is_missing = |cell: &Cell| !robot.map().is_known(*cell);
        let told = std::format!(
            "robot {:?} from {start}: {stop}\n{:?}",
            robot.id,
            robot.map()
        );
        // Exchanges of roles join the maps: everybody knows what its body can reach.
        let keeps_out = |cell| robot.map().keeps_out(cell);
        let here = robot.around.position;
        let all = scene.reachable(here, |cell| !keeps_out(cell));
        if stop.is_complete() {
            prop_assert_eq!(all.iter().find(|cell| is_missing(cell)), None, "{}", told);
        }
        // What no look shows, nobody enters; what refuses, neither.
        let passes =
            |cell| !scene.is_silent(cell) && scene.refuses(cell).is_none() && !keeps_out(cell);
        // Robots that may not share a cell and have given up are in each other's way.
        let is_crowded = scene.solid && !stop.is_complete();
        let free = if is_crowded {
            Vec::new()
        } else {
            scene.reachable(here, passes)
        };
        for cell in free {
            for seen in Direction::ALL.map(|direction| cell.step(direction)) {
                let shows =
                    scene.extent.contains(seen) && !scene.is_silent(seen) && !keeps_out(seen);
                prop_assert!(
                    !shows || !is_missing(&seen),
                    "{} is unknown to {}",
                    seen,
                    told
                );
            }
        }
        match stop {
            Stop::Complete => {}
            // Others may have told more since it stopped.
            Stop::AtEdge { cells } => {
                prop_assert!(
                    cells > 0 && cells <= robot.map().free_edge_cells(),
                    "{}",
                    told
                );
            }
            Stop::Enclosed { .. } => {
                prop_assert!(scene.solid || robot.hearsay().cells > 0, "{}", told)
            }
            Stop::OutOfReach { .. } => {
                let is_alone = scene.start.len() == 1;
                prop_assert!(!is_alone || robot.hearsay().cells == 0, "{}", told);
            }
            Stop::Blocked { at, .. } => {
                prop_assert_eq!(scene.refuses(at), Some(Motion::Blocked), "{}", told);
            }
            Stop::Held { at, .. } => {
                let is_so = scene.solid || scene.refuses(at) == Some(Motion::Held);
                prop_assert!(is_so, "{}", told);
            }
            Stop::Unseen { at, .. } => {
                // Others may have stood on it and told it since.
                prop_assert!(scene.is_silent(at), "{}", told);
            }
            Stop::BackAtStart { .. }
            | Stop::NoTrace { .. }
            | Stop::Home { .. }
            | Stop::Arrived { .. }
            | Stop::NoWay { .. } => prop_assert!(false, "{}", told),
        }
        if scene.start.len() == 1 && !matches!(stop, Stop::AtEdge { .. }) {
            prop_assert_eq!(stop.left(), robot.map().frontiers(), "{}", told);
        }
    }
    Ok(ended)
}

/// As many small worlds as `PROPTEST_CASES` says, or these.
pub(super) fn soak() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES");
    ProptestConfig {
        cases: asked
            .ok()
            .and_then(|cases| cases.parse().ok())
            .unwrap_or(10_000),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(soak())]

    #[test]
    fn every_robot_stops_with_a_complete_map(scene in scene(false)) {
        assert_truthful(&scene)?;
    }

    #[test]
    fn every_robot_in_trouble_stops_and_tells_the_truth(scene in scene(true)) {
        assert_truthful(&scene)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: soak().cases.div_ceil(10), ..soak() })]

    /// Whatever the sensor says, of every cell but the robot's own.
    #[test]
    fn every_robot_stops_whatever_it_sees(mut scene in scene(true), noise in any::<u8>()) {
        scene.trouble.noise = noise;
        let ended = run(&scene, 400_000);
        for (robot, stop) in ended.robots.iter().zip(&ended.stops) {
            prop_assert!(
                stop.is_some(),
                "still running at {}, waiting for {:?}, the plan {:?}\n{:?}",
                robot.around.position,
                robot.waiting(),
                robot.role,
                robot.map()
            );
        }
    }
}

proptest! {
    #[test]
    fn the_same_scene_runs_the_same(scene in scene(true)) {
        let (a, b) = (run(&scene, 300), run(&scene, 300));
        prop_assert_eq!(a.ticks, b.ticks);
        for (a, b) in a.robots.iter().zip(&b.robots) {
            prop_assert_eq!(a.status(), b.status());
            prop_assert!(a.map() == b.map());
        }
    }
}

/// A look that shows one wall far away is not the end of an exploration; without any look the
/// robot waits.
#[test]
fn looks_that_show_little_complete_nothing() {
    let start = Cell::new(3, 3);
    let mut robot = Small::new(Config::new(), RobotId(1), Extent::new(20, 20), start).unwrap();
    for _ in 0..1_000 {
        assert_eq!(robot.tick(), Action::Wait);
        assert_eq!(robot.waiting(), Some(Wait::Sight));
    }
    let mut look = Sighting::new(start);
    look.see_blocked(Cell::new(9, 3));
    for _ in 0..10_000 {
        robot.observe(&look);
        match robot.tick() {
            Action::Move(_) => robot.report(Motion::Blocked),
            Action::Wait => {}
            Action::Stop(stop) => {
                assert!(matches!(stop, Stop::Unseen { .. }), "{stop}");
                return;
            }
        }
    }
    panic!("no stop");
}
