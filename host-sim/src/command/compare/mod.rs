//! `host-sim compare`.

mod settings;

use std::collections::HashSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use host_sim::experiments::{
    Comparison, Counted, Journal, Metric, Order, Plan, Row, Settings, Shard, Tally, compare,
    comparisons_csv, execute, markdown, to_csv,
};
use host_sim::planners::PlannerKind;
use host_sim::scenario::TroubleArgs;
use indicatif::{ProgressBar, ProgressStyle};

use super::folder::Folder;
use super::{Done, left_out};
use settings::SettingsArgs;

/// What a merge takes from the plan, or has no use for, besides [`SettingsArgs`].
const NOT_IN_A_MERGE: [&str; 11] = [
    "shard",
    "resume",
    "false_walls",
    "false_frees",
    "error_kind",
    "misplaced",
    "drift",
    "people",
    "doors",
    "see_robots",
    "looks",
];
/// Where runs go if nobody says.
const OUT: &str = "out/compare";

#[derive(Args)]
pub(crate) struct Compare {
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    trouble: TroubleArgs,
    /// The planner that the others are measured by. Default: minpos; with --merge, that of
    /// the plan.
    #[arg(long, value_name = "NAME")]
    reference: Option<PlannerKind>,
    /// What the tables compare. Default: seen; with --merge, as in the plan.
    #[arg(long, value_name = "WHAT")]
    metric: Option<Metric>,
    /// Folder for the runs and the tables. Default: out/compare; with --merge, the first
    /// folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Do the I-th of N shares of the worlds only, and make no tables.
    #[arg(long, value_name = "I/N", conflicts_with = "parquet")]
    shard: Option<Shard>,
    /// Make the tables of the shards in these folders, as one run of all would have; run
    /// nothing.
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = NOT_IN_A_MERGE)]
    merge: Vec<PathBuf>,
    /// Write the runs as a Parquet file too; for programs compiled with
    /// `--features parquet`.
    #[arg(long)]
    parquet: bool,
    /// Keep the runs of every shard that is in the folder, not only of one's own, and do
    /// those that are missing.
    #[arg(long)]
    resume: bool,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

/// What was compared.
struct Results {
    /// The runs; `None`: not kept.
    rows: Option<Vec<Row>>,
    comparisons: Vec<Comparison>,
    reference: PlannerKind,
    metric: Metric,
    /// Runs that have not been done, and the first of their worlds.
    missing: Option<(usize, String)>,
}

impl Compare {
    pub(crate) fn run(self) -> Done {
        if self.parquet && !cfg!(feature = "parquet") {
            return Err(left_out("--parquet", "parquet").into());
        }
        if let Some(first) = self.merge.first() {
            let out = self.out.as_ref().unwrap_or(first);
            let results = merge(&self.merge, self.reference, self.metric)?;
            self.write(out, &results)?;
            return Ok(match &results.missing {
                None => ExitCode::SUCCESS,
                Some((runs, world)) => {
                    eprintln!("error: {runs} runs are missing, the first in {world}");
                    ExitCode::FAILURE
                }
            });
        }

        let out = self.out.clone().unwrap_or_else(|| OUT.into());
        let (reference, metric) = (
            self.reference.unwrap_or(PlannerKind::MinPos),
            self.metric.unwrap_or_default(),
        );
        let (settings, maps) = self
            .settings
            .read(reference, metric, self.trouble.clone())?;
        let plan = settings.plan(maps);
        settings.claim(&out)?;
        match settings.summary_only {
            true => self.count(&plan, &settings, &out)?,
            false => self.keep_rows(&plan, &settings, &out)?,
        }
        if self.shard.is_none() {
            self.write(&out, &merge(std::slice::from_ref(&out), None, None)?)?;
        } else {
            let tables = format!("compare --merge {}", out.display());
            println!("Shard done; `{tables}` makes the tables when all are.");
        }
        Ok(ExitCode::SUCCESS)
    }

    fn shard(&self) -> Shard {
        self.shard.unwrap_or(Shard::ALL)
    }

    /// Does what is missing, run by run.
    fn keep_rows(&self, plan: &Plan, settings: &Settings, out: &Path) -> Result<(), Failure> {
        let order = settings.order();
        let journal = Journal::open(out, self.shard())?;
        let rows = match self.resume || self.shard.is_none() {
            true => Journal::read_all(out)?,
            false => journal.read()?,
        };
        let done: HashSet<usize> = rows.iter().filter_map(|row| order.place(row)).collect();
        drop(rows);
        let of = |world, run| world * order.runs_a_world() + run;
        let is_done = |world, run| done.contains(&of(world, run));
        let bar = self.progress_bar(plan, &order, &is_done);
        execute(plan, self.shard(), &is_done, &|row, _| {
            bar.inc(1);
            journal.add(&row)
        })?;
        bar.finish_and_clear();
        Ok(())
    }

