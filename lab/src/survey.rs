//! 3-D surveys: terrain as blocks that are painted from back to front, drones above.

mod setup;

use std::sync::Arc;

use egui::{Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, vec2};
use host_sim::survey::{self, Stepping, Terrain, Trace};
use planner_core::{Cell, Point};

use crate::colors::{Colors, mix};

pub use setup::{ALTITUDES, CEILINGS, ROBOTS, SIZES, SurveySetup};

/// A survey on the screen.
pub struct SurveyScene {
    /// What was set for it.
    pub setup: SurveySetup,
    /// Whether the ground that nobody has seen is drawn, pale.
    pub shows_hidden: bool,
    /// Whether the greatest height is drawn.
    pub shows_ceiling: bool,
    terrain: Arc<Terrain>,
    run: Box<dyn Stepping>,
    /// Columns that have been seen, row by row: since which step, and how high.
    seen: Vec<Option<(usize, f32)>>,
    taken: usize,
    is_over: bool,
    digest: Option<String>,
    /// Whose state is drawn: that after so many steps.
    shown: usize,
    due: f32,
    turn: f32,
    tilt: f32,
    zoom: f32,
}

impl SurveyScene {
    /// A survey before its first step.
    ///
    /// # Errors
    /// What cannot be flown, in a sentence for the user.
    pub fn new(setup: SurveySetup) -> Result<Self, String> {
        let terrain = Arc::new(setup.terrain.load(setup.size)?);
        let run =
            survey::open(terrain.clone(), &setup.scenario()).map_err(|error| error.to_string())?;
        let mut scene = Self {
            seen: vec![None; terrain.extent().cells() as usize],
            setup,
            shows_hidden: true,
            shows_ceiling: false,
            terrain,
            run,
            taken: 0,
            is_over: false,
            digest: None,
            shown: 0,
            due: 0.0,
            turn: 0.7,
            tilt: 0.75,
            zoom: 1.0,
        };
        // The look before the first flight.
        scene.run_on();
        Ok(scene)
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
        self.is_over = !self.run.step();
        let width = usize::from(self.terrain.extent().width);
        let found = &self.run.trace().found;
        for (step, column) in &found[self.taken..] {
            let index = column.cell.y as usize * width + column.cell.x as usize;
            self.seen[index].get_or_insert((*step as usize, column.height.cells()));
        }
        self.taken = found.len();
        if self.is_over {
            self.digest = Some(self.run.trace().digest());
        }
    }

    /// Whether every drone has stopped, or time is up.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Whether every column was seen and every drone has stopped.
    pub fn is_complete(&self) -> bool {
        let trace = self.run.trace();
        self.is_over && trace.all_stopped && trace.complete()
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.run.trace().seen.len() - 1
    }

    /// The step that is shown: so many are done.
    pub fn shown(&self) -> usize {
        self.shown
    }

    /// Shows the state after so many steps.
    pub fn show_step(&mut self, step: usize) {
        self.shown = step.min(self.steps());
    }

