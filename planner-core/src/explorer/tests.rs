//! The explorer in a small world of its own: the obviously correct simulator.

use std::collections::HashMap;
use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::role::exchange;
use crate::sight::look;

type Small = Explorer<3, 3>;

#[derive(Clone, Debug)]
struct Scene {
    extent: Extent,
    walls: Vec<bool>,
    start: Vec<Cell>,
    radius: u8,
    config: Config,
    /// Ticks between two exchanges of maps; 0: never.
    sync: u32,
    /// Steps refused, out of 256, for a while.
    refusals: u8,
    solid: bool,
    trouble: Trouble,
    seed: u64,
}

/// What a robot cannot rely on.
#[derive(Clone, Debug, Default)]
struct Trouble {
    /// Robots that only tell where they are and go, and what each is up to.
    ghosts: Vec<Ghost>,
    /// Cells of which no look says anything.
    silent: Vec<Cell>,
    /// Cells that refuse every step, and whether as a robot that goes first.
    refusing: Vec<(Cell, bool)>,
    /// Degrees in which the sensor looks; 0: all around.
    view: u16,
    /// Ticks in which a robot's poses lie off the grid: robot, first, number.
    astray: Vec<(usize, u32, u32)>,
    /// Of the tiles that could be seen, those out of 256 that are told before the start.
    told: u8,
    /// Looks at a cell that are wrong, out of 256.
    noise: u8,
}

impl Trouble {
    /// Whether a robot may have to give up.
    fn is_any(&self) -> bool {
        !self.silent.is_empty() || !self.refusing.is_empty()
    }
}

/// A robot that is not there, told of so as to do harm.
#[derive(Clone, Copy, Debug)]
struct Ghost {
    id: u8,
    /// What it claims, see [`Ghost::status`].
    aim: u8,
    /// Ticks between two changes of its mind.
    period: u32,
    /// It speaks only until then.
    silence: u32,
}

impl Ghost {
    fn status(self, robot: &Small, tick: u32, dice: &mut Dice) -> Status {
        let here = robot.around.position;
        let goal = robot.status().goal;
        let far = Cell::new(
            i16::from(dice.roll()) % robot.map().extent().width as i16,
            i16::from(dice.roll()) % robot.map().extent().height as i16,
        );
        let is_turn = (tick / self.period).is_multiple_of(2);
        let (position, goal) = match self.aim {
            // On the robot, on its goal, now here and now there, on its goal as soon as
            // its way ends or it has no more changes, at random, or near it.
            0 => (here, None),
            1 => (goal.unwrap_or(here), goal),
            2 if is_turn => (goal.unwrap_or(far), None),
            2 => (far, None),
            3 if robot.role.remaining() < 6 || robot.role.changes >= robot.config.tokens => {
                (goal.unwrap_or(far), None)
            }
            3 => (far, Some(here)),
            4 => (far, Some(far)),
            _ => (here.step(Direction::from_index(dice.roll())), goal),
        };
        let is_done = self.aim == 2 && tick.is_multiple_of(7);
        Status {
            position,
            goal,
            activity: if is_done {
                Activity::Stopped
            } else {
                Activity::Exploring
            },
        }
    }
}

impl Scene {
    fn is_blocked(&self, cell: Cell) -> bool {
        !self.extent.contains(cell)
            || self.walls[cell.y as usize * usize::from(self.extent.width) + cell.x as usize]
    }

    /// The cells that a way leads to over free cells that `passes` lets through.
    fn reachable(&self, from: Cell, passes: impl Fn(Cell) -> bool) -> Vec<Cell> {
        let mut found = vec![from];
        let mut next = 0;
        while let Some(&cell) = found.get(next) {
            for direction in Direction::ALL {
                let beside = cell.step(direction);
                if !self.is_blocked(beside) && !found.contains(&beside) && passes(beside) {
                    found.push(beside);
                }
            }
            next += 1;
        }
        found
    }

    fn is_silent(&self, cell: Cell) -> bool {
        self.trouble.silent.contains(&cell)
    }

    fn refuses(&self, cell: Cell) -> Option<Motion> {
        let found = self.trouble.refusing.iter().find(|(at, _)| *at == cell);
        found.map(|&(_, robot)| if robot { Motion::Held } else { Motion::Blocked })
    }

