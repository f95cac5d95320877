//! A view of the map: the ground as a texture, robots and marks above it, and what the
//! pointer does to it.

use egui::epaint::{RectShape, StrokeKind};
use egui::{
    Align2, Color32, ColorImage, FontId, Pos2, Rect, Response, Sense, Shape, Stroke, TextureHandle,
    TextureOptions, Ui, Vec2, pos2, vec2,
};
use host_sim::medium::{Fate, Message};
use host_sim::run::Stepping;
use host_sim::sensor::ALL_AROUND;
use planner_core::{Cell, Extent, RobotId};

use crate::colors::{Colors, mix};
use crate::ground::{self, Layers, Subject};
use crate::playback::Playback;
use crate::watch::{Obstruction, Watch};

/// More messages than this are drawn only for a selected robot.
pub const MOST_MESSAGES: usize = 1000;

/// What the pointer does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects robots; moves and zooms the view.
    #[default]
    Look,
    /// Draws walls.
    Wall,
    /// Erases walls.
    Erase,
    /// Places starts, and drags robots to where they start; in a running exploration,
    /// a robot is added.
    Place,
    /// Kills the robot that is clicked.
    Kill,
    /// Shuts the cell that is clicked, or opens it again.
    Shut,
}

impl Tool {
    /// All of them, with their names and keys.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Look, "look"),
        (Self::Wall, "draw walls"),
        (Self::Erase, "erase walls"),
        (Self::Place, "place robots"),
        (Self::Kill, "kill robots"),
        (Self::Shut, "shut cells"),
    ];
}

/// What the pointer did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// Clicked a robot, or none.
    Selected(Option<usize>),
    /// Draws or erases over this cell.
    Painted(Cell),
    /// Clicked this cell to place a robot.
    Placed(Cell),
    /// Dragged the robot there.
    Dragged(usize, Cell),
    /// Clicked this robot to kill it.
    Killed(usize),
    /// Clicked this cell to shut it, or to open it.
    Shut(Cell),
}

/// Which part of the map is looked at; the same in all views of one world.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// How much larger than fitting.
    pub zoom: f32,
    /// The point of the map in the middle, from 0 to 1 in each direction.
    pub centre: Pos2,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            zoom: 1.0,
            centre: pos2(0.5, 0.5),
        }
    }
}

/// One view with its texture.
#[derive(Default)]
pub struct View {
    texture: Option<TextureHandle>,
    /// What the texture shows.
    key: Option<Key>,
    /// The cells in their colours, without what moves over them.
    ground: ColorImage,
    /// The texture's pixels, and those before: no memory is taken for a tick.
    pixels: [ColorImage; 2],
    dragged: Option<usize>,
}

#[derive(Clone, PartialEq)]
struct Key {
    run: usize,
    shown: u32,
    has_state: bool,
    subject: Subject,
    layers: Layers,
    colors: Colors,
    /// Whose way is not dim, if the texture shows ways.
    ways: Option<Option<usize>>,
}

/// Below so many points a cell, ways and plans are pixels of the ground: thousands of
/// lines take longer, and could not be told apart.
const COARSE: f32 = 3.0;

/// Side of the squares, in cells, in which a texture is renewed.
const PATCH: usize = 32;

/// What is shown in a view.
pub struct Frame<'a> {
    /// The run.
    pub watch: &'a Watch,
    /// Differs from run to run.
    pub run: usize,
    /// Whose knowledge.
    pub subject: Subject,
    /// What is drawn.
    pub layers: &'a Layers,
    /// The robot that is looked at more closely.
    pub selected: Option<usize>,
    /// What the pointer does.
    pub tool: Tool,
}

