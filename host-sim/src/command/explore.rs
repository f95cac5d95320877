//! `host-sim explore`.

use std::error::Error;
use std::fmt::Display;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;
use std::sync::Arc;

use clap::Args;
use host_sim::draw::{self, Coverage};
use host_sim::files;
use host_sim::measured::Measured;
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::run::{self, Options, Outcome, Progress, Stepping};
use host_sim::scans::Laser;
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Area, ConditionsArgs, MediumKind, MotionArgs, Save, ScenarioError};
use host_sim::sensor::ALL_AROUND;
use host_sim::summary::Summary;
use host_sim::world::{KnownMap, ReadOptions, Scale, Starts, World};
use planner_core::Cell;

use super::output::OutputArgs;
use super::report;
use super::{Done, left_out, tell_notes};
use crate::interrupt;

/// Seed of all chance unless said otherwise.
const SEED: u64 = 1;
/// Bytes of a save that are read: more than 255 robots on the largest map take.
const MOST_SAVE: u64 = 64 << 20;

#[derive(Args)]
pub(crate) struct Explore {
    /// The map: .png, .pgm, .yaml (ROS map_server), .map (MovingAI) or .txt. What it
    /// calls unknown (map_saver's gray 205, transparent pixels) robots do not enter.
    map: PathBuf,
    /// The planner of each robot.
    #[arg(long, value_name = "NAME", default_value = "explorer")]
    planner: PlannerKind,
    /// Number of robots, 1 to 255.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..))]
    robots: u8,
    /// Where robots start: X,Y (column and row from 0 at the top left; repeat
    /// it for several), center, corner, random, or spread: far apart. Default: the
    /// digits in a text map, else center.
    #[arg(long, value_name = "WHERE")]
    start: Vec<Start>,
    /// Sensor range in cells, 1 to 31.
    #[arg(long, value_name = "R", default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..=31))]
    range: u8,
    /// The sensor's field of view around the robot's heading in degrees, 1 to 360;
    /// below 360, for the explorer alone, robots turn to look around.
    #[arg(long, value_name = "DEGREES", default_value_t = ALL_AROUND, value_parser = clap::value_parser!(u16).range(1..=360))]
    fov: u16,
    /// A cell holds at most one robot.
    #[arg(long)]
    solid: bool,
    /// Robots are discs that reach N cells beyond the one of their centre, 0 to 3, and touch
    /// nothing. For the explorer alone; robots that start together start beside each other.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(..=3))]
    clearance: u8,
    /// Images: N×N pixels are one cell.
    #[arg(long, value_name = "N", conflicts_with = "cell_size", value_parser = clap::value_parser!(u32).range(1..))]
    pixels_per_cell: Option<u32>,
    /// Maps with a resolution: side of a cell in metres.
    #[arg(long, value_name = "METRES")]
    cell_size: Option<f64>,
    /// Also write what a laser on each robot would have measured in every cell that it
    /// entered, with errors of 1 cm in ranges and of 3 cm and 1° in poses: a log for
    /// `replay-scans`. Cells are 0.25 m wide if the map does not say it.
    #[arg(long, value_name = "FILE")]
    scans: Option<PathBuf>,
    /// Also write a recording (MCAP) of ROS 2 messages, which Foxglove and other viewers
    /// open: maps, poses, goals and scans. Compile with `--features mcap`.
    #[arg(long, value_name = "FILE")]
    mcap: Option<PathBuf>,
    /// Also write what the planners know when the run ends, for --restore. The first Ctrl-C
    /// ends the run then. Explorer only.
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Go on from a file of --save: in the same map, with as many robots, from where they
    /// were.
    #[arg(long, value_name = "FILE", conflicts_with = "start")]
    restore: Option<PathBuf>,
    /// An image or the YAML file of one, as a map of the same size: robots keep out of what is
    /// black or unknown there (nav2's keepout filter takes such masks).
    #[arg(long, value_name = "FILE")]
    keep_out_mask: Option<PathBuf>,
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    conditions: ConditionsArgs,
}

/// Side of a cell: as the map or --cell says, else as wide as recordings take it.
fn metres_per_cell(scenario: &Scenario) -> f64 {
    let of_map = scenario.world.metres_per_cell();
    let of_motion = scenario.motion.map(|motion| motion.cell);
    { of_map.or(of_motion) }.unwrap_or(Laser::default().cell_size)
}

/// One value of `--start`.
#[derive(Clone, Copy)]
enum Start {
    Cell(Cell),
    Center,
    Corner,
    Random,
    Spread,
}

