//! `host-sim explore`.

use std::error::Error;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;
use std::sync::Arc;

use clap::Args;
use host_sim::draw::{self, Coverage};
use host_sim::measured::Measured;
use host_sim::medium::MediumKind;
use host_sim::planners::PlannerKind;
use host_sim::run::{self, Here, Host, Options, Progress, Scenario};
use host_sim::sensor::ALL_AROUND;
use host_sim::summary::Summary;
use host_sim::world::{ReadOptions, Scale, Starts, World};
use indicatif::{ProgressBar, ProgressStyle};
use planner_core::Cell;
use planner_core::radio::{Key, MAX_LEN};

use super::faults::FaultArgs;
use super::folder::Folder;
use super::report;
use super::{Done, tell_notes};

#[derive(Args)]
pub(crate) struct Explore {
    /// The map: .png, .pgm, .yaml (ROS map_server), .map (MovingAI) or .txt. What it
    /// calls unknown (map_saver's gray 205, transparent pixels) robots do not enter.
    map: PathBuf,
    /// What decides in each robot.
    #[arg(long, value_name = "NAME", default_value = "explorer")]
    planner: PlannerKind,
    /// Number of robots, 1 to 255.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..))]
    robots: u8,
    /// Where robots start: X,Y (column and row from 0 at the top left; repeat
    /// it for several), center, corner or random. Default: the digits in a text
    /// map, else center.
    #[arg(long, value_name = "WHERE")]
    start: Vec<Start>,
    /// Sensor range in cells, 1 to 15.
    #[arg(long, value_name = "R", default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..=15))]
    range: u8,
    /// The sensor's field of view around the robot's heading in degrees, 1 to 360;
    /// below 360, for the explorer alone, robots turn to look around.
    #[arg(long, value_name = "DEGREES", default_value_t = ALL_AROUND, value_parser = clap::value_parser!(u16).range(1..=360))]
    fov: u16,
    /// How robots tell each other what they know: in radio frames of at most 55
    /// bytes, or ideally, whole maps at once as in the papers.
    #[arg(long, value_name = "NAME", default_value = "radio")]
    medium: MediumKind,
    /// Ticks between two exchanges of maps, or between two transmissions of a
    /// robot; 0: never.
    #[arg(long, value_name = "D", default_value_t = 1)]
    sync: u32,
    /// Bytes that a robot may send by radio in a tick on average; less than a
    /// frame: one every few ticks.
    #[arg(long, value_name = "BYTES", default_value_t = MAX_LEN as u16)]
    byte_budget: u16,
    /// Sign frames, and take signed ones only: the fleet's secret as 32 hex digits, or a
    /// file that holds them.
    #[arg(long, value_name = "HEX|FILE", value_parser = super::key::parse)]
    key: Option<Key>,
    /// Seed of all chance in the run.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// A cell holds at most one robot.
    #[arg(long)]
    solid: bool,
    /// Give up after this many ticks. Default: 1000 and 8 for each reachable
    /// cell, for bmilrv 100.
    #[arg(long, value_name = "T")]
    max_ticks: Option<u32>,
    /// Folder for pictures, trace and summary. Default: out/ and the map's name.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the summary as one JSON object.
    #[arg(long)]
    json: bool,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
    /// Images: N×N pixels are one cell.
    #[arg(long, value_name = "N", conflicts_with = "cell_size", value_parser = clap::value_parser!(u32).range(1..))]
    pixels_per_cell: Option<u32>,
    /// Maps with a resolution: side of a cell in metres.
    #[arg(long, value_name = "METRES")]
    cell_size: Option<f64>,
    #[command(flatten)]
    faults: FaultArgs,
}

/// One value of `--start`.
#[derive(Clone, Copy)]
enum Start {
    Cell(Cell),
    Center,
    Corner,
    Random,
}

impl FromStr for Start {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "center" | "centre" => Self::Center,
            "corner" => Self::Corner,
            "random" => Self::Random,
            _ => text
                .split_once(',')
                .and_then(|(x, y)| Some(Cell::new(x.trim().parse().ok()?, y.trim().parse().ok()?)))
                .map(Self::Cell)
                .ok_or("expected X,Y in cells (for example 3,4), center, corner or random")?,
        })
    }
}

