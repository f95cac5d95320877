//! `host-sim survey`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use host_sim::medium::MediumKind;
use host_sim::survey::draw::{
    animate, animation, coverage_plot, oblique_view, top_view, write_png,
};
use host_sim::survey::voxels::{self, Scene, VoxelTrace};
use host_sim::survey::{
    DEFAULT_BYTE_BUDGET, Kill, Planner, Scenario, Summary, TerrainSource, octree, run,
};
use planner_core::survey::Limits;

use super::Done;
use super::explore::parse_share;
use super::folder::Folder;

#[derive(Args)]
pub(crate) struct Survey {
    /// gaussian:SEED, urban:SEED, a grey image (heights in quarters of a cell) or an
    /// OctoMap .bt file. town:SEED is a town of voxels, up to 64×64×18, with rooms and
    /// bridges: there another planner flies, and of the options below only size, robots,
    /// range, medium, byte-budget, loss, seed, max-ticks, out and json apply.
    #[arg(long, value_name = "WHERE", default_value = "gaussian:0")]
    terrain: TerrainSource,
    /// Columns along a side of a drawn terrain.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u16).range(8..=512))]
    size: u16,
    /// How the robots decide.
    #[arg(long, value_enum, default_value_t = Planner::CoordinatedSurvey)]
    planner: Planner,
    /// Number of robots.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u8).range(1..=64))]
    robots: u8,
    /// Sensor range in cells, at most 12.
    #[arg(long, value_name = "R", default_value_t = 8.0)]
    range: f32,
    /// Longest flight in a step, in cells.
    #[arg(long, value_name = "A", default_value_t = 2.0)]
    step: f32,
    /// Least altitude over ground, in cells.
    #[arg(long, value_name = "H", default_value_t = 2.0)]
    min_altitude: f32,
    /// Greatest height, in cells.
    #[arg(long, value_name = "Z", default_value_t = 40.0)]
    ceiling: f32,
    /// How robots tell each other what they know: in radio frames of at most 55
    /// bytes, or ideally, all news at once as in the paper.
    #[arg(long, value_name = "NAME", default_value = "radio")]
    medium: MediumKind,
    /// Bytes that a robot may send by radio in a step on average.
    #[arg(long, value_name = "BYTES", default_value_t = DEFAULT_BYTE_BUDGET)]
    byte_budget: u16,
    /// Share of messages lost, 0 to 1.
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_share)]
    loss: f64,
    /// Share of its steps that a robot sleeps through, 0 to 1.
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_share)]
    skip: f64,
    /// ROBOT@STEP: this robot dies before this step. May be given again.
    #[arg(long, value_name = "WHO")]
    kill: Vec<Kill>,
    /// Seed of the robots' random choices and of the faults.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Steps after which the run is given up.
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    max_ticks: u32,
    /// Folder for the results; default: out/ and the name of the terrain.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

impl Survey {
    pub(crate) fn run(self) -> Done {
        if let Some(scene) = self.terrain.scene(self.size) {
            return self.run_in(&scene);
        }
        let terrain = self.terrain.load(self.size)?;
        let trace = run(&terrain, &self.scenario())?;
        let summary = Summary::new(&trace);
        let json = serde_json::to_string_pretty(&summary)?;
        let out = self
            .out
            .unwrap_or_else(|| PathBuf::from("out").join(terrain.name()));
        let mut folder = Folder::open(out)?;
        let all = u32::MAX;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("explored.png", |file| {
            write_png(&top_view(&trace, all), file)
        })?;
        folder.write("oblique.png", |file| {
            write_png(&oblique_view(&trace, all), file)
        })?;
        folder.write("explored.gif", |file| animation(&trace, file))?;
        folder.write("coverage.csv", |file| Ok(trace.write_coverage(file)?))?;
        folder.write("coverage.png", |file| coverage_plot(&trace, file))?;
        folder.write("map.bt", |file| Ok(octree(&trace, all).write(file)?))?;
        let path = folder.path().to_path_buf();
        folder.close()?;
        if self.json {
            println!("{json}");
        } else {
            print(&summary, &path);
        }
        Ok(if summary.complete {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        })
    }

