//! Instructions on this machine: the same figure in every run, and what changed since
//! the last one.
//!
//! `cargo bench -p host-sim --bench instructions -- --nocapture=stdout`
//!
//! Ten explorers on a cave of 64×64 cells: a whole run in the simulator with an exchange
//! in every tick, by either medium; the first ticks of 255 of them by radio on 128×128
//! cells; the calls of one robot among ten that talk by radio; and a step of CAO.
//! Divide a run's instructions by the robot-ticks that it prints; without the option they
//! stay hidden.
//!
//! It needs Valgrind (`apt-get install valgrind`) and the harness's runner, in the
//! version of the crate: `cargo install gungraun-runner --version 0.20.0`. It says so when
//! one is missing.

// The harness's macros make everything public.
#![allow(missing_docs)]

use std::hint::black_box;
use std::sync::Arc;

use gungraun::{library_benchmark, library_benchmark_group, main};
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Outcome, run};
use host_sim::scenario::MediumKind;
use host_sim::scenario::grid::Scenario;
use host_sim::sensor::Sensor;
use host_sim::world::{Family, Starts, World, generate};
use planner_core::cao::{Degree, Frame, Model, Sample};
use planner_core::explorer::{Config, Explorer};
use planner_core::radio::MAX_LEN;
use planner_core::rng::Rng;
use planner_core::{Action, Cell, Direction, Inspect, Motion, Planner, Point, RobotId};

const RANGE: u8 = 5;
const ROBOTS: usize = 10;

fn world() -> Arc<World> {
    Arc::new(generate(Family::Cave, 64, 64, 1).expect("a world of 64×64 cells"))
}

fn starts(world: &World) -> Vec<Cell> {
    let starts = world.place(ROBOTS, &Starts::Random(1), false);
    starts.expect("robots may share a cell")
}

/// A sensor that has looked from everywhere: what a look costs is the world's affair.
fn sensor(world: &Arc<World>) -> Arc<Sensor> {
    let sensor = Sensor::new(world.clone(), RANGE);
    for cell in world.free_cells() {
        sensor.view(cell, Direction::East);
    }
    Arc::new(sensor)
}

fn exploration(medium: MediumKind, robots: usize, side: u16, most: u32) -> Scenario {
    let world = generate(Family::Cave, side, side, 1).expect("a world of this size");
    let starts = world.place(robots, &Starts::Random(1), false);
    let starts = starts.expect("robots may share a cell");
    let mut scenario = Scenario::new(Arc::new(world), starts, PlannerKind::Explorer);
    scenario.conditions.medium = medium;
    scenario.conditions.max_ticks = scenario.conditions.max_ticks.min(most);
    scenario
}

fn print_robot_ticks(outcome: Outcome) {
    println!(
        "{} robot-ticks",
        outcome.ticks as usize * outcome.robots.len()
    );
}

// With a sensor that has looked from nowhere.
#[library_benchmark]
#[bench::ideal(args = (MediumKind::Ideal, ROBOTS, 64, u32::MAX), setup = exploration, teardown = print_robot_ticks)]
#[bench::radio(args = (MediumKind::Radio, ROBOTS, 64, u32::MAX), setup = exploration, teardown = print_robot_ticks)]
#[bench::crowd(args = (MediumKind::Radio, 255, 128, 60), setup = exploration, teardown = print_robot_ticks)]
fn whole_run(scenario: Scenario) -> Outcome {
    let (outcome, _) = run(&scenario, Options::default()).expect("the scenario is in range");
    outcome
}

/// Robots that talk by radio.
struct Team {
    sensor: Arc<Sensor>,
    robots: Vec<Box<Explorer<8, 8>>>,
}

/// One robot just before a call.
type Alone = (Box<Explorer<8, 8>>, Arc<Sensor>);

impl Team {
    fn new() -> Self {
        let world = world();
        let extent = world.extent();
        let robot = |(start, id)| {
            let robot = Explorer::new(Config::new(), RobotId(id), extent, start);
            Box::new(robot.expect("the map holds the world"))
        };
        Self {
            robots: starts(&world).into_iter().zip(0..).map(robot).collect(),
            sensor: sensor(&world),
        }
    }

    fn look(&mut self) {
        for robot in &mut self.robots {
            let here = robot.status().position;
            robot.observe(&self.sensor.view(here, Direction::East).sighting);
        }
    }

