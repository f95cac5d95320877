//! The plain data of the interface.

use planner_core::explorer::{MoveError, SensorModel};
use planner_core::radio::FrameError;
use planner_core::sight::{Beam, Bearing, Pose};
use planner_core::{Action, Cell, Direction, Map, Reason, RestoreError, Wait};

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
    /// The grid or the box is empty or larger than the header's largest, or the robot starts
    /// off the grid; or a grid that moves would lie too far from the origin.
    Extent = 4,
    /// The scan's pose is not a number, its largest range is not a positive one, or its
    /// tolerance is not between 0 and 0.25.
    Scan = 5,
    /// More values than a call takes, or than there is room for.
    TooMany = 6,
    /// The motion is none of the constants.
    Motion = 7,
    // 8 was any frame that was not taken.
    /// `cell_mm` is 0.
    CellSize = 9,
    /// The cell that the robot is to go to lies off the grid, and nothing has changed. Or its
    /// own place does, so nothing was learnt: the planner decides nothing and waits, for
    /// `PLANNER_WAIT_POSE`, until a place lies on the grid again. Or the robot or its home
    /// would lie off a grid that is to move, and nothing has changed.
    OffGrid = 10,
    /// No frame has this length: cut short, or followed by something else.
    FrameLength = 11,
    /// The frame is written in another version of the format.
    FrameVersion = 12,
    /// The frame is of a kind that this planner does not read.
    FrameKind = 13,
    /// The frame's check bytes do not match: damaged, or not signed with the key.
    FrameCheck = 14,
    /// The sender's map is of another origin, cell size or extent.
    FrameOtherGrid = 15,
    /// The frame is the robot's own.
    FrameOwn = 16,
    /// A field of the frame holds what it cannot.
    FrameField = 17,
    /// Another robot has this robot's id: give each robot its own.
    FrameSameId = 18,
    /// The sensor or the field is none of the constants, or the margin is above 3.
    Sensor = 19,
    /// The memory is smaller than a planner of this library: the header was included for
    /// another size than the library was built for.
    Memory = 20,
    /// The clearance is above 3.
    Clearance = 21,
    /// The robot or its home lies in the cells that it is to keep out of, or its body would
    /// reach into them there. Or it keeps out of cells of a grid that is to move.
    KeptOut = 22,
    /// Nothing was saved there.
    NoSave = 23,
    /// The save is of another version of the library.
    SaveVersion = 24,
    /// The save is damaged or cut short.
    SaveDamaged = 25,
    /// The save is of a grid of another size, origin or size of cells.
    SaveOtherGrid = 26,
    /// The save is of a robot with another id.
    SaveOtherRobot = 27,
    /// The grid was moved 16 times since the robot stopped last.
    TooOften = 28,
    /// The range is not 2 to `PLANNER_VOXEL_MAX_RANGE`, or not more than the clearance.
    Range = 29,
    /// The heading is above 7.
    Heading = 30,
    /// The field of view of a sensor with zones is not above 0 and up to pi/2.
    ZoneFieldOfView = 31,
    /// Its pitch is not between -pi/4 and pi/4; among voxels, -pi/2 and pi/2.
    ZonePitch = 32,
    /// Its yaw is not finite.
    ZoneYaw = 33,
    /// Not `floor_mm` < `height_mm` < `top_mm`.
    ZoneHeights = 34,
    /// Its largest range or the side of a cell is 0.
    ZoneZero = 35,
}

impl From<MoveError> for PlannerResult {
    fn from(error: MoveError) -> Self {
        match error {
            MoveError::Robot(_) | MoveError::Home(_) => Self::OffGrid,
            MoveError::KeptOut => Self::KeptOut,
            MoveError::TooOften => Self::TooOften,
            MoveError::TooFar => Self::Extent,
        }
    }
}

impl From<RestoreError> for PlannerResult {
    fn from(error: RestoreError) -> Self {
        match error {
            RestoreError::Unable | RestoreError::NoSave => Self::NoSave,
            RestoreError::Version(_) => Self::SaveVersion,
            RestoreError::Damaged => Self::SaveDamaged,
            RestoreError::Grid(_) => Self::SaveOtherGrid,
            RestoreError::Robot(_) => Self::SaveOtherRobot,
        }
    }
}

impl From<FrameError> for PlannerResult {
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::Length(_) => Self::FrameLength,
            FrameError::Version(_) => Self::FrameVersion,
            FrameError::Kind(_) => Self::FrameKind,
            FrameError::Check => Self::FrameCheck,
            FrameError::OtherGrid(_) => Self::FrameOtherGrid,
            FrameError::Own => Self::FrameOwn,
            FrameError::SameId(_) => Self::FrameSameId,
            FrameError::Field(_) => Self::FrameField,
        }
    }
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

