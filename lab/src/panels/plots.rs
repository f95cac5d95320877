//! Coverage, work and bytes, tick by tick.

use egui::{Rangef, RichText, Stroke, Ui};
use egui_plot::{
    AxisHints, Corner, GridInput, Legend, Line, Plot, PlotPoints, VLine, uniform_grid_spacer,
};

use crate::app::App;
use crate::colors::Colors;
use crate::playback::Series;

/// Points on a curve at most: one for each of the panel's pixels, about.
const POINTS: usize = 240;

impl App {
    /// The curves of all that is played, those of one kind in one plot.
    pub(super) fn plots(&mut self, ui: &mut Ui) {
        let colors = Colors::of(ui);
        let (shown, players) = (self.shown_tick(), self.players());
        for (of, name) in Series::ALL {
            let name = match of {
                Series::Seen if self.survey().is_some() => "Ground seen, %",
                _ => name,
            };
            ui.label(RichText::new(name).strong());
            let mut plot = small(name);
            if players.len() > 1 && of == Series::Seen {
                plot = plot.legend(Legend::default().position(Corner::LeftTop));
            }
            plot.show(ui, |plot| {
                for (index, player) in players.iter().enumerate() {
                    let line = Line::new(player.title(), thinned(&player.curve(of)));
                    plot.line(line.stroke(Stroke::new(2.0, colors.robot(index))));
                }
                let now = VLine::new("", f64::from(shown));
                plot.vline(now.stroke(Stroke::new(1.0, colors.ink)));
            });
        }
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

/// Of several ticks, the largest value: no peak is lost.
fn thinned(curve: &[[f64; 2]]) -> PlotPoints<'static> {
    let each = curve.len().div_ceil(POINTS).max(1);
    let largest = |ticks: &[[f64; 2]]| {
        let value = ticks.iter().map(|point| point[1]).fold(0.0, f64::max);
        ticks.last().map(|last| [last[0], value])
    };
    curve.chunks(each).filter_map(largest).collect()
}