    fn talk(&mut self) {
        let mut frame = [0; MAX_LEN];
        for from in 0..ROBOTS {
            while let Some(length) = self.robots[from].transmit(&mut frame) {
                for to in (0..ROBOTS).filter(|&to| to != from) {
                    let heard = self.robots[to].receive(&frame[..length]);
                    heard.expect("a robot of this team sent it");
                }
            }
        }
    }

    /// Whether anybody goes on.
    fn decide(&mut self) -> bool {
        let mut goes_on = false;
        for robot in &mut self.robots {
            let action = robot.tick();
            if matches!(action, Action::Move(_)) {
                robot.report(Motion::Moved);
            }
            goes_on |= !matches!(action, Action::Stop(_));
        }
        goes_on
    }

    fn after(ticks: usize) -> Self {
        let mut team = Self::new();
        for _ in 0..ticks {
            team.look();
            team.talk();
            team.decide();
        }
        team
    }

    fn into_alone(mut self, robot: usize) -> Alone {
        (self.robots.swap_remove(robot), self.sensor)
    }
}

/// A robot before the tick that has more work than `percent` of all that have any.
fn before_tick(percent: usize) -> Alone {
    let mut team = Team::new();
    let mut ticks = Vec::new();
    for tick in 0.. {
        team.look();
        team.talk();
        let goes_on = team.decide();
        let work = team.robots.iter().map(|robot| robot.work());
        ticks.extend(work.zip(0..).map(|(work, robot)| (work, tick, robot)));
        if !goes_on {
            break;
        }
    }
    ticks.retain(|&(work, ..)| work > 0);
    ticks.sort_unstable();
    let (_, tick, robot) = ticks[(ticks.len() - 1) * percent / 100];
    let mut team = Team::after(tick);
    team.look();
    team.talk();
    team.into_alone(robot)
}

#[library_benchmark]
#[bench::median(args = (50), setup = before_tick)]
#[bench::longest(args = (100), setup = before_tick)]
fn tick((mut robot, sensor): Alone) -> (Action, Alone) {
    (black_box(robot.tick()), (robot, sensor))
}

fn before_look(ticks: usize) -> Alone {
    Team::after(ticks).into_alone(0)
}

#[library_benchmark]
#[bench::on_the_way(args = (20), setup = before_look)]
fn observe((mut robot, sensor): Alone) -> Alone {
    let here = robot.status().position;
    robot.observe(&sensor.view(here, Direction::East).sighting);
    (robot, sensor)
}

fn before_frame(ticks: usize) -> (Alone, Vec<u8>) {
    let mut team = Team::after(ticks);
    team.look();
    let mut frame = [0; MAX_LEN];
    let length = team.robots[1].transmit(&mut frame);
    let length = length.expect("a robot that has just looked has something to say");
    (team.into_alone(0), frame[..length].to_vec())
}

#[library_benchmark]
#[bench::tile(args = (20), setup = before_frame)]
fn receive(((mut robot, sensor), frame): (Alone, Vec<u8>)) -> (Alone, Vec<u8>) {
    let heard = robot.receive(black_box(&frame));
    heard.expect("a robot of this team sent it");
    ((robot, sensor), frame)
}

const HERE: Point = Point::new(50.0, 50.0, 5.0);

fn history() -> ([Sample; 8], Rng) {
    let mut rng = Rng::new(1, 0);
    let samples = std::array::from_fn(|_| {
        let (x, y, z) = rng.direction();
        Sample {
            at: HERE.offset(8.0 * x, 8.0 * y, 8.0 * z),
            value: 30.0 * rng.unit(),
            weight: 1.0,
        }
    });
    (samples, rng)
}

// A fit to a full history, and the best of 100 candidates.
#[library_benchmark]
#[bench::full_history(args = (), setup = history)]
fn cao((samples, mut rng): ([Sample; 8], Rng)) -> f32 {
    let frame = Frame {
        origin: HERE,
        scale: 1.0 / 8.0,
    };
    let model = Model::fit::<8>(&samples, frame, Degree::Cubic, 8e-4);
    let model = model.expect("the samples are in general position");
    let values = (0..100).map(|_| {
        let (x, y, z) = rng.direction();
        model.value(HERE.offset(2.0 * x, 2.0 * y, 2.0 * z))
    });
    values.fold(f32::MIN, f32::max)
}

library_benchmark_group!(
    name = instructions,
    benchmarks = [whole_run, tick, observe, receive, cao]
);

main!(library_benchmark_groups = instructions);
