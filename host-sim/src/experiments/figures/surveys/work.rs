//! The work of a decision by size of the map and of the fleet.

use std::fmt::Write;

use super::{Drawn, Fleet, METHODS, ROBOTS, SIDE, Setup, colour};
use crate::draw::chart::{Axis, Chart, Panel, Series, Style};
use crate::experiments::table::Csv;
use crate::scenario::ScenarioError;

pub(super) fn work(terrains: u64) -> Result<Drawn, ScenarioError> {
    let sides = [60u16, 100, 150, 200];
    let fleets = [1usize, 2, 4, 8, 16];
    let mut csv = Csv::new("planner,side,robots,mean_work,max_work");
    let mut summary =
        String::from("| planner | least mean | largest mean | most |\n|---|---:|---:|---:|\n");
    let mut curves: [Vec<Series>; 2] = Default::default();
    for planner in METHODS {
        let (mut least, mut largest, mut most) = (f64::INFINITY, 0.0f64, 0);
        let mut measure = |setups: Vec<Setup>| -> Result<Series, ScenarioError> {
            let mut points = Vec::new();
            for (place, setup) in setups.into_iter().enumerate() {
                let fleet = Fleet::new(setup, terrains)?;
                let mean = fleet.mean(|run| Some(run.mean_work()));
                let max = fleet.runs.iter().map(|run| run.max_work).max().unwrap_or(0);
                points.extend(mean.map(|interval| interval.at(place as f64)));
                let mean = mean.map_or(f64::NAN, |interval| interval.mean);
                (least, largest, most) = (least.min(mean), largest.max(mean), most.max(max));
                let mean = format!("{mean:.0}");
                csv.add([&planner, &setup.side, &setup.robots, &mean, &max]);
            }
            Ok(Series {
                name: planner.to_string(),
                color: colour(planner),
                style: Style::Dots,
                points,
            })
        };
        let by_side = sides.map(|side| Setup {
            side,
            ..Setup::new(planner, ROBOTS)
        });
        curves[0].push(measure(by_side.to_vec())?);
        let by_robots = fleets.map(|robots| Setup::new(planner, robots));
        curves[1].push(measure(by_robots.to_vec())?);
        let _ = writeln!(
            summary,
            "| {planner} | {least:.0} | {largest:.0} | {most} |"
        );
    }
    let [by_side, by_robots] = curves;
    let panel = |title: &str, label: &str, places: Vec<String>, series| Panel {
        title: title.into(),
        x: Axis::Places(label.into(), places),
        y: "mean work of a decision".into(),
        series,
    };
    Ok(Drawn {
        id: "fcao-work",
        title: "The work of a decision by size of the map and of the fleet".into(),
        caption: format!(
            "Counted work as in fcao3, means over {terrains} terrains with 95 % confidence. It \
             stays level for the planners of the core; that of the frontier methods grows with \
             the frontier, and the centre's also with the fleet."
        ),
        chart: Chart {
            title: "Work of a decision".into(),
            panels: vec![
                panel(
                    &format!("{ROBOTS} robots"),
                    "columns along a side",
                    sides.map(|side| side.to_string()).to_vec(),
                    by_side,
                ),
                panel(
                    &format!("{SIDE}×{SIDE} columns"),
                    "robots",
                    fleets.map(|robots| robots.to_string()).to_vec(),
                    by_robots,
                ),
            ],
        },
        csv: csv.text(),
        commands: String::new(),
        table: String::new(),
        summary,
    })
}
