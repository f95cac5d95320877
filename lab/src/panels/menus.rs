//! What can be set: map, robots, planner, radio, view, and what can be taken away.

use std::mem::discriminant;

use clap::ValueEnum;
use egui::{Button, CollapsingHeader, ComboBox, DragValue, RichText, Slider, TextEdit, Ui};
use host_sim::planners::PlannerKind;
use host_sim::scenario::heights::Planner;
use host_sim::scenario::{Conditions, ErrorKind, Faults, MediumKind, Preset, Reach, Trouble};
use host_sim::sensor::ALL_AROUND;
use host_sim::terrain::TerrainSource;
use host_sim::world::{Family, Starts};
use planner_core::Extent;
use planner_core::explorer::MAX_CLEARANCE;
use planner_core::sight::{MAX_LONG_RADIUS, MAX_RADIUS};

use crate::app::App;
use crate::export;
use crate::ground::ALL_TICKS;
use crate::maps::{Map, file_name};
use crate::platform::{Inbox, choose_file, save};
use crate::setup::Setup;
use crate::survey::{ALTITUDES, CEILINGS, RANGES, ROBOTS, SurveyScene, SurveySetup};
use crate::view::Tool;

const ADDRESS_COPIED: &str = "copied: the part of the page's address behind #";

impl App {
    pub(super) fn menus(&mut self, ui: &mut Ui) {
        if self.survey.is_some() {
            return self.survey_menus(ui);
        }
        let before = (self.setup.clone(), self.rival);
        let mut setup = self.setup.clone();
        title(ui, "Map");
        self.map(ui, &mut setup);
        title(ui, "Robots");
        robots(ui, &mut setup);
        choice(
            ui,
            "planner",
            &mut setup.planner,
            PlannerKind::value_variants(),
        );
        if !setup.planner.turns_sensor() {
            setup.fov = ALL_AROUND;
        }
        if !setup.planner.has_body() {
            setup.clearance = 0;
        }
        self.rival(ui);
        title(ui, "Radio");
        radio(ui, &mut setup.conditions);
        CollapsingHeader::new("A world that misleads")
            .show(ui, |ui| trouble(ui, &mut setup.conditions.trouble));
        if setup.planner.weighs_looks() {
            let preset = &mut setup.conditions.preset;
            choice(ui, "sensor taken for", preset, Preset::value_variants());
        } else {
            setup.conditions.preset = Preset::default();
        }
        if (&setup, self.rival) != (&before.0, before.1) {
            if !self.set(setup) {
                self.rival = before.1;
            }
            self.playing = true;
        }
        title(ui, "Pointer");
        self.tools(ui);
        title(ui, "View");
        self.layers(ui);
        title(ui, "Take away");
        self.exports(ui);
    }

    fn map(&mut self, ui: &mut Ui, setup: &mut Setup) {
        let name = match &setup.map {
            Map::BuiltIn(name) => (*name).to_owned(),
            Map::Generated { family, .. } => family.to_string(),
            Map::Given(world) => world.name().to_owned(),
        };
        let mut fresh = None;
        ComboBox::from_label("map")
            .selected_text(name)
            .show_ui(ui, |ui| {
                for name in Map::built_in() {
                    if ui
                        .selectable_label(setup.map == Map::BuiltIn(name), name)
                        .clicked()
                    {
                        fresh = Map::named(name);
                    }
                }
                ui.separator();
                for family in Family::ALL {
                    if ui.selectable_label(false, family.to_string()).clicked() {
                        fresh = Some(Map::Generated {
                            family,
                            extent: Extent::new(64, 64),
                            seed: 1,
                        });
                    }
                }
            });
        if let Map::Generated { extent, seed, .. } = &mut setup.map {
            ui.horizontal(|ui| {
                number(
                    ui,
                    "width",
                    DragValue::new(&mut extent.width).range(8..=512),
                );
                number(
                    ui,
                    "height",
                    DragValue::new(&mut extent.height).range(8..=512),
                );
                number(ui, "seed", DragValue::new(seed));
            });
        }
        files(ui, &self.inbox, &mut self.path);
        if let Some(map) = fresh {
            *setup = Setup {
                map,
                starts: None,
                conditions: Conditions {
                    faults: Faults::default(),
                    ..setup.conditions.clone()
                },
                ..setup.clone()
            };
        }
    }

