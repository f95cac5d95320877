//! The page that shows all figures.

use std::fmt::Write;

use super::measure::Measured;
use super::tables::tables;
use crate::draw::chart::Chart;
use crate::experiments::{Metric, compare, markdown, to_csv};
use crate::planners::PlannerKind;

/// A figure as it is shown.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Short name: that of its files.
    pub id: &'static str,
    /// What is shown.
    pub title: String,
    /// Where it is from, and how it is to be read.
    pub caption: String,
    /// What is drawn.
    pub chart: Chart,
    /// The numbers, comma-separated.
    pub csv: String,
    /// Commands besides that of the figure.
    pub commands: String,
    /// The numbers as a table to read; may be empty.
    pub table: String,
    /// What it comes to, in Markdown; may be empty.
    pub summary: String,
}

impl From<&Measured> for Drawn {
    fn from(measured: &Measured) -> Self {
        let figure = &measured.figure;
        let plan = &figure.plan;
        let comparisons = compare(&measured.rows, PlannerKind::MinPos, Metric::Seen);
        Self {
            id: figure.id,
            title: figure.title.clone(),
            caption: format!(
                "{} Sensor range {} cells, {} starts a map (place: {}), seed {}, {} runs.",
                figure.caption,
                plan.ranges[0],
                plan.starts,
                plan.place,
                plan.seed,
                measured.rows.len(),
            ),
            chart: measured.chart(),
            csv: to_csv(&measured.rows, true),
            commands: figure.command(),
            table: markdown(&comparisons, PlannerKind::MinPos, Metric::Seen),
            summary: tables(measured),
        }
    }
}

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;\
color:#282c34}figure{margin:2em 0}img{max-width:100%;border:1px solid #ddd}\
pre{overflow-x:auto;background:#f4f5f7;padding:.8em;font-size:13px}";

/// The figures as a web page, which expects `ID.svg` beside it for each one.
pub fn page(figures: &[Drawn], surveys: &[Drawn]) -> String {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\">\n\
         <title>Exploration planners compared</title>\n<style>{STYLE}</style>\n\
         <h1>Exploration planners compared</h1>\n\
         <p>Means are geometric and over complete runs only; the share of runs that were not \
         complete stands beside each name. Error bars and bands are 95 % confidence intervals \
         over starts. Where a bar or a dot is missing, no run was complete.</p>\n"
    );
    figures.iter().for_each(|figure| add(&mut html, figure));
    if !surveys.is_empty() {
        html.push_str("<h1>Surveys of 3-D terrain</h1>\n<p>Here means are arithmetic.</p>\n");
    }
    surveys.iter().for_each(|figure| add(&mut html, figure));
    html.push_str("</html>\n");
    html
}

fn add(html: &mut String, figure: &Drawn) {
    let table = match &*figure.table {
        "" => String::new(),
        table => format!(
            "<details><summary>Table</summary><pre>{}</pre></details>\n",
            escape(table)
        ),
    };
    let _ = write!(
        html,
        "<figure id=\"{id}\">\n<h2>{title}</h2>\n<img src=\"{id}.svg\" alt=\"{title}\">\n\
         <figcaption>{caption} The numbers: <a href=\"{id}.csv\">{id}.csv</a>. The picture: \
         <a href=\"{id}.png\">{id}.png</a>.</figcaption>\n\
         <pre>host-sim figures --only {id}\n{commands}</pre>\n{table}</figure>\n",
        id = figure.id,
        title = escape(&figure.title),
        caption = escape(&figure.caption),
        commands = escape(&figure.commands),
    );
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
