//! What can be set of a survey: terrain, drones, radio, view.

use std::mem::discriminant;

use clap::ValueEnum;
use egui::{DragValue, RichText, Slider, Ui};
use host_sim::scenario::heights::Planner;
use host_sim::terrain::TerrainSource;

use super::parts::{choice, events, files, medium, number, title};
use crate::app::App;
use crate::survey::{ALTITUDES, CEILINGS, RANGES, ROBOTS, SurveySetup};
use crate::view::Tool;

impl App {
    pub(super) fn survey_menus(&mut self, ui: &mut Ui) {
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
        events(ui, &mut setup.conditions.faults);
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
        if setup != survey.setup {
            self.fly(setup);
        }
        title(ui, "Export");
        self.exports(ui);
    }
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
