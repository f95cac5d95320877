//! The numbers of a figure as tables to read.

use std::fmt::Write;

use super::list::Layout;
use super::measure::Measured;
use crate::experiments::statistics::geometric_mean;
use crate::experiments::{Metric, Row, compare};
use crate::planners::PlannerKind;

/// Markdown: planners as rows. Means are geometric, over complete runs; in brackets stands
/// the share of runs that were not complete.
pub(super) fn tables(measured: &Measured) -> String {
    let plan = &measured.figure.plan;
    let maps: Vec<String> = plan.sites.iter().map(|site| site.name()).collect();
    let mut text = String::new();
    let mut table = |title: &str, corner: &str, heads: &[String], cell: &Cell| {
        let id = measured.figure.id;
        let _ = writeln!(
            text,
            "{id}, {title}:\n\n| {corner} | {} |",
            heads.join(" | ")
        );
        let _ = writeln!(text, "|---|{}", "---:|".repeat(heads.len()));
        for &planner in &plan.planners {
            let cells: Vec<String> = (0..heads.len()).map(|place| cell(planner, place)).collect();
            let _ = writeln!(text, "| {planner} | {} |", cells.join(" | "));
        }
        text.push('\n');
    };
    let ticks = |belongs: &dyn Fn(&Row) -> bool| mean_ticks(&measured.rows, belongs);
    let robots: Vec<String> = plan.robots.iter().map(|it| format!("m = {it}")).collect();
    match measured.figure.layout {
        Layout::Maps | Layout::Coverage => {
            let cell = |planner, map: usize| {
                ticks(&|row| row.planner == planner && row.world == maps[map])
            };
            let corner = format!("{} robots", plan.robots[0]);
            table("ticks", &corner, &maps, &cell);
        }
        Layout::Robots => {
            for map in &maps {
                let cell = |planner, place: usize| {
                    let robots = plan.robots[place];
                    ticks(&|row| {
                        row.planner == planner && row.world == *map && row.robots == robots
                    })
                };
                table("ticks", map, &robots, &cell);
            }
            let ratios = compare(&measured.rows, PlannerKind::MinPos, Metric::Seen);
            let ratio = |planner, place: usize| {
                let ratio = ratios.iter().find(|it| {
                    it.planner == planner
                        && it.family.is_none()
                        && it.robots == Some(plan.robots[place])
                });
                let mean = ratio.and_then(|it| it.ratio).map(|it| it.mean);
                mean.map_or("–".into(), |mean| format!("{mean:.2}"))
            };
            table("all maps", "ratio to minpos", &robots, &ratio);
            let left = |planner, map: usize| {
                let belongs = |row: &&Row| row.planner == planner && row.world == maps[map];
                format!("{:.0} %", incomplete(measured.rows.iter().filter(belongs)))
            };
            table("all numbers of robots", "not complete", &maps, &left);
        }
        Layout::Syncs => {
            let syncs: Vec<String> = plan.syncs.iter().map(|it| format!("d_sync {it}")).collect();
            let cell = |planner, place: usize| {
                let sync = plan.syncs[place];
                ticks(&|row| row.planner == planner && row.sync == sync)
            };
            let corner = format!("ticks, {} robots", plan.robots[0]);
            table("all maps", &corner, &syncs, &cell);
        }
    }
    text
}

/// The text of a cell, by planner and column.
type Cell<'a> = dyn Fn(PlannerKind, usize) -> String + 'a;

fn mean_ticks(rows: &[Row], belongs: &dyn Fn(&Row) -> bool) -> String {
    let rows = || rows.iter().filter(|row| belongs(row));
    let samples = rows()
        .filter_map(|row| Some((row.world.as_str(), row.metric(Metric::Seen)?.max(1).into())));
    let mean = geometric_mean(samples).map_or("–".into(), |it| format!("{:.0}", it.mean));
    match incomplete(rows()) {
        0.0 => mean,
        share => format!("{mean} ({share:.0} %)"),
    }
}

/// Percent.
fn incomplete<'a>(rows: impl Iterator<Item = &'a Row>) -> f64 {
    let (left, all) = rows.fold((0, 0), |(left, all), row| {
        (left + u32::from(!row.complete), all + 1)
    });
    100.0 * f64::from(left) / f64::from(all.max(1))
}
