//! The screen: menus on the left, views in the middle, the robot and the curves on the
//! right, time below. On a phone, one thing at a time.

mod examples;
mod exports;
mod menus;
mod parts;
mod plots;
mod robot;
mod survey_menus;
mod time;
mod views;

use egui::{CentralPanel, Frame, Key, Margin, Panel, RichText, ScrollArea, Theme, Ui};

use crate::app::App;
use crate::colors::Colors;
use crate::playback::Verdict;
use crate::survey::SurveySetup;

/// Narrower screens show one thing at a time.
const NARROW: f32 = 820.0;

/// Keys, and what they do.
const KEYS: [(&str, &str); 6] = [
    ("Space", "play or pause"),
    ("Right", "one tick on"),
    ("Left", "one tick back"),
    ("Home", "the first tick"),
    ("End", "the last tick so far"),
    ("Escape", "no robot selected"),
];

/// What covers the views on a narrow screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sheet {
    /// Map, robots, planner, radio.
    Setup,
    /// The selected robot, and the curves.
    Details,
}

impl App {
    /// One frame: keys, time, and everything on the screen.
    pub fn ui(&mut self, ui: &mut Ui) {
        let inbox = self.inbox.clone();
        inbox.take_dropped(ui.ctx());
        self.keys(ui);
        let seconds = ui.input(|input| input.unstable_dt);
        self.advance(seconds);
        let is_narrow = ui.available_width() < NARROW;
        Panel::top("bar").show(ui, |ui| self.bar(ui, is_narrow));
        if self.notice.is_some() {
            Panel::top("notice").show(ui, |ui| self.notice(ui));
        }
        Panel::bottom("time").show(ui, |ui| self.time(ui));
        if is_narrow {
            self.sheet(ui);
        } else {
            Panel::left("setup").default_size(250.0).show(ui, |ui| {
                ScrollArea::vertical().show(ui, |ui| self.menus(ui));
            });
            Panel::right("details").default_size(280.0).show(ui, |ui| {
                ScrollArea::vertical().show(ui, |ui| self.details(ui));
            });
        }
        if !is_narrow || self.sheet.is_none() {
            let frame = Frame::central_panel(ui.style()).inner_margin(Margin::same(4));
            CentralPanel::default()
                .frame(frame)
                .show(ui, |ui| self.views(ui, is_narrow));
        }
        if self.is_busy() {
            ui.ctx().request_repaint();
        }
    }

    fn bar(&mut self, ui: &mut Ui, is_narrow: bool) {
        ui.horizontal_wrapped(|ui| {
            if is_narrow {
                for (sheet, name) in [(Sheet::Setup, "Setup"), (Sheet::Details, "Details")] {
                    let is_open = self.sheet == Some(sheet);
                    if ui.selectable_label(is_open, name).clicked() {
                        self.sheet = (!is_open).then_some(sheet);
                    }
                }
            } else {
                ui.label(RichText::new("Exploration lab").strong());
            }
            ui.separator();
            let flies = self.survey().is_some();
            if ui.selectable_label(!flies, "2-D").clicked() && flies {
                self.land();
            }
            if ui.selectable_label(flies, "3-D survey").clicked() && !flies {
                self.fly(SurveySetup::default());
            }
            self.examples(ui);
            if !is_narrow {
                ui.menu_button("Keys", keys);
            }
            ui.separator();
            let dark = ui.visuals().dark_mode;
            if ui.button(if dark { "Light" } else { "Dark" }).clicked() {
                ui.ctx()
                    .set_theme(if dark { Theme::Light } else { Theme::Dark });
            }
            if !is_narrow {
                ui.separator();
                ui.label(self.headline());
            }
        });
        if is_narrow {
            ui.label(self.headline());
        }
    }

    /// How the first run stands, in words.
    fn headline(&self) -> String {
        let players = self.players();
        let Some(player) = players.first() else {
            return String::new();
        };
        let verdict = match player.verdict() {
            _ if player.shown() < player.ticks() => "",
            Verdict::Running => "",
            Verdict::Complete => ": complete",
            Verdict::Incomplete => ": over, not complete",
        };
        let (name, seen) = (player.name(), player.seen_percent());
        let all = match (self.survey(), self.runs.first()) {
            (None, Some(run)) => format!("{} cells", run.watch.reachable().count()),
            _ => "the ground".to_owned(),
        };
        format!("{name}: {seen:.1} % of {all} seen{verdict}")
    }

    fn notice(&mut self, ui: &mut Ui) {
        let Some(notice) = self.notice.clone() else {
            return;
        };
        let color = if notice.is_error {
            Colors::of(ui).lost
        } else {
            Colors::of(ui).ink
        };
        ui.horizontal_wrapped(|ui| {
            if ui.button("Close").clicked() {
                self.notice = None;
            }
            ui.label(RichText::new(notice.text).color(color).strong());
        });
    }

    fn sheet(&mut self, ui: &mut Ui) {
        let Some(sheet) = self.sheet else { return };
        CentralPanel::default().show(ui, |ui| {
            ScrollArea::vertical().show(ui, |ui| match sheet {
                Sheet::Setup => self.menus(ui),
                Sheet::Details => self.details(ui),
            });
        });
    }

    fn details(&mut self, ui: &mut Ui) {
        match self.survey().is_some() {
            true => self.drone(ui),
            false => self.robot(ui),
        }
        self.plots(ui);
        self.violations(ui);
    }

    /// What the keys of [`KEYS`] do.
    fn keys(&mut self, ui: &Ui) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        if pressed(Key::Space) {
            self.play_or_pause();
        }
        if pressed(Key::ArrowRight) {
            self.playing = false;
            self.tick();
        }
        if pressed(Key::ArrowLeft) {
            self.playing = false;
            self.show(self.shown_tick().saturating_sub(1));
        }
        if pressed(Key::Home) {
            self.show(0);
        }
        if pressed(Key::End) {
            self.show(self.last_tick());
        }
        if pressed(Key::Escape) {
            self.selected = None;
        }
    }
}

/// The keyboard in a few lines.
fn keys(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (key, what) in KEYS {
            ui.label(RichText::new(key).strong());
            ui.label(what);
            ui.end_row();
        }
    });
}
