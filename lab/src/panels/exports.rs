//! What is shown, as files, as a command and as an address.

use egui::{Button, Ui};

use crate::app::App;
use crate::maps::{Map, file_name};
use crate::platform::save;
use crate::playback::Export;

impl App {
    /// Buttons that export what is played: of two runs, the first.
    pub(super) fn exports(&mut self, ui: &mut Ui) {
        let players = self.players();
        let Some(player) = players.first() else {
            return;
        };
        let name = file_name(player.name());
        let mut done = None;
        ui.horizontal_wrapped(|ui| {
            for (what, label) in Export::ALL {
                if ui.button(label).clicked() {
                    let file = player.export(what);
                    done = Some(
                        file.and_then(|(ending, bytes)| save(&format!("{name}{ending}"), &bytes)),
                    );
                }
            }
        });
        let (is_replay, digest) = (player.is_replay(), player.digest());
        let (command, is_repeatable) = match self.survey() {
            Some(survey) => (survey.setup.command(), survey.is_repeatable()),
            None => (self.setup.command(), true),
        };
        let mut runs_again = false;
        ui.horizontal_wrapped(|ui| {
            let hint = "this trace was flown with more than the menus can set";
            let button = |ui: &mut Ui, label| {
                let button = ui.add_enabled(is_repeatable, Button::new(label));
                button.on_disabled_hover_text(hint)
            };
            let copies = button(ui, "Copy command").on_hover_text(&command);
            if copies.clicked() {
                let needs_map = self.survey().is_none() && matches!(self.setup.map, Map::Given(_));
                done = Some(Ok(match needs_map {
                    true => "copied; save the map (button Map) beside it".to_owned(),
                    false => "copied".to_owned(),
                }));
                ui.ctx().copy_text(command);
            }
            if button(ui, "Copy address").clicked() {
                ui.ctx().copy_text(format!("#{}", self.address()));
                done = Some(Ok(
                    "copied: the part of the page's address behind #".to_owned()
                ));
            }
            runs_again = is_replay && button(ui, "Run again").clicked();
        });
        if let Some(digest) = digest {
            ui.label(format!("trace digest {digest}"));
        }
        if let Some(done) = done {
            self.say(done);
        }
        if runs_again {
            self.run_again();
        }
    }
}
