//! What can be set of an exploration: map, robots, planner, radio, pointer, view.

use clap::ValueEnum;
use egui::{CollapsingHeader, ComboBox, DragValue, RichText, Slider, Ui};
use host_sim::planners::PlannerKind;
use host_sim::scenario::{Conditions, ErrorKind, Faults, MediumKind, Preset, Reach, Trouble};
use host_sim::sensor::ALL_AROUND;
use host_sim::world::{Family, Starts};
use planner_core::Extent;
use planner_core::explorer::MAX_CLEARANCE;
use planner_core::sight::{MAX_LONG_RADIUS, MAX_RADIUS};

use super::parts::{choice, events, files, medium, number, rival, share, title};
use crate::app::App;
use crate::ground::ALL_TICKS;
use crate::maps::Map;
use crate::setup::Setup;
use crate::view::Tool;

impl App {
    pub(super) fn menus(&mut self, ui: &mut Ui) {
        if self.survey().is_some() {
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
        rival(ui, &mut self.rival, PlannerKind::value_variants());
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
        title(ui, "Export");
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
    events(ui, &mut setup.conditions.faults);
}

/// Looks that err, poses that slip, people and doors.
fn trouble(ui: &mut Ui, trouble: &mut Trouble) {
    share(ui, "false walls", &mut trouble.false_walls);
    share(ui, "false free cells", &mut trouble.false_frees);
    choice(
        ui,
        "errors",
        &mut trouble.error_kind,
        ErrorKind::value_variants(),
    );
    share(ui, "misplaced looks", &mut trouble.misplaced);
    ui.add(Slider::new(&mut trouble.drift, 0..=500).text("drift every (0: never)"));
    ui.add(Slider::new(&mut trouble.people, 0..=20).text("people"));
    ui.add(Slider::new(&mut trouble.doors, 0..=20).text("doors"));
    ui.add(Slider::new(&mut trouble.looks, 1..=16).text("looks a tick"));
    ui.checkbox(&mut trouble.see_robots, "robots see each other");
    if !trouble.is_none() && ui.button("Without all that").clicked() {
        *trouble = Trouble::default();
    }
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
