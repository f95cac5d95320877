//! The page that shows all figures.

use std::fmt::Write;

use super::measure::Measured;
use crate::experiments::{Metric, compare, markdown};
use crate::planners::PlannerKind;
use crate::survey::figures as survey;

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;\
color:#282c34}figure{margin:2em 0}img{max-width:100%;border:1px solid #ddd}\
pre{overflow-x:auto;background:#f4f5f7;padding:.8em;font-size:13px}";

/// The figures as a web page, which expects `ID.svg` beside it for each one.
pub fn page(figures: &[Measured], surveys: &[survey::Figure]) -> String {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\">\n\
         <title>Exploration planners compared</title>\n<style>{STYLE}</style>\n\
         <h1>Exploration planners compared</h1>\n\
         <p>Means are geometric and over complete runs only; the share of runs that were not \
         complete stands beside each name. Error bars and bands are 95 % confidence intervals \
         over starts. Where a bar or a dot is missing, no run was complete.</p>\n"
    );
    for measured in figures {
        let figure = &measured.figure;
        let plan = &figure.plan;
        let comparisons = compare(&measured.rows, PlannerKind::MinPos, Metric::Seen);
        let table = markdown(&comparisons, PlannerKind::MinPos, Metric::Seen);
        let _ = write!(
            html,
            "<figure id=\"{id}\">\n<h2>{title}</h2>\n<img src=\"{id}.svg\" alt=\"{title}\">\n\
             <figcaption>{caption} Sensor range {range} cells, {starts} starts a map \
             (place: {place}), seed {seed}, {runs} runs. The runs: <a href=\"{id}.csv\">{id}.csv\
             </a>. The picture: <a href=\"{id}.png\">{id}.png</a>.</figcaption>\n\
             <pre>host-sim figures --only {id}\n{command}</pre>\n\
             <details><summary>Table</summary><pre>{table}</pre></details>\n</figure>\n",
            id = figure.id,
            title = escape(&figure.title),
            caption = escape(&figure.caption),
            range = plan.ranges[0],
            starts = plan.starts,
            place = plan.place,
            seed = plan.seed,
            runs = measured.rows.len(),
            command = escape(&figure.command()),
            table = escape(&table),
        );
    }
    if !surveys.is_empty() {
        html.push_str("<h1>Surveys of 3-D terrain</h1>\n<p>Here means are arithmetic.</p>\n");
    }
    for figure in surveys {
        let _ = write!(
            html,
            "<figure id=\"{id}\">\n<h2>{title}</h2>\n<img src=\"{id}.svg\" alt=\"{title}\">\n\
             <figcaption>{caption} The numbers: <a href=\"{id}.csv\">{id}.csv</a>. The picture: \
             <a href=\"{id}.png\">{id}.png</a>.</figcaption>\n\
             <pre>host-sim figures --only {id}</pre>\n</figure>\n",
            id = figure.id,
            title = escape(&figure.title),
            caption = escape(&figure.caption),
        );
    }
    html.push_str("</html>\n");
    html
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
