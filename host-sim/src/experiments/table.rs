//! Comparisons as tables.

use std::fmt::Write;

use super::row::Metric;
use super::statistics::{Comparison, Interval, in_order};
use crate::planners::PlannerKind;

/// Markdown: for each planner and set of conditions a table of ratios, families
/// as columns, numbers of robots as rows; then the runs that were not complete.
pub fn markdown(comparisons: &[Comparison], reference: PlannerKind, metric: Metric) -> String {
    let mut text = String::new();
    for conditions in in_order(comparisons, |comparison| comparison.conditions) {
        let title = metric.title();
        let _ = writeln!(
            text,
            "## Range {}, sync {}, loss {}: {title}\n",
            conditions.range, conditions.sync, conditions.loss
        );
        for planner in in_order(comparisons, |comparison| comparison.planner) {
            let rows: Vec<&Comparison> = comparisons
                .iter()
                .filter(|row| row.planner == planner && row.conditions == conditions)
                .collect();
            if planner == reference {
                let _ = writeln!(text, "Geometric mean of {title}, **{planner}**:\n");
                table(&mut text, &rows, |row| cell(row.ticks, 1));
            } else {
                let _ = writeln!(text, "Ratio of **{planner}** to {reference}:\n");
                table(&mut text, &rows, |row| cell(row.ratio, 3));
            }
            if rows.iter().any(|row| row.incomplete > 0) {
                let _ = writeln!(text, "Runs of {planner} that left something unseen:\n");
                table(&mut text, &rows, |row| match row.runs {
                    0 => "–".into(),
                    runs => format!("{:.1} %", 100.0 * row.incomplete as f64 / runs as f64),
                });
            } else if let Some(all) = rows.iter().map(|row| row.runs).max() {
                let _ = writeln!(
                    text,
                    "0 of {all} runs of {planner} left something unseen.\n"
                );
            }
        }
    }
    text.push_str(
        "± is half of the 95 % confidence interval; runs in one world count as related.\n",
    );
    text
}

fn table(text: &mut String, rows: &[&Comparison], cell: impl Fn(&Comparison) -> String) {
    let families = in_order(rows, |row| row.family.clone());
    let heads = families
        .iter()
        .map(|family| family.as_deref().unwrap_or("all"));
    let mut lines = vec![
        ["robots"]
            .into_iter()
            .chain(heads)
            .map(String::from)
            .collect(),
    ];
    for robots in in_order(rows, |row| row.robots) {
        let name = robots.map_or("all".into(), |robots| robots.to_string());
        let cells = rows
            .iter()
            .filter(|row| row.robots == robots)
            .map(|row| cell(row));
        lines.push([name].into_iter().chain(cells).collect::<Vec<String>>());
    }
    let widths: Vec<usize> = (0..=families.len())
        .map(|column| {
            lines
                .iter()
                .map(|line| line[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    for (number, line) in lines.iter().enumerate() {
        for (cell, &width) in line.iter().zip(&widths) {
            let _ = write!(text, "| {cell:>width$} ");
        }
        text.push_str("|\n");
        if number == 0 {
            for width in &widths {
                let _ = write!(text, "|{:->1$}:", "", width + 1);
            }
            text.push_str("|\n");
        }
    }
    text.push('\n');
}

fn cell(interval: Option<Interval>, digits: usize) -> String {
    match interval {
        None => "–".into(),
        Some(Interval { mean, low, high }) if high.is_finite() => {
            format!("{mean:.digits$} ±{:.digits$}", (high - low) / 2.0)
        }
        Some(Interval { mean, .. }) => format!("{mean:.digits$}"),
    }
}

/// One line for each comparison, numbers in full.
pub fn comparisons_csv(comparisons: &[Comparison], metric: Metric) -> String {
    let mut text = String::from(
        "metric,range,sync,loss,planner,family,robots,runs,incomplete,\
         ticks,ticks_low,ticks_high,pairs,ratio,ratio_low,ratio_high\n",
    );
    for row in comparisons {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{},{}",
            metric.name(),
            row.conditions.range,
            row.conditions.sync,
            row.conditions.loss,
            row.planner,
            row.family.as_deref().unwrap_or("all"),
            row.robots.map_or("all".into(), |robots| robots.to_string()),
            row.runs,
            row.incomplete,
            fields(row.ticks),
            row.pairs,
            fields(row.ratio),
        );
    }
    text
}

fn fields(interval: Option<Interval>) -> String {
    interval.map_or(",,".into(), |Interval { mean, low, high }| {
        format!("{mean},{low},{high}")
    })
}