impl View {
    /// Draws the view over all of the room that is left; says what the pointer did.
    pub fn show(&mut self, ui: &mut Ui, camera: &mut Camera, frame: &Frame<'_>) -> Option<Deed> {
        let colors = Colors::of(ui);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let extent = frame.watch.scenario().world.extent();
        let mut place = Place::new(rect, extent, camera);
        steer(ui, &response, camera, &place, frame.tool);
        place = Place::new(rect, extent, camera);

        self.paint_ground(ui, frame, &place, &colors);
        let painter = ui.painter_at(rect);
        if let Some(texture) = &self.texture {
            let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            painter.image(texture.id(), place.map(), uv, Color32::WHITE);
        }
        painter.extend(marks(frame, &place, &colors));
        painter.extend(sectors(frame, &place, &colors));
        painter.extend(obstructions(frame, &place, &colors));
        paint_robots(&painter, frame, &place, &colors);
        response.widget_info(|| {
            let about = format!("map, {} robots", frame.watch.scenario().starts.len());
            egui::WidgetInfo::labeled(egui::Role::Image, true, about)
        });
        self.deed(&response, &place, frame)
    }

    fn paint_ground(&mut self, ui: &Ui, frame: &Frame<'_>, place: &Place, colors: &Colors) {
        let &Frame {
            watch,
            subject,
            layers,
            ..
        } = frame;
        let key = Key {
            run: frame.run,
            shown: watch.shown(),
            has_state: watch.state().is_some(),
            subject,
            layers: *layers,
            colors: *colors,
            ways: place.is_coarse().then_some(frame.selected),
        };
        if self.key.as_ref() == Some(&key) {
            return;
        }
        let kept = self.key.as_ref().filter(|old| {
            let then = Key {
                shown: old.shown,
                has_state: old.has_state,
                ways: old.ways,
                ..key.clone()
            };
            **old == then
        });
        let is_renewed = kept.is_some_and(|old| {
            ground::update(&mut self.ground, old.shown, watch, subject, layers, colors)
        });
        if !is_renewed {
            self.ground = ground::image(watch, subject, layers, colors);
        }
        self.pixels.swap(0, 1);
        let [pixels, old] = &mut self.pixels;
        pixels.size = self.ground.size;
        pixels.pixels.clone_from(&self.ground.pixels);
        if place.is_coarse() {
            draw_ways(pixels, frame, colors);
        }
        match &mut self.texture {
            Some(texture) if old.size == pixels.size => renew(texture, old, pixels),
            Some(texture) => texture.set(pixels.clone(), TextureOptions::NEAREST),
            None => {
                let image = pixels.clone();
                let context = ui.ctx();
                self.texture = Some(context.load_texture("ground", image, TextureOptions::NEAREST));
            }
        }
        self.key = Some(key);
    }

    fn deed(&mut self, response: &Response, place: &Place, frame: &Frame<'_>) -> Option<Deed> {
        let at = response.interact_pointer_pos();
        let cell = at.and_then(|at| place.cell(at));
        let robot = at.and_then(|at| robot_at(frame.watch, place, at));
        match frame.tool {
            Tool::Look if response.clicked() => Some(Deed::Selected(robot)),
            Tool::Look => None,
            Tool::Wall | Tool::Erase => (response.dragged() || response.clicked())
                .then_some(cell?)
                .map(Deed::Painted),
            Tool::Kill => response.clicked().then_some(robot?).map(Deed::Killed),
            Tool::Shut => response.clicked().then_some(cell?).map(Deed::Shut),
            Tool::Place => {
                if response.drag_started() {
                    self.dragged = robot;
                }
                if response.drag_stopped()
                    && let Some(robot) = self.dragged.take()
                {
                    return Some(Deed::Dragged(robot, cell?));
                }
                response.clicked().then_some(cell?).map(Deed::Placed)
            }
        }
    }
}

