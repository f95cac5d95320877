//! 3-D surveys: what is known as blocks that are painted from back to front, drones above.

mod eye;
mod flight;
mod heights;
mod rival;
mod setup;
mod sight;
mod voxels;

use egui::{Pos2, Sense, Shape, Stroke, Ui};
use host_sim::draw::write_png;
use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;
use planner_core::{Point, RobotId};

use crate::colors::{Colors, mix};
use crate::playback::{Export, Playback, Series, Verdict};
use crate::view::{Deed, Tool, lines};
use eye::Eye;
use flight::{Cost, Flight};
use heights::Heights;
use voxels::Voxels;

pub use eye::{SHAPE, Turn};
pub use flight::{Drone, Layers};
pub use rival::Rival;
pub use setup::{ALTITUDES, CEILINGS, CLEARANCES, RANGES, ROBOTS, SurveySetup};

/// How near to a drone a click means it, in points.
const NEAR: f32 = 14.0;

/// A survey on the screen.
pub struct SurveyScene {
    /// What was set for it; of a trace, as far as the menus reach.
    pub setup: SurveySetup,
    flight: Box<dyn Flight>,
    /// Whether it is a trace that was opened.
    is_replay: bool,
    /// Whether the setup gives the same survey.
    is_repeatable: bool,
    is_over: bool,
    digest: Option<String>,
    /// Whose state is drawn: that after so many steps.
    shown: usize,
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
            flight,
            is_replay: false,
            is_repeatable: true,
            is_over: false,
            digest: None,
            shown: 0,
        }
    }

    fn run_on(&mut self) {
        self.is_over = !self.flight.step();
        if self.is_over {
            self.digest = Some(self.flight.digest());
        }
    }

    /// Whether the setup gives the same survey, as it may not with a trace that was opened.
    pub fn is_repeatable(&self) -> bool {
        self.is_repeatable
    }

    /// Levels of voxels, if it is made of them.
    pub fn levels(&self) -> Option<u8> {
        self.flight.levels()
    }

    /// Of the steps done: what is decided after the last look is not flown yet.
    fn costs(&self) -> impl Iterator<Item = Cost> {
        let steps = self.ticks() as usize;
        self.flight.costs().into_iter().take(steps)
    }

    fn percent(&self, seen: u32) -> f64 {
        100.0 * f64::from(seen) / f64::from(self.flight.all())
    }

    /// What should never happen, in words, and how many flights did it.
    pub fn violations(&self) -> (&'static str, u32) {
        self.flight.violations()
    }

    /// What befell drones that did nothing wrong, in sentences.
    pub fn mishaps(&self) -> Vec<String> {
        self.flight.mishaps()
    }

    /// What a drone does at the shown step, row by row, and whether it is alive and whether
    /// it has stopped.
    pub fn drone(&self, drone: usize) -> Drone {
        self.flight.drone(drone, self.shown())
    }

    /// Draws the scene over the room that is left; dragging turns it, the wheel zooms. Says
    /// what a click did.
    pub fn view(
        &self,
        ui: &mut Ui,
        turn: &mut Turn,
        layers: &Layers,
        selected: Option<usize>,
        tool: Tool,
    ) -> Option<Deed> {
        let colors = Colors::of(ui);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let drag = response.drag_delta();
        turn.about += drag.x * 0.008;
        turn.down = (turn.down + drag.y * 0.006).clamp(0.15, 1.5);
        if response.hovered() {
            let (pinch, wheel) =
                ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta().y));
            turn.zoom = (turn.zoom * pinch * (wheel / 300.0).exp()).clamp(0.5, 12.0);
        }
        let eye = Eye::new(
            self.flight.extent(),
            self.flight.is_northward(),
            *turn,
            rect,
        );
        let painter = ui.painter_at(rect);
        painter.add(self.flight.ground(self.shown, &eye, layers, &colors));
        if layers.ceiling && self.levels().is_none() {
            painter.add(self.ceiling(&eye, &colors));
        }
        if layers.sensor {
            painter.extend(self.sensors(&eye, &colors, selected));
        }
        painter.extend(self.drones(&eye, &colors, selected));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "terrain"));
        let at = response.clicked().then(|| response.interact_pointer_pos());
        let drone = self.drone_at(&eye, at.flatten()?);
        match tool {
            Tool::Kill => drone.map(Deed::Killed),
            _ => Some(Deed::Selected(drone)),
        }
    }

    /// The drone that is drawn nearest to a point of the screen, if any is near.
    fn drone_at(&self, eye: &Eye, at: Pos2) -> Option<usize> {
        let ways = self.flight.ways(self.shown);
        let places = ways.iter().filter_map(|way| way.last()).enumerate();
        let away = |&(_, place): &(usize, &Point)| eye.over(*place).distance(at);
        let nearest = places.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        (away(&nearest) <= NEAR).then_some(nearest.0)
    }

    fn ceiling(&self, eye: &Eye, colors: &Colors) -> Shape {
        let extent = self.flight.extent();
        let (width, height) = (f32::from(extent.width), f32::from(extent.height));
        let z = self.setup.ceiling;
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let corners = corners.map(|(x, y)| eye.project(x, y, z)).to_vec();
        Shape::closed_line(corners, Stroke::new(1.5, colors.lost))
    }

    /// What the selected drone's sensor has in its field; faintly, what all have.
    fn sensors(&self, eye: &Eye, colors: &Colors, selected: Option<usize>) -> Vec<Shape> {
        let (ways, headings) = (
            self.flight.ways(self.shown),
            self.flight.headings(self.shown),
        );
        let (sight, faults) = (self.flight.sight(), &self.setup.conditions.faults);
        let is_meant = |drone: usize| {
            let id = RobotId(drone.min(255) as u8);
            selected.is_none_or(|selected| selected == drone) && faults.is_alive(id, self.shown())
        };
        let strength = if selected.is_some() { 0.9 } else { 0.4 };
        let mut shapes = Vec::new();
        for (drone, way) in ways
            .iter()
            .enumerate()
            .filter(|&(drone, _)| is_meant(drone))
        {
            let Some(&at) = way.last() else { continue };
            let heading = headings.get(drone).copied().unwrap_or_default();
            let color = colors.robot(drone).gamma_multiply(strength);
            shapes.extend(sight.outline(eye, (at, heading), color));
        }
        shapes
    }

    fn drones(&self, eye: &Eye, colors: &Colors, selected: Option<usize>) -> Vec<Shape> {
        let (ways, headings) = (
            self.flight.ways(self.shown),
            self.flight.headings(self.shown),
        );
        let mut shapes = Vec::new();
        let color = |robot| match selected {
            Some(selected) if selected != robot => mix(colors.free, colors.robot(robot), 0.4),
            _ => colors.robot(robot),
        };
        for (robot, way) in ways.iter().enumerate() {
            let stroke = Stroke::new(1.5, color(robot));
            shapes.extend(lines(way.iter().map(|&at| eye.over(at)), stroke));
        }
        for (robot, way) in ways.iter().enumerate() {
            let Some(&at) = way.last() else { continue };
            let middle = eye.over(at);
            let foot = eye.project(at.x, at.y, self.flight.beneath(at));
            let plumb = Stroke::new(1.0, mix(colors.free, colors.ink, 0.6));
            shapes.extend(Shape::dashed_line(&[middle, foot], plumb, 3.0, 3.0));
            if let Some(&heading) = headings.get(robot) {
                let edge = Stroke::new(1.0, colors.ink);
                shapes.push(sight::beak(eye, (at, heading), color(robot), edge));
            }
            shapes.push(Shape::circle_filled(middle, 6.0, colors.ink));
            shapes.push(Shape::circle_filled(middle, 5.0, color(robot)));
        }
        shapes
    }
}

