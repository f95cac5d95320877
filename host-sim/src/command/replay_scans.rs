//! `host-sim replay-scans`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use host_sim::draw;
use host_sim::scans::{Log, Options, Score};
use planner_core::explorer::SensorModel;
use planner_core::sight::MAX_RADIUS;

use super::Done;
use super::folder::Folder;

#[derive(Args)]
pub(crate) struct ReplayScans {
    /// Logs: a look a line, `x y heading bearing range bearing range …` in metres and
    /// radians (y up, angles counter-clockwise), CARMEN with FLASER or ROBOTLASER lines, or a
    /// ROS 2 recording (MCAP) with LaserScan and TF or Odometry (`--features mcap`).
    #[arg(required = true, value_name = "FILE")]
    logs: Vec<PathBuf>,
    /// Side of a cell in metres.
    #[arg(long, value_name = "METRES")]
    cell_size: f64,
    /// How far beams count, in cells, 1 to 15.
    #[arg(long, value_name = "CELLS", default_value_t = MAX_RADIUS, value_parser = clap::value_parser!(u8).range(1..=i64::from(MAX_RADIUS)))]
    range: u8,
    /// How far the map believes a look.
    #[arg(long, value_name = "NAME", default_value = "lidar")]
    preset: Preset,
    /// Folder for the pictures.
    #[arg(long, value_name = "DIR", default_value = "out/scans")]
    out: PathBuf,
    /// Print the scores as JSON, an object a line.
    #[arg(long)]
    json: bool,
}

/// Models of sensors that planner-core comes with.
#[derive(Clone, Copy, ValueEnum)]
enum Preset {
    /// Always right: the first look decides.
    Truthful,
    /// A laser scanner.
    Lidar,
    /// A few range sensors, in cells about as large as their errors.
    Rangers,
}

impl From<Preset> for SensorModel {
    fn from(preset: Preset) -> Self {
        match preset {
            Preset::Truthful => Self::truthful(),
            Preset::Lidar => Self::lidar(),
            Preset::Rangers => Self::rangers(),
        }
    }
}

impl ReplayScans {
    pub(crate) fn run(self) -> Done {
        let options = Options {
            cell_size: self.cell_size,
            range: self.range,
            sensor: self.preset.into(),
        };
        let mut names = BTreeSet::new();
        let mut scores = Vec::new();
        let mut pictures = Vec::new();
        for path in &self.logs {
            let log = Log::read(path)?;
            let (replayed, score) = log.replay(options)?;
            let mut picture = Vec::new();
            draw::scans(&replayed, &score, &mut picture)?;
            if !names.insert(log.name.clone()) {
                return Err(format!("two logs are called {}; rename one", log.name).into());
            }
            pictures.push((format!("{}.png", log.name), picture));
            scores.push(score);
        }
        let mut folder = Folder::open(self.out)?;
        for (name, picture) in pictures {
            folder.write(name, |file| Ok(file.write_all(&picture)?))?;
        }
        let path = folder.path().to_path_buf();
        folder.close()?;
        if self.json {
            for score in &scores {
                println!("{}", serde_json::to_string(score)?);
            }
        } else {
            print(&scores);
            println!("pictures in {}", path.display());
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// The scores as a table.
fn print(scores: &[Score]) {
    let longest = scores.iter().map(|score| score.log.chars().count()).max();
    let wide = longest.unwrap_or(0).max(3);
    println!(
        "{:<wide$} {:>6} {:>9} {:>8} {:>8} {:>7} {:>7} {:>8} {:>6} {:>7}",
        "log",
        "looks",
        "cells",
        "no hit",
        "floor",
        "closed",
        "cut off",
        "opened",
        "driven",
        "closed"
    );
    for score in scores {
        println!(
            "{:<wide$} {:>6} {:>9} {:>6.2} m {:>8} {:>5.1} % {:>5.1} % {:>6.1} % {:>6} {:>7}",
            score.log,
            score.looks,
            format!("{}×{}", score.width, score.height),
            score.nothing_from,
            score.open_floor,
            score.closed_percent,
            score.cut_off_percent,
            score.opened_percent,
            score.driven,
            score.driven_closed
        );
    }
    println!(
        "closed, cut off: of the open floor (at least 3 beams, fewer than 20 % hits), what is \
         wall on the map, what no free cells lead to; opened: of the walls (at least 3 hits and \
         50 %), what is free on the map; driven: cells driven through, and those closed at the end"
    );
}