impl From<Cell> for PlannerCell {
    fn from(Cell { x, y }: Cell) -> Self {
        Self { x, y }
    }
}

/// What is known of a cell.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerState {
    /// Nothing.
    Unknown = 0,
    /// Free, and so are its neighbours, or known otherwise.
    Free = 1,
    /// Free, and beside a cell of which nothing is known.
    Frontier = 2,
    /// Seen blocked, but not often enough to believe it.
    Doubtful = 3,
    /// An obstacle.
    Obstacle = 4,
}

impl PlannerState {
    pub(crate) fn of<const TW: usize, const TH: usize>(map: &Map<TW, TH>, cell: Cell) -> Self {
        match () {
            () if map.is_doubtful(cell) => Self::Doubtful,
            () if !map.is_known(cell) => Self::Unknown,
            () if map.is_obstacle(cell) => Self::Obstacle,
            () if map.is_frontier(cell) => Self::Frontier,
            () => Self::Free,
        }
    }
}

/// Where a robot is, what it knows, and what it has from others. Counts begin when the
/// planner is created; those of 16 bits stay at their largest value.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerStatus {
    /// Where it stands.
    pub position: PlannerCell,
    /// Where it goes; where it stands, if it goes nowhere.
    pub goal: PlannerCell,
    /// Whether it goes somewhere: 0 or 1.
    pub has_goal: u8,
    /// Cells of the map that are known.
    pub known: u32,
    /// Those of them that are frontiers.
    pub frontiers: u32,
    /// Cells that others told before the robot saw them.
    pub heard_cells: u32,
    /// Cells that others told otherwise than the robot saw them. Where sensors are right
    /// and all robots have the same origin and axes: none. A robot that takes left for
    /// right shows here.
    pub contradictions: u16,
    /// The robot that told most of them; 255: nobody told more than half.
    pub contradicted_by: u8,
    /// Frames of another robot with this robot's id.
    pub same_id: u16,
    /// Frames that were damaged, or not signed with the key.
    pub refused: u16,
}

/// How a planner is set up. All robots of a fleet agree on everything but the
/// id, in which all differ, and the start.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerConfig {
    /// The robot's number, its own in the fleet; lower ones win ties.
    pub id: u8,
    /// Width of the grid, in cells.
    pub width: u16,
    /// Height of the grid, in cells.
    pub height: u16,
    /// Where the robot stands, on the grid.
    pub start: PlannerCell,
    /// Side of a cell in millimetres, above 0.
    pub cell_mm: u16,
    /// Where the grid's north-western corner, which is that of cell 0,0, lies in the
    /// common frame, in millimetres.
    pub origin_x_mm: i32,
    /// The same along y. For a square grid around the place where poses in metres begin:
    /// minus half of its side for x, plus half of it for y.
    pub origin_y_mm: i32,
    /// Bytes that the robot may send a tick on average; 0: it only listens, which
    /// `planner_is_mute` tells. Less than `PLANNER_MAX_FRAME`: a frame every few ticks.
    pub bytes_per_tick: u16,
    /// 0: frames are not signed, and only those without a signature are taken.
    /// Anything else: they are signed with `key`, and only those signed with it are
    /// taken. Without a key whoever is in reach of the radio can write into the map.
    pub is_keyed: u8,
    /// The fleet's secret.
    pub key: [u8; 16],
    /// How far looks are believed, one of [`PlannerSensor`].
    pub sensor: u8,
    /// Votes by which one side leads before a cell is decided, 1 to 3; 0: as the sensor
    /// has it.
    pub margin: u8,
    /// How far from the robot looks can make a cell a wall, in cells; 0: as the sensor has
    /// it. 2 for a sensor that sees things from afar that are not there.
    pub sure_range: u8,
    /// Ticks after which a robot that is done looks again at places that were free and are
    /// walls now, instead of stopping; 0: it stops.
    pub patrol_ticks: u16,
    /// Cells that the robot's body reaches beyond the one of its centre, in a disc: 0 to 3,
    /// the same for all robots. Looks have to show what is within `clearance` + 2 cells.
    pub clearance: u8,
    /// Not 0: a robot that has explored goes home, to where it started, before it stops.
    pub come_home: u8,
}

/// How far the looks of a sensor can be believed.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerSensor {
    /// A few range sensors, one look a step: three votes, each from another cell.
    Rangers = 0,
    /// A laser scanner, three looks or more a step: three votes.
    Lidar = 1,
    /// Never wrong: the first look decides. For simulations.
    Truthful = 2,
}

