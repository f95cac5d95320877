//! Play, pause, single tick, speed, and going back and forth.

use egui::{Slider, Ui};

use crate::app::App;

impl App {
    pub(super) fn time(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let play = if self.playing { "Pause" } else { "Play" };
            if ui.button(play).on_hover_text("Space").clicked() {
                self.play_or_pause();
            }
            if ui
                .button("Tick")
                .on_hover_text("One tick: right arrow")
                .clicked()
            {
                self.playing = false;
                self.tick();
            }
            if ui.button("Restart").clicked() {
                self.restart();
            }
            ui.add(
                Slider::new(&mut self.speed, 1.0..=2000.0)
                    .logarithmic(true)
                    .max_decimals(0)
                    .text("ticks/s"),
            );
        });
        ui.horizontal(|ui| {
            let last = self.last_tick();
            let mut shown = self.shown_tick();
            ui.spacing_mut().slider_width = (ui.available_width() - 100.0).max(80.0);
            let slider = Slider::new(&mut shown, 0..=last.max(1)).text("tick");
            if ui.add(slider).changed() {
                self.playing = false;
                self.show(shown);
            }
        });
    }
}
