//! What holds in every world, and with every input.

use proptest::prelude::*;

use super::*;
use crate::sight::look;

fn config() -> impl Strategy<Value = Config> {
    let flags = any::<[bool; 6]>();
    (0u16..6, flags, 0u32..60).prop_map(|(d_max, flags, silence)| Config {
        d_max,
        second_chance: flags[0],
        neighbourhood: [Neighbourhood::Four, Neighbourhood::Eight][usize::from(flags[1])],
        distance: [Distance::Euclidean, Distance::Manhattan][usize::from(flags[2])],
        drop_resolved: flags[3],
        keep_expired: flags[4],
        approach_hidden: flags[5],
        silence,
        link: crate::radio::LinkConfig::new(),
    })
}

fn world() -> impl Strategy<Value = World> {
    let size = (3u16..=24, 3u16..=24, 0.0..0.6f64);
    size.prop_flat_map(|(width, height, share)| {
        let start = (0..width as i16, 0..height as i16).prop_map(|(x, y)| Cell::new(x, y));
        let cells = usize::from(width) * usize::from(height);
        let walls = proptest::collection::vec(proptest::bool::weighted(share), cells);
        (start, walls).prop_map(move |(start, walls)| {
            World::from_fn(Extent::new(width, height), start, |i| walls[i])
        })
    })
}

/// The reason says no more than is so.
fn assert_truthful(world: &World, robot: &world::Robot, stop: Stop) {
    let map = robot.map();
    let knows_all = world.reachable().iter().all(|&cell| map.is_known(cell));
    match stop {
        Stop::Complete => assert!(knows_all && map.frontiers() == 0 && map.free_edge_cells() == 0),
        Stop::AtEdge { cells } => {
            assert!(knows_all && map.frontiers() == 0);
            assert!(cells > 0 && cells == map.free_edge_cells());
        }
        Stop::BackAtStart { frontiers } => {
            assert_eq!(robot.position, world.start);
            assert!(frontiers > 0 && frontiers == map.frontiers());
        }
        Stop::NoTrace { frontiers } | Stop::Blocked { frontiers, .. } => {
            assert!(frontiers > 0 && frontiers == map.frontiers());
        }
        Stop::Enclosed { .. }
        | Stop::OutOfReach { .. }
        | Stop::Unseen { .. }
        | Stop::Held { .. }
        | Stop::Home { .. }
        | Stop::Arrived { .. }
        | Stop::NoWay { .. } => panic!("it does not look for that"),
    }
}

proptest! {
    #[test]
    fn steps_are_in_view_work_is_bounded_and_reasons_are_true(
        world in world(), config in config(), radius in 1u8..=8, count in 1u8..=4,
        barred in proptest::collection::vec((0i16..24, 0i16..24), 0..4),
    ) {
        let mut fleet = Fleet::new(&world, radius, config, count);
        fleet.barred = barred.into_iter().map(|(x, y)| Cell::new(x, y)).collect();
        for _ in 0..150 {
            let before = fleet.robots.clone();
            let actions = fleet.tick();
            for ((robot, before), action) in fleet.robots.iter().zip(&before).zip(actions) {
                let sighting = look(before.position, radius, |cell| world.is_wall(cell));
                match action {
                    Action::Move(direction) => {
                        prop_assert!(sighting.is_free(before.position.step(direction)));
                    }
                    Action::Wait => prop_assert!(!robot.closed.is_empty() || !before.closed.is_empty()),
                    // Later the map may grow by what others tell.
                    Action::Stop(_) if matches!(before.phase, Phase::Stopped(_)) => {}
                    Action::Stop(stop) => assert_truthful(&world, robot, stop),
                }
            }
        }
        prop_assert!(fleet.work <= world::Robot::work_bound(radius));
        if config.neighbourhood == Neighbourhood::Four {
            // What the documentation says of an ideal sensor.
            prop_assert!(radius != 5 || fleet.work <= world::Robot::work_bound(radius) / 5);
        }
    }

    /// Sightings that no sensor gives, robots that are carried about, states that
    /// nobody is in: neither a panic nor work beyond the bound.
    #[test]
    fn no_input_panics_or_takes_longer(
        config in config(),
        looks in proptest::collection::vec(
            (-20i16..45, -20i16..45, any::<u64>(), any::<bool>(), any::<u8>()), 1..25),
    ) {
        let extent = Extent::new(24, 20);
        let mut robot = world::Robot::new(config, RobotId(1), extent, Cell::new(3, 3)).unwrap();
        for (x, y, seed, moved, id) in looks {
            let mut sighting = Sighting::new(Cell::new(x, y));
            let mut bits = seed;
            for i in 0..961i16 {
                bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                let cell = Cell::new(x - 15 + i % 31, y - 15 + i / 31);
                match bits >> 61 {
                    0..=4 => sighting.see_free(cell),
                    5 => sighting.see_blocked(cell),
                    _ => {}
                }
            }
            robot.observe(&sighting);
            let activity = [Activity::Exploring, Activity::SecondChance, Activity::Stopped];
            let activity = activity[usize::from(id) % 3];
            let status = Status { position: Cell::new(y, x), goal: None, activity };
            robot.hear(RobotId(id), status);
            for _ in 0..2 {
                robot.tick();
                prop_assert!(robot.work() <= world::Robot::work_bound(15));
                robot.report(if moved { Motion::Moved } else { Motion::Blocked });
            }
        }
    }
}