    /// Share of the columns that have been seen after each step, in per cent.
    pub fn curve(&self) -> impl Iterator<Item = f64> + '_ {
        let all = f64::from(self.terrain.extent().cells());
        self.run
            .trace()
            .seen
            .iter()
            .map(move |&seen| 100.0 * f64::from(seen) / all)
    }

    /// Flights lower or higher than allowed, through the ground, or too near.
    pub fn violations(&self) -> u32 {
        let safety = self.run.trace().safety;
        safety.altitude_violations + safety.obstacle_violations + safety.separation_violations
    }

    /// The digest of the trace, when the survey is over.
    pub fn digest(&self) -> Option<&str> {
        self.digest.as_deref()
    }

    /// The run so far.
    pub fn trace(&self) -> &Trace {
        self.run.trace()
    }

    /// Draws the scene over the room that is left; dragging turns it, the wheel zooms.
    pub fn show(&mut self, ui: &mut Ui) {
        let colors = Colors::of(ui);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let drag = response.drag_delta();
        self.turn += drag.x * 0.008;
        self.tilt = (self.tilt + drag.y * 0.006).clamp(0.15, 1.5);
        if response.hovered() {
            let (pinch, wheel) =
                ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta().y));
            self.zoom = (self.zoom * pinch * (wheel / 300.0).exp()).clamp(0.5, 12.0);
        }
        let eye = Eye::new(self, rect);
        let painter = ui.painter_at(rect);
        painter.add(self.ground(&eye, &colors));
        if self.shows_ceiling {
            painter.add(self.ceiling(&eye, &colors));
        }
        painter.extend(self.drones(&eye, &colors));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "terrain"));
    }

    /// Every column as a block: its top and the sides that face the eye, far ones first.
    fn ground(&self, eye: &Eye, colors: &Colors) -> Shape {
        let extent = self.terrain.extent();
        let highest = self.terrain.highest().cells().max(1.0);
        let width = usize::from(extent.width);
        let mut mesh = egui::Mesh::default();
        let mut quad = |corners: [Pos2; 4], color: Color32| {
            let first = mesh.vertices.len() as u32;
            for corner in corners {
                mesh.colored_vertex(corner, color);
            }
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first, first + 2, first + 3);
        };
        let across: Vec<i16> = eye.far_to_near(extent.width, eye.east_is_near());
        let down: Vec<i16> = eye.far_to_near(extent.height, eye.south_is_near());
        for &y in &down {
            for &x in &across {
                let seen = self.seen[y as usize * width + x as usize];
                let (height, base) = match seen.filter(|(since, _)| *since <= self.shown) {
                    Some((_, height)) => (height, shade(height / highest, colors)),
                    None if self.shows_hidden => {
                        let height = self.terrain.height(Cell::new(x, y));
                        (height.map_or(0.0, |height| height.cells()), colors.unknown)
                    }
                    None => continue,
                };
                let (x, y) = (f32::from(x), f32::from(y));
                let top = |dx: f32, dy: f32| eye.project(x + dx, y + dy, height);
                let foot = |dx: f32, dy: f32| eye.project(x + dx, y + dy, 0.0);
                if height > 0.0 {
                    let east = if eye.east_is_near() { 1.0 } else { 0.0 };
                    let south = if eye.south_is_near() { 1.0 } else { 0.0 };
                    let side = [
                        top(east, 0.0),
                        top(east, 1.0),
                        foot(east, 1.0),
                        foot(east, 0.0),
                    ];
                    quad(side, mix(base, Color32::BLACK, 0.3));
                    let side = [
                        top(0.0, south),
                        top(1.0, south),
                        foot(1.0, south),
                        foot(0.0, south),
                    ];
                    quad(side, mix(base, Color32::BLACK, 0.45));
                }
                quad(
                    [top(0.0, 0.0), top(1.0, 0.0), top(1.0, 1.0), top(0.0, 1.0)],
                    base,
                );
            }
        }
        Shape::mesh(mesh)
    }

    fn ceiling(&self, eye: &Eye, colors: &Colors) -> Shape {
        let extent = self.terrain.extent();
        let (width, height) = (f32::from(extent.width), f32::from(extent.height));
        let z = self.setup.ceiling;
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let corners = corners.map(|(x, y)| eye.project(x, y, z)).to_vec();
        Shape::closed_line(corners, Stroke::new(1.5, colors.lost))
    }

    fn drones(&self, eye: &Eye, colors: &Colors) -> Vec<Shape> {
        let trace = self.run.trace();
        let mut ways: Vec<Vec<Pos2>> = vec![Vec::new(); trace.robots];
        let mut last = trace.starts.clone();
        for (way, &start) in ways.iter_mut().zip(&trace.starts) {
            way.push(eye.over(start));
        }
        let flown = |record: &survey::Record| (record.tick as usize) < self.shown;
        let done = trace.records.partition_point(flown);
        for record in &trace.records[..done] {
            let robot = usize::from(record.robot);
            ways[robot].push(eye.over(record.at));
            last[robot] = record.at;
        }
        let mut shapes = Vec::new();
        for (robot, way) in ways.into_iter().enumerate() {
            let stroke = Stroke::new(1.5, colors.robot(robot));
            shapes.push(Shape::line(way, stroke));
        }
        for (robot, &at) in last.iter().enumerate() {
            let middle = eye.over(at);
            let ground = self
                .terrain
                .height(at.cell())
                .map_or(0.0, |height| height.cells());
            let foot = eye.project(at.x, at.y, ground);
            let plumb = Stroke::new(1.0, mix(colors.free, colors.ink, 0.6));
            shapes.extend(Shape::dashed_line(&[middle, foot], plumb, 3.0, 3.0));
            shapes.push(Shape::circle_filled(middle, 6.0, colors.ink));
            shapes.push(Shape::circle_filled(middle, 5.0, colors.robot(robot)));
        }
        shapes
    }
}

