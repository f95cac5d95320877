//! Scenarios to start from, each with a sentence on what there is to see.

use egui::{Align, Layout, RichText, Ui};

use crate::app::App;
use crate::gallery::EXAMPLES;

impl App {
    pub(super) fn examples(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        ui.menu_button("Examples", |ui| {
            ui.set_max_width(320.0);
            ui.with_layout(Layout::top_down(Align::LEFT), |ui| {
                for example in &EXAMPLES {
                    if ui.button(RichText::new(example.name).strong()).clicked() {
                        chosen = Some(example);
                    }
                    ui.label(RichText::new(example.what).weak());
                }
            });
        });
        if let Some(example) = chosen {
            self.load(example.address);
            self.say(Ok(example.what.into()));
        }
    }
}