    fn rival(&mut self, ui: &mut Ui) {
        let name = self
            .rival
            .map_or("nothing".to_owned(), |rival| rival.to_string());
        ComboBox::from_label("beside it")
            .selected_text(name)
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut self.rival, None, "nothing");
                for &planner in PlannerKind::value_variants() {
                    ui.selectable_value(&mut self.rival, Some(planner), planner.to_string());
                }
            });
    }

    fn tools(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            for (tool, name) in Tool::ALL {
                ui.selectable_value(&mut self.tool, tool, name);
            }
        });
        let hint = match self.tool {
            Tool::Look => "Click a robot; drag and scroll to move and zoom.",
            Tool::Wall | Tool::Erase => "Drag over cells; the run begins anew.",
            Tool::Place => "Click for one more robot; drag one to another start.",
            Tool::Kill => "Click a robot: from this tick on it is dead.",
            Tool::Shut => "Click a cell: from this tick on it is shut, or open again.",
        };
        ui.label(RichText::new(hint).weak());
    }

    fn layers(&mut self, ui: &mut Ui) {
        let layers = &mut self.layers;
        let trail = Slider::new(&mut layers.trail, 0..=ALL_TICKS).logarithmic(true);
        let trail = trail
            .smallest_positive(1.0)
            .custom_formatter(|ticks, _| match ticks as u32 {
                ALL_TICKS.. => "all ticks".into(),
                ticks => format!("{ticks} ticks"),
            });
        ui.add(trail.text("ways"));
        ui.horizontal_wrapped(|ui| {
            for (shows, name) in [
                (&mut layers.frontiers, "frontiers"),
                (&mut layers.goals, "goals"),
                (&mut layers.plans, "plans"),
                (&mut layers.owners, "nearest robot"),
                (&mut layers.visited, "visited"),
                (&mut layers.search, "search"),
                (&mut layers.votes, "votes"),
                (&mut layers.radio, "radio"),
            ] {
                ui.checkbox(shows, name);
            }
        });
        if self.layers.votes {
            let hint = "Of the selected robot's looks, as it knows the map. As letters: for a wall; \
                        blue: against one.";
            ui.label(RichText::new(hint).weak());
        }
        if self.layers.radio {
            let hint = "Arrow: heard; cross: lost; square: under way. With a crowd, \
                        select a robot.";
            ui.label(RichText::new(hint).weak());
        }
    }

    fn exports(&mut self, ui: &mut Ui) {
        let Some(run) = self.runs.first() else { return };
        let name = file_name(run.watch.scenario().world.name());
        let mut done = None;
        ui.horizontal_wrapped(|ui| {
            if ui.button("PNG").clicked() {
                let png = export::png(&run.watch);
                done = Some(png.and_then(|png| save(&format!("{name}.png"), &png)));
            }
            if ui.button("GIF").clicked() {
                let gif = export::gif(&run.watch.trace());
                done = Some(gif.and_then(|gif| save(&format!("{name}.gif"), &gif)));
            }
            if ui.button("Trace").clicked() {
                let trace = export::trace(&run.watch.trace());
                done = Some(trace.and_then(|trace| save(&format!("{name}-trace.csv"), &trace)));
            }
            if ui.button("Map").clicked() {
                let text = run.watch.scenario().world.to_text();
                let file = run.setup.map.file();
                let file = file.file_stem().unwrap_or_default().to_string_lossy();
                done = Some(save(&format!("{file}.txt"), text.as_bytes()));
            }
        });
        let is_replay = run.watch.is_replay();
        ui.horizontal_wrapped(|ui| {
            if ui
                .button("Copy command")
                .on_hover_text(self.setup.command())
                .clicked()
            {
                ui.ctx().copy_text(self.setup.command());
                done = Some(Ok(match self.setup.map {
                    Map::Given(_) => "copied; save the map (button Map) beside it".to_owned(),
                    _ => "copied".to_owned(),
                }));
            }
            if ui.button("Copy address").clicked() {
                ui.ctx().copy_text(format!("#{}", self.setup.address()));
                done = Some(Ok(ADDRESS_COPIED.to_owned()));
            }
            if ui
                .add_enabled(is_replay, Button::new("Run again"))
                .clicked()
            {
                self.set(self.setup.clone());
            }
        });
        if let Some(done) = done {
            self.say(done);
        }
        let digest = self.report().digest;
        if !digest.is_empty() {
            ui.label(format!("trace digest {digest}"));
        }
    }

    fn survey_menus(&mut self, ui: &mut Ui) {
        let Some(survey) = &mut self.survey else {
            return;
        };
        let mut setup = survey.setup.clone();
        title(ui, "Terrain");
        terrain(ui, &mut setup);
        files(ui, &self.inbox, &mut self.path);
        title(ui, "Drones");
        ui.add(Slider::new(&mut setup.robots, ROBOTS).text("drones"));
        if !setup.is_of_voxels() {
            choice(ui, "planner", &mut setup.planner, Planner::value_variants());
        }
        ui.add(Slider::new(&mut setup.range, RANGES).text("sensor range"));
        if !setup.is_of_voxels() {
            ui.add(Slider::new(&mut setup.min_altitude, ALTITUDES).text("least altitude"));
            ui.add(Slider::new(&mut setup.ceiling, CEILINGS).text("ceiling"));
        }
        ui.horizontal(|ui| {
            number(
                ui,
                "seed of the drones",
                DragValue::new(&mut setup.conditions.seed),
            );
        });
        title(ui, "Radio");
        medium(ui, &mut setup.conditions);
        title(ui, "View");
        let levels = survey.levels();
        let layers = &mut survey.layers;
        ui.checkbox(&mut layers.hidden, "ground that was not seen");
        match levels {
            None => {
                ui.checkbox(&mut layers.ceiling, "ceiling");
            }
            Some(levels) => {
                layers.levels = layers.levels.min(levels);
                ui.add(Slider::new(&mut layers.levels, 1..=levels).text("levels"));
            }
        }
        let changed = setup != survey.setup;
        title(ui, "Take away");
        let done = survey_exports(ui, survey);
        let again = survey.is_replay()
            && ui
                .add_enabled(survey.is_repeatable(), Button::new("Run again"))
                .clicked();
        if changed || again {
            let layers = survey.layers;
            self.fly(setup);
            if let Some(survey) = &mut self.survey {
                survey.layers = layers;
            }
        }
        if let Some(done) = done {
            self.say(done);
        }
    }
}

