//! Time to see every voxel of some towns, by fleet and medium.

use std::fmt::Write;

use rayon::prelude::*;

use super::Drawn;
use crate::draw::chart::{Axis, Chart, Panel, Point, Series, Style};
use crate::experiments::table::Csv;
use crate::run::voxels::run;
use crate::scenario::voxels::Scenario;
use crate::scenario::{MediumKind, ScenarioError};
use crate::scene::Scene;

/// Columns along a side.
const SIDE: u16 = 40;

/// Fleets: how many robots, and what carries their news.
const FLEETS: [(usize, MediumKind); 5] = [
    (1, MediumKind::Radio),
    (2, MediumKind::Radio),
    (4, MediumKind::Radio),
    (2, MediumKind::Ideal),
    (4, MediumKind::Ideal),
];

/// The towns 1 to `towns`.
pub(super) fn towns(towns: u64) -> Result<Drawn, ScenarioError> {
    let steps = |(town, (robots, medium))| -> Result<Option<u32>, ScenarioError> {
        let mut scenario = Scenario::new(robots, 1);
        scenario.conditions.medium = medium;
        Ok(run(&Scene::town(town, SIDE), &scenario)?.ticks_to(1.0))
    };
    let runs: Vec<_> = (1..=towns)
        .flat_map(|town| FLEETS.map(|fleet| (town, fleet)))
        .collect();
    let steps: Vec<Option<u32>> = runs
        .par_iter()
        .map(|&run| steps(run))
        .collect::<Result<_, _>>()?;
    let names = FLEETS.map(|(robots, medium)| match medium {
        MediumKind::Radio => format!("m = {robots}"),
        medium => format!("m = {robots}, {medium}"),
    });
    let mut summary = format!(
        "| terrain | {} |\n|---|{}\n",
        names.join(" | "),
        "---:|".repeat(5)
    );
    let mut csv = Csv::new("town,robots,medium,ticks_to_seen");
    let mut series = Vec::new();
    let mut sums = [0.0; FLEETS.len()];
    for (town, row) in (1..).zip(steps.chunks(FLEETS.len())) {
        let cells = row
            .iter()
            .map(|it| it.map_or("–".into(), |it| it.to_string()));
        let cells: Vec<String> = cells.collect();
        let _ = writeln!(summary, "| town:{town} | {} |", cells.join(" | "));
        for (cell, (robots, medium)) in cells.iter().zip(FLEETS) {
            csv.add([&town, &robots, &medium, cell]);
        }
        let row = row.iter().map(|it| it.map_or(f64::NAN, f64::from));
        let points = row.clone().enumerate();
        series.push(Series {
            name: format!("town:{town}"),
            color: series.len(),
            style: Style::Dots,
            points: points
                .map(|(place, it)| Point::certain(place as f64, it))
                .collect(),
        });
        sums.iter_mut().zip(row).for_each(|(sum, it)| *sum += it);
    }
    let means = sums.map(|sum| format!("{:.0}", sum / towns as f64));
    let _ = writeln!(summary, "| mean | {} |", means.join(" | "));
    Ok(Drawn {
        id: "towns",
        title: "Steps to see every voxel of a town".into(),
        caption: format!(
            "Towns of {SIDE}×{SIDE} columns surveyed by voxel-survey, range 8; by radio, and with \
             all news exchanged at once (ideal)."
        ),
        chart: Chart {
            title: "Towns of voxels".into(),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::Places("robots".into(), names.to_vec()),
                y: "steps until every voxel is seen".into(),
                series,
            }],
        },
        csv: csv.text(),
        commands: format!("host-sim survey --terrain town:1 --size {SIDE} --robots 1"),
        table: String::new(),
        summary,
    })
}