    /// What a robot that looks to `heading` sees.
    fn look(&self, from: Cell, heading: Direction) -> Sighting {
        let all = look(from, self.radius, |cell| self.is_blocked(cell));
        let is_in_view = |cell: &Cell| {
            if self.trouble.view == 0 {
                return true;
            }
            let (x, y) = heading.delta();
            let (dx, dy) = (f64::from(cell.x - from.x), f64::from(cell.y - from.y));
            let along = dx * f64::from(x) + dy * f64::from(y);
            let across = dx * f64::from(y) - dy * f64::from(x);
            let angle = across.atan2(along).abs().to_degrees();
            angle <= f64::from(self.trouble.view) / 2.0
        };
        let shows = |cell: &Cell| is_in_view(cell) && !self.is_silent(*cell);
        let mut sighting = Sighting::new(from);
        for cell in all.free_cells().filter(shows) {
            sighting.see_free(cell);
        }
        for cell in all.blocked_cells().filter(shows) {
            sighting.see_blocked(cell);
        }
        sighting
    }

    /// Tells a robot, truthfully, tiles of the place where it will be.
    fn tell(&self, robot: &mut Small, start: Cell, dice: &mut Dice) {
        let mut told = Map::<3, 3>::new(self.extent).unwrap();
        for cell in self.reachable(start, |_| true) {
            if !self.is_silent(cell) {
                told.observe(&self.look(cell, Direction::East));
            }
        }
        let mut tiles = TileSet::new();
        for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
            if dice.roll() < self.trouble.told {
                tiles.insert(TileIndex { x, y });
            }
        }
        robot.join(&told, &tiles);
    }
}

/// What a sensor says that is wrong now and then, of any cell but the robot's own.
fn noisy(sighting: &Sighting, noise: u8, dice: &mut Dice) -> Sighting {
    let mut told = Sighting::new(sighting.centre());
    let mut tell = |cell: Cell, blocked: bool| {
        if blocked != (dice.roll() < noise) {
            told.see_blocked(cell);
        } else {
            told.see_free(cell);
        }
    };
    sighting.free_cells().for_each(|cell| tell(cell, false));
    sighting.blocked_cells().for_each(|cell| tell(cell, true));
    told
}

/// No step is refused from this tick on: within the patience of the default
/// configuration, 4 + 8 + … + 256 ticks of pauses before the eighth refusal.
const CLEARED: u32 = 400;

struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u8 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 56) as u8
    }
}

fn trouble(cells: usize, width: u16, robots: usize) -> impl Strategy<Value = Trouble> {
    let cell = move || {
        (0..cells).prop_map(move |i| {
            let (x, y) = (i % usize::from(width), i / usize::from(width));
            Cell::new(x as i16, y as i16)
        })
    };
    let ghost = (
        prop_oneof![Just(0u8), Just(100), any::<u8>()],
        0u8..6,
        1u32..9,
        prop_oneof![0u32..200, Just(u32::MAX)],
    )
        .prop_map(|(id, aim, period, silence)| Ghost {
            id,
            aim,
            period,
            silence,
        });
    let some = |most| prop_oneof![Just(0usize), Just(0), 0..=most];
    let view = prop_oneof![Just(0u16), Just(0), Just(180), Just(90), Just(62), Just(45)];
    (
        prop::collection::vec(ghost, 0..4),
        some(cells / 8).prop_flat_map(move |n| prop::collection::vec(cell(), 0..=n)),
        some(cells / 3)
            .prop_flat_map(move |n| prop::collection::vec((cell(), any::<bool>()), 0..=n)),
        view,
        prop::collection::vec((0..robots, 0u32..300, 1u32..50), 0..3),
        prop_oneof![Just(0u8), any::<u8>()],
    )
        .prop_map(|(ghosts, silent, refusing, view, astray, told)| Trouble {
            ghosts,
            silent,
            refusing,
            view,
            astray,
            told,
            noise: 0,
        })
}

fn sensor() -> impl Strategy<Value = SensorModel> {
    let votes = prop_oneof![Just(Votes::PerLook), Just(Votes::PerPlace)];
    let any_model = (1..=3u8, votes, 1..=15u8, [0..=15u8, 0..=15], any::<bool>()).prop_map(
        |(margin, votes, sure_range, [flip_range, visited_range], sees_robots)| SensorModel {
            margin,
            votes,
            sure_range,
            flip_range,
            visited_range,
            sees_robots,
        },
    );
    prop_oneof![
        Just(SensorModel::truthful()),
        Just(SensorModel::lidar()),
        Just(SensorModel::rangers()),
        any_model,
    ]
}