impl Playback for SurveyScene {
    fn name(&self) -> &str {
        self.flight.name()
    }

    fn tick(&mut self) -> bool {
        if self.shown() == self.ticks() && !self.is_over {
            self.run_on();
        }
        let goes_on = self.shown() < self.ticks();
        self.shown += usize::from(goes_on);
        goes_on
    }

    fn shown(&self) -> u32 {
        self.shown as u32
    }

    fn ticks(&self) -> u32 {
        self.flight.seen().len() as u32 - 1
    }

    fn show(&mut self, tick: u32) {
        self.shown = tick.min(self.ticks()) as usize;
    }

    fn seen_percent(&self) -> f64 {
        let seen = self.flight.seen().get(self.shown);
        seen.map_or(0.0, |&seen| self.percent(seen))
    }

    fn title(&self) -> String {
        self.setup.title()
    }

    fn curve(&self, of: Series) -> Vec<[f64; 2]> {
        let steps = (0..).map(f64::from);
        match of {
            Series::Seen => {
                let seen = self.flight.seen().iter();
                let seen = seen.map(|&seen| self.percent(seen));
                steps.zip(seen).map(Into::into).collect()
            }
            Series::Work => {
                let work = self.costs().map(|cost| cost.work.into());
                steps.skip(1).zip(work).map(Into::into).collect()
            }
            Series::Bytes => {
                let sent = self.costs().scan(0, |sent, cost| {
                    *sent += cost.bytes;
                    Some(*sent as f64)
                });
                steps.skip(1).zip(sent).map(Into::into).collect()
            }
        }
    }

    fn verdict(&self) -> Verdict {
        match (self.is_over, self.flight.is_complete()) {
            (false, _) => Verdict::Running,
            (true, true) => Verdict::Complete,
            (true, false) => Verdict::Incomplete,
        }
    }

    fn is_replay(&self) -> bool {
        self.is_replay
    }

    fn digest(&self) -> Option<String> {
        self.digest.clone()
    }

