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

use egui::{CentralPanel, Frame, Key, Margin, Panel, RichText, ScrollArea, Theme, Ui};

use crate::app::App;
use crate::colors::Colors;
use crate::ground::Subject;
use crate::playback::{Playback, Verdict};
use crate::view;

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
            let flies = self.survey.is_some();
            if ui.selectable_label(!flies, "2-D").clicked() && flies {
                self.land();
            }
            if ui.selectable_label(flies, "3-D survey").clicked() && !flies {
                self.fly(Default::default());
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
        let all = match (&self.survey, self.runs.first()) {
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
        if self.survey.is_some() {
            self.drone(ui);
            self.survey_plots(ui);
        } else {
            self.robot(ui);
            self.plots(ui);
        }
    }

    /// Known map and real world of one run, or the known maps of two.
    fn views(&mut self, ui: &mut Ui, is_narrow: bool) {
        if let Some(survey) = &mut self.survey {
            if let Some(deed) = survey.view(ui, self.selected, self.tool) {
                self.apply(deed);
            }
            return;
        }
        let known = self.selected.map_or(Subject::Team, Subject::Robot);
        let mut wanted = Vec::new();
        for index in 0..self.runs.len() {
            match self.runs.len() {
                1 if is_narrow && self.shows_world => wanted.push((index, Subject::World)),
                1 if is_narrow => wanted.push((index, known)),
                1 => wanted.extend([(index, known), (index, Subject::World)]),
                _ => wanted.push((
                    index,
                    if self.shows_world {
                        Subject::World
                    } else {
                        known
                    },
                )),
            }
        }
        if is_narrow || self.runs.len() > 1 {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.shows_world, false, "known map");
                ui.selectable_value(&mut self.shows_world, true, "real world");
            });
        }
        let (count, room) = (wanted.len() as f32, ui.available_size());
        let gap = ui.spacing().item_spacing;
        // Beside each other or one above the other: as the maps get larger.
        let extent = self
            .runs
            .first()
            .map(|run| run.watch.scenario().world.extent());
        let side = |room: egui::Vec2| {
            extent.map_or(0.0, |extent| {
                (room.x / f32::from(extent.width)).min((room.y - 20.0) / f32::from(extent.height))
            })
        };
        let stacked =
            side(egui::vec2(room.x, room.y / count)) > side(egui::vec2(room.x / count, room.y));
        let size = match stacked {
            true => egui::vec2(room.x, (room.y - gap.y * (count - 1.0)) / count),
            false => egui::vec2((room.x - gap.x * (count - 1.0)) / count, room.y),
        };
        let layout = match stacked {
            true => egui::Layout::top_down(egui::Align::Min),
            false => egui::Layout::left_to_right(egui::Align::Min),
        };
        let mut deed = None;
        ui.with_layout(layout, |ui| {
            for (index, subject) in wanted {
                let inner = egui::Layout::top_down(egui::Align::Min);
                ui.allocate_ui_with_layout(size, inner, |ui| {
                    deed = self.view(ui, index, subject).or(deed.take());
                });
            }
        });
        if let Some(deed) = deed {
            self.apply(deed);
        }
    }

    fn view(&mut self, ui: &mut Ui, index: usize, subject: Subject) -> Option<view::Deed> {
        let is_pair = self.runs.len() > 1;
        let run = self.runs.get_mut(index)?;
        let watch = &run.watch;
        let mut title = match subject {
            Subject::World => "Real world and ways".to_owned(),
            Subject::Team => "What the robots have seen".to_owned(),
            Subject::Robot(robot) if watch.state().is_some() => format!("What robot {robot} knows"),
            Subject::Robot(_) if watch.differs().is_some() => "What the robots have seen".into(),
            Subject::Robot(robot) => format!("Working out what robot {robot} knew …"),
        };
        if is_pair {
            let all = watch.reachable().count().max(1);
            let seen = 100.0 * f64::from(watch.seen_cells()) / f64::from(all);
            title = format!("{}: {seen:.1} %, tick {}", run.setup.planner, watch.shown());
        }
        ui.label(RichText::new(title).strong());
        let second = usize::from(subject == Subject::World);
        let [one, two] = &mut run.views;
        let view = if second == 1 { two } else { one };
        view.show(
            ui,
            &mut self.camera,
            &view::Frame {
                watch,
                run: run.id,
                subject,
                layers: &self.layers,
                selected: self.selected,
                tool: self.tool,
            },
        )
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
