//! What is asked beside the verbs: for logs, for a display, for whoever looks for a fault.

use core::ffi::{CStr, c_char};

use planner_core::sight::Pose;
use planner_core::{Cell, Direction, Planner as _};

use crate::answer;
use crate::place::{Planner, input, output, robot};
use crate::types::{
    PlannerCell, PlannerConfig, PlannerPose, PlannerResult, PlannerState, PlannerStatus,
};

/// The pose of a robot at `x`, `y` in metres, y to the left of x, whose `yaw` in radians
/// grows counter-clockwise from x: the frame of ROS and of the Crazyflie. In the grid y
/// and angles grow the other way, so angles of such a robot's sensors go to
/// `planner_bearing` with their sign changed. `PLANNER_RESULT_CELL_SIZE`: the
/// configuration's `cell_mm` is 0.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_pose_from_metres(
    config: *const PlannerConfig,
    x: f32,
    y: f32,
    yaw: f32,
    pose: *mut PlannerPose,
) -> PlannerResult {
    answer(|| {
        let (origin_mm, cell_mm) = input(config)?.grid()?;
        let made = Pose::from_metres(x, y, yaw, origin_mm, cell_mm);
        output(pose)?.write(made.into());
        Ok(())
    })
}

/// The middle of a cell in the same frame, in metres: where to go for a move to that cell.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_middle_in_metres(
    config: *const PlannerConfig,
    cell: PlannerCell,
    x: *mut f32,
    y: *mut f32,
) -> PlannerResult {
    answer(|| {
        let (origin_mm, cell_mm) = input(config)?.grid()?;
        let (x, y) = (output(x)?, output(y)?);
        let middle = Cell::new(cell.x, cell.y).middle_in_metres(origin_mm, cell_mm);
        x.write(middle.0);
        y.write(middle.1);
        Ok(())
    })
}

/// A `PlannerDirection` as a yaw in radians, counter-clockwise from the east.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_yaw(direction: u8) -> f32 {
    Direction::from_index(direction).yaw()
}

/// Writes where the robot is, where it goes, what it knows, and what it has from others.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_status(
    planner: *mut Planner,
    status: *mut PlannerStatus,
) -> PlannerResult {
    answer(|| {
        let explorer = &robot(planner)?.planner;
        let (now, map, hearsay) = (explorer.status(), explorer.map(), explorer.hearsay());
        let goal = now.goal.unwrap_or(now.position);
        output(status)?.write(PlannerStatus {
            position: now.position.into(),
            goal: goal.into(),
            has_goal: now.goal.is_some().into(),
            known: map.known_cells(),
            frontiers: map.frontiers(),
            heard_cells: hearsay.cells,
            contradictions: hearsay.contradictions,
            contradicted_by: hearsay.contradicted_by.map_or(u8::MAX, |id| id.0),
            same_id: hearsay.same_id,
            refused: hearsay.refused,
        });
        Ok(())
    })
}

/// Writes the farthest cell of the way that the robot can go to in a straight line, centre
/// to centre, and whether there is one: every cell that the line touches is known to be
/// passable. At most 19 cells away each way. A robot that steers there instead of making the
/// step of the last move observes from any cell on its way, and reports only what stops it:
/// places on the line, on the way or beside the way keep the plan. Work: 16 tiles, and 64
/// lines of at most 20 rows each.
///
/// Stack: 2048 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_waypoint(
    planner: *mut Planner,
    has_waypoint: *mut bool,
    waypoint: *mut PlannerCell,
) -> PlannerResult {
    answer(|| {
        let found = robot(planner)?.planner.waypoint();
        let (has_waypoint, waypoint) = (output(has_waypoint)?, output(waypoint)?);
        has_waypoint.write(found.is_some());
        if let Some(cell) = found {
            waypoint.write(cell.into());
        }
        Ok(())
    })
}

/// Writes the cells of the way, from the next one on: at most `room` of at most 256, up to
/// the goal or to where its rest is searched for; `count` is how many.
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_way(
    planner: *mut Planner,
    cells: *mut PlannerCell,
    room: usize,
    count: *mut usize,
) -> PlannerResult {
    answer(|| {
        let way = robot(planner)?.planner.way();
        let count = output(count)?;
        let mut written = 0;
        for cell in way.take(room) {
            output(cells.wrapping_add(written))?.write(cell.into());
            written += 1;
        }
        count.write(written);
        Ok(())
    })
}

