//! A small world with robots in it, drawn at random, and what becomes of them.

use std::boxed::Box;
use std::collections::HashMap;
use std::sync::Mutex;
use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::map::CellSet;
use crate::planner::{Errands, KeepOutError};
use crate::role::exchange;
use crate::sight::look;

#[derive(Clone, Debug)]
pub(in crate::explorer) struct Scene {
    pub(in crate::explorer) extent: Extent,
    pub(in crate::explorer) walls: Vec<bool>,
    pub(in crate::explorer) start: Vec<Cell>,
    pub(in crate::explorer) radius: u8,
    pub(in crate::explorer) config: Config,
    /// Ticks between two exchanges of maps; 0: never.
    pub(in crate::explorer) sync: u32,
    /// Steps refused, out of 256, for a while.
    pub(in crate::explorer) refusals: u8,
    pub(in crate::explorer) solid: bool,
    pub(in crate::explorer) trouble: Trouble,
    pub(in crate::explorer) seed: u64,
    /// Steps that each robot's energy lasts for, and ticks after which it is told again.
    pub(in crate::explorer) energy: Option<(u32, u32)>,
    /// What each robot keeps out of, none or as many as robots, and from which tick on.
    pub(in crate::explorer) kept_out: Vec<Vec<Cell>>,
    pub(in crate::explorer) kept_from: u32,
}

/// Cells for as long as the tests run, remembered so that none are lost.
pub(in crate::explorer) fn kept(cells: &[Cell]) -> &'static CellSet<3, 3> {
    static ALL: Mutex<Vec<&'static CellSet<3, 3>>> = Mutex::new(Vec::new());
    let mut set = CellSet::new();
    cells.iter().for_each(|cell| set.insert(*cell));
    let set = Box::leak(Box::new(set));
    ALL.lock().unwrap().push(set);
    set
}

/// What a robot cannot rely on.
#[derive(Clone, Debug, Default)]
pub(in crate::explorer) struct Trouble {
    /// Robots that only tell where they are and go, and what each is up to.
    pub(in crate::explorer) ghosts: Vec<Ghost>,
    /// Cells of which no look says anything.
    pub(in crate::explorer) silent: Vec<Cell>,
    /// Cells that refuse every step, and whether as a robot that goes first.
    pub(in crate::explorer) refusing: Vec<(Cell, bool)>,
    /// Degrees in which the sensor looks; 0: all around.
    pub(in crate::explorer) view: u16,
    /// Ticks in which a robot's poses lie off the grid: robot, first, number.
    pub(in crate::explorer) astray: Vec<(usize, u32, u32)>,
    /// Of the tiles that could be seen, those out of 256 that are told before the start.
    pub(in crate::explorer) told: u8,
    /// Looks at a cell that are wrong, out of 256.
    pub(in crate::explorer) noise: u8,
}

impl Trouble {
    /// Whether a robot may have to give up.
    pub(in crate::explorer) fn is_any(&self) -> bool {
        !self.silent.is_empty() || !self.refusing.is_empty()
    }
}

/// A robot that is not there, told of so as to do harm.
#[derive(Clone, Copy, Debug)]
pub(in crate::explorer) struct Ghost {
    pub(in crate::explorer) id: u8,
    /// What it claims, see [`Ghost::status`].
    pub(in crate::explorer) aim: u8,
    /// Ticks between two changes of its mind.
    pub(in crate::explorer) period: u32,
    /// It speaks only until then.
    pub(in crate::explorer) silence: u32,
}