/// Buttons that take a survey away; says what was done.
fn survey_exports(ui: &mut Ui, survey: &SurveyScene) -> Option<Result<String, String>> {
    let name = file_name(survey.name());
    let mut done = None;
    ui.horizontal_wrapped(|ui| {
        if ui.button("PNG").clicked() {
            let png = survey.png();
            done = Some(png.and_then(|png| save(&format!("{name}.png"), &png)));
        }
        if ui.button("GIF").clicked() {
            let gif = survey.gif();
            done = Some(gif.and_then(|gif| save(&format!("{name}.gif"), &gif)));
        }
        if ui.button("Trace").clicked() {
            let csv = survey.file();
            done = Some(csv.and_then(|csv| save(&format!("{name}-trace.csv"), &csv)));
        }
    });
    ui.horizontal_wrapped(|ui| {
        let command = survey.setup.command();
        let hint = "this trace was flown with more than the menus can set";
        let button = ui.add_enabled(survey.is_repeatable(), Button::new("Copy command"));
        let button = button.on_disabled_hover_text(hint);
        if button.on_hover_text(&command).clicked() {
            ui.ctx().copy_text(command);
            done = Some(Ok("copied".to_owned()));
        }
        let button = ui.add_enabled(survey.is_repeatable(), Button::new("Copy address"));
        if button.on_disabled_hover_text(hint).clicked() {
            ui.ctx().copy_text(format!("#{}", survey.setup.address()));
            done = Some(Ok(ADDRESS_COPIED.to_owned()));
        }
    });
    if let Some(digest) = survey.digest() {
        ui.label(format!("trace digest {digest}"));
    }
    done
}

/// A way in for maps and traces.
fn files(ui: &mut Ui, inbox: &Inbox, path: &mut String) {
    ui.horizontal(|ui| {
        if cfg!(target_arch = "wasm32") {
            if ui.button("Open a file …").clicked() {
                choose_file("", inbox, ui.ctx());
            }
        } else {
            let edit = TextEdit::singleline(path).hint_text("path of a map or trace");
            let entered = ui.add(edit.desired_width(150.0)).lost_focus()
                && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if ui.button("Open").clicked() || entered {
                choose_file(path, inbox, ui.ctx());
            }
        }
    });
    ui.label(RichText::new("or drop a map or a trace here").weak());
}

/// A kind of place, drawn by a seed.
type Place = fn(u64) -> TerrainSource;