fn scene(is_troubled: bool) -> impl Strategy<Value = Scene> {
    (4u16..=20, 4u16..=20, 0.0..0.55f64, 1usize..=6, any::<u64>()).prop_flat_map(
        move |(width, height, share, robots, seed)| {
            let cells = usize::from(width) * usize::from(height);
            let disturbance = (
                prop_oneof![Just(0u8), 0u8..100],
                any::<bool>(),
                trouble(cells, width, robots),
                sensor(),
            );
            (
                proptest::collection::vec(proptest::bool::weighted(share), cells),
                proptest::collection::vec(0..cells, robots),
                1u8..=8,
                // A search of one tile a tick takes hundreds of ticks, and trouble many.
                prop_oneof![Just(1u32), Just(4), 64u32..2000]
                    .prop_map(move |slice| if is_troubled { slice.max(64) } else { slice }),
                prop_oneof![Just(8u16), Just(256)],
                prop_oneof![Just(0u32), Just(1), 2u32..50],
                disturbance,
            )
                .prop_map(
                    move |(mut walls, starts, radius, slice, way, sync, rest)| {
                        let (refusals, solid, mut trouble, mut sensor) = rest;
                        for &start in &starts {
                            walls[start] = false;
                        }
                        let mut start: Vec<_> = starts
                            .iter()
                            .map(|&i| {
                                let (x, y) = (i % usize::from(width), i / usize::from(width));
                                Cell::new(x as i16, y as i16)
                            })
                            .collect();
                        if solid {
                            start.sort();
                            start.dedup();
                        }
                        if !is_troubled {
                            trouble = Trouble::default();
                            sensor = SensorModel::truthful();
                        }
                        trouble.astray.retain(|(robot, ..)| *robot < start.len());
                        // A robot that leaves such a cell cannot go back.
                        trouble.refusing.retain(|(cell, _)| !start.contains(cell));
                        Scene {
                            extent: Extent::new(width, height),
                            walls,
                            start,
                            radius,
                            config: Config {
                                slice,
                                way,
                                sensor,
                                ..Config::new()
                            },
                            sync,
                            refusals,
                            solid,
                            trouble,
                            seed,
                        }
                    },
                )
        },
    )
}

struct Ended {
    robots: Vec<Small>,
    stops: Vec<Option<Stop>>,
    ticks: u32,
}

