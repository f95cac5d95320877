//! `host-sim compare`.

use std::collections::{HashMap, HashSet};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::Args;
use host_sim::experiments::{
    Journal, Key, Metric, Place, Plan, Row, Shard, Site, compare, comparisons_csv, execute,
    markdown, to_csv,
};
use host_sim::planners::PlannerKind;
use host_sim::scenario::{MediumKind, Preset, Trouble, TroubleArgs, parse_share};
use host_sim::world::{Family, ReadOptions, Recipe, Scale, World};
use indicatif::{ProgressBar, ProgressStyle};
use planner_core::Extent;

use super::folder::Folder;
use super::generate::parse_size;
use super::{Done, tell_notes};

#[derive(Args)]
pub(crate) struct Compare {
    /// Maps to run in, besides those of --families.
    maps: Vec<PathBuf>,
    /// Planners to compare.
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "explorer,minpos"
    )]
    planners: Vec<PlannerKind>,
    /// The planner that the others are measured by.
    #[arg(long, value_name = "NAME", default_value = "minpos")]
    reference: PlannerKind,
    /// Numbers of robots, 1 to 255 each.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,3,5,8,10", value_parser = clap::value_parser!(u8).range(1..))]
    robots: Vec<u8>,
    /// How robots are placed.
    #[arg(long, value_name = "HOW", default_value = "random")]
    place: Place,
    /// Placings in each world.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    starts: u32,
    /// What carries messages.
    #[arg(long, value_name = "KIND", default_value = "ideal")]
    medium: MediumKind,
    /// Ticks between two exchanges of maps; 0: never.
    #[arg(long, value_name = "D,…", value_delimiter = ',', default_value = "1")]
    sync: Vec<u32>,
    /// Shares of messages lost, 0 to 1.
    #[arg(long, value_name = "P,…", value_delimiter = ',', default_value = "0", value_parser = parse_share)]
    loss: Vec<f64>,
    /// Sensor ranges in cells, 1 to 15.
    #[arg(long, value_name = "R,…", value_delimiter = ',', default_value = "5", value_parser = clap::value_parser!(u8).range(1..=15))]
    range: Vec<u8>,
    /// Families of worlds to generate, or `all`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = parse_families)]
    families: Vec<Families>,
    /// Worlds of each family.
    #[arg(long, value_name = "N", default_value_t = 20)]
    worlds: u64,
    /// Size of generated worlds in cells.
    #[arg(long, value_name = "WxH", default_value = "64x64", value_parser = parse_size)]
    size: Extent,
    /// First seed of the worlds, and seed of placings and losses.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// What the tables compare.
    #[arg(long, value_name = "WHAT", default_value = "seen")]
    metric: Metric,
    /// Folder for the runs and the tables.
    #[arg(long, value_name = "DIR", default_value = "out/compare")]
    out: PathBuf,
    /// Do every N-th run only, from the I-th on; the tables hold the runs of all
    /// shards that are in the folder.
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: Shard,
    /// Write the runs as a Parquet file too; for programs compiled with
    /// `--features parquet`.
    #[arg(long)]
    parquet: bool,
    /// Keep the runs that are in the folder, and do those that are missing.
    #[arg(long)]
    resume: bool,
    /// Images: N×N pixels are one cell.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pixels_per_cell: Option<u32>,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
    /// What the explorer takes its sensors for.
    #[arg(long, value_name = "NAME", default_value = "truthful")]
    preset: Preset,
    #[command(flatten)]
    trouble: TroubleArgs,
}

/// One value of `--families`.
#[derive(Clone)]
struct Families(Vec<Family>);

fn parse_families(text: &str) -> Result<Families, String> {
    match text {
        "all" => Ok(Families(Family::ALL.to_vec())),
        _ => clap::ValueEnum::from_str(text, false).map(|family| Families(vec![family])),
    }
}

