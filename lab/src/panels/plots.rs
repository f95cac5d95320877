//! Coverage, work and bytes, tick by tick.

use egui::{RichText, Stroke, Ui};
use egui_plot::{Corner, Legend, Line, Plot, PlotPoints, VLine};

use crate::app::{App, Shown};
use crate::colors::Colors;
use crate::watch::Point;

/// Points on a curve at most: more could not be told apart.
const POINTS: usize = 600;

/// What a plot draws of a tick; the second argument is the number of cells in all.
type Value = fn(&Point, u32) -> f64;

const PLOTS: [(&str, Value); 3] = [
    ("Cells seen, %", |point, all| {
        100.0 * f64::from(point.seen) / f64::from(all.max(1))
    }),
    ("Largest work of a robot in a tick", |point, _| {
        point.work.into()
    }),
    ("Bytes sent by all robots", |point, _| point.bytes as f64),
];

impl App {
    pub(super) fn plots(&mut self, ui: &mut Ui) {
        let colors = Colors::of(ui);
        let shown = self.shown_tick();
        for (place, (title, value)) in PLOTS.into_iter().enumerate() {
            ui.label(RichText::new(title).strong());
            let mut plot = small(title);
            if self.runs.len() > 1 && place == 0 {
                plot = plot.legend(Legend::default().position(Corner::LeftTop));
            }
            plot.show(ui, |plot| {
                for (index, run) in self.runs.iter().enumerate() {
                    let color = colors.robot(index);
                    let line = Line::new(run.setup.planner.to_string(), curve(run, value));
                    plot.line(line.stroke(Stroke::new(2.0, color)));
                }
                let now = VLine::new("", f64::from(shown));
                plot.vline(now.stroke(Stroke::new(1.0, colors.ink)));
            });
        }
    }

    pub(super) fn survey_details(&mut self, ui: &mut Ui) {
        let Some(survey) = &self.survey else { return };
        let colors = Colors::of(ui);
        ui.label(RichText::new("Ground seen, %").strong());
        let points: Vec<[f64; 2]> = (0..)
            .map(f64::from)
            .zip(survey.curve())
            .map(Into::into)
            .collect();
        small("ground").show(ui, |plot| {
            let line = Line::new("seen", PlotPoints::from(points));
            plot.line(line.stroke(Stroke::new(2.0, colors.robot(0))));
            let now = VLine::new("", survey.shown() as f64);
            plot.vline(now.stroke(Stroke::new(1.0, colors.ink)));
        });
        let state = if survey.is_over() {
            "over"
        } else {
            "under way"
        };
        ui.label(format!("The survey is {state}."));
        let violations = survey.violations();
        ui.label(match violations {
            0 => "No flight was too low, too high or too near to another.".to_owned(),
            _ => format!("{violations} flights were too low, too high or too near to another."),
        });
        ui.label("Drag turns the view, the wheel or two fingers zoom.");
    }
}

fn small(name: &str) -> Plot<'_> {
    Plot::new(name)
        .height(110.0)
        .include_y(0.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
}

fn curve(run: &Shown, value: Value) -> PlotPoints<'static> {
    let (series, all) = (run.watch.series(), run.watch.reachable().count());
    // Of several ticks, the largest value: no peak is lost.
    let each = series.len().div_ceil(POINTS).max(1);
    let points = series.chunks(each).zip((1..).step_by(each));
    points
        .map(|(ticks, first)| {
            let largest = ticks
                .iter()
                .map(|point| value(point, all))
                .fold(0.0, f64::max);
            [f64::from(first) + ticks.len() as f64 - 1.0, largest]
        })
        .collect()
}