impl Ghost {
    pub(in crate::explorer) fn status(self, robot: &Small, tick: u32, dice: &mut Dice) -> Status {
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
    pub(in crate::explorer) fn is_blocked(&self, cell: Cell) -> bool {
        !self.extent.contains(cell)
            || self.walls[cell.y as usize * usize::from(self.extent.width) + cell.x as usize]
    }

    /// The cells that a way leads to over free cells that `passes` lets through.
    pub(in crate::explorer) fn reachable(
        &self,
        from: Cell,
        passes: impl Fn(Cell) -> bool,
    ) -> Vec<Cell> {
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

    pub(in crate::explorer) fn is_silent(&self, cell: Cell) -> bool {
        self.trouble.silent.contains(&cell)
    }

    pub(in crate::explorer) fn refuses(&self, cell: Cell) -> Option<Motion> {
        let found = self.trouble.refusing.iter().find(|(at, _)| *at == cell);
        found.map(|&(_, robot)| if robot { Motion::Held } else { Motion::Blocked })
    }

    /// What a robot that looks to `heading` sees.
    pub(in crate::explorer) fn look(&self, from: Cell, heading: Direction) -> Sighting {
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
    pub(in crate::explorer) fn tell(&self, robot: &mut Small, start: Cell, dice: &mut Dice) {
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
pub(in crate::explorer) fn noisy(sighting: &Sighting, noise: u8, dice: &mut Dice) -> Sighting {
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
pub(in crate::explorer) const CLEARED: u32 = 400;

pub(in crate::explorer) struct Dice(u64);

impl Dice {
    pub(in crate::explorer) fn roll(&mut self) -> u8 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 56) as u8
    }
}

pub(in crate::explorer) fn trouble(
    cells: usize,
    width: u16,
    robots: usize,
) -> impl Strategy<Value = Trouble> {
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

pub(in crate::explorer) fn sensor() -> impl Strategy<Value = SensorModel> {
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

pub(in crate::explorer) fn scene(is_troubled: bool) -> impl Strategy<Value = Scene> {
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
                // A search of one cell a tick takes hundreds of ticks, and trouble many.
                prop_oneof![Just(1u32), Just(400), 6_000u32..200_000]
                    .prop_map(move |slice| if is_troubled { slice.max(6_000) } else { slice }),
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
                            energy: None,
                            kept_out: Vec::new(),
                            kept_from: 0,
                        }
                    },
                )
        },
    )
}

/// So many steps take the robot home, over what it knows to be free.
fn assert_comes_home(robot: &Small, energy: u32) {
    let (home, here) = (robot.role.home, robot.around.position);
    let mut layer = vec![here];
    let mut reached = layer.clone();
    for _ in 0..energy {
        if reached.contains(&home) {
            break;
        }
        let beside = layer
            .iter()
            .flat_map(|cell| Direction::ALL.map(|side| cell.step(side)));
        let mut next: Vec<_> = beside.filter(|cell| robot.map().is_free(*cell)).collect();
        next.sort();
        next.dedup();
        next.retain(|cell| !reached.contains(cell));
        reached.extend(&next);
        layer = next;
    }
    assert!(
        reached.contains(&home),
        "caught out at {here}, home is {home}, {energy} left, {:?} {:?}\n{:?}",
        robot.budget,
        robot.role,
        robot.map()
    );
}

pub(in crate::explorer) struct Ended {
    pub(in crate::explorer) robots: Vec<Small>,
    pub(in crate::explorer) stops: Vec<Option<Stop>>,
    pub(in crate::explorer) ticks: u32,
}

/// Runs until every robot has stopped, or `limit` ticks.
pub(in crate::explorer) fn run(scene: &Scene, limit: u32) -> Ended {
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
    let mut steps = vec![0; robots.len()];
    let mut looks = HashMap::new();
    let mut ticks = 0;
    while stops.iter().any(Option::is_none) && ticks < limit || ticks <= scene.kept_from {
        if ticks == scene.kept_from {
            for (robot, cells) in robots.iter_mut().zip(&scene.kept_out) {
                let (here, home) = (robot.around.position, robot.role.home);
                let result = robot.keep_out(Some(kept(cells)));
                assert_eq!(
                    result,
                    match () {
                        () if cells.contains(&here) => Err(KeepOutError::Robot(here)),
                        () if cells.contains(&home) => Err(KeepOutError::Home(home)),
                        () => Ok(()),
                    }
                );
            }
        }
        if let Some((energy, period)) = scene.energy {
            for (robot, steps) in robots.iter_mut().zip(&steps) {
                if ticks % period == 0 {
                    robot.energy(energy - steps);
                }
                assert_comes_home(robot, energy - steps);
            }
        }
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
            let rank = robots[i].role.rank;
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
                    let keeps_out = robots[i].map().keeps_out(next);
                    assert!(!keeps_out, "a step to where it keeps out, {next}");
                    assert!(robots[i].work() <= scene.config.work_bound());
                    let holder = at.iter().position(|&cell| cell == next);
                    match holder {
                        _ if scene.refuses(next).is_some() => {
                            robots[i].report(scene.refuses(next).unwrap());
                        }
                        _ if ticks < CLEARED && dice.roll() < scene.refusals => {
                            robots[i].report(Motion::Blocked);
                        }
                        Some(_) if scene.solid && scene.energy.is_some() => {
                            assert_eq!(robots[i].role(), None);
                            robots[i].report(Motion::Blocked);
                        }
                        Some(j) if scene.solid => {
                            let (mine, theirs) =
                                (robots[i].role().unwrap(), robots[j].role().unwrap());
                            if acted.contains(&theirs.rank()) {
                                robots[i].report(Motion::Held);
                                continue;
                            }
                            let exchanged = exchange(&mine, at[i], &theirs, at[j]);
                            let (a, b) = (robots[i].map().clone(), robots[j].map().clone());
                            robots[i].join(&b, &all);
                            robots[j].join(&a, &all);
                            match exchanged {
                                None => robots[i].report(Motion::Held),
                                Some((here, there)) => {
                                    robots[i].adopt(here);
                                    robots[j].adopt(there);
                                    acted.extend([mine.rank(), theirs.rank()]);
                                }
                            }
                        }
                        _ => {
                            at[i] = next;
                            steps[i] += 1;
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