impl PlannerConfig {
    /// Where the grid lies, and the side of its cells.
    pub(crate) const fn grid(&self) -> Result<((i32, i32), u16), PlannerResult> {
        match self.cell_mm {
            0 => Err(PlannerResult::CellSize),
            cell_mm => Ok(((self.origin_x_mm, self.origin_y_mm), cell_mm)),
        }
    }

    /// The model of its sensor; `None` if there is no such one.
    pub(crate) fn sensor(&self) -> Option<SensorModel> {
        const RANGERS: u8 = PlannerSensor::Rangers as u8;
        const LIDAR: u8 = PlannerSensor::Lidar as u8;
        const TRUTHFUL: u8 = PlannerSensor::Truthful as u8;
        let mut model = match self.sensor {
            RANGERS => SensorModel::rangers(),
            LIDAR => SensorModel::lidar(),
            TRUTHFUL => SensorModel::truthful(),
            _ => return None,
        };
        if self.margin > 0 {
            model.margin = self.margin;
        }
        if self.sure_range > 0 {
            model.sure_range = self.sure_range;
        }
        (model.margin <= 3).then_some(model)
    }
}

/// Where the robot is, in cells: the cell x,y covers x to x + 1 and y to y + 1.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerPose {
    /// Position along x, in cells.
    pub x: f32,
    /// Position along y, in cells.
    pub y: f32,
    /// Direction of the bearing that is straight ahead, in radians; grows from east to
    /// south.
    pub heading: f32,
}

/// A direction relative to the heading, as a vector of length 1; `planner_bearing` makes
/// it of an angle. A beam whose vector is longer or shorter by 0.001 says nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerBearing {
    /// Its part along the heading: 1 is straight ahead.
    pub ahead: f32,
    /// Its part to the right of the heading.
    pub right: f32,
}

/// One distance measured.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerBeam {
    /// Where it pointed to.
    pub bearing: PlannerBearing,
    /// Distance to what was hit, in cells. Infinite, or not below `max_range`: nothing
    /// within reach, so what lies on the beam is free. Negative or not a number: no
    /// measurement, which says nothing about any cell. Never give one for the other.
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
    /// Stand still for this tick, for the reason in `wait`.
    Wait = 1,
    /// Done, for the reason in `stop`. Every later tick says the same, until
    /// `planner_resume`.
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

/// Why the robot stopped; `planner_stop_is_complete` tells whether it was done.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerStop {
    /// It has not.
    None = 0,
    /// Every cell that can be reached is known.
    Complete = 1,
    /// The same; no way leads to `frontiers` more frontiers, and part of the map was
    /// heard from others.
    Enclosed = 2,
    /// Gave up: the way stayed blocked at `at`, `frontiers` cells are left.
    Blocked = 3,
    /// Of another planner than this interface has: gave up back at the start.
    BackAtStart = 4,
    /// Of another planner than this interface has: gave up without a trace to follow.
    NoTrace = 5,
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
    /// Back where it started, as it was told or for its energy; `frontiers` cells are left.
    Home = 10,
    /// At the cell `at` that it was sent to; `frontiers` cells are left.
    Arrived = 11,
    /// Gave up: over cells that are known to be free no way leads to `at`, where it was to
    /// go; `frontiers` cells are left.
    NoWay = 12,
}

impl From<Reason> for PlannerStop {
    fn from(reason: Reason) -> Self {
        match reason {
            Reason::Complete => Self::Complete,
            Reason::Enclosed => Self::Enclosed,
            Reason::Blocked => Self::Blocked,
            Reason::BackAtStart => Self::BackAtStart,
            Reason::NoTrace => Self::NoTrace,
            Reason::AtEdge => Self::AtEdge,
            Reason::OutOfReach => Self::OutOfReach,
            Reason::Unseen => Self::Unseen,
            Reason::Held => Self::Held,
            Reason::Home => Self::Home,
            Reason::Arrived => Self::Arrived,
            Reason::NoWay => Self::NoWay,
        }
    }
}