    /// Does what is missing, world by world.
    fn count(&self, plan: &Plan, settings: &Settings, out: &Path) -> Result<(), Failure> {
        let tally = Tally::open(out, self.shard(), settings)?;
        let mut counted = tally.counted();
        if self.resume || self.shard.is_none() {
            counted = Counted::default();
            counted.read_all(out)?;
        }
        let is_done = |world, _| counted.worlds.contains(&world);
        let bar = self.progress_bar(plan, &settings.order(), &is_done);
        execute(plan, self.shard(), &is_done, &|row, _| {
            bar.inc(1);
            tally.add(row)
        })?;
        bar.finish_and_clear();
        Ok(tally.write()?)
    }

    fn write(&self, out: &Path, results: &Results) -> Result<(), Failure> {
        let Results {
            comparisons,
            reference,
            metric,
            ..
        } = results;
        let table = markdown(comparisons, *reference, *metric);
        let mut folder = Folder::open(out.into())?;
        if let Some(rows) = &results.rows {
            folder.put("runs.csv", &to_csv(rows, true))?;
            #[cfg(feature = "parquet")]
            if self.parquet {
                let mut bytes = Vec::new();
                host_sim::experiments::write_parquet(rows, &mut bytes)?;
                folder.write("runs.parquet", |file| Ok(file.write_all(&bytes)?))?;
            }
        }
        folder.put("table.md", &table)?;
        folder.put("table.csv", &comparisons_csv(comparisons, *metric))?;
        folder.close()?;
        print!("{table}");
        println!("Files in {}", out.display());
        Ok(())
    }

    fn progress_bar(
        &self,
        plan: &Plan,
        order: &Order,
        is_done: &dyn Fn(usize, usize) -> bool,
    ) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let worlds = self.shard().of(plan);
        let runs = order.runs_a_world();
        let done = worlds
            .iter()
            .flat_map(|&world| (0..runs).map(move |run| (world, run)))
            .filter(|&(world, run)| is_done(world, run))
            .count();
        let style = "{spinner} {percent:>3} % {wide_bar} {pos}/{len} runs [{elapsed}, {eta} left]";
        let bar = ProgressBar::new((worlds.len() * runs) as u64);
        bar.set_position(done as u64);
        bar.with_style(ProgressStyle::with_template(style).expect("the template is well-formed"))
    }
}

type Failure = Box<dyn std::error::Error>;

/// What the shards in some folders come to. Each file is read once.
fn merge(
    folders: &[PathBuf],
    reference: Option<PlannerKind>,
    metric: Option<Metric>,
) -> Result<Results, Failure> {
    let settings = Settings::read(&folders[0])?;
    for other in &folders[1..] {
        settings.must_be_those_of(other)?;
    }
    let (reference, metric) = (
        reference.unwrap_or(settings.reference),
        metric.unwrap_or(settings.metric),
    );
    if !settings.planners.contains(&reference) {
        return Err(format!("--reference {reference}: the plan has no runs of it").into());
    }
    let order = settings.order();
    let (rows, comparisons, missing) = if settings.summary_only {
        if (reference, metric) != (settings.reference, settings.metric) {
            return Err(
                "--reference and --metric can be chosen anew only where rows were kept".into(),
            );
        }
        let mut counted = Counted::default();
        for folder in folders {
            counted.read_all(folder)?;
        }
        let comparisons = counted.totals.comparisons(&settings.axes());
        let missing = order.missing(|world, _| counted.worlds.contains(&world));
        (None, comparisons, missing)
    } else {
        let mut rows = Vec::new();
        for folder in folders {
            rows.append(&mut Journal::read_all(folder)?);
        }
        let rows = order.sort(rows);
        let done: HashSet<usize> = rows.iter().filter_map(|row| order.place(row)).collect();
        let missing =
            order.missing(|world, run| done.contains(&(world * order.runs_a_world() + run)));
        let comparisons = compare(&rows, reference, metric);
        (Some(rows), comparisons, missing)
    };
    Ok(Results {
        rows,
        comparisons,
        reference,
        metric,
        missing,
    })
}
