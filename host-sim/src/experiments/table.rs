//! Comparisons as tables.

use std::fmt::{Display, Write};

use super::row::Metric;
use super::statistics::{Comparison, Conditions, Interval, in_order};
use crate::planners::PlannerKind;
use crate::scenario::Preset;

/// Comma-separated values, row by row.
pub(super) struct Csv(csv::Writer<Vec<u8>>);

impl Csv {
    /// Without rows; `columns` with commas between.
    pub(super) fn new(columns: &str) -> Self {
        let mut table = csv::Writer::from_writer(Vec::new());
        let named = table.write_record(columns.split(','));
        named.expect("a Vec takes everything");
        Self(table)
    }

    pub(super) fn add<const N: usize>(&mut self, fields: [&dyn Display; N]) {
        let row = fields.map(|field| field.to_string());
        self.0.write_record(row).expect("rows are of one length");
    }

    pub(super) fn text(self) -> String {
        let text = self.0.into_inner().expect("a Vec takes everything");
        String::from_utf8(text).expect("fields are text")
    }
}

/// Markdown: for each planner and set of conditions a table of ratios, families
/// as columns, numbers of robots as rows; then the runs that were not complete.
pub fn markdown(comparisons: &[Comparison], reference: PlannerKind, metric: Metric) -> String {
    let mut text = String::new();
    for conditions in in_order(comparisons, |comparison| comparison.conditions.clone()) {
        let title = metric.title();
        let _ = writeln!(
            text,
            "## Range {}, sync {}, loss {}{}{}: {title}\n",
            conditions.range,
            conditions.sync,
            conditions.loss,
            match conditions.preset {
                Preset::Truthful => String::new(),
                preset => format!(", {preset}"),
            },
            match conditions.trouble.as_str() {
                "" => String::new(),
                trouble => format!(", {trouble}"),
            },
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
                table(&mut text, &rows, |row| share(row.incomplete, row.runs));
            } else if let Some(all) = rows.iter().map(|row| row.runs).max() {
                let _ = writeln!(
                    text,
                    "0 of {all} runs of {planner} left something unseen.\n"
                );
            }
            if rows.iter().any(|row| row.waiting > Some(0.0)) {
                let _ = writeln!(text, "Robot-ticks of {planner} spent waiting:\n");
                table(&mut text, &rows, |row| percent(row.waiting));
            } else if rows.iter().any(|row| row.waiting.is_some()) {
                let _ = writeln!(text, "Robots of {planner} never waited.\n");
            }
            if rows.iter().any(|row| row.false_claims > 0) {
                let _ = writeln!(text, "Runs of {planner} with a false claim:\n");
                table(&mut text, &rows, |row| share(row.false_claims, row.runs));
            }
        }
    }
    text.push_str(
        "± is half of the 95 % confidence interval; where that is wide, its ends stand in brackets. \
         Runs in one world count as related; where all are in one world, its starts count as \
         independent, and the interval is about that world.\n",
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

fn share(some: u64, all: u64) -> String {
    percent((all > 0).then(|| some as f64 / all as f64))
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".into(), |share| format!("{:.1} %", 100.0 * share))
}

/// Intervals of logarithms that are wider than this share of their mean have two halves that
/// differ too much to be told as one.
const WIDE: f64 = 0.4;

fn cell(interval: Option<Interval>, digits: usize) -> String {
    match interval {
        None => "–".into(),
        Some(Interval { mean, low, high }) if high - low > WIDE * mean => match high.is_finite() {
            true => format!("{mean:.digits$} ({low:.digits$} to {high:.digits$})"),
            false => format!("{mean:.digits$}"),
        },
        Some(Interval { mean, low, high }) => {
            format!("{mean:.digits$} ±{:.digits$}", (high - low) / 2.0)
        }
    }
}

/// One line for each comparison, numbers in full.
pub fn comparisons_csv(comparisons: &[Comparison], metric: Metric) -> String {
    let mut csv = Csv::new(
        "metric,range,sync,loss,preset,trouble,planner,family,robots,runs,incomplete,false_claims,\
         waiting,ticks,ticks_low,ticks_high,pairs,ratio,ratio_low,ratio_high",
    );
    for row in comparisons {
        let Conditions {
            range,
            sync,
            loss,
            preset,
            trouble,
        } = &row.conditions;
        let robots = row.robots.map_or("all".into(), |robots| robots.to_string());
        let waiting = row
            .waiting
            .map_or_else(String::new, |share| share.to_string());
        let ([ticks, ticks_low, ticks_high], [ratio, low, high]) =
            (fields(row.ticks), fields(row.ratio));
        csv.add([
            &metric.name(),
            range,
            sync,
            loss,
            preset,
            trouble,
            &row.planner,
            &row.family.as_deref().unwrap_or("all"),
            &robots,
            &row.runs,
            &row.incomplete,
            &row.false_claims,
            &waiting,
            &ticks,
            &ticks_low,
            &ticks_high,
            &row.pairs,
            &ratio,
            &low,
            &high,
        ]);
    }
    csv.text()
}

fn fields(interval: Option<Interval>) -> [String; 3] {
    interval.map_or_else(Default::default, |Interval { mean, low, high }| {
        [mean, low, high].map(|number| number.to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_intervals_are_told_by_their_ends() {
        let told = |low, high| {
            let mean = 0.926;
            cell(Some(Interval { mean, low, high }), 3)
        };
        assert_eq!(told(0.9, 0.95), "0.926 ±0.025");
        assert_eq!(told(0.337, 2.542), "0.926 (0.337 to 2.542)");
        assert_eq!(told(0.0, f64::INFINITY), "0.926");
    }
}
