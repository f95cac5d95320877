//! A view of the map: the ground as a texture, robots and marks above it, and what the
//! pointer does to it.

mod marks;
mod pixels;
mod place;

use egui::{Color32, ColorImage, Pos2, Rect, Response, Sense, TextureHandle, Ui, pos2};
use planner_core::Cell;

use crate::colors::Colors;
use crate::ground::{Layers, Subject};
use crate::watch::Watch;
use marks::{marks, obstructions, paint_robots, sectors};
use pixels::Key;
use place::{Place, robot_at, steer};

pub(crate) use marks::lines;
pub use place::Camera;

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