/// Runs until every robot has stopped, or `limit` ticks.
fn run(scene: &Scene, limit: u32) -> Ended {
    let mut dice = Dice(scene.seed);
    let mut robots: Vec<Small> = scene
        .start
        .iter()
        .zip(0u8..)
        .map(|(&start, id)| Small::new(scene.config, RobotId(id), scene.extent, start).unwrap())
        .collect();
    for (robot, &start) in robots.iter_mut().zip(&scene.start) {
        scene.tell(robot, start, &mut dice);
    }
    let mut at = scene.start.clone();
    let mut heading = vec![Direction::East; robots.len()];
    let mut stops = vec![None; robots.len()];
    let all = {
        let mut all = TileSet::new();
        for y in 0..3 {
            for x in 0..3 {
                all.insert(crate::tile::TileIndex { x, y });
            }
        }
        all
    };
    let mut looks = HashMap::new();
    let mut ticks = 0;
    while stops.iter().any(Option::is_none) && ticks < limit {
        let ticks_now = ticks;
        let is_astray = |robot: usize| {
            let mut spells = scene.trouble.astray.iter();
            spells
                .any(|&(of, from, ticks)| of == robot && (from..from + ticks).contains(&ticks_now))
        };
        for (i, robot) in robots.iter_mut().enumerate() {
            if is_astray(i) {
                robot.observe(&Sighting::new(Cell::new(-7, 300)));
            } else {
                let (place, side) = (at[i], heading[i]);
                let look = looks
                    .entry((place.x, place.y, side as u8))
                    .or_insert_with(|| scene.look(place, side));
                match scene.trouble.noise {
                    0 => robot.observe(look),
                    noise => robot.observe(&noisy(look, noise, &mut dice)),
                };
            }
            for ghost in &scene.trouble.ghosts {
                if ticks < ghost.silence && usize::from(ghost.id) != i {
                    let status = ghost.status(robot, ticks, &mut dice);
                    robot.hear(RobotId(ghost.id), status);
                }
            }
        }
        if scene.sync > 0 && ticks % scene.sync == 0 {
            let told: Vec<_> = robots
                .iter()
                .map(|r| (r.map().clone(), r.status()))
                .collect();
            for (i, robot) in robots.iter_mut().enumerate() {
                for (j, (map, status)) in told.iter().enumerate() {
                    if i != j && dice.roll() > 40 {
                        robot.join(map, &all);
                        robot.hear(RobotId(j as u8), *status);
                    }
                }
            }
        }
        let mut acted = Vec::new();
        for i in 0..robots.len() {
            let rank = robots[i].role().unwrap().rank();
            if acted.contains(&rank) {
                continue;
            }
            match robots[i].tick() {
                Action::Move(step) => {
                    assert!(!is_astray(i), "a step from nowhere");
                    let next = at[i].step(step);
                    heading[i] = step;
                    if scene.trouble.noise > 0 && scene.is_blocked(next) {
                        robots[i].report(Motion::Blocked);
                        continue;
                    }
                    assert!(!scene.is_blocked(next), "a step into an obstacle at {next}");
                    assert!(robots[i].work() <= scene.config.work_bound());
                    let holder = at.iter().position(|&cell| cell == next);
                    match holder {
                        _ if scene.refuses(next).is_some() => {
                            robots[i].report(scene.refuses(next).unwrap());
                        }
                        _ if ticks < CLEARED && dice.roll() < scene.refusals => {
                            robots[i].report(Motion::Blocked);
                        }
                        Some(j) if scene.solid => {
                            let (mine, theirs) =
                                (robots[i].role().unwrap(), robots[j].role().unwrap());
                            if acted.contains(&theirs.rank()) {
                                robots[i].report(Motion::Held);
                                continue;
                            }
                            match exchange(&mine, at[i], &theirs, at[j]) {
                                None => robots[i].report(Motion::Held),
                                Some((here, there)) => {
                                    let (a, b) = (robots[i].map().clone(), robots[j].map().clone());
                                    robots[i].join(&b, &all);
                                    robots[j].join(&a, &all);
                                    robots[i].adopt(here);
                                    robots[j].adopt(there);
                                    acted.extend([mine.rank(), theirs.rank()]);
                                }
                            }
                        }
                        _ => {
                            at[i] = next;
                            robots[i].report(Motion::Moved);
                        }
                    }
                }
                Action::Wait => match robots[i].waiting() {
                    Some(Wait::Look(direction)) => heading[i] = direction,
                    Some(reason) => assert_eq!(is_astray(i), reason == Wait::Pose),
                    None => panic!("it waits without a reason"),
                },
                Action::Stop(_) => {}
            }
        }
        for (robot, stop) in robots.iter().zip(&mut stops) {
            *stop = robot.role.stopped.get();
        }
        ticks += 1;
    }
    Ended {
        robots,
        stops,
        ticks,
    }
}

/// Every robot stops; what its sensor could show it from where it could go, it knows; and
/// its reason says no more than is so.
fn assert_truthful(scene: &Scene) -> Result<(), TestCaseError> {
    let ended = run(scene, 100_000);
    // Without trouble there is no reason to give up. Bodies that see little and may not
    // pass each other can be in each other's way for good.
    let is_crowd_in_the_dark = scene.solid && scene.trouble.view > 0;
    let is_troubled = scene.trouble.is_any() || is_crowd_in_the_dark;
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
        let all = scene.reachable(start, |_| true);
        if stop.is_complete() {
            prop_assert_eq!(all.iter().find(|cell| is_missing(cell)), None, "{}", told);
        }
        // What no look shows, nobody enters; what refuses, neither.
        let passes = |cell| !scene.is_silent(cell) && scene.refuses(cell).is_none();
        // Robots that may not share a cell and have given up are in each other's way.
        let is_crowded = scene.solid && !stop.is_complete();
        let free = if is_crowded {
            Vec::new()
        } else {
            scene.reachable(start, passes)
        };
        for cell in free {
            for seen in Direction::ALL.map(|direction| cell.step(direction)) {
                let shows = scene.extent.contains(seen) && !scene.is_silent(seen);
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
            Stop::BackAtStart { .. } | Stop::NoTrace { .. } => prop_assert!(false, "{}", told),
        }
        if scene.start.len() == 1 && !matches!(stop, Stop::AtEdge { .. }) {
            prop_assert_eq!(stop.left(), robot.map().frontiers(), "{}", told);
        }
    }
    Ok(())
}

