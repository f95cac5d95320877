//! The plain data of the interface.

use planner_core::sight::Pose;
use planner_core::{Action, Direction, Stop};

/// What came of a call.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerResult {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    Null = 1,
    /// A pointer is not aligned to its type.
    Misaligned = 2,
    /// There is no planner in this memory; call `planner_create` first.
    NotCreated = 3,
    /// The grid is empty or larger than `PLANNER_MAX_CELLS`, or the robot starts
    /// outside of it.
    Extent = 4,
    /// The scan's pose or its largest range is not a usable number.
    Scan = 5,
    /// More values than a call takes.
    TooMany = 6,
    /// The motion is none of the constants.
    Motion = 7,
    /// The frame says nothing to this robot: damaged, its own, of another version
    /// or about another grid.
    Frame = 8,
}

/// One cell of the grid.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerCell {
    /// Column, growing to the east.
    pub x: i16,
    /// Row, growing to the south.
    pub y: i16,
}

/// How a planner is set up. All robots of a fleet agree on everything but the
/// id and the start.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerConfig {
    /// The robot's number; lower ones win ties.
    pub id: u8,
    /// Width of the grid, in cells.
    pub width: u16,
    /// Height of the grid, in cells.
    pub height: u16,
    /// Where the robot stands.
    pub start: PlannerCell,
    /// Side of a cell in millimetres.
    pub cell_mm: u16,
    /// Where cell 0,0 lies in the common frame, in millimetres.
    pub origin_x_mm: i32,
    /// The same along y.
    pub origin_y_mm: i32,
    /// Bytes that the robot may send a tick on average; 0: it only listens.
    pub bytes_per_tick: u16,
}

/// Where the robot is, in cells: the cell x,y covers x to x + 1 and y to y + 1.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerPose {
    /// Position along x, in cells.
    pub x: f32,
    /// Position along y, in cells.
    pub y: f32,
    /// Direction of bearing 0, in radians; grows from east to south.
    pub heading: f32,
}

/// One distance measured.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerBeam {
    /// Direction relative to the heading, in radians; grows from east to south.
    pub bearing: f32,
    /// Distance to what was hit, in cells; infinite: nothing; negative: no
    /// measurement.
    pub range: f32,
}

/// One cell that was seen.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerSeen {
    /// Which one.
    pub cell: PlannerCell,
    /// 0: it is free. Anything else: it is blocked.
    pub blocked: u8,
}

/// What the robot shall do.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerActionKind {
    /// Go to the neighbouring cell in `direction`, then call `planner_report`.
    Move = 0,
    /// Stand still for this tick.
    Wait = 1,
    /// Done, for the reason in `stop`. Final.
    Stop = 2,
}

/// One of the four steps.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerDirection {
    /// x + 1
    East = 0,
    /// y + 1
    South = 1,
    /// x - 1
    West = 2,
    /// y - 1
    North = 3,
}

/// Why the robot stopped.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerStop {
    /// It has not.
    None = 0,
    /// Every cell that can be reached is known.
    Complete = 1,
    /// The same; `frontiers` cells heard of from others lie behind walls.
    Enclosed = 2,
    /// Gave up: the way stayed blocked at `at`, `frontiers` cells are left.
    Blocked = 3,
    /// Every cell that can be reached within the map is known; the map ends at
    /// `frontiers` free cells, and the world may go on.
    AtEdge = 6,
    /// Every cell that can be reached is known; `frontiers` cells in sight lie where no
    /// way leads.
    OutOfReach = 7,
    /// Gave up: no look shows what is at `at`, `frontiers` cells are left.
    Unseen = 8,
    /// Gave up: a robot stayed in the way at `at`, `frontiers` cells are left.
    Held = 9,
}

/// What a tick decided.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerAction {
    /// What to do.
    pub kind: PlannerActionKind,
    /// Where to, for a move.
    pub direction: PlannerDirection,
    /// Why, for a stop.
    pub stop: PlannerStop,
    /// Frontier cells left, for a stop.
    pub frontiers: u32,
    /// The cell that could not be entered, for `PlannerStop::Blocked`.
    pub at: PlannerCell,
}

/// Enumerations take one byte in the ABI of bare Arm chips; the header checks the same.
#[cfg(all(target_arch = "arm", target_os = "none"))]
const _: () = assert!(size_of::<PlannerAction>() == 12 && size_of::<PlannerResult>() == 1);

impl From<&PlannerPose> for Pose {
    fn from(pose: &PlannerPose) -> Self {
        Self {
            x: pose.x,
            y: pose.y,
            heading: pose.heading,
        }
    }
}

impl From<Action> for PlannerAction {
    fn from(action: Action) -> Self {
        let mut told = Self {
            kind: PlannerActionKind::Wait,
            direction: PlannerDirection::East,
            stop: PlannerStop::None,
            frontiers: 0,
            at: PlannerCell { x: 0, y: 0 },
        };
        match action {
            Action::Wait => {}
            Action::Move(direction) => {
                told.kind = PlannerActionKind::Move;
                told.direction = match direction {
                    Direction::East => PlannerDirection::East,
                    Direction::South => PlannerDirection::South,
                    Direction::West => PlannerDirection::West,
                    Direction::North => PlannerDirection::North,
                };
            }
            Action::Stop(stop) => {
                told.kind = PlannerActionKind::Stop;
                told.frontiers = stop.left();
                if let Some(at) = stop.place() {
                    told.at = PlannerCell { x: at.x, y: at.y };
                }
                told.stop = match stop {
                    Stop::Complete => PlannerStop::Complete,
                    Stop::Enclosed { .. } => PlannerStop::Enclosed,
                    Stop::Blocked { .. } => PlannerStop::Blocked,
                    // Of another planner; told as what it is, a stop without completeness.
                    Stop::BackAtStart { .. } | Stop::NoTrace { .. } => PlannerStop::None,
                    Stop::AtEdge { .. } => PlannerStop::AtEdge,
                    Stop::OutOfReach { .. } => PlannerStop::OutOfReach,
                    Stop::Unseen { .. } => PlannerStop::Unseen,
                    Stop::Held { .. } => PlannerStop::Held,
                };
            }
        }
        told
    }
}