/// Brings to the graphics card what differs.
fn renew(texture: &mut TextureHandle, old: &ColorImage, new: &ColorImage) {
    let [width, height] = new.size;
    for top in (0..height).step_by(PATCH) {
        for left in (0..width).step_by(PATCH) {
            let (right, bottom) = ((left + PATCH).min(width), (top + PATCH).min(height));
            let rows = || (top..bottom).map(|y| y * width + left..y * width + right);
            if rows().any(|row| old.pixels[row.clone()] != new.pixels[row]) {
                let pixels = rows().flat_map(|row| &new.pixels[row]).copied().collect();
                let patch = ColorImage::new([right - left, bottom - top], pixels);
                texture.set_partial([left, top], patch, TextureOptions::NEAREST);
            }
        }
    }
}

/// Ways and plans as pixels, those of the selected robot over all others.
fn draw_ways(image: &mut ColorImage, frame: &Frame<'_>, colors: &Colors) {
    let watch = frame.watch;
    let extent = watch.scenario().world.extent();
    // Fainter than the robots.
    let faint = |robot| mix(colors.free, robot_color(frame, colors, robot), 0.65);
    let faint: Vec<Color32> = (0..watch.scenario().starts.len()).map(faint).collect();
    let mut dot = |cell: Cell, robot: usize| {
        if extent.contains(cell) {
            let index = cell.y as usize * image.size[0] + cell.x as usize;
            image.pixels[index] = faint.get(robot).copied().unwrap_or(colors.ink);
        }
    };
    let is_selected = |robot: usize| frame.selected == Some(robot);
    if frame.subject == Subject::World {
        let records = match frame.layers.trail {
            0 => &[],
            trail => ground::trail_records(watch, trail),
        };
        for on_top in [false, true] {
            for record in records {
                let robot = usize::from(record.robot);
                if is_selected(robot) == on_top {
                    dot(record.at, robot);
                }
            }
        }
    } else if let (true, Some(state)) = (frame.layers.plans, watch.state()) {
        let positions = watch.positions();
        for on_top in [false, true] {
            for record in watch.last_records() {
                let robot = usize::from(record.robot);
                if let (Some(&at), true) = (positions.get(robot), is_selected(robot) == on_top) {
                    let mut cell = at;
                    for step in state.way(robot) {
                        cell = cell.step(step);
                        dot(cell, robot);
                    }
                }
            }
        }
    }
}

/// The colour of a robot's marks: dim if another one is looked at.
fn robot_color(frame: &Frame<'_>, colors: &Colors, robot: usize) -> Color32 {
    let color = colors.robot(robot);
    match frame.selected {
        Some(selected) if selected != robot => mix(colors.free, color, 0.4),
        _ => color,
    }
}

/// Moves and zooms.
fn steer(ui: &Ui, response: &Response, camera: &mut Camera, place: &Place, tool: Tool) {
    if tool == Tool::Look && response.dragged() {
        let moved = response.drag_delta() / place.map().size();
        camera.centre -= moved;
    }
    if let Some(pointer) = response.hover_pos() {
        let (pinch, wheel) = ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta().y));
        let factor = pinch * (wheel / 300.0).exp();
        let zoom = (camera.zoom * factor).clamp(1.0, 40.0);
        if zoom != camera.zoom {
            // The point under the pointer stays where it is.
            let point = (pointer - place.map().min) / place.map().size();
            let away = point - camera.centre.to_vec2();
            camera.centre += away * (1.0 - camera.zoom / zoom);
            camera.zoom = zoom;
        }
    }
    let most = 0.5 - 0.5 / camera.zoom;
    camera.centre = camera
        .centre
        .clamp(pos2(0.5 - most, 0.5 - most), pos2(0.5 + most, 0.5 + most));
}

/// Where the cells lie on the screen.
struct Place {
    /// The top left corner of the map.
    origin: Pos2,
    /// Points a cell.
    scale: f32,
    extent: Extent,
}

impl Place {
    fn new(rect: Rect, extent: Extent, camera: &Camera) -> Self {
        let size = vec2(extent.width.into(), extent.height.into());
        let fitting = (rect.width() / size.x).min(rect.height() / size.y);
        let scale = (fitting * camera.zoom).max(0.01);
        Self {
            origin: rect.center() - camera.centre.to_vec2() * size * scale,
            scale,
            extent,
        }
    }