impl FromStr for Start {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "center" | "centre" => Self::Center,
            "corner" => Self::Corner,
            "random" => Self::Random,
            "spread" => Self::Spread,
            _ => text
                .split_once(',')
                .and_then(|(x, y)| Some(Cell::new(x.trim().parse().ok()?, y.trim().parse().ok()?)))
                .map(Self::Cell)
                .ok_or(
                    "expected X,Y in cells (for example 3,4), center, corner, random or spread",
                )?,
        })
    }
}

/// What a run came to, its trace, and what the planners took of chips.
pub(super) type Ran = (Outcome, Option<Trace>, Option<Measured>);

impl Explore {
    pub(crate) fn run(self) -> Done {
        self.run_by(|scenario, options| {
            let (outcome, trace) = run::run(scenario, options)?;
            Ok((outcome, trace, None))
        })
    }

    /// Explores by `run`, which also tells what the planners took, if they were on chips.
    pub(super) fn run_by(
        self,
        run: impl FnOnce(&Scenario, Options<'_>) -> Result<Ran, Box<dyn Error>>,
    ) -> Done {
        if self.mcap.is_some() && !cfg!(feature = "mcap") {
            return Err(left_out("--mcap", "mcap").into());
        }
        let world = Arc::new(World::read(&self.map, &self.read_options())?);
        tell_notes(&self.map, &world);
        let scenario = self.scenario(world)?;
        let end = self.save.is_some().then(interrupt::ask_for_end);
        let mut folder = self.output.folder(scenario.world.name())?;

        let cells = scenario.reachable().count();
        let bar = self.output.bar(cells, "cells");
        let mut advance = |progress: Progress| {
            bar.set_position(progress.seen_cells.into());
            bar.set_message(format!("tick {}", progress.ticks));
        };
        let mut over = None;
        let mut ended = |run: &dyn Stepping| over = Some((run.save(), run.known()));
        let options = Options {
            trace: true,
            progress: Some(&mut advance),
            end,
            ended: Some(&mut ended),
            ..Options::default()
        };
        let (outcome, trace, measured) = run(&scenario, options)?;
        let trace = trace.expect("a trace was asked for");
        let (save, known) = over.expect("the run is over");
        bar.finish_and_clear();

        let mut summary = Summary::new(&scenario, &outcome, trace.digest());
        summary.firmware = measured;
        let json = serde_json::to_string_pretty(&summary)?;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("explored.png", |file| draw::picture(&trace, file))?;
        folder.write("explored.gif", |file| draw::animation(&trace, file))?;
        folder.write("map.pgm", |file| Ok(file.write_all(&known.pgm())?))?;
        folder.put(
            "map.yaml",
            &KnownMap::yaml(
                "map.pgm",
                metres_per_cell(&scenario),
                scenario.world.origin(),
            ),
        )?;
        folder.write_coverage(&Coverage::from(&trace))?;
        let path = folder.path().to_path_buf();
        if let Some(scans) = &self.scans {
            let mut log = Vec::new();
            Laser::default().log(&trace).write(&mut log)?;
            files::write(scans, &log).map_err(|error| format!("{}: {error}", scans.display()))?;
        }
        if let Some(path) = &self.save {
            let text = save.ok_or("the planners cannot be saved")?.to_text();
            files::write(path, text.as_bytes())
                .map_err(|error| format!("{}: {error}", path.display()))?;
        }
        #[cfg(feature = "mcap")]
        if let Some(path) = &self.mcap {
            let bytes = draw::recording(&trace, std::io::Cursor::new(Vec::new()))?.into_inner();
            files::write(path, &bytes).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        folder.close_run()?;

        if self.output.json {
            println!("{json}");
        } else {
            report::print(&summary, &path);
        }
        if let Some(violation) = outcome.violations.first() {
            eprintln!(
                "this is a bug of planner {}: in tick {} robot {} moved into the obstacle at {}",
                summary.planner, violation.tick, violation.robot.0, violation.into
            );
        }
        if summary.head.complete {
            return Ok(ExitCode::SUCCESS);
        }
        eprintln!("{}", report::left(&summary));
        Ok(ExitCode::from(1))
    }

    /// Whether frames are to be signed.
    #[cfg(unix)]
    pub(super) fn has_key(&self) -> bool {
        self.conditions.has_key()
    }

    /// Whether bodies move in metres.
    #[cfg(unix)]
    pub(super) fn has_motion(&self) -> bool {
        self.motion.is_given()
    }

    /// The option that names cells to keep out of, if one is given.
    #[cfg(unix)]
    pub(super) fn limit(&self) -> Option<&'static str> {
        let mask = self.keep_out_mask.is_some().then_some("keep-out-mask");
        self.conditions.limit().or(mask)
    }

    fn read_options(&self) -> ReadOptions {
        let scale = match (self.pixels_per_cell, self.cell_size) {
            (Some(pixels), _) => Scale::Pixels(pixels),
            (None, Some(metres)) => Scale::Metres(metres),
            (None, None) => Scale::Pixel,
        };
        ReadOptions {
            scale,
            ..ReadOptions::default()
        }
    }

    fn scenario(&self, world: Arc<World>) -> Result<Scenario, Box<dyn Error>> {
        let restored = self.restored(&world)?.map(Arc::new);
        let starts = match &restored {
            Some(save) => Starts::At(save.positions()),
            None => self.starts(&world)?,
        };
        let motion = self.motion.motion(&world, self.clearance)?;
        let solid = self.solid || motion.is_some();
        let starts = match self.clearance {
            0 => world.place(self.robots.into(), &starts, solid)?,
            clearance => world.place_bodies(self.robots.into(), &starts, clearance)?,
        };
        let mut scenario = Scenario::new(world, starts, self.planner);
        scenario.range = self.range;
        scenario.fov = self.fov;
        scenario.solid = solid;
        scenario.clearance = self.clearance;
        scenario.move_in_metres(motion);
        scenario.restored = restored;
        if self.save.is_some() && !self.planner.is_saved() {
            let (option, planner) = ("save", self.planner);
            return Err(ScenarioError::NeverSaved { option, planner }.into());
        }
        scenario.conditions.medium = MediumKind::Radio;
        scenario.conditions.seed = SEED;
        let mut conditions = self.conditions.clone();
        conditions.lay(&scenario.world)?;
        conditions.set(&mut scenario.conditions)?;
        if let Some(path) = &self.keep_out_mask {
            let mask = self.mask(path, &scenario.world)?;
            scenario.conditions.limits.keep_out.extend(mask);
        }
        scenario.check()?;
        Ok(scenario)
    }

    /// What a mask says to keep out of.
    fn mask(&self, path: &Path, world: &World) -> Result<Vec<Area>, Box<dyn Error>> {
        let mask = World::read(path, &self.read_options())?;
        let (extent, found) = (world.extent(), mask.extent());
        if extent != found {
            return Err(format!(
                "--keep-out-mask {}: has {found} cells, and the map {extent}; make it as large",
                path.display()
            )
            .into());
        }
        Ok(Area::covering(extent, |cell| !mask.is_free(cell)))
    }

    /// The save to go on from, if one is named and fits.
    fn restored(&self, world: &World) -> Result<Option<Save>, String> {
        let Some(path) = &self.restore else {
            return Ok(None);
        };
        let wrong = |problem: &dyn Display| format!("--restore {}: {problem}", path.display());
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|file| {
            // Longer is none: a device without an end is not read to it.
            file.take(MOST_SAVE).read_to_end(&mut bytes)
        });
        read.map_err(|error| wrong(&error))?;
        let save = Save::parse(&bytes).map_err(|error| wrong(&error))?;
        if self.planner.is_saved() {
            let fits = save.check(world, self.planner, self.robots.into());
            fits.map_err(|error| wrong(&error))?;
        }
        Ok(Some(save))
    }

    /// The option of saves, if one is given.
    #[cfg(unix)]
    pub(super) fn of_saves(&self) -> Option<&'static str> {
        let restore = self.restore.is_some().then_some("restore");
        restore.or(self.save.is_some().then_some("save"))
    }

    fn starts(&self, world: &World) -> Result<Starts, &'static str> {
        let cells = |start: &Start| match start {
            Start::Cell(cell) => Some(*cell),
            Start::Center | Start::Corner | Start::Random | Start::Spread => None,
        };
        let seed = self.conditions.seed().unwrap_or(SEED);
        Ok(match self.start[..] {
            [] => world.default_starts(),
            [Start::Center] => Starts::Center,
            [Start::Corner] => Starts::Corner,
            [Start::Random] => Starts::Random(seed),
            [Start::Spread] => Starts::Spread(seed),
            _ => Starts::At(
                self.start
                    .iter()
                    .map(cells)
                    .collect::<Option<_>>()
                    .ok_or("--start: center, corner, random and spread stand alone; give either one of them, or one or more X,Y")?,
            ),
        })
    }
}
