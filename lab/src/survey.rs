//! 3-D surveys: what is known as blocks that are painted from back to front, drones above.

mod eye;
mod flight;
mod heights;
mod setup;
mod voxels;

use egui::{Sense, Shape, Stroke, Ui};
use host_sim::draw::write_png;
use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;

use crate::colors::{Colors, mix};
use crate::view::lines;
use eye::{Eye, Turn};
use flight::Flight;
use heights::Heights;
use voxels::Voxels;

pub use flight::Layers;
pub use setup::{ALTITUDES, CEILINGS, RANGES, ROBOTS, SurveySetup};

/// A survey on the screen.
pub struct SurveyScene {
    /// What was set for it; of a trace, as far as the menus reach.
    pub setup: SurveySetup,
    /// What is drawn.
    pub layers: Layers,
    flight: Box<dyn Flight>,
    /// Whether it is a trace that was opened.
    is_replay: bool,
    /// Whether the setup gives the same survey.
    is_repeatable: bool,
    is_over: bool,
    digest: Option<String>,
    /// Whose state is drawn: that after so many steps.
    shown: usize,
    due: f32,
    turn: Turn,
}

impl SurveyScene {
    /// A survey before its first step.
    ///
    /// # Errors
    /// What cannot be flown, in a sentence for the user.
    pub fn new(setup: SurveySetup) -> Result<Self, String> {
        let flight = flight::open(&setup)?;
        let mut scene = Self::with(setup, flight);
        // The look before the first flight.
        scene.run_on();
        Ok(scene)
    }

    /// A trace of a survey over heights, at its first step.
    pub fn replay(trace: Trace) -> Self {
        let setup = SurveySetup::of(&trace);
        Self {
            is_repeatable: setup.gives(&trace),
            ..Self::opened(setup, Box::new(Heights::opened(trace)))
        }
    }

    /// A trace of a survey among voxels, at its first step.
    pub fn replay_voxels(trace: VoxelTrace) -> Self {
        let setup = SurveySetup::of_voxels(&trace);
        Self {
            is_repeatable: setup.gives_voxels(&trace),
            ..Self::opened(setup, Box::new(Voxels::opened(trace)))
        }
    }

    fn opened(setup: SurveySetup, flight: Box<dyn Flight>) -> Self {
        Self {
            is_replay: true,
            is_over: true,
            digest: Some(flight.digest()),
            ..Self::with(setup, flight)
        }
    }

    fn with(setup: SurveySetup, flight: Box<dyn Flight>) -> Self {
        Self {
            setup,
            layers: Layers::default(),
            flight,
            is_replay: false,
            is_repeatable: true,
            is_over: false,
            digest: None,
            shown: 0,
            due: 0.0,
            turn: Turn {
                about: 0.7,
                down: 0.75,
                zoom: 1.0,
            },
        }
    }

    /// Lets time go by; false if there is nothing more to show.
    pub fn advance(&mut self, seconds: f32, speed: f32, has_time: impl Fn() -> bool) -> bool {
        self.due += speed * seconds;
        while self.due >= 1.0 {
            self.due -= 1.0;
            if !self.step() {
                self.due = 0.0;
                return false;
            }
            if !has_time() {
                self.due = 0.0;
            }
        }
        true
    }

    /// Shows the next step, and flies it if it was not flown yet; false if there is none.
    pub fn step(&mut self) -> bool {
        if self.shown == self.steps() && !self.is_over {
            self.run_on();
        }
        let goes_on = self.shown < self.steps();
        self.shown += usize::from(goes_on);
        goes_on
    }

    fn run_on(&mut self) {
        self.is_over = !self.flight.step();
        if self.is_over {
            self.digest = Some(self.flight.digest());
        }
    }

    /// Whether every drone has stopped, or time is up.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Whether it is a trace that was opened.
    pub fn is_replay(&self) -> bool {
        self.is_replay
    }

    /// Whether the setup gives the same survey, as it may not with a trace that was opened.
    pub fn is_repeatable(&self) -> bool {
        self.is_repeatable
    }

    /// Whether everything was seen and every drone has stopped.
    pub fn is_complete(&self) -> bool {
        self.is_over && self.flight.is_complete()
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.flight.seen().len() - 1
    }

    /// The step that is shown: so many are done.
    pub fn shown(&self) -> usize {
        self.shown
    }

    /// Shows the state after so many steps.
    pub fn show_step(&mut self, step: usize) {
        self.shown = step.min(self.steps());
    }

    /// The name of the place.
    pub fn name(&self) -> &str {
        self.flight.name()
    }

    /// Levels of voxels, if it is made of them.
    pub fn levels(&self) -> Option<u8> {
        self.flight.levels()
    }