/// Which place, which seed, how large.
fn terrain(ui: &mut Ui, setup: &mut SurveySetup) {
    let mut seed = match setup.terrain {
        TerrainSource::Gaussian(seed) | TerrainSource::Urban(seed) | TerrainSource::Town(seed) => {
            seed
        }
        TerrainSource::File(_) => 0,
    };
    let places: [(Place, _); 3] = [
        (TerrainSource::Gaussian, "hills"),
        (TerrainSource::Urban, "town"),
        (TerrainSource::Town, "town with rooms"),
    ];
    let is_chosen =
        |place: fn(u64) -> TerrainSource| discriminant(&place(0)) == discriminant(&setup.terrain);
    let mut chosen = places.iter().position(|(place, _)| is_chosen(*place));
    ui.horizontal_wrapped(|ui| {
        for (index, (_, name)) in places.iter().enumerate() {
            ui.selectable_value(&mut chosen, Some(index), *name);
        }
    });
    ui.horizontal(|ui| number(ui, "seed", DragValue::new(&mut seed)));
    // A place out of a trace stays until another one is chosen.
    if let Some(index) = chosen {
        setup.terrain = places[index].0(seed);
    }
    let sizes = setup.sizes();
    setup.size = setup.size.min(*sizes.end());
    ui.add(Slider::new(&mut setup.size, sizes).text("columns a side"));
}

fn title(ui: &mut Ui, text: &str) {
    ui.add_space(6.0);
    ui.label(RichText::new(text).strong());
}

/// A number behind its name.
fn number(ui: &mut Ui, name: &str, value: DragValue<'_>) {
    let label = ui.label(name);
    ui.add(value).labelled_by(label.id);
}

fn choice<T: ValueEnum + PartialEq + Copy + ToString>(
    ui: &mut Ui,
    name: &str,
    value: &mut T,
    all: &[T],
) {
    ComboBox::from_label(name)
        .selected_text(value.to_string())
        .show_ui(ui, |ui| {
            for &other in all {
                ui.selectable_value(value, other, other.to_string());
            }
        });
}

fn robots(ui: &mut Ui, setup: &mut Setup) {
    let before = setup.robots;
    ui.add(
        Slider::new(&mut setup.robots, 1..=255)
            .logarithmic(true)
            .text("robots"),
    );
    if setup.robots < before {
        let left = setup.robots;
        let faults = &mut setup.conditions.faults;
        faults.deaths.retain(|death| death.robot.0 < left);
        faults.arrivals.retain(|arrival| arrival.robot.0 < left);
        faults.restarts.retain(|restart| restart.robot.0 < left);
        faults.resumes.retain(|resume| resume.robot.0 < left);
        faults
            .sensor_failures
            .retain(|failure| failure.robot.0 < left);
        faults.lost_poses.retain(|lost| lost.robot.0 < left);
    }
    let name = match &setup.starts {
        None => "as the map says",
        Some(Starts::Center) => "centre",
        Some(Starts::Corner) => "corner",
        Some(Starts::Random(_)) => "random",
        Some(Starts::Spread(_)) => "far apart",
        Some(Starts::At(_)) => "placed by hand",
    };
    ComboBox::from_label("start")
        .selected_text(name)
        .show_ui(ui, |ui| {
            for (starts, name) in [
                (None, "as the map says"),
                (Some(Starts::Center), "centre"),
                (Some(Starts::Corner), "corner"),
                (Some(Starts::Random(setup.conditions.seed)), "random"),
                (Some(Starts::Spread(setup.conditions.seed)), "far apart"),
            ] {
                ui.selectable_value(&mut setup.starts, starts, name);
            }
        });
    let longest = match setup.planner.sees_far() {
        true => MAX_LONG_RADIUS,
        false => MAX_RADIUS,
    };
    ui.add(Slider::new(&mut setup.range, 1..=longest).text("sensor range"));
    if setup.planner.turns_sensor() {
        ui.add(Slider::new(&mut setup.fov, 1..=ALL_AROUND).text("field of view"));
    }
    if setup.planner.has_body() {
        ui.add(Slider::new(&mut setup.clearance, 0..=MAX_CLEARANCE).text("clearance"));
    }
    ui.checkbox(&mut setup.solid, "a cell holds one robot");
    ui.horizontal(|ui| {
        number(
            ui,
            "seed of the run",
            DragValue::new(&mut setup.conditions.seed),
        );
    });
    if let Some(Starts::Random(seed) | Starts::Spread(seed)) = &mut setup.starts {
        *seed = setup.conditions.seed;
    }
    let faults = &mut setup.conditions.faults;
    if !faults.deaths.is_empty() || !faults.arrivals.is_empty() {
        let (deaths, arrivals) = (faults.deaths.len(), faults.arrivals.len());
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("{deaths} killed, {arrivals} added on the way"));
            if ui.button("Revive").clicked() {
                faults.deaths.clear();
                faults.arrivals.clear();
            }
        });
    }
    let others = Faults {
        deaths: Vec::new(),
        arrivals: Vec::new(),
        ..faults.clone()
    };
    if others != Faults::default() {
        ui.horizontal_wrapped(|ui| {
            ui.label(in_words(&others));
            if ui.button("Without them").clicked() {
                *faults = Faults {
                    deaths: std::mem::take(&mut faults.deaths),
                    arrivals: std::mem::take(&mut faults.arrivals),
                    ..Faults::default()
                };
            }
        });
    }
}