/// Writes the `PlannerState` of a cell. `PLANNER_RESULT_OFF_GRID`: there is no such cell.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_cell(
    planner: *mut Planner,
    cell: PlannerCell,
    state: *mut u8,
) -> PlannerResult {
    answer(|| {
        let explorer = &robot(planner)?.planner;
        let cell = Cell::new(cell.x, cell.y);
        if !explorer.map().extent().contains(cell) {
            return Err(PlannerResult::OffGrid);
        }
        output(state)?.write(PlannerState::of(explorer.map(), cell) as u8);
        Ok(())
    })
}

/// Writes the `PlannerState` of the cells of row `y`, from the west: at most `room`
/// of them; `count` is how many. Work: one cell after the other.
///
/// Stack: 256 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_row(
    planner: *mut Planner,
    y: i16,
    states: *mut u8,
    room: usize,
    count: *mut usize,
) -> PlannerResult {
    answer(|| {
        let map = robot(planner)?.planner.map();
        let (extent, count) = (map.extent(), output(count)?);
        if !extent.contains(Cell::new(0, y)) {
            return Err(PlannerResult::OffGrid);
        }
        let width = room.min(extent.width.into());
        for (x, at) in (0..width).zip(0..) {
            let state = PlannerState::of(map, Cell::new(at, y));
            output(states.wrapping_add(x))?.write(state as u8);
        }
        count.write(width);
        Ok(())
    })
}

/// A `PlannerResult` in words, for logs.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_result_text(result: u8) -> *const c_char {
    text(result.into(), &RESULTS)
}

/// A `PlannerStop` in words.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_stop_text(stop: u8) -> *const c_char {
    text(stop.into(), &STOPS)
}

/// A `PlannerWait` in words.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_wait_text(wait: u8) -> *const c_char {
    text(wait.into(), &WAITS)
}

fn text(code: usize, texts: &'static [&'static CStr]) -> *const c_char {
    texts.get(code).unwrap_or(&c"unknown").as_ptr()
}

/// By [`PlannerResult`]. What Rust's `Display` says too begins with the same words.
pub(crate) const RESULTS: [&CStr; 36] = [
    c"done",
    c"a pointer is null",
    c"a pointer is not aligned",
    c"no planner was created in this memory",
    c"the grid or box is empty, too large, or the start lies off it",
    c"the scan's pose or largest range cannot be, or its tolerance is not between 0 and 0.25 cells",
    c"too many values",
    c"no such motion",
    c"unknown",
    c"cells of 0 mm",
    c"the place lies off the grid",
    c"no frame is of this length",
    c"the frame is of another version",
    c"this planner does not read frames of this kind",
    c"the frame's check bytes do not match",
    c"the frame is about another grid",
    c"the frame is the robot's own",
    c"the frame's fields are out of range",
    c"another robot has the id of this one",
    c"no such sensor or field",
    c"header and library are of different sizes",
    c"no such clearance",
    c"the robot or its home lies in cells that it is to keep out of",
    c"nothing was saved there",
    c"the save is of another version",
    c"the save is damaged or cut short",
    c"the save is of another grid",
    c"the save is of another robot",
    c"the grid was moved too often since the last stop",
    c"no such range",
    c"no such heading",
    c"the field of view is not above 0 and up to pi/2",
    c"the pitch is not between -pi/4 and pi/4, or -pi/2 and pi/2 among voxels",
    c"the yaw is not finite",
    c"the floor must end below the sensor, and the robot above it",
    c"the largest range and the side of a cell must be above 0",
];

/// By [`PlannerStop`](crate::PlannerStop), in the same words.
pub(crate) const STOPS: [&CStr; 13] = [
    c"exploring",
    c"complete",
    c"complete; no way leads to what is left, and part of the map was heard",
    c"gave up: the way stayed blocked",
    c"back at the start with no frontier in view",
    c"no frontier in view and no trace to follow",
    c"complete within the map, which ends at free cells",
    c"complete; no way leads to what is left in sight",
    c"gave up: no look shows what is at a cell",
    c"gave up: a robot stayed in the way",
    c"home",
    c"arrived",
    c"gave up: no known way leads there",
];

/// By [`PlannerWait`](crate::PlannerWait).
pub(crate) const WAITS: [&CStr; 9] = [
    c"does not wait",
    c"has seen nothing yet",
    c"waits for a place on the grid",
    c"searches the map",
    c"waits for a cell that refused a step",
    c"wants to look",
    c"something is in its way",
    c"on patrol",
    c"doubts a wall",
];
