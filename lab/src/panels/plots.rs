//! Coverage, work and bytes, tick by tick.

use egui::{Rangef, RichText, Stroke, Ui};
use egui_plot::{
    AxisHints, Corner, GridInput, Legend, Line, Plot, PlotPoints, VLine, uniform_grid_spacer,
};

use crate::app::{App, Shown};
use crate::colors::Colors;
use crate::playback::Playback;
use crate::watch::Point;

/// Points on a curve at most: one for each of the panel's pixels, about.
const POINTS: usize = 240;

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

    pub(super) fn survey_plots(&mut self, ui: &mut Ui) {
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
            let now = VLine::new("", f64::from(survey.shown()));
            plot.vline(now.stroke(Stroke::new(1.0, colors.ink)));
        });
        ui.label(match survey.violations() {
            (wrong, 0) => format!("No flight was {wrong}."),
            (wrong, flights) => format!("{flights} flights were {wrong}."),
        });
    }
}

fn small(name: &str) -> Plot<'_> {
    let along = AxisHints::new_x().label_spacing(Rangef::new(30.0, 35.0));
    // Room for numbers that come with the first peak.
    let up = AxisHints::new_y()
        .min_thickness(44.0)
        .label_spacing(Rangef::new(12.0, 15.0));
    Plot::new(name)
        .height(110.0)
        .include_y(0.0)
        .custom_x_axes(vec![along])
        .custom_y_axes(vec![up])
        .x_grid_spacer(uniform_grid_spacer(steps))
        .y_grid_spacer(uniform_grid_spacer(steps))
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
}

/// Between two lines of the grid: 1, 2, or 5 times a power of ten, so that two to five
/// lines have room for their numbers.
fn steps(input: GridInput) -> [f64; 3] {
    let half = ((input.bounds.1 - input.bounds.0) / 2.0).max(1e-9);
    let power = 10_f64.powf(half.log10().floor());
    let step = match half / power {
        5.0.. => 5.0 * power,
        2.0.. => 2.0 * power,
        _ => power,
    };
    // Lines of one kind.
    [step; 3]
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