/// The faults that no button sets, as many as there are of each kind.
fn in_words(faults: &Faults) -> String {
    let counts = [
        (faults.restarts.len(), "restarted"),
        (faults.resumes.len(), "told to go on"),
        (faults.closures.len(), "cells closed"),
        (faults.shut.len(), "cells shut"),
        (faults.blind.len(), "cells that no look shows"),
        (faults.sensor_failures.len(), "sensors fail"),
        (faults.lost_poses.len(), "poses lost"),
    ];
    let some = counts.iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = some.map(|(count, of)| format!("{count} {of}")).collect();
    words.join(", ")
}

/// Looks that err, poses that slip, people and doors.
fn trouble(ui: &mut Ui, trouble: &mut Trouble) {
    let share = |value| {
        let slider = Slider::new(value, 0.0..=1.0).logarithmic(true);
        slider.smallest_positive(0.001).max_decimals(3)
    };
    ui.add(share(&mut trouble.false_walls).text("false walls"));
    ui.add(share(&mut trouble.false_frees).text("false free cells"));
    choice(
        ui,
        "errors",
        &mut trouble.error_kind,
        ErrorKind::value_variants(),
    );
    ui.add(share(&mut trouble.misplaced).text("misplaced looks"));
    ui.add(Slider::new(&mut trouble.drift, 0..=500).text("drift every (0: never)"));
    ui.add(Slider::new(&mut trouble.people, 0..=20).text("people"));
    ui.add(Slider::new(&mut trouble.doors, 0..=20).text("doors"));
    ui.add(Slider::new(&mut trouble.looks, 1..=16).text("looks a tick"));
    ui.checkbox(&mut trouble.see_robots, "robots see each other");
    if !trouble.is_none() && ui.button("Without all that").clicked() {
        *trouble = Trouble::default();
    }
}

/// What carries messages, and how many are lost.
fn medium(ui: &mut Ui, conditions: &mut Conditions) {
    let was_radio = conditions.medium == MediumKind::Radio;
    let all = MediumKind::value_variants();
    choice(ui, "medium", &mut conditions.medium, all);
    if was_radio && conditions.medium == MediumKind::Ideal {
        *conditions = conditions.clone().without_frames();
    }
    let loss = Slider::new(&mut conditions.loss, 0.0..=1.0);
    ui.add(loss.max_decimals(2).text("loss"));
}

fn radio(ui: &mut Ui, conditions: &mut Conditions) {
    medium(ui, conditions);
    ui.add(Slider::new(&mut conditions.sync, 0..=50).text("sync every (0: never)"));
    let reach = &mut conditions.air.reach;
    let name = match reach {
        Reach::Everywhere => "everybody".to_owned(),
        Reach::LineOfSight => "in sight".to_owned(),
        Reach::Cells(cells) => format!("{cells} cells"),
    };
    ComboBox::from_label("hears")
        .selected_text(name)
        .show_ui(ui, |ui| {
            ui.selectable_value(reach, Reach::Everywhere, "everybody");
            ui.selectable_value(reach, Reach::LineOfSight, "in sight");
            let near = matches!(reach, Reach::Cells(_));
            if ui.selectable_label(near, "so many cells").clicked() && !near {
                *reach = Reach::Cells(15);
            }
        });
    if let Reach::Cells(cells) = reach {
        ui.add(Slider::new(cells, 1..=100).text("radio range"));
    }
    if conditions.medium == MediumKind::Radio {
        ui.add(Slider::new(&mut conditions.byte_budget, 1..=500).text("bytes/tick"));
        ui.add(Slider::new(&mut conditions.air.delay, 0..=20).text("ticks late at most"));
    }
}