    fn map(&self) -> Rect {
        let size = vec2(self.extent.width.into(), self.extent.height.into());
        Rect::from_min_size(self.origin, size * self.scale)
    }

    /// The middle of a cell.
    fn middle(&self, cell: Cell) -> Pos2 {
        self.origin + vec2(f32::from(cell.x) + 0.5, f32::from(cell.y) + 0.5) * self.scale
    }

    fn cell(&self, at: Pos2) -> Option<Cell> {
        let place = (at - self.origin) / self.scale;
        let cell = Cell::new(place.x.floor() as i16, place.y.floor() as i16);
        self.extent.contains(cell).then_some(cell)
    }

    /// Whether cells are too small for lines between them.
    fn is_coarse(&self) -> bool {
        self.scale < COARSE
    }

    /// Radius of a robot: large enough to be seen and hit on any map.
    fn robot(&self) -> f32 {
        (self.scale * 0.42).clamp(3.5, 14.0)
    }

    /// A little aside, so that the ways of several robots stay apart.
    fn lane(&self, robot: usize, robots: usize) -> Vec2 {
        let lanes = robots.min(7) as f32;
        let lane = (robot % 7) as f32 - (lanes - 1.0) / 2.0;
        Vec2::splat(lane / lanes * self.scale * 0.6)
    }
}

