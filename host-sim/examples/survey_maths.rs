//! How long surveys take with the mathematics that this was built with, and how many
//! decisions differ from those of another build in the same places:
//!
//! `cargo run --release -p host-sim --example survey_maths -- --record target/decisions.json`
//! `cargo run --release -p host-sim --example survey_maths --features
//! planner-core/micromath -- --compare target/decisions.json`

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::PathBuf;
use std::rc::Rc;

use bridge::SurveyorConfig;
use clap::Parser;
use host_sim::experiments::{Interval, mean};
use host_sim::run::Site;
use host_sim::run::heights::{Host, run, run_on};
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::terrain::Terrain;
use planner_core::coordinated_survey::CoordinatedSurvey;
use planner_core::fcao::Fcao;
use planner_core::survey::{Knowledge, Limits, Pilot, SetupError, Surveyor};
use planner_core::{Action, Cell, Extent, Point, RobotId};

const PLANNERS: [Planner; 3] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
];
const ROBOTS: usize = 8;

/// Flights that end nearer to each other than this are the same decision: a twentieth of
/// a step, far above what the functions themselves differ by.
const SAME: f32 = 0.1;

#[derive(Parser)]
struct Arguments {
    /// Gaussian terrains of 100×100 columns.
    #[arg(long, default_value_t = 20)]
    terrains: u64,
    /// Runs on each terrain, of different seeds.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Writes the decisions of the first seed to this file.
    #[arg(long)]
    record: Option<PathBuf>,
    /// Flies as this file says, and counts the decisions that would have been others.
    #[arg(long)]
    compare: Option<PathBuf>,
}

/// What a robot decided, and where it said that it goes.
type Decision = (Action<Point>, Option<Cell>);

/// The decisions of each robot of a run.
type Decisions = BTreeMap<u8, Vec<Decision>>;

/// Robots whose decisions are written down, or replaced by those that were.
#[derive(Clone, Default)]
struct Books {
    recorded: Option<Decisions>,
    own: Rc<RefCell<Decisions>>,
}

struct Scribe<const T: usize> {
    id: RobotId,
    robot: Box<dyn Pilot<T, T>>,
    recorded: Option<std::vec::IntoIter<Decision>>,
    own: Rc<RefCell<Decisions>>,
}

impl Site for Books {}

impl Host for Books {
    fn surveyor<const T: usize>(
        &self,
        extent: Extent,
        _limits: Limits,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Result<Box<dyn Surveyor<T, T>>, SetupError> {
        let of_robot = |decisions: &Decisions| decisions.get(&id.0).cloned().unwrap_or_default();
        let robot: Box<dyn Pilot<T, T>> = match planner {
            SurveyorConfig::Fcao(config) => Box::new(Fcao::<T, T>::new(config, id, extent)?),
            SurveyorConfig::Coordinated(config) => {
                Box::new(CoordinatedSurvey::new(config, id, extent)?)
            }
        };
        Ok(Box::new(Scribe {
            id,
            robot,
            recorded: self.recorded.as_ref().map(of_robot).map(Vec::into_iter),
            own: self.own.clone(),
        }))
    }
}

impl<const T: usize> Pilot<T, T> for Scribe<T> {
    fn knowledge(&self) -> &Knowledge<T, T> {
        self.robot.knowledge()
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<T, T> {
        self.robot.knowledge_mut()
    }

    fn decide(&mut self) -> Action<Point> {
        self.robot.decide()
    }

    fn act(&mut self) -> Action<Point> {
        let own = (self.robot.act(), self.robot.knowledge().goal());
        self.own
            .borrow_mut()
            .entry(self.id.0)
            .or_default()
            .push(own);
        let Some((action, target)) = self.recorded.as_mut().and_then(Iterator::next) else {
            return own.0;
        };
        self.knowledge_mut().set_goal(target);
        action
    }
}

fn differ((own, _): &Decision, (recorded, _): &Decision) -> bool {
    match (own, recorded) {
        (Action::Move(own), Action::Move(recorded)) => own.distance(*recorded) > SAME,
        (own, recorded) => own != recorded,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    if let Some(path) = arguments.compare {
        return compare(serde_json::from_reader(BufReader::new(File::open(path)?))?);
    }
    let mut book: Vec<Vec<Decisions>> = Vec::new();
    println!("planner               steps to 95 %  99 %   100 % with its 95 % interval");
    for planner in PLANNERS {
        let mut recorded = Vec::new();
        let mut ticks: [Vec<(String, f64)>; 3] = Default::default();
        for (terrain, seed) in runs(arguments.terrains, arguments.seeds) {
            let host = Books::default();
            let scenario = Scenario::new(planner, ROBOTS, terrain + 1000 * seed);
            let trace = run_on(&host, &Terrain::gaussian(terrain, 100), &scenario)?;
            for (ticks, share) in ticks.iter_mut().zip([0.95, 0.99, 1.0]) {
                let to = trace.ticks_to(share).ok_or("a survey was not complete")?;
                ticks.push((terrain.to_string(), f64::from(to)));
            }
            if trace.safety.violations() > 0 {
                return Err(format!("{planner} flew where it must not").into());
            }
            if seed == 0 {
                recorded.push(host.own.take());
            }
        }
        let [most, nearly, all] = ticks.map(|ticks| {
            mean(ticks.iter().map(|(terrain, ticks)| (&**terrain, *ticks))).expect("there are runs")
        });
        let Interval { mean, low, .. } = all;
        println!(
            "{:20} {:14.1} {:5.1} {mean:7.1} ± {:.1}",
            planner.to_string(),
            most.mean,
            nearly.mean,
            mean - low
        );
        book.push(recorded);
    }
    if let Some(path) = arguments.record {
        serde_json::to_writer(BufWriter::new(File::create(path)?), &book)?;
    }
    Ok(())
}

fn runs(terrains: u64, seeds: u64) -> impl Iterator<Item = (u64, u64)> {
    (0..terrains).flat_map(move |terrain| (0..seeds).map(move |seed| (terrain, seed)))
}

fn compare(book: Vec<Vec<Decisions>>) -> Result<(), Box<dyn Error>> {
    println!("planner               decisions  changed   traces changed");
    for (planner, runs) in PLANNERS.into_iter().zip(book) {
        let (mut all, mut changed, mut traces, number) = (0, 0, 0, runs.len());
        for (terrain, recorded) in (0..).zip(runs) {
            let ground = Terrain::gaussian(terrain, 100);
            let scenario = Scenario::new(planner, ROBOTS, terrain);
            let host = Books {
                recorded: Some(recorded.clone()),
                ..Books::default()
            };
            let as_recorded = run_on(&host, &ground, &scenario)?;
            let own = host.own.take();
            for (own, recorded) in own.values().flatten().zip(recorded.values().flatten()) {
                all += 1;
                changed += u32::from(differ(own, recorded));
            }
            traces += u32::from(run(&ground, &scenario)?.digest() != as_recorded.digest());
        }
        let share = 100.0 * f64::from(changed) / f64::from(all);
        println!(
            "{:20} {all:10} {share:6.2} %   {traces} of {number}",
            planner.to_string()
        );
    }
    Ok(())
}
