//! How long a planner of surveys takes beside another one, over a grid of ranges, steps,
//! least altitudes and fleets:
//!
//! `cargo run --release -p host-sim --example survey_grid -- --terrains 20`

use std::error::Error;

use clap::Parser;
use host_sim::experiments::mean;
use host_sim::run::heights::run;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::terrain::Terrain;
use rayon::prelude::*;

#[derive(Parser)]
struct Arguments {
    /// The planner.
    #[arg(long, default_value = "coordinated-survey")]
    planner: Planner,
    /// What it is compared with.
    #[arg(long, default_value = "greedy")]
    reference: Planner,
    /// Terrains of each point.
    #[arg(long, default_value_t = 20)]
    terrains: u64,
    /// Seed of the first terrain; the others follow.
    #[arg(long, default_value_t = 2000)]
    first: u64,
    /// Columns along a side.
    #[arg(long, default_value_t = 100)]
    side: u16,
    /// Towns instead of Gaussian terrains.
    #[arg(long)]
    towns: bool,
    /// Ranges of the sensors, in cells.
    #[arg(long, value_delimiter = ',', default_value = "6,8,12")]
    ranges: Vec<f32>,
    /// Longest flights in one step, in cells.
    #[arg(long, value_delimiter = ',', default_value = "0.5,1,2")]
    steps: Vec<f32>,
    /// Least heights over ground, in cells.
    #[arg(long, value_delimiter = ',', default_value = "2,3,4")]
    altitudes: Vec<f32>,
    /// Sizes of the fleet.
    #[arg(long, value_delimiter = ',', default_value = "1,3,8,16")]
    robots: Vec<usize>,
}

/// One set-up of the grid.
#[derive(Clone, Copy)]
struct Point {
    range: f32,
    step: f32,
    altitude: f32,
    robots: usize,
}

/// Steps until 95 % and until everything was seen.
type Ticks = [f64; 2];

impl Arguments {
    fn points(&self) -> Vec<Point> {
        let mut points = Vec::new();
        for &range in &self.ranges {
            for &step in &self.steps {
                for &altitude in &self.altitudes {
                    for &robots in &self.robots {
                        points.push(Point {
                            range,
                            step,
                            altitude,
                            robots,
                        });
                    }
                }
            }
        }
        points
    }

    fn fly(&self, planner: Planner, point: Point, seed: u64) -> Result<Ticks, String> {
        let terrain = match self.towns {
            true => Terrain::urban(seed, self.side),
            false => Terrain::gaussian(seed, self.side),
        };
        let mut scenario = Scenario::new(planner, point.robots, seed);
        scenario.limits.range = point.range;
        scenario.limits.step = point.step;
        scenario.limits.min_altitude = point.altitude;
        let trace = run(&terrain, &scenario).map_err(|error| error.to_string())?;
        if trace.safety.violations() > 0 {
            return Err(format!("{planner} flew where it must not, terrain {seed}"));
        }
        let to = |share| {
            let ticks = trace.ticks_to(share).map(f64::from);
            ticks.ok_or(format!("{planner} was not complete, terrain {seed}"))
        };
        Ok([to(0.95)?, to(1.0)?])
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let (planner, reference) = (arguments.planner, arguments.reference);
    println!("steps to 95 % and to all of {planner}, the same of {reference}, and the ratio of");
    println!("the means to all, over {} terrains", arguments.terrains);
    println!("range  step  altitude  robots      95 %     all      95 %     all  ratio");
    let mut worst = 0.0f64;
    for point in arguments.points() {
        let seeds = arguments.first..arguments.first + arguments.terrains;
        let flights: Vec<(Ticks, Ticks)> = seeds
            .into_par_iter()
            .map(|seed| {
                let own = arguments.fly(planner, point, seed)?;
                Ok((own, arguments.fly(reference, point, seed)?))
            })
            .collect::<Result<_, String>>()?;
        let over_all = |ticks: &dyn Fn(&(Ticks, Ticks)) -> f64| {
            mean((0u32..).zip(flights.iter().map(ticks))).map_or(f64::NAN, |interval| interval.mean)
        };
        let [own_most, own] = [0, 1].map(|share| over_all(&|flight| flight.0[share]));
        let [its_most, its] = [0, 1].map(|share| over_all(&|flight| flight.1[share]));
        let ratio = own / its;
        worst = worst.max(ratio);
        let Point {
            range,
            step,
            altitude,
            robots,
        } = point;
        println!(
            "{range:5}  {step:4}  {altitude:8}  {robots:6}  {own_most:8.1} {own:7.1}  \
             {its_most:8.1} {its:7.1}  {ratio:5.3}"
        );
    }
    println!("largest ratio {worst:.3}");
    Ok(())
}