fn robot_at(watch: &Watch, place: &Place, at: Pos2) -> Option<usize> {
    let near = |cell: Cell| place.middle(cell).distance(at);
    let positions = watch.positions().into_iter().enumerate();
    let (robot, distance) = positions
        .map(|(robot, cell)| (robot, near(cell)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (distance <= place.robot() + 6.0).then_some(robot)
}

/// Ways, goals, plans and messages, over the ground.
fn marks(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let watch = frame.watch;
    let robots = watch.scenario().starts.len();
    let mut shapes = Vec::new();
    let color = |robot: usize| robot_color(frame, colors, robot);
    if frame.layers.trail > 0 && frame.subject == Subject::World && !place.is_coarse() {
        let width = (place.scale * 0.12).clamp(1.0, 2.5);
        for (robot, way) in ground::ways(watch, frame.layers.trail).iter().enumerate() {
            let lane = place.lane(robot, robots);
            let stroke = Stroke::new(width, color(robot));
            let way = way.iter().map(|&cell| place.middle(cell) + lane);
            shapes.extend(lines(way, stroke));
        }
    }
    let positions = watch.positions();
    if frame.subject != Subject::World {
        for record in watch.last_records() {
            let robot = usize::from(record.robot);
            let Some(&at) = positions.get(robot) else {
                continue;
            };
            let stroke = Stroke::new((place.scale * 0.15).clamp(1.2, 3.0), color(robot));
            let plans = frame.layers.plans && !place.is_coarse();
            if let (true, Some(state)) = (plans, watch.state()) {
                let mut cell = at;
                let mut way = vec![cell];
                for step in state.way(robot) {
                    cell = cell.step(step);
                    ground::extend(&mut way, cell);
                }
                let way = way.into_iter().map(|cell| place.middle(cell));
                shapes.extend(lines(way, stroke));
            }
            if let (true, Some(goal)) = (frame.layers.goals, record.goal) {
                let (middle, arm) = (place.middle(goal), place.robot() * 0.8);
                for arm in [vec2(arm, arm), vec2(arm, -arm)] {
                    shapes.push(Shape::line_segment([middle - arm, middle + arm], stroke));
                }
                if !frame.layers.plans || watch.state().is_none() {
                    let ends = [place.middle(at), middle];
                    shapes.extend(Shape::dashed_line(&ends, stroke, 4.0, 4.0));
                }
            }
        }
    }
    if let (true, Some(state)) = (frame.layers.radio, watch.state()) {
        shapes.extend(messages(frame, state, place, colors));
    }
    shapes
}

/// A way as lines, one as far as it does not turn back: there, egui would widen it.
pub(crate) fn lines(way: impl IntoIterator<Item = Pos2>, stroke: Stroke) -> Vec<Shape> {
    let mut lines = Vec::new();
    let mut points: Vec<Pos2> = Vec::new();
    for point in way {
        if let [.., a, b] = points[..]
            && (b - a).dot(point - b) < 0.0
        {
            lines.push(Shape::line(std::mem::replace(&mut points, vec![b]), stroke));
        }
        points.push(point);
    }
    lines.push(Shape::line(points, stroke));
    lines
}

/// What was said in the last tick. A message that was heard ends in an arrow, one that
/// was lost in a cross on the way, and one under way carries a square: nobody needs to
/// tell colours apart.
fn messages(frame: &Frame<'_>, state: &dyn Stepping, place: &Place, colors: &Colors) -> Vec<Shape> {
    let said = state.messages();
    let robots = frame.watch.scenario().starts.len();
    let concerns = |message: &Message| match frame.selected {
        Some(robot) => [message.from, message.to].contains(&RobotId(robot as u8)),
        None => said.len() <= MOST_MESSAGES,
    };
    let mut drawn = vec![false; robots * robots * 4];
    let mut shapes = Vec::new();
    for message in said.iter().filter(|message| concerns(message)) {
        let [from, to] = [message.from, message.to].map(|id| usize::from(id.0));
        // Several frames make one line.
        let index = (from * robots + to) * 4 + message.fate as usize;
        if std::mem::replace(&mut drawn[index], true) {
            continue;
        }
        let [from, to] = [from, to].map(|robot| state.robot(robot));
        if !from.alive || !to.alive || message.fate == Fate::OutOfReach {
            continue;
        }
        let [begin, end] = [from, to].map(|robot| place.middle(robot.position));
        let along = (end - begin).normalized();
        if along == Vec2::ZERO {
            continue;
        }
        // On the right, as on a road: the answer comes on the other side.
        let aside = vec2(-along.y, along.x) * 3.0;
        let gap = along * (place.robot() + 1.0);
        let (begin, end) = (begin + gap + aside, end - gap + aside);
        // Marks of both directions stay apart.
        let (lost, under_way) = (begin.lerp(end, 0.35), begin.lerp(end, 0.55));
        let quiet = Stroke::new(1.0, mix(colors.free, colors.ink, 0.55));
        let loud = Stroke::new(1.5, colors.lost);
        match message.fate {
            Fate::OutOfReach => {}
            Fate::Heard => {
                shapes.push(Shape::line_segment([begin, end], quiet));
                for side in [aside, -aside] {
                    let feather = end - along * 6.0 + side;
                    shapes.push(Shape::line_segment([feather, end], quiet));
                }
            }
            Fate::UnderWay => {
                shapes.extend(Shape::dotted_line(&[begin, end], quiet.color, 5.0, 1.0));
                let square = Rect::from_center_size(under_way, Vec2::splat(5.0));
                shapes.push(Shape::rect_filled(square, 0.0, quiet.color));
            }
            Fate::Lost => {
                shapes.extend(Shape::dashed_line(&[begin, lost], loud, 4.0, 4.0));
                for arm in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
                    shapes.push(Shape::line_segment([lost - arm, lost + arm], loud));
                }
            }
        }
    }
    shapes
}

/// What each robot's sensor looks at, if it does not look all around.
fn sectors(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let scenario = frame.watch.scenario();
    let Some(state) = frame.watch.state().filter(|_| scenario.fov < ALL_AROUND) else {
        return Vec::new();
    };
    let half = f32::from(scenario.fov).to_radians() / 2.0;
    let radius = f32::from(scenario.range) * place.scale;
    let sector = |robot: usize| {
        let seen = state.robot(robot);
        let (x, y) = seen.heading.delta();
        let ahead = vec2(x.into(), y.into()).angle();
        let middle = place.middle(seen.position);
        let arc = (-8..=8).map(|part| ahead + half * part as f32 / 8.0);
        let arc = arc.map(|angle| middle + Vec2::angled(angle) * radius);
        let edge = std::iter::once(middle).chain(arc).collect();
        let stroke = Stroke::new(1.0, robot_color(frame, colors, robot));
        (seen.alive && seen.is_there).then(|| Shape::closed_line(edge, stroke))
    };
    (0..scenario.starts.len()).filter_map(sector).collect()
}

/// People as diamonds, doors as squares: filled where they are shut.
fn obstructions(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let shape = |obstruction: &Obstruction| {
        let (cell, is_filled) = match *obstruction {
            Obstruction::Person(cell) | Obstruction::Shut(cell) => (cell, true),
            Obstruction::Open(cell) => (cell, false),
        };
        let (middle, half) = (place.middle(cell), (place.scale * 0.5).max(2.5));
        let fill = if is_filled {
            colors.lost
        } else {
            Color32::TRANSPARENT
        };
        let edge = Stroke::new(1.5, colors.lost);
        match obstruction {
            Obstruction::Person(_) => {
                let arms = [
                    vec2(half, 0.0),
                    vec2(0.0, half),
                    vec2(-half, 0.0),
                    vec2(0.0, -half),
                ];
                let corners = arms.map(|arm| middle + arm).to_vec();
                Shape::convex_polygon(corners, fill, edge)
            }
            Obstruction::Shut(_) | Obstruction::Open(_) => {
                let square = Rect::from_center_size(middle, Vec2::splat(2.0 * half - 1.5));
                Shape::Rect(RectShape::new(square, 0.0, fill, edge, StrokeKind::Inside))
            }
        }
    };
    frame.watch.obstructions().iter().map(shape).collect()
}

fn paint_robots(painter: &egui::Painter, frame: &Frame<'_>, place: &Place, colors: &Colors) {
    let radius = place.robot();
    let clearance = frame.watch.scenario().clearance;
    let state = frame.watch.state();
    let records = frame.watch.last_records();
    for (robot, cell) in frame.watch.positions().into_iter().enumerate() {
        let lives = match state {
            Some(state) => state.robot(robot).alive,
            None => {
                frame.watch.shown() == 0 || records.iter().any(|it| usize::from(it.robot) == robot)
            }
        };
        if state.is_some_and(|state| !state.robot(robot).is_there) {
            continue;
        }
        let middle = place.middle(cell);
        let color = colors.robot(robot);
        if clearance > 0 {
            let reach = place.scale * (f32::from(clearance) + 0.5);
            painter.circle(
                middle,
                reach,
                color.gamma_multiply(0.2),
                Stroke::new(1.0, color),
            );
        }
        if lives {
            // Two discs are two quads each; a disc with an edge is dozens of triangles.
            painter.circle_filled(middle, radius + 0.5, colors.ink);
            painter.circle_filled(middle, radius - 0.5, color);
        } else {
            painter.circle(middle, radius, colors.unknown, Stroke::new(2.0, color));
            let arm = vec2(radius, radius) * 0.6;
            let stroke = Stroke::new(2.0, colors.lost);
            painter.line_segment([middle - arm, middle + arm], stroke);
            painter.line_segment([middle - arm.rot90(), middle + arm.rot90()], stroke);
        }
        if frame.selected == Some(robot) {
            painter.circle_stroke(middle, radius + 4.0, Stroke::new(2.0, colors.ink));
        }
        if radius >= 6.0 && lives {
            let font = FontId::proportional(radius * 1.3);
            let text = if luminance(color) > 0.5 {
                Color32::BLACK
            } else {
                Color32::WHITE
            };
            painter.text(middle, Align2::CENTER_CENTER, robot, font, text);
        }
    }
}

fn luminance(color: Color32) -> f32 {
    let [red, green, blue, _] = color.to_array().map(f32::from);
    (0.299 * red + 0.587 * green + 0.114 * blue) / 255.0
}
