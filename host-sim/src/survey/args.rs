//! The command `survey`.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;

use clap::Args;
use planner_core::survey::Limits;
use serde::Serialize;

use super::draw::{Curve, animation, curves, oblique_view, top_view};
use super::mapped::octree;
use super::terrain_source::TerrainSource;
use super::{Kill, Planner, Safety, Scenario, Terrain, Trace, run};

/// A fleet of flying robots maps an unknown surface.
#[derive(Args, Clone, Debug)]
pub struct SurveyArgs {
    /// gaussian:SEED, urban:SEED, a grey image (heights in quarters of a cell) or an
    /// OctoMap .bt file.
    #[arg(long, default_value = "gaussian:0")]
    pub terrain: TerrainSource,
    /// Columns along a side of a drawn terrain.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u16).range(8..=512))]
    pub size: u16,
    /// How the robots decide.
    #[arg(long, value_enum, default_value_t = Planner::CoordinatedSurvey)]
    pub planner: Planner,
    /// Number of robots.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub robots: u8,
    /// Sensor range in cells, at most 12.
    #[arg(long, default_value_t = 8.0)]
    pub range: f32,
    /// Longest flight in a step, in cells.
    #[arg(long, default_value_t = 2.0)]
    pub step: f32,
    /// Least altitude over ground, in cells.
    #[arg(long, default_value_t = 2.0)]
    pub min_altitude: f32,
    /// Greatest height, in cells.
    #[arg(long, default_value_t = 40.0)]
    pub ceiling: f32,
    /// Share of messages lost, 0 to 1.
    #[arg(long, default_value_t = 0.0)]
    pub loss: f64,
    /// Share of its steps that a robot sleeps through, 0 to 1.
    #[arg(long, default_value_t = 0.0)]
    pub skip: f64,
    /// ROBOT@STEP: this robot dies before this step. May be given again.
    #[arg(long)]
    pub kill: Vec<Kill>,
    /// Seed of the robots' random choices and of the faults.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Steps after which the run is given up.
    #[arg(long, default_value_t = 20_000)]
    pub max_steps: u32,
    /// Print the result as JSON.
    #[arg(long)]
    pub json: bool,
    /// Write trace.csv, top.png, oblique.png, coverage.svg, run.gif and map.bt here.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

/// What a run came to; the keys are those of `explore` where they mean the same.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// How the robots decided.
    pub planner: Planner,
    /// Number of robots.
    pub robots: usize,
    /// Whether every column was seen.
    pub complete: bool,
    /// Columns seen, and all.
    pub seen: u32,
    /// Columns there are.
    pub columns: u32,
    /// Steps until 95 %, 99 % and all of the columns had been seen.
    pub ticks_to_95: Option<u32>,
    /// See `ticks_to_95`.
    pub ticks_to_99: Option<u32>,
    /// See `ticks_to_95`.
    pub ticks_to_seen: Option<u32>,
    /// Steps until every living robot had stopped.
    pub ticks_to_stopped: Option<u32>,
    /// Length of all ways, in cells.
    pub distance: f64,
    /// Largest and mean work of a decision.
    pub max_work_per_tick: u32,
    /// See `max_work_per_tick`.
    pub mean_work_per_tick: f64,
    /// What should never happen.
    pub safety: Safety,
    /// Flights that the flight controller refused for another robot's sake.
    pub refused_flights: usize,
    /// Two runs are the same if this is.
    pub trace_digest: String,
}

impl Summary {
    /// The summary of a run of `planner`.
    pub fn new(planner: Planner, trace: &Trace) -> Self {
        let work = || trace.records.iter().map(|record| record.work);
        let distance = (0..trace.robots)
            .flat_map(|robot| {
                let way = trace.way(robot, u32::MAX);
                way.windows(2)
                    .map(|leg| f64::from(leg[0].distance(leg[1])))
                    .collect::<Vec<_>>()
            })
            .sum();
        Self {
            planner,
            robots: trace.robots,
            complete: trace.complete(),
            seen: trace.seen.last().copied().unwrap_or(0),
            columns: trace.extent.cells(),
            ticks_to_95: trace.steps_to(0.95),
            ticks_to_99: trace.steps_to(0.99),
            ticks_to_seen: trace.steps_to(1.0),
            ticks_to_stopped: trace.steps_to_stopped(),
            distance,
            max_work_per_tick: work().max().unwrap_or(0),
            mean_work_per_tick: work().map(f64::from).sum::<f64>()
                / trace.records.len().max(1) as f64,
            safety: trace.safety,
            refused_flights: trace.records.iter().filter(|record| record.blocked).count(),
            trace_digest: format!("{:016x}", trace.digest()),
        }
    }
}

impl SurveyArgs {
    /// Runs the command; gives what it prints, and whether everything was seen.
    /// Errors are sentences for the user.
    pub fn run(&self) -> Result<(String, bool), String> {
        let terrain = self.terrain.load(self.size)?;
        let trace = run(&terrain, &self.scenario()).map_err(|error| error.to_string())?;
        if let Some(folder) = &self.out {
            write_all(folder, &terrain, &trace)
                .map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        let summary = Summary::new(self.planner, &trace);
        if self.json {
            let text = serde_json::to_string_pretty(&summary).map_err(|error| error.to_string())?;
            return Ok((text, summary.complete));
        }
        let steps = |number: Option<u32>| number.map_or("never".into(), |n| n.to_string());
        let text = format!(
            "{} of {} columns seen; 95 % after {} steps, 99 % after {}, all after {}; stopped after {}",
            summary.seen,
            summary.columns,
            steps(summary.ticks_to_95),
            steps(summary.ticks_to_99),
            steps(summary.ticks_to_seen),
            steps(summary.ticks_to_stopped),
        );
        Ok((text, summary.complete))
    }

    fn scenario(&self) -> Scenario {
        let mut scenario = Scenario::new(self.planner, self.robots.into(), self.seed);
        scenario.limits = Limits {
            range: self.range,
            step: self.step,
            min_altitude: self.min_altitude,
            ceiling: self.ceiling,
            ..scenario.limits
        };
        (scenario.loss, scenario.skip) = (self.loss, self.skip);
        scenario.kills.clone_from(&self.kill);
        scenario.max_steps = self.max_steps;
        scenario
    }
}

fn write_all(
    folder: &std::path::Path,
    terrain: &Terrain,
    trace: &Trace,
) -> Result<(), Box<dyn std::error::Error>> {
    fs::create_dir_all(folder)?;
    let create = |name: &str| File::create(folder.join(name)).map(BufWriter::new);
    let all = u32::MAX;
    trace.write_csv(create("trace.csv")?)?;
    top_view(terrain, trace, all).save(folder.join("top.png"))?;
    oblique_view(terrain, trace, all).save(folder.join("oblique.png"))?;
    let columns = f64::from(trace.extent.cells());
    let coverage = Curve {
        name: "seen".into(),
        values: trace
            .seen
            .iter()
            .map(|seen| 100.0 * f64::from(*seen) / columns)
            .collect(),
    };
    fs::write(
        folder.join("coverage.svg"),
        curves("surface seen, %", &[coverage])?,
    )?;
    animation(terrain, trace, create("run.gif")?)?;
    octree(trace, all).write(create("map.bt")?)?;
    Ok(())
}