    fn export(&self, what: Export) -> Result<(&'static str, Vec<u8>), String> {
        match what {
            Export::Picture => {
                let mut png = Vec::new();
                let picture = self.flight.picture(self.shown());
                write_png(&picture, &mut png).map_err(|error| error.to_string())?;
                Ok((".png", png))
            }
            Export::Animation => self.flight.animation().map(|gif| (".gif", gif)),
            Export::Trace => self.flight.file().map(|csv| ("-trace.csv", csv)),
            Export::Map => {
                let mut octree = Vec::new();
                let written = self.flight.octree(self.shown()).write(&mut octree);
                written.map_err(|error| error.to_string())?;
                Ok((".bt", octree))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use host_sim::run::{heights, voxels};
    use host_sim::scenario::{Conditions, Preset};
    use host_sim::terrain::TerrainSource;

    use super::setup::tests::{all, blown, blown_about_rooms, filmed, misled, town, unusual};
    use super::*;

    fn flown(setup: SurveySetup) -> SurveyScene {
        let mut scene = SurveyScene::new(setup).unwrap();
        while scene.tick() {}
        scene
    }

    /// What is known to have been seen after the shown step.
    fn seen(scene: &SurveyScene) -> u32 {
        scene.flight.seen()[scene.shown]
    }

    #[test]
    fn a_survey_on_screen_is_the_survey_of_host_sim() {
        for setup in all() {
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
            assert_eq!(scene.digest(), Some(digest));
            assert_eq!(scene.seen_percent(), 100.0);
            assert_eq!(scene.verdict(), Verdict::Complete);
        }
    }

    #[test]
    fn every_step_can_be_gone_back_to() {
        for setup in [unusual(), filmed()] {
            let mut scene = flown(setup.clone());
            let mut ahead = SurveyScene::new(setup).unwrap();
            for step in 0..scene.ticks() {
                scene.show(step);
                assert_eq!(ahead.shown(), step);
                assert_eq!(seen(&scene), seen(&ahead));
                let steps = step as usize;
                assert_eq!(scene.flight.ways(steps), ahead.flight.ways(steps));
                let headings = ahead.flight.headings(steps);
                assert_eq!(scene.flight.headings(steps), headings);
                let drones = usize::from(scene.setup.robots);
                let is_turned = scene.flight.sight().field.side.is_some();
                assert_eq!(headings.len(), if is_turned { drones } else { 0 });
                assert!(ahead.tick());
            }
            assert!(!ahead.tick());
        }
    }

    #[test]
    fn a_saved_trace_shows_what_was_flown() {
        for setup in all() {
            let flown = flown(setup.clone());
            let (_, file) = flown.export(Export::Trace).unwrap();
            let mut replay = match setup.terrain {
                TerrainSource::Town(_) => {
                    SurveyScene::replay_voxels(VoxelTrace::read(&*file).unwrap())
                }
                _ => SurveyScene::replay(Trace::read(&*file).unwrap()),
            };
            assert_eq!((replay.shown(), replay.ticks()), (0, flown.ticks()));
            assert_eq!(replay.setup, setup);
            assert!(replay.is_replay() && replay.is_repeatable());
            assert_eq!(replay.verdict(), Verdict::Complete);
            assert_eq!(replay.digest(), flown.digest());
            assert_eq!(replay.violations(), flown.violations());
            if setup == setup.clone().without_errors() {
                assert_eq!(replay.mishaps(), flown.mishaps());
            }
            for (of, name) in Series::ALL {
                assert_eq!(replay.curve(of), flown.curve(of), "{name}");
            }
            while replay.tick() {}
            assert_eq!(replay.shown(), flown.ticks());
            let last = flown.ticks() as usize;
            assert_eq!(replay.flight.ways(last), flown.flight.ways(last));
            assert_eq!(replay.flight.headings(last), flown.flight.headings(last));
            assert_eq!(replay.export(Export::Trace).unwrap().1, file);
        }
    }

    #[test]
    fn what_befell_the_drones_is_told() {
        let told = |setup: SurveySetup| flown(setup).mishaps().join(" ");
        assert_eq!(told(town()), "");
        assert!(told(blown()).contains("too near to another"));
        assert!(told(blown_about_rooms()).contains("beside or in something"));
        let truthful = SurveySetup {
            conditions: Conditions {
                preset: Preset::Truthful,
                ..misled().conditions
            },
            ..misled()
        };
        let (misled, deceived) = (told(misled()), told(truthful));
        assert!(misled.contains("steps ended at what was not seen. 0 drones say"));
        assert!(!deceived.contains(" 0 drones say"), "{deceived}");
    }

    /// The command says in a trace where the drones start in a town: where they would anyway.
    #[test]
    fn a_town_flown_by_the_command_is_flown_again() {
        let setup = filmed();
        let scene = setup.terrain.scene(setup.size).unwrap();
        let mut scenario = setup.voxel_scenario();
        scenario.start = scene.start(scenario.clearance);
        let trace = voxels::run(&scene, &scenario).unwrap();
        let digest = trace.digest();
        let replay = SurveyScene::replay_voxels(trace);
        assert_eq!(replay.setup, setup);
        assert!(replay.is_repeatable());
        assert_eq!(flown(setup).digest(), Some(digest));
    }
}