    /// Share of what can be seen that has been seen after each step, in per cent.
    pub fn curve(&self) -> impl Iterator<Item = f64> + '_ {
        let all = f64::from(self.flight.all());
        let seen = self.flight.seen().iter();
        seen.map(move |&seen| 100.0 * f64::from(seen) / all)
    }

    /// What should never happen, in words, and how many flights did it.
    pub fn violations(&self) -> (&'static str, u32) {
        self.flight.violations()
    }

    /// The digest of the trace, when the survey is over.
    pub fn digest(&self) -> Option<&str> {
        self.digest.as_deref()
    }

    /// A picture of the shown step, as PNG.
    ///
    /// # Errors
    /// Those of the encoder.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let mut png = Vec::new();
        let picture = self.flight.picture(self.shown as u32);
        write_png(&picture, &mut png).map_err(|error| error.to_string())?;
        Ok(png)
    }

    /// The survey up to its last step as an animation.
    ///
    /// # Errors
    /// Those of the encoder.
    pub fn gif(&self) -> Result<Vec<u8>, String> {
        self.flight.animation()
    }

    /// The trace as host-sim writes it.
    ///
    /// # Errors
    /// None in memory.
    pub fn file(&self) -> Result<Vec<u8>, String> {
        self.flight.file()
    }

    /// Draws the scene over the room that is left; dragging turns it, the wheel zooms.
    pub fn show(&mut self, ui: &mut Ui) {
        let colors = Colors::of(ui);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let drag = response.drag_delta();
        let turn = &mut self.turn;
        turn.about += drag.x * 0.008;
        turn.down = (turn.down + drag.y * 0.006).clamp(0.15, 1.5);
        if response.hovered() {
            let (pinch, wheel) =
                ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta().y));
            turn.zoom = (turn.zoom * pinch * (wheel / 300.0).exp()).clamp(0.5, 12.0);
        }
        let eye = Eye::new(self.flight.extent(), *turn, rect);
        let painter = ui.painter_at(rect);
        painter.add(self.flight.ground(self.shown, &eye, &self.layers, &colors));
        if self.layers.ceiling && self.levels().is_none() {
            painter.add(self.ceiling(&eye, &colors));
        }
        painter.extend(self.drones(&eye, &colors));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "terrain"));
    }

    fn ceiling(&self, eye: &Eye, colors: &Colors) -> Shape {
        let extent = self.flight.extent();
        let (width, height) = (f32::from(extent.width), f32::from(extent.height));
        let z = self.setup.ceiling;
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let corners = corners.map(|(x, y)| eye.project(x, y, z)).to_vec();
        Shape::closed_line(corners, Stroke::new(1.5, colors.lost))
    }

    fn drones(&self, eye: &Eye, colors: &Colors) -> Vec<Shape> {
        let ways = self.flight.ways(self.shown);
        let mut shapes = Vec::new();
        for (robot, way) in ways.iter().enumerate() {
            let stroke = Stroke::new(1.5, colors.robot(robot));
            shapes.extend(lines(way.iter().map(|&at| eye.over(at)), stroke));
        }
        for (robot, way) in ways.iter().enumerate() {
            let Some(&at) = way.last() else { continue };
            let middle = eye.over(at);
            let foot = eye.project(at.x, at.y, self.flight.beneath(at));
            let plumb = Stroke::new(1.0, mix(colors.free, colors.ink, 0.6));
            shapes.extend(Shape::dashed_line(&[middle, foot], plumb, 3.0, 3.0));
            shapes.push(Shape::circle_filled(middle, 6.0, colors.ink));
            shapes.push(Shape::circle_filled(middle, 5.0, colors.robot(robot)));
        }
        shapes
    }
}

#[cfg(test)]
mod tests {
    use host_sim::run::{heights, voxels};
    use host_sim::terrain::TerrainSource;

    use super::setup::tests::{town, unusual};
    use super::*;

    fn flown(setup: SurveySetup) -> SurveyScene {
        let mut scene = SurveyScene::new(setup).unwrap();
        while scene.step() {}
        scene
    }

    /// What is known to have been seen after the shown step.
    fn seen(scene: &SurveyScene) -> u32 {
        scene.flight.seen()[scene.shown]
    }

    #[test]
    fn a_survey_on_screen_is_the_survey_of_host_sim() {
        let hills = SurveySetup {
            size: 24,
            ..SurveySetup::default()
        };
        for setup in [hills, unusual(), town()] {
            let scene = flown(setup.clone());
            let digest = match setup.terrain.scene(setup.size) {
                Some(scene) => voxels::run(&scene, &setup.voxel_scenario())
                    .unwrap()
                    .digest(),
                None => {
                    let terrain = setup.terrain.load(setup.size).unwrap();
                    heights::run(&terrain, &setup.scenario()).unwrap().digest()
                }
            };
            assert_eq!(scene.digest(), Some(&*digest));
            assert_eq!(scene.curve().last(), Some(100.0));
            assert!(scene.is_complete());
        }
    }

    #[test]
    fn every_step_can_be_gone_back_to() {
        for setup in [unusual(), town()] {
            let mut scene = flown(setup.clone());
            let mut ahead = SurveyScene::new(setup).unwrap();
            for step in 0..scene.steps() {
                scene.show_step(step);
                assert_eq!(ahead.shown(), step);
                assert_eq!(seen(&scene), seen(&ahead));
                assert_eq!(scene.flight.ways(step), ahead.flight.ways(step));
                assert!(ahead.step());
            }
            assert!(!ahead.step());
        }
    }

    #[test]
    fn a_saved_trace_shows_what_was_flown() {
        for setup in [unusual(), town()] {
            let flown = flown(setup.clone());
            let file = flown.file().unwrap();
            let mut replay = match setup.terrain {
                TerrainSource::Town(_) => {
                    SurveyScene::replay_voxels(VoxelTrace::read(&*file).unwrap())
                }
                _ => SurveyScene::replay(Trace::read(&*file).unwrap()),
            };
            assert_eq!((replay.shown(), replay.steps()), (0, flown.steps()));
            assert_eq!(replay.setup, setup);
            assert!(replay.is_replay() && replay.is_repeatable() && replay.is_complete());
            assert_eq!(replay.digest(), flown.digest());
            assert_eq!(replay.violations(), flown.violations());
            assert!(replay.curve().eq(flown.curve()));
            while replay.step() {}
            assert_eq!(replay.shown(), flown.steps());
            let last = flown.steps();
            assert_eq!(replay.flight.ways(last), flown.flight.ways(last));
            assert_eq!(replay.file().unwrap(), file);
        }
    }
}