/// Why the robot waits.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerWait {
    /// It does not.
    None = 0,
    /// It has seen nothing yet: call `planner_observe_scan` or `planner_observe_cells`.
    Sight = 1,
    /// Its place lies off the grid, or on a cell that it keeps out of: nothing is decided
    /// until one lies elsewhere.
    Pose = 2,
    /// It searches the map.
    Search = 3,
    /// What is left lies behind cells that refused a step. They are tried again later.
    Closed = 4,
    /// It asks for a look in the direction `look`: turn the sensor there, then observe.
    /// A robot that sees all around need not turn.
    Look = 5,
    /// The last look saw the next cell of its way blocked, which its map calls free: it
    /// looks again, a few times, and takes what stays for a refusal. (With rangers, where
    /// the place before showed the cell free, it tries the step.)
    Obstructed = 6,
    /// Nothing is left. It will look again at places that were free and are walls now.
    Patrol = 7,
    /// Nothing seems to be left, but its last look showed a wall of its map free, near by:
    /// it looks again, a few times, before it says so.
    Doubt = 8,
}

impl From<Option<Wait>> for PlannerWait {
    fn from(waiting: Option<Wait>) -> Self {
        match waiting {
            None => Self::None,
            Some(Wait::Sight) => Self::Sight,
            Some(Wait::Pose) => Self::Pose,
            Some(Wait::Search) => Self::Search,
            Some(Wait::Closed) => Self::Closed,
            Some(Wait::Doubt) => Self::Doubt,
            Some(Wait::Patrol) => Self::Patrol,
            Some(Wait::Obstructed) => Self::Obstructed,
            Some(Wait::Look(_)) => Self::Look,
        }
    }
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
    /// Frontier cells left, for a stop; free cells at the map's edge, for
    /// `PLANNER_STOP_AT_EDGE`.
    pub frontiers: u32,
    /// The cell that could not be entered, for `PLANNER_STOP_BLOCKED` and
    /// `PLANNER_STOP_HELD`; or be seen, for `PLANNER_STOP_UNSEEN`; or that the robot was sent
    /// to, for `PLANNER_STOP_ARRIVED` and `PLANNER_STOP_NO_WAY`.
    pub at: PlannerCell,
    /// Why, for a wait.
    pub wait: PlannerWait,
    /// Where to look, for `PLANNER_WAIT_LOOK`.
    pub look: PlannerDirection,
}

/// Enumerations take one byte in the ABI of bare Arm chips; the header checks the same.
#[cfg(all(target_arch = "arm", target_os = "none"))]
const _: () = assert!(size_of::<PlannerAction>() == 16 && size_of::<PlannerResult>() == 1);

impl PlannerPose {
    /// Whether it names a place, on the grid or off it.
    pub(crate) const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.heading.is_finite()
    }
}

impl From<&PlannerPose> for Pose {
    fn from(pose: &PlannerPose) -> Self {
        Self {
            x: pose.x,
            y: pose.y,
            heading: pose.heading,
        }
    }
}

impl From<Pose> for PlannerPose {
    fn from(Pose { x, y, heading }: Pose) -> Self {
        Self { x, y, heading }
    }
}

impl From<Bearing> for PlannerBearing {
    fn from(bearing: Bearing) -> Self {
        Self {
            ahead: bearing.ahead(),
            right: bearing.right(),
        }
    }
}

impl From<Beam> for PlannerBeam {
    fn from(Beam { bearing, range }: Beam) -> Self {
        Self {
            bearing: bearing.into(),
            range,
        }
    }
}

impl PlannerBeam {
    /// `None`: it points nowhere.
    pub(crate) fn read(&self) -> Option<Beam> {
        Some(Beam {
            bearing: Bearing::from_unit(self.bearing.ahead, self.bearing.right)?,
            range: self.range,
        })
    }
}

impl From<Direction> for PlannerDirection {
    fn from(direction: Direction) -> Self {
        match direction {
            Direction::East => Self::East,
            Direction::South => Self::South,
            Direction::West => Self::West,
            Direction::North => Self::North,
        }
    }
}

impl PlannerAction {
    /// Tells an action, and what the planner says of a wait.
    pub(crate) fn new(action: Action, waiting: Option<Wait>) -> Self {
        let mut told = Self {
            kind: PlannerActionKind::Wait,
            direction: PlannerDirection::East,
            stop: PlannerStop::None,
            frontiers: 0,
            at: PlannerCell { x: 0, y: 0 },
            wait: PlannerWait::None,
            look: PlannerDirection::East,
        };
        match action {
            Action::Move(direction) => {
                told.kind = PlannerActionKind::Move;
                told.direction = direction.into();
            }
            Action::Wait => {
                told.wait = waiting.into();
                if let Some(Wait::Look(direction)) = waiting {
                    told.look = direction.into();
                }
            }
            Action::Stop(stop) => {
                told.kind = PlannerActionKind::Stop;
                told.stop = stop.reason().into();
                told.frontiers = stop.left();
                if let Some(at) = stop.place() {
                    told.at = (*at).into();
                }
            }
        }
        told
    }
}
