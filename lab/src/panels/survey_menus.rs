//! What can be set of a survey: terrain, drones, radio, view.

use std::mem::discriminant;

use clap::ValueEnum;
use egui::{CollapsingHeader, DragValue, RichText, Slider, SliderClamping, Ui};
use host_sim::scenario::heights::Planner;
use host_sim::scenario::{Conditions, Mission, Preset, Wind, voxels};
use host_sim::scene::{Fov, Sensor};
use host_sim::terrain::TerrainSource;

use super::parts::{choice, events, files, medium, number, rival, share, slider, title};
use crate::app::App;
use crate::survey::{ALTITUDES, CEILINGS, CLEARANCES, RANGES, ROBOTS, SurveySetup};
use crate::view::Tool;

impl App {
    pub(super) fn survey_menus(&mut self, ui: &mut Ui) {
        let Some(survey) = self.survey() else {
            return;
        };
        let levels = survey.levels();
        let before = (survey.setup.clone(), self.survey_rival);
        let mut setup = before.0.clone();
        title(ui, "Terrain");
        terrain(ui, &mut setup);
        files(ui, &self.inbox, &mut self.path);
        title(ui, "Drones");
        slider(ui, "drones", &mut setup.robots, ROBOTS);
        match setup.is_of_voxels() {
            true => {
                let all = voxels::Planner::value_variants();
                choice(ui, "planner", &mut setup.voxel_planner, all);
            }
            false => choice(ui, "planner", &mut setup.planner, Planner::value_variants()),
        }
        sensor(ui, &mut setup);
        slider(ui, "sensor range", &mut setup.range, RANGES);
        if setup.is_of_voxels() {
            slider(ui, "clearance", &mut setup.clearance, CLEARANCES);
        } else {
            slider(ui, "least altitude", &mut setup.min_altitude, ALTITUDES);
            slider(ui, "ceiling", &mut setup.ceiling, CEILINGS);
        }
        rival(ui, &mut self.survey_rival, &setup.rivals());
        ui.horizontal(|ui| {
            number(
                ui,
                "seed of the drones",
                DragValue::new(&mut setup.conditions.seed),
            );
        });
        if setup.has_mission() {
            mission(ui, &mut setup.conditions.mission);
        }
        wind(ui, &mut setup.conditions.wind);
        if setup.has_errors() {
            CollapsingHeader::new("Looks that err")
                .default_open(!setup.conditions.trouble.is_none())
                .show(ui, |ui| errors(ui, &mut setup.conditions));
        }
        events(ui, &mut setup.conditions.faults);
        title(ui, "Radio");
        medium(ui, &mut setup.conditions);
        title(ui, "View");
        let layers = &mut self.survey_layers;
        ui.checkbox(&mut layers.hidden, "ground that was not seen");
        ui.checkbox(&mut layers.sensor, "sensor");
        match levels {
            None => {
                ui.checkbox(&mut layers.ceiling, "ceiling");
            }
            Some(levels) => {
                layers.levels = layers.levels.min(levels);
                ui.add(Slider::new(&mut layers.levels, 1..=levels).text("levels"));
            }
        }
        title(ui, "Pointer");
        ui.horizontal_wrapped(|ui| {
            for (tool, name) in [(Tool::Look, "look"), (Tool::Kill, "kill drones")] {
                let is_chosen = (self.tool == Tool::Kill) == (tool == Tool::Kill);
                if ui.selectable_label(is_chosen, name).clicked() {
                    self.tool = tool;
                }
            }
        });
        let hint = match self.tool {
            Tool::Kill => "Click a drone: from this step on it is dead.",
            _ => "Click a drone; drag to turn, scroll to zoom.",
        };
        ui.label(RichText::new(hint).weak());
        let is_changed = (&setup, self.survey_rival) != (&before.0, before.1);
        if is_changed && !self.fly(setup.tidied()) {
            self.survey_rival = before.1;
        }
        title(ui, "Export");
        self.exports(ui);
    }
}

/// What the drones see, if there is a choice.
fn sensor(ui: &mut Ui, setup: &mut SurveySetup) {
    if !setup.has_sensors() {
        return;
    }
    choice(ui, "sensor", &mut setup.sensor, Sensor::value_variants());
    if setup.sensor == Sensor::Camera {
        let (mut width, mut height) = setup.fov.degrees();
        slider(ui, "degrees wide", &mut width, Fov::WIDTHS);
        slider(ui, "degrees high", &mut height, Fov::HEIGHTS);
        setup.fov = Fov::new(width, height).unwrap_or(setup.fov);
    }
}

/// Where the drones go in the end, and how long they can fly.
fn mission(ui: &mut Ui, mission: &mut Mission) {
    ui.checkbox(&mut mission.come_home, "come home in the end");
    let energy = Slider::new(&mut mission.energy, 0..=5000).logarithmic(true);
    let energy = energy
        .smallest_positive(10.0)
        .clamping(SliderClamping::Edits);
    ui.add(energy.text("energy (0: no limit)"));
}

/// How far off gusts blow the drones.
fn wind(ui: &mut Ui, wind: &mut Wind) {
    let deviation = Slider::new(&mut wind.deviation, 0.0..=1.0).max_decimals(2);
    ui.add(deviation.text("wind (cells a step)"));
}

/// How often looks at voxels are wrong, and what the drones expect.
fn errors(ui: &mut Ui, conditions: &mut Conditions) {
    let trouble = &mut conditions.trouble;
    share(ui, "false walls", &mut trouble.false_walls);
    share(ui, "false free voxels", &mut trouble.false_frees);
    let presets = [Preset::Truthful, Preset::Rangers];
    choice(ui, "sensor taken for", &mut conditions.preset, &presets);
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
    if setup.is_drawn() {
        slider(ui, "columns a side", &mut setup.size, sizes);
    }
}
