//! Surface seen over time [Renzaglia2019 fig. 3].

use super::{Drawn, Fleet, ROBOTS, SIDE};
use crate::draw::chart::{Axis, Chart, Panel, Point, Style};
use crate::experiments::table::Csv;

pub(super) fn over_time(fleets: &[Fleet]) -> Drawn {
    let panel = |title: &str, y: &str, points: &dyn Fn(&Fleet) -> Vec<Point>| Panel {
        title: title.into(),
        x: Axis::Numbers("time (ticks)".into()),
        y: y.into(),
        series: fleets
            .iter()
            .map(|fleet| fleet.series(Style::Curve, points(fleet)))
            .collect(),
    };
    let seen = |fleet: &Fleet| fleet.curve(|run| &run.seen, true);
    let work = |fleet: &Fleet| fleet.curve(|run| &run.work, false);
    let mut csv = Csv::new("planner,tick,seen_percent,work_per_decision");
    for fleet in fleets {
        for (seen, work) in seen(fleet).iter().zip(work(fleet)) {
            let planner = fleet.setup.planner;
            csv.add([
                &planner,
                &seen.x,
                &format!("{:.3}", seen.y),
                &format!("{:.1}", work.y),
            ]);
        }
    }
    let terrains = fleets[0].runs.len();
    Drawn {
        id: "fcao3",
        title: "Surface seen over time, and the work of a decision".into(),
        caption: format!(
            "[Renzaglia2019, figure 3] over {terrains} Gaussian terrains of {SIDE}×{SIDE} columns \
             instead of one, {ROBOTS} robots, range 8, step 2. Work: cells, tiles, candidates and \
             samples looked at in one decision, a mean over the robots; greedy counts the \
             centre's once for each robot. Bands: 95 % confidence over terrains."
        ),
        chart: Chart {
            title: format!("Surface seen over time, {ROBOTS} robots"),
            panels: vec![
                panel("explored", "columns seen (%)", &seen),
                panel("work", "work of a decision", &work),
            ],
        },
        csv: csv.text(),
        commands: String::new(),
        table: String::new(),
        summary: String::new(),
    }
}