    /// The same in a scene of voxels.
    fn run_in(self, scene: &Scene) -> Done {
        let scenario = voxels::Scenario {
            robots: self.robots.into(),
            range: self.range as u8,
            medium: self.medium,
            byte_budget: self.byte_budget,
            loss: self.loss,
            seed: self.seed,
            max_ticks: self.max_ticks,
        };
        let trace = voxels::run(scene, &scenario)?;
        let work = trace.work.iter().copied();
        let robots: Vec<_> = (0..scenario.robots)
            .map(|robot| voxel_robot(&trace, robot))
            .collect();
        let json = serde_json::json!({
            "complete": trace.complete(),
            "ticks_to_seen": trace.ticks_to(1.0),
            "ticks_to_95": trace.ticks_to(0.95),
            "ticks_to_99": trace.ticks_to(0.99),
            "ticks_to_stopped": trace.all_stopped.then_some(trace.seen.len() - 1),
            "ticks": trace.seen.len() - 1,
            "reachable_cells": trace.visible,
            "seen_cells": trace.seen.last(),
            "max_work_per_tick": work.clone().max(),
            "mean_work_per_tick": work.clone().map(f64::from).sum::<f64>() / work.len() as f64,
            "violations": trace.violations,
            "trace_digest": trace.digest(),
            "map": scene.name(),
            "planner": "voxel-survey",
            "range": scenario.range,
            "medium": scenario.medium,
            "byte_budget": scenario.byte_budget,
            "loss": scenario.loss,
            "seed": scenario.seed,
            "robots": robots,
        });
        let json = serde_json::to_string_pretty(&json)?;
        let out = self
            .out
            .unwrap_or_else(|| PathBuf::from("out").join(scene.name()));
        let mut folder = Folder::open(out)?;
        let all = u32::MAX;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("oblique.png", |file| {
            write_png(&trace.oblique_view(all - 1), file)
        })?;
        folder.write("explored.gif", |file| {
            let ticks = trace.seen.len() as u32;
            animate(ticks, |tick| trace.oblique_view(tick), file)
        })?;
        folder.write("map.bt", |file| Ok(trace.octree(all).write(file)?))?;
        let path = folder.path().to_path_buf();
        folder.close()?;
        if self.json {
            println!("{json}");
        } else {
            let seen = trace.seen.last().copied().unwrap_or(0);
            println!(
                "{}: {seen} of {} visible voxels seen",
                scene.name(),
                trace.visible
            );
            println!(
                "  everything seen    after {} ticks",
                words(trace.ticks_to(1.0))
            );
            println!("  violations         {}", trace.violations);
            for (number, stop) in trace.stops.iter().enumerate() {
                let stop = stop.map(|stop| stop.to_string());
                let stop = stop.as_deref().unwrap_or("had not stopped");
                println!("  robot {number:<12} {stop}");
            }
            println!("  trace digest       {}", trace.digest());
            println!("  results            {}", path.display());
        }
        Ok(if trace.complete() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        })
    }

    fn scenario(&self) -> Scenario {
        let scenario = Scenario::new(self.planner, self.robots.into(), self.seed);
        Scenario {
            limits: Limits {
                range: self.range,
                step: self.step,
                min_altitude: self.min_altitude,
                ceiling: self.ceiling,
                ..scenario.limits
            },
            medium: self.medium,
            byte_budget: self.byte_budget,
            loss: self.loss,
            skip: self.skip,
            kills: self.kill.clone(),
            max_ticks: self.max_ticks,
            ..scenario
        }
    }
}

/// What one robot of a survey of voxels came to.
fn voxel_robot(trace: &VoxelTrace, robot: usize) -> serde_json::Value {
    let decisions = trace.ways.len();
    let of = |index: &usize| index % decisions == robot;
    let (way, sent) = (&trace.ways[robot], (0..trace.sent.len()).filter(of));
    let sent: Vec<_> = sent.map(|index| trace.sent[index]).collect();
    let work = (0..trace.work.len()).filter(of);
    serde_json::json!({
        "start": (way[0].x, way[0].y, way[0].z),
        "steps": way.windows(2).filter(|leg| leg[0] != leg[1]).count(),
        "work": work.map(|index| u64::from(trace.work[index])).sum::<u64>(),
        "frames_sent": sent.iter().map(|sent| sent.frames).sum::<u32>(),
        "bytes_sent": sent.iter().map(|sent| sent.bytes).sum::<u32>(),
        "stop": trace.stops[robot].map(|stop| stop.name()),
        "stop_reason": trace.stops[robot].map(|stop| stop.to_string()),
    })
}

fn words(ticks: Option<u32>) -> String {
    ticks.map_or("ever so many".into(), |ticks| ticks.to_string())
}

fn print(summary: &Summary, out: &std::path::Path) {
    let ticks =
        |ticks: Option<u32>| ticks.map_or("never".into(), |ticks| format!("after {ticks} ticks"));
    println!(
        "{}: {} of {} columns seen",
        summary.map, summary.seen_cells, summary.reachable_cells
    );
    println!("  95 % seen          {}", ticks(summary.ticks_to_95));
    println!("  everything seen    {}", ticks(summary.ticks_to_seen));
    println!("  every robot done   {}", ticks(summary.ticks_to_stopped));
    println!(
        "  most work          {} in one tick",
        summary.max_work_per_tick
    );
    println!("  violations         {}", summary.violations);
    for (number, robot) in summary.robots.iter().enumerate() {
        println!(
            "  robot {number:<3} {:>6} steps, {:>6} columns known, {:>5} frames of {:>7} bytes sent, {}",
            robot.steps,
            robot.cells_known,
            robot.frames_sent,
            robot.bytes_sent,
            match &robot.stop_reason {
                _ if !robot.alive => "died",
                Some(reason) => reason,
                None => "had not stopped",
            }
        );
    }
    println!("  trace digest       {}", summary.trace_digest);
    println!("  results            {}", out.display());
}
