//! The explorer behind a C interface: `include/planner.h` for firmware in C.
//!
//! Five verbs, as everywhere: observe, tick, report, transmit, receive. A planner
//! lives in memory of the caller; pointers that are null or not aligned, and
//! memory without a planner, are answered with a [`PlannerResult`], not with a
//! crash. What no library can check is left to the caller: that memory behind a
//! pointer is as large as its type, and that nobody else uses it during a call.
#![cfg_attr(target_os = "none", no_std)]

mod place;
mod types;

use planner_core::explorer::Config;
use planner_core::radio::MAX_LEN;
use planner_core::sight::{Beam, RangeScan};
use planner_core::{Cell, Extent, Motion, Planner as _, RobotId, Sighting};

pub use place::{PLANNER_WORDS, Planner};
pub use types::{
    PlannerAction, PlannerActionKind, PlannerBeam, PlannerCell, PlannerConfig, PlannerDirection,
    PlannerPose, PlannerResult, PlannerSeen, PlannerStop,
};

use place::{Robot, input, inputs, output, robot};

/// The robot is on the cell that it was sent to.
pub const PLANNER_MOVED: u8 = 0;
/// Something stood in the way; the robot is where it was.
pub const PLANNER_BLOCKED: u8 = 1;
/// Another robot stands there and goes first; the robot is where it was.
pub const PLANNER_HELD: u8 = 2;

/// Largest width and height of a grid, in cells.
pub const PLANNER_MAX_CELLS: u16 = 128;
const _: () = assert!(PLANNER_MAX_CELLS as usize == 8 * place::TILES);

/// The longest frame, in bytes.
pub const PLANNER_MAX_FRAME: usize = 55;
const _: () = assert!(PLANNER_MAX_FRAME == MAX_LEN);

/// Beams of one scan at most.
pub const PLANNER_MAX_BEAMS: usize = 64;

/// Creates a planner in place, or starts it anew. Takes 1 KiB of stack.
#[unsafe(no_mangle)]
pub extern "C" fn planner_create(
    planner: *mut Planner,
    config: *const PlannerConfig,
) -> PlannerResult {
    answer(|| {
        let config = *input(config)?;
        let extent = Extent::new(config.width, config.height);
        let start = Cell::new(config.start.x, config.start.y);
        if !extent.contains(start) {
            return Err(PlannerResult::Extent);
        }
        let mut explorer = Config::new();
        explorer.link.cell_mm = config.cell_mm;
        explorer.link.origin_mm = (config.origin_x_mm, config.origin_y_mm);
        explorer.link.bytes_per_tick = config.bytes_per_tick;
        Robot::create(planner)?
            .reset(explorer, RobotId(config.id), extent, start)
            .map_err(|_| PlannerResult::Extent)
    })
}

/// Takes in a range scan: a lidar, a multi-ranger, an 8×8 time-of-flight sensor.
/// At most [`PLANNER_MAX_BEAMS`] beams; `max_range` in cells.
#[unsafe(no_mangle)]
pub extern "C" fn planner_observe_scan(
    planner: *mut Planner,
    pose: *const PlannerPose,
    max_range: f32,
    beams: *const PlannerBeam,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let pose = input(pose)?;
        let nothing = Beam {
            bearing: 0.0,
            range: f32::NAN,
        };
        let mut measured = [nothing; PLANNER_MAX_BEAMS];
        let given = inputs(beams, count)?;
        let places = measured.get_mut(..given.len());
        for (beam, given) in places.ok_or(PlannerResult::TooMany)?.iter_mut().zip(given) {
            beam.bearing = given.bearing;
            beam.range = given.range;
        }
        let scan = RangeScan {
            pose: pose.into(),
            max_range,
            beams: &measured,
        };
        let sighting = scan.sighting().map_err(|_| PlannerResult::Scan)?;
        robot.observe(&sighting);
        Ok(())
    })
}

/// Takes in cells that were seen from the cell `centre`, which is free.
#[unsafe(no_mangle)]
pub extern "C" fn planner_observe_cells(
    planner: *mut Planner,
    centre: PlannerCell,
    cells: *const PlannerSeen,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let mut sighting = Sighting::new(Cell::new(centre.x, centre.y));
        for seen in inputs(cells, count)? {
            let cell = Cell::new(seen.cell.x, seen.cell.y);
            match seen.blocked {
                0 => sighting.see_free(cell),
                _ => sighting.see_blocked(cell),
            }
        }
        robot.observe(&sighting);
        Ok(())
    })
}

/// Decides what the robot does now. Call it once a tick.
#[unsafe(no_mangle)]
pub extern "C" fn planner_tick(planner: *mut Planner, action: *mut PlannerAction) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let action = output(action)?;
        action.write(robot.tick().into());
        Ok(())
    })
}

/// Says how the step of the last move went: [`PLANNER_MOVED`],
/// [`PLANNER_BLOCKED`] or [`PLANNER_HELD`].
#[unsafe(no_mangle)]
pub extern "C" fn planner_report(planner: *mut Planner, motion: u8) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        robot.report(match motion {
            PLANNER_MOVED => Motion::Moved,
            PLANNER_BLOCKED => Motion::Blocked,
            PLANNER_HELD => Motion::Held,
            _ => return Err(PlannerResult::Motion),
        });
        Ok(())
    })
}

/// Writes the next frame for the other robots into `frame`, which holds
/// [`PLANNER_MAX_FRAME`] bytes, and its length into `length`: 0 if there is
/// nothing to send in this tick any more.
#[unsafe(no_mangle)]
pub extern "C" fn planner_transmit(
    planner: *mut Planner,
    frame: *mut u8,
    length: *mut usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let frame = output(frame.cast::<[u8; MAX_LEN]>())?;
        let length = output(length)?;
        let mut buffer = [0; MAX_LEN];
        let written = robot.transmit(&mut buffer);
        frame.write(buffer);
        length.write(written.unwrap_or(0));
        Ok(())
    })
}

/// Takes in a frame of another robot. [`PlannerResult::Frame`]: it says nothing to
/// this robot, and nothing has changed.
#[unsafe(no_mangle)]
pub extern "C" fn planner_receive(
    planner: *mut Planner,
    frame: *const u8,
    length: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let frame = inputs(frame, length)?;
        robot.receive(frame).map_err(|_| PlannerResult::Frame)?;
        Ok(())
    })
}

/// Writes how many cells of the map are known, and how many of them are frontiers.
#[unsafe(no_mangle)]
pub extern "C" fn planner_known(
    planner: *mut Planner,
    known: *mut u32,
    frontiers: *mut u32,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let (known, frontiers) = (output(known)?, output(frontiers)?);
        known.write(robot.map().known_cells());
        frontiers.write(robot.map().frontiers());
        Ok(())
    })
}

fn answer(call: impl FnOnce() -> Result<(), PlannerResult>) -> PlannerResult {
    call().err().unwrap_or(PlannerResult::Ok)
}

/// planner-core never panics, and neither does this crate: on the chip the
/// linker drops this.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

#[cfg(test)]
mod tests;
