//! Time to see everything, terrain by terrain [Renzaglia2019 fig. 4].

use std::fmt::Write;

use super::{Drawn, Fleet, ROBOTS, SIDE, times};
use crate::draw::chart::{Axis, Chart, Panel, Point, Style};
use crate::experiments::table::Csv;
use crate::scenario::heights::Planner;

pub(super) fn final_times(fleets: &[Fleet]) -> Drawn {
    let mut order: Vec<usize> = (0..fleets[0].runs.len()).collect();
    let reference = fleets
        .iter()
        .find(|fleet| fleet.setup.planner == Planner::Greedy);
    if let Some(greedy) = reference {
        order.sort_by_key(|&terrain| greedy.runs[terrain].ticks[2]);
    }
    let single = |fleet: &Fleet| {
        let time = |(place, &terrain): (usize, &usize)| {
            let value = f64::from(fleet.runs[terrain].ticks[2]?);
            Some(Point::certain(place as f64, value))
        };
        order.iter().enumerate().filter_map(time).collect()
    };
    let averages = |number: usize, fleet: &Fleet| {
        let mean = fleet.ticks(2).map(|interval| interval.at(number as f64));
        mean.into_iter().collect()
    };
    let mut csv = Csv::new("planner,terrain,ticks_to_95,ticks_to_99,ticks_to_seen");
    for fleet in fleets {
        for (terrain, run) in fleet.runs.iter().enumerate() {
            let [a, b, c] = run
                .ticks
                .map(|t| t.map_or(String::new(), |t| t.to_string()));
            csv.add([&fleet.setup.planner, &terrain, &a, &b, &c]);
        }
    }
    let names: Vec<String> = fleets
        .iter()
        .map(|fleet| fleet.setup.planner.to_string())
        .collect();
    let mut summary = String::from(
        "| planner | 95 % | 99 % | 100 % | to greedy | to greedy-unique |\n|---|---:|---:|---:|---:|---:|\n",
    );
    for fleet in fleets {
        let _ = writeln!(summary, "| {} | {} |", fleet.name(), times(fleet, fleets));
    }
    let duration = "ticks until every column is seen";
    Drawn {
        id: "fcao4",
        title: "Time to see everything, terrain by terrain".into(),
        caption: format!(
            "[Renzaglia2019, figure 4]: {} Gaussian terrains of {SIDE}×{SIDE} columns, {ROBOTS} \
             robots; left each terrain, in the order of greedy's times, right the means with 95 % \
             confidence over terrains.",
            fleets[0].runs.len()
        ),
        chart: Chart {
            title: format!("Time to see everything, {ROBOTS} robots"),
            panels: vec![
                Panel {
                    title: "each terrain".into(),
                    x: Axis::Numbers("terrains, by greedy's time".into()),
                    y: duration.into(),
                    series: fleets
                        .iter()
                        .map(|f| f.series(Style::Curve, single(f)))
                        .collect(),
                },
                Panel {
                    title: "means".into(),
                    x: Axis::Places("planner".into(), names.iter().map(|n| short(n)).collect()),
                    y: duration.into(),
                    series: fleets
                        .iter()
                        .enumerate()
                        .map(|(number, f)| f.series(Style::Dots, averages(number, f)))
                        .collect(),
                },
            ],
        },
        csv: csv.text(),
        commands: String::new(),
        table: String::new(),
        summary,
    }
}

/// A planner's name without what its colour says anyway.
fn short(name: &str) -> String {
    let long = ["coordinated-", "-frontier", "greedy-", "closest-"];
    long.iter()
        .fold(name.to_owned(), |name, part| match name.replace(part, "") {
            short if short.is_empty() => name,
            short => short,
        })
}