/// As many small worlds as `PROPTEST_CASES` says, or these.
fn soak() -> ProptestConfig {
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

/// A corridor with a door in the middle, which is free when it is first seen.
fn before_a_door(config: Config) -> (Small, impl Fn(Cell, bool) -> bool) {
    let extent = Extent::new(12, 3);
    let robot = Small::new(config, RobotId(0), extent, Cell::new(1, 1)).unwrap();
    let is_blocked = move |cell: Cell, is_shut: bool| {
        cell.y != 1 || !(1..11).contains(&cell.x) || is_shut && cell == Cell::new(5, 1)
    };
    (robot, is_blocked)
}

/// Goes on until the robot stops or waits on patrol; whether the door is shut follows from
/// the robot's column.
fn go(
    robot: &mut Small,
    is_blocked: &impl Fn(Cell, bool) -> bool,
    is_shut: impl Fn(i16) -> bool,
) -> Option<Stop> {
    for _ in 0..2000 {
        let here = robot.status().position;
        robot.observe(&look(here, 3, |cell| is_blocked(cell, is_shut(here.x))));
        match robot.tick() {
            Action::Move(step) if is_blocked(here.step(step), is_shut(here.x)) => {
                panic!("a bump, where looks are right");
            }
            Action::Move(_) => robot.report(Motion::Moved),
            Action::Wait if robot.waiting() == Some(Wait::Patrol) => return None,
            Action::Wait => {}
            Action::Stop(stop) => return Some(stop),
        }
    }
    panic!("it goes on and on");
}

const DOOR: Cell = Cell::new(5, 1);

fn models() -> [SensorModel; 3] {
    [
        SensorModel::truthful(),
        SensorModel::lidar(),
        SensorModel::rangers(),
    ]
}

#[test]
fn a_door_that_is_shut_is_named_and_visited_after_resume() {
    for sensor in models() {
        let (mut robot, is_blocked) = before_a_door(Config {
            sensor,
            ..Config::new()
        });
        assert_eq!(go(&mut robot, &is_blocked, |x| x > 2), Some(Stop::Complete));
        assert_eq!(
            (robot.map().shut().cells(), robot.map().shut().places()),
            (1, &[DOOR][..])
        );
        assert!(!robot.map().is_known(Cell::new(9, 1)));
        // Nothing has opened: it looks, and stops again.
        robot.resume();
        assert_eq!(go(&mut robot, &is_blocked, |_| true), Some(Stop::Complete));
        assert_eq!(robot.map().shut().places(), [DOOR]);
        robot.resume();
        assert_eq!(go(&mut robot, &is_blocked, |_| false), Some(Stop::Complete));
        assert_eq!(robot.map().shut().cells(), 0);
        assert!(robot.map().is_free(Cell::new(10, 1)));
    }
}

#[test]
fn a_robot_on_patrol_looks_at_shut_places_in_turn_instead_of_stopping() {
    for sensor in models() {
        let (mut robot, is_blocked) = before_a_door(Config {
            sensor,
            patrol: 50,
            ..Config::new()
        });
        assert_eq!(go(&mut robot, &is_blocked, |x| x > 2), None);
        assert_eq!(robot.map().shut().places(), [DOOR]);
        for tick in 0..300 {
            let here = robot.status().position;
            robot.observe(&look(here, 3, |cell| is_blocked(cell, true)));
            match robot.tick() {
                Action::Move(_) => robot.report(Motion::Moved),
                Action::Wait => {}
                Action::Stop(stop) => panic!("{stop} after {tick} ticks on patrol"),
            }
        }
        // Once it is open and all is known, nothing is left to watch.
        let stop = (0..20).find_map(|_| go(&mut robot, &is_blocked, |_| false));
        assert_eq!(stop, Some(Stop::Complete));
        assert!(robot.map().is_free(Cell::new(10, 1)));
    }
}

/// What a look saw in the way of a robot stops it before any map does.
#[test]
fn a_robot_does_not_step_into_what_it_sees() {
    for sensor in models() {
        let (mut robot, is_blocked) = before_a_door(Config {
            sensor,
            ..Config::new()
        });
        // Somebody stands in the door for two ticks, just before the robot enters it.
        let mut waited = 0;
        for tick in 0..200 {
            let here = robot.status().position;
            let is_there = here == Cell::new(4, 1) && waited < 2;
            robot.observe(&look(here, 3, |cell| is_blocked(cell, is_there)));
            match robot.tick() {
                Action::Move(_) if is_there => panic!("it steps on somebody, in tick {tick}"),
                Action::Move(_) => robot.report(Motion::Moved),
                Action::Wait => waited += u32::from(is_there),
                Action::Stop(stop) => {
                    assert!(stop.is_complete());
                    break;
                }
            }
        }
        assert!(robot.map().is_free(Cell::new(10, 1)), "{:?}", robot.map());
    }
}

#[test]
fn a_robot_does_not_take_another_for_a_wall() {
    let extent = Extent::new(12, 3);
    let config = Config {
        sensor: SensorModel::lidar(),
        ..Config::new()
    };
    let mut robot = Small::new(config, RobotId(0), extent, Cell::new(1, 1)).unwrap();
    let other = Cell::new(3, 1);
    let status = Status {
        position: other,
        goal: None,
        activity: Activity::Stopped,
    };
    for _ in 0..10 {
        robot.hear(RobotId(1), status);
        robot.observe(&look(Cell::new(1, 1), 3, |cell| {
            !extent.contains(cell) || cell == other
        }));
        robot.tick();
        robot.report(Motion::Held);
    }
    assert!(!robot.map().is_obstacle(other) && !robot.map().is_doubtful(other));
    // Unheard, it is one.
    let mut robot = Small::new(config, RobotId(0), extent, Cell::new(1, 1)).unwrap();
    for _ in 0..10 {
        robot.observe(&look(Cell::new(1, 1), 3, |cell| {
            !extent.contains(cell) || cell == other
        }));
        robot.tick();
        robot.report(Motion::Held);
    }
    assert!(robot.map().is_obstacle(other));
}

/// Walls that somebody forged around a robot, on every cell that it sees free.
fn walled_in(robot: &mut Small, seen: &Sighting) {
    let mut told = Map::<3, 3>::new(robot.map().extent()).unwrap();
    let mut tiles = TileSet::new();
    for cell in seen.free_cells() {
        let (at, bit) = TileIndex::of(cell).unwrap();
        told.join_tile(at, crate::map::Tile::seen(0, bit));
        tiles.insert(at);
    }
    robot.join(&told, &tiles);
}

/// Explores alone, walled in at that tick; the cells that it could reach and does not know.
fn unseen_after_false_walls(scene: &Scene, at: u32) -> usize {
    let start = scene.start[0];
    let mut robot = Small::new(scene.config, RobotId(0), scene.extent, start).unwrap();
    let mut here = start;
    for tick in 0..20_000 {
        let seen = scene.look(here, Direction::East);
        robot.observe(&seen);
        if tick == at {
            walled_in(&mut robot, &seen);
        }
        match robot.tick() {
            Action::Move(step) => {
                here = here.step(step);
                robot.report(Motion::Moved);
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                assert!(stop.is_complete(), "{stop}");
                let reachable = scene.reachable(start, |_| true).into_iter();
                return reachable
                    .filter(|cell| !robot.map().is_known(*cell))
                    .count();
            }
        }
    }
    panic!("it goes on and on");
}

/// The worst places in sight: every cell that the robot sees free becomes a wall, once, at
/// any time. It explores all the same, but for what lies behind false walls that it never
/// sees again: it remembers eight of them.
#[test]
fn false_walls_in_sight_cost_a_detour_at_most() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut incomplete, mut unseen, mut cells) = (0, 0, 0);
    for at in 0..300 {
        let mut scene = scene(false).new_tree(&mut runner).unwrap().current();
        scene.radius = scene.radius.max(3);
        if at % 2 == 0 {
            scene.config.sensor = SensorModel::lidar();
        }
        let missed = unseen_after_false_walls(&scene, at / 4);
        incomplete += usize::from(missed > 0);
        unseen += missed;
        cells += scene.reachable(scene.start[0], |_| true).len();
    }
    assert!(incomplete <= 6, "{incomplete} of 300 incomplete");
    assert!(unseen * 500 <= cells, "{unseen} of {cells} cells unseen");
}