impl Explore {
    pub(crate) fn run(self) -> Done {
        self.run_on(Here, || Ok(None))
    }

    /// Explores with planners that are on `host`, which tells at the end what they took.
    pub(super) fn run_on(
        self,
        host: impl Host,
        measured: impl FnOnce() -> Result<Option<Measured>, Box<dyn Error>>,
    ) -> Done {
        let world = Arc::new(World::read(&self.map, &self.read_options())?);
        tell_notes(&self.map, &world);
        let scenario = self.scenario(world)?;
        let out = self.out.clone();
        let out = out.unwrap_or_else(|| PathBuf::from("out").join(scenario.world.name()));
        let mut folder = Folder::open(out)?;

        let bar = self.progress_bar(&scenario);
        let mut advance = |progress: Progress| {
            bar.set_position(progress.seen_cells.into());
            bar.set_message(format!("tick {}", progress.ticks));
        };
        let options = Options {
            trace: true,
            progress: Some(&mut advance),
            ..Options::default()
        };
        let (outcome, trace) = run::run_on(&host, &scenario, options)?;
        drop(host);
        let trace = trace.expect("a trace was asked for");
        bar.finish_and_clear();

        let mut summary = Summary::new(&scenario, &outcome, trace.digest());
        summary.firmware = measured()?;
        let json = serde_json::to_string_pretty(&summary)?;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("explored.png", |file| draw::picture(&trace, file))?;
        folder.write("explored.gif", |file| draw::animation(&trace, file))?;
        folder.write_coverage(&Coverage::from(&trace))?;
        let path = folder.path().to_path_buf();
        folder.close()?;

        if self.json {
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
        if summary.complete {
            return Ok(ExitCode::SUCCESS);
        }
        eprintln!("{}", report::left(&summary));
        Ok(ExitCode::from(1))
    }

    /// Whether frames are to be signed.
    #[cfg(unix)]
    pub(super) const fn has_key(&self) -> bool {
        self.key.is_some()
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
        let starts = self.starts(&world)?;
        let starts = world.place(self.robots.into(), &starts, self.solid)?;
        let mut scenario = Scenario::new(world, starts, self.planner);
        scenario.range = self.range;
        scenario.fov = self.fov;
        scenario.sync = self.sync;
        scenario.loss = self.faults.loss;
        scenario.air = self.faults.air();
        scenario.faults = self.faults.of_robots(self.robots.into())?;
        scenario.medium = self.medium;
        scenario.byte_budget = self.byte_budget;
        scenario.key = self.key;
        scenario.seed = self.seed;
        scenario.solid = self.solid;
        scenario.max_ticks = self.max_ticks.unwrap_or(scenario.max_ticks);
        scenario.check()?;
        Ok(scenario)
    }

    fn starts(&self, world: &World) -> Result<Starts, &'static str> {
        let cells = |start: &Start| match start {
            Start::Cell(cell) => Some(*cell),
            Start::Center | Start::Corner | Start::Random => None,
        };
        Ok(match self.start[..] {
            [] => world.default_starts(),
            [Start::Center] => Starts::Center,
            [Start::Corner] => Starts::Corner,
            [Start::Random] => Starts::Random(self.seed),
            _ => Starts::At(
                self.start
                    .iter()
                    .map(cells)
                    .collect::<Option<_>>()
                    .ok_or("--start: center, corner and random stand alone; give either one of them, or one or more X,Y")?,
            ),
        })
    }

    fn progress_bar(&self, scenario: &Scenario) -> ProgressBar {
        if self.json || self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let cells = scenario.world.reachable(&scenario.starts).count();
        let style = "{spinner} {percent:>3} % {wide_bar} {pos}/{len} cells seen, {msg} [{elapsed}]";
        ProgressBar::new(cells.into())
            .with_style(ProgressStyle::with_template(style).expect("the template is well-formed"))
    }
}

pub(super) fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a share from 0 (nothing) to 1 (everything), for example 0.6".into()),
    }
}