impl Compare {
    pub(crate) fn run(self) -> Done {
        if self.parquet && !cfg!(feature = "parquet") {
            let arguments: Vec<String> = std::env::args().skip(1).collect();
            return Err(format!(
                "--parquet was left out of this program; run `cargo run --release --features \
                 parquet -- {}`",
                arguments.join(" ")
            )
            .into());
        }
        let plan = self.plan()?;
        let journal = Journal::open(&self.out, self.shard, self.resume)?;
        let done: HashSet<Key> = match self.resume {
            true => Journal::read_all(&self.out)?.iter().map(Row::key).collect(),
            false => HashSet::new(),
        };
        let bar = self.progress_bar(&plan);
        bar.set_position(plan.keys().filter(|key| done.contains(key)).count() as u64);
        execute(&plan, self.shard, &done, &|row, _| {
            bar.inc(1);
            journal.add(&row)
        })?;
        bar.finish_and_clear();

        let rows = in_order_of(&plan, Journal::read_all(&self.out)?);
        let comparisons = compare(&rows, self.reference, self.metric);
        let table = markdown(&comparisons, self.reference, self.metric);
        let mut folder = Folder::open(self.out.clone())?;
        folder.put("runs.csv", &to_csv(&rows, true))?;
        #[cfg(feature = "parquet")]
        if self.parquet {
            let mut bytes = Vec::new();
            host_sim::experiments::write_parquet(&rows, &mut bytes)?;
            folder.write("runs.parquet", |file| Ok(file.write_all(&bytes)?))?;
        }
        folder.put("table.md", &table)?;
        folder.put("table.csv", &comparisons_csv(&comparisons, self.metric))?;
        folder.close()?;

        print!("{table}");
        if rows.len() < plan.runs() {
            println!(
                "{} of {} runs so far; the rest belongs to other shards.",
                rows.len(),
                plan.runs()
            );
        }
        println!("Files in {}", self.out.display());
        Ok(ExitCode::SUCCESS)
    }

    fn plan(&self) -> Result<Plan, Box<dyn std::error::Error>> {
        let mut sites = Vec::new();
        for path in &self.maps {
            sites.push(Site::Given(self.read(path)?));
        }
        // World by world rather than family by family: an interrupted
        // comparison has some runs of every family.
        for seed in self.seed..self.seed + self.worlds {
            for &family in self.families.iter().flat_map(|families| &families.0) {
                sites.push(Site::Generated(Recipe::new(family, self.size, seed)));
            }
        }
        if sites.is_empty() {
            return Err("nothing to run in: name maps, or --families".into());
        }
        let mut names = HashSet::new();
        if let Some(twice) = sites.iter().find(|site| !names.insert(site.name())) {
            return Err(format!(
                "two worlds are called {}: tables could not tell them apart; rename one",
                twice.name()
            )
            .into());
        }
        let mut planners = self.planners.clone();
        if !planners.contains(&self.reference) {
            planners.push(self.reference);
        }
        Ok(Plan {
            sites,
            planners,
            robots: self.robots.clone(),
            place: self.place,
            starts: self.starts,
            medium: self.medium,
            syncs: self.sync.clone(),
            losses: self.loss.clone(),
            ranges: self.range.clone(),
            trouble: self.trouble.clone().over(Trouble::default()),
            preset: self.preset,
            seed: self.seed,
        })
    }

    fn read(&self, path: &Path) -> Result<Arc<World>, host_sim::world::WorldError> {
        let options = ReadOptions {
            scale: self.pixels_per_cell.map_or(Scale::Pixel, Scale::Pixels),
            ..ReadOptions::default()
        };
        let world = World::read(path, &options)?;
        tell_notes(path, &world);
        Ok(Arc::new(world))
    }

    fn progress_bar(&self, plan: &Plan) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let style = "{spinner} {percent:>3} % {wide_bar} {pos}/{len} runs [{elapsed}, {eta} left]";
        ProgressBar::new(plan.runs() as u64)
            .with_style(ProgressStyle::with_template(style).expect("the template is well-formed"))
    }
}

/// The rows of the runs of a plan, in its order, whichever shard they are from.
fn in_order_of(plan: &Plan, rows: Vec<Row>) -> Vec<Row> {
    let mut rows: HashMap<Key, Row> = rows.into_iter().map(|row| (row.key(), row)).collect();
    plan.keys().filter_map(|key| rows.remove(&key)).collect()
}
