//! Time to see everything by number of robots, and by loss.

use std::fmt::Write;

use super::{Drawn, Fleet, METHODS, ROBOTS, SIDE, Setup, colour, times};
use crate::draw::chart::{Axis, Chart, Panel, Series, Style};
use crate::experiments::Interval;
use crate::experiments::table::Csv;
use crate::scenario::MediumKind;
use crate::scenario::ScenarioError;
use crate::scenario::heights::Planner;

pub(super) fn by_robots(terrains: u64) -> Result<Drawn, ScenarioError> {
    let fleets = [1, 2, 4, 8, 16];
    let mut rows = Vec::new();
    for planner in METHODS {
        for robots in fleets {
            rows.push(Fleet::new(Setup::new(planner, robots), terrains)?);
        }
    }
    let losses = [0.0, 0.1, 0.3, 0.6];
    for planner in &METHODS[..3] {
        for loss in losses {
            let setup = Setup {
                medium: MediumKind::Radio,
                loss,
                ..Setup::new(*planner, ROBOTS)
            };
            rows.push(Fleet::new(setup, terrains)?);
        }
    }
    let greedy = |planner, robots| {
        let is = |fleet: &&Fleet| fleet.setup == Setup::new(planner, robots);
        rows.iter()
            .find(is)
            .and_then(|fleet| fleet.ticks(2))
            .map_or(f64::NAN, |i| i.mean)
    };
    let mut csv = Csv::new(
        "planner,robots,medium,loss,ticks_to_95,ticks_to_99,\
         ticks_to_seen,half_interval,to_greedy,to_greedy_unique,\
         mean_work,max_work",
    );
    for fleet in &rows {
        let Setup {
            planner,
            robots,
            medium,
            loss,
            ..
        } = fleet.setup;
        let [t95, t99, all] =
            [0, 1, 2].map(|share| fleet.ticks(share).map_or(f64::NAN, |i| i.mean));
        let half = fleet.ticks(2).map_or(f64::NAN, |i| i.high - i.mean);
        let work = fleet
            .mean(|run| Some(run.mean_work()))
            .map_or(f64::NAN, |i| i.mean);
        let max = fleet.runs.iter().map(|run| run.max_work).max().unwrap_or(0);
        let to_greedy = all / greedy(Planner::Greedy, robots);
        let to_unique = all / greedy(Planner::GreedyUnique, robots);
        csv.add([
            &planner,
            &robots,
            &medium,
            &loss,
            &format!("{t95:.1}"),
            &format!("{t99:.1}"),
            &format!("{all:.1}"),
            &format!("{half:.1}"),
            &format!("{to_greedy:.3}"),
            &format!("{to_unique:.3}"),
            &format!("{work:.0}"),
            &max,
        ]);
    }
    let mut summary = String::from(
        "| planner | robots | medium | lost | 95 % | 99 % | 100 % | to greedy | to greedy-unique |\n\
         |---|---:|---|---:|---:|---:|---:|---:|---:|\n",
    );
    for fleet in &rows {
        let Setup {
            robots,
            medium,
            loss,
            ..
        } = fleet.setup;
        let (name, lost) = (fleet.name(), 100.0 * loss);
        let _ = writeln!(
            summary,
            "| {name} | {robots} | {medium} | {lost:.0} % | {} |",
            times(fleet, &rows)
        );
    }
    let of = |planner: Planner, medium| {
        rows.iter()
            .filter(move |fleet| fleet.setup.planner == planner && fleet.setup.medium == medium)
    };
    let robots = |planner: Planner| {
        let ratio = |(place, fleet): (usize, &Fleet)| {
            let all = greedy(Planner::Greedy, fleet.setup.robots);
            let Interval { mean, low, high } = fleet.ticks(2)?;
            let share = |value| 100.0 * value / all;
            let scaled = Interval {
                mean: share(mean),
                low: share(low),
                high: share(high),
            };
            Some(scaled.at(place as f64))
        };
        of(planner, MediumKind::Ideal)
            .enumerate()
            .filter_map(ratio)
            .collect()
    };
    let lossy = |planner: Planner| {
        let ticks = |(place, fleet): (usize, &Fleet)| Some(fleet.ticks(2)?.at(place as f64));
        of(planner, MediumKind::Radio)
            .enumerate()
            .filter_map(ticks)
            .collect()
    };
    let series = |planner: Planner, points| Series {
        name: planner.to_string(),
        color: colour(planner),
        style: Style::Dots,
        points,
    };
    let places = |of: &[String]| of.to_vec();
    Ok(Drawn {
        id: "fcao-robots",
        title: "Time to see everything by number of robots, and by loss".into(),
        caption: format!(
            "{terrains} Gaussian terrains of {SIDE}×{SIDE} columns. Left: the mean time as a share \
             of greedy's, all news exchanged at once. Right: {ROBOTS} robots that learn from one \
             another by frames of 55 bytes only, five a step, of which a share is lost. Error bars: \
             95 % confidence over terrains."
        ),
        chart: Chart {
            title: "Number of robots, and loss".into(),
            panels: vec![
                Panel {
                    title: "against greedy".into(),
                    x: Axis::Places("robots".into(), places(&fleets.map(|n| n.to_string()))),
                    y: "time of greedy's (%)".into(),
                    series: METHODS.iter().map(|&p| series(p, robots(p))).collect(),
                },
                Panel {
                    title: format!("{ROBOTS} robots by radio"),
                    x: Axis::Places(
                        "share of frames lost".into(),
                        places(&losses.map(|l| l.to_string())),
                    ),
                    y: "ticks until every column is seen".into(),
                    series: METHODS[..3].iter().map(|&p| series(p, lossy(p))).collect(),
                },
            ],
        },
        csv: csv.text(),
        commands: String::new(),
        table: String::new(),
        summary,
    })
}