/// From low to high in colours whose brightness rises with the height, so that they
/// need no hue.
fn shade(share: f32, colors: &Colors) -> Color32 {
    let (low, high) = match colors == &Colors::DARK {
        true => (
            Color32::from_rgb(40, 80, 100),
            Color32::from_rgb(250, 235, 190),
        ),
        false => (
            Color32::from_rgb(70, 110, 130),
            Color32::from_rgb(255, 242, 205),
        ),
    };
    mix(low, high, share.clamp(0.0, 1.0))
}

/// Where one looks from: turned about the middle of the terrain, without perspective.
struct Eye {
    middle: Vec2,
    centre: Pos2,
    sine: f32,
    cosine: f32,
    /// How steeply one looks down, as sine and cosine.
    down: f32,
    along: f32,
    scale: f32,
}

impl Eye {
    fn new(scene: &SurveyScene, rect: Rect) -> Self {
        let extent = scene.terrain.extent();
        let size = vec2(extent.width.into(), extent.height.into());
        let fitting = (rect.width() / (size.length())).min(rect.height() / (size.length() * 0.85));
        Self {
            middle: size / 2.0,
            centre: rect.center() + vec2(0.0, rect.height() * 0.05),
            sine: scene.turn.sin(),
            cosine: scene.turn.cos(),
            down: scene.tilt.sin(),
            along: scene.tilt.cos(),
            scale: fitting * scene.zoom,
        }
    }

    fn project(&self, x: f32, y: f32, z: f32) -> Pos2 {
        let (x, y) = (x - self.middle.x, y - self.middle.y);
        let right = x * self.cosine - y * self.sine;
        let near = x * self.sine + y * self.cosine;
        self.centre + vec2(right, near * self.down - z * self.along) * self.scale
    }

    fn over(&self, point: Point) -> Pos2 {
        self.project(point.x, point.y, point.z)
    }

    fn east_is_near(&self) -> bool {
        self.sine > 0.0
    }

    fn south_is_near(&self) -> bool {
        self.cosine > 0.0
    }

    fn far_to_near(&self, cells: u16, end_is_near: bool) -> Vec<i16> {
        let cells = 0..cells as i16;
        if end_is_near {
            cells.collect()
        } else {
            cells.rev().collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::setup::tests::unusual;
    use super::*;

    fn flown(setup: SurveySetup) -> SurveyScene {
        let mut scene = SurveyScene::new(setup).unwrap();
        while scene.step() {}
        scene
    }

    #[test]
    fn a_survey_on_screen_is_the_survey_of_host_sim() {
        let hills = SurveySetup {
            size: 24,
            ..SurveySetup::default()
        };
        for setup in [hills, unusual()] {
            let scene = flown(setup.clone());
            let terrain = setup.terrain.load(setup.size).unwrap();
            let trace = survey::run(&terrain, &setup.scenario()).unwrap();
            assert_eq!(scene.digest(), Some(&*trace.digest()));
            assert_eq!(scene.curve().last(), Some(100.0));
            assert!(scene.is_complete());
        }
    }

    #[test]
    fn every_step_can_be_gone_back_to() {
        let mut scene = flown(unusual());
        let mut ahead = SurveyScene::new(unusual()).unwrap();
        for step in 0..scene.steps() {
            scene.show_step(step);
            assert_eq!(ahead.shown(), step);
            let visible = |scene: &SurveyScene| {
                let seen = scene.seen.iter().flatten();
                seen.filter(|(since, _)| *since <= scene.shown).count()
            };
            assert_eq!(visible(&scene), visible(&ahead));
            let curve = ahead.trace().seen[step];
            assert_eq!(visible(&ahead), curve as usize);
            assert!(ahead.step());
        }
        assert!(!ahead.step());
    }
}
