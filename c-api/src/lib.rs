//! The explorer, and the planner among voxels, behind a C interface: `include/planner.h` for
//! firmware in C.
//!
//! The verbs are those of everywhere: observe, tick, report, transmit, receive. A planner
//! lives in memory of the caller; pointers that are null or not aligned, and
//! memory without a planner, are answered with a [`PlannerResult`], not with a
//! crash. What no library can check is left to the caller: that memory behind a
//! pointer is as large as its type, and that nobody else uses it during a call.
#![cfg_attr(target_os = "none", no_std)]

mod limits;
mod place;
mod queries;
mod types;
mod voxels;
mod voxels_seen;
mod zones;

use planner_core::explorer::{Config, Explorer, MAX_CLEARANCE};
use planner_core::map::MOST_PLACES;
use planner_core::radio::{Key, LinkConfig, MAX_LEN};
use planner_core::sight::{Beam, Bearing, Look, RangeScan, RangeSensor, Row, ScanError};
use planner_core::{
    Cell, Errands as _, Extent, LongSight as _, Motion, Planner as _, Reason, RobotId, Sighting,
};

pub use limits::{
    planner_add_rectangle, planner_keep_out, planner_recentre, planner_restore, planner_save,
    planner_saved_bytes, planner_settle,
};
pub use place::{
    PLANNER_CELL_SET_WORDS, PLANNER_MAX_CELLS, PLANNER_WORDS, Planner, PlannerCellSet,
};
pub use queries::{
    planner_cell, planner_middle_in_metres, planner_pose_from_metres, planner_result_text,
    planner_row, planner_status, planner_stop_text, planner_wait_text, planner_way,
    planner_waypoint, planner_yaw,
};
pub use types::{
    PlannerAction, PlannerActionKind, PlannerBeam, PlannerBearing, PlannerCell, PlannerConfig,
    PlannerDirection, PlannerPose, PlannerResult, PlannerSeen, PlannerSensor, PlannerState,
    PlannerStatus, PlannerStop, PlannerWait,
};
pub use voxels::{
    PLANNER_VOXEL_MAX_LEVELS, PLANNER_VOXEL_MAX_RANGE, PLANNER_VOXEL_MAX_SIDE,
    PLANNER_VOXEL_SURVEY_WORDS, PlannerVoxel, PlannerVoxelAction, PlannerVoxelConfig,
    PlannerVoxelField, PlannerVoxelSeen, PlannerVoxelStatus, PlannerVoxelSurvey,
    planner_voxel_create, planner_voxel_energy, planner_voxel_go_home, planner_voxel_hear,
    planner_voxel_observe, planner_voxel_receive, planner_voxel_resume, planner_voxel_state,
    planner_voxel_status, planner_voxel_tick, planner_voxel_transmit,
};
pub use voxels_seen::{
    PLANNER_VOXEL_ZONES_SEEN, PlannerRay, PlannerVector, PlannerVoxelLook, PlannerVoxelPose,
    planner_voxel_at, planner_voxel_middle_in_metres, planner_voxel_pose_from_metres,
    planner_voxel_rays, planner_voxel_set_field, planner_voxel_yaw, planner_voxel_zones,
};
pub use zones::{
    PLANNER_ZONE_BEAMS, PLANNER_ZONES, PlannerZone, PlannerZoneSensor, planner_zone_beams,
};

use place::{create, fits, input, inputs, output, robot};

/// The robot is on the cell that it was sent to.
pub const PLANNER_MOVED: u8 = 0;
/// Something stood in the way; the robot is where it was.
pub const PLANNER_BLOCKED: u8 = 1;
/// Another robot stands there and goes first; the robot is where it was.
pub const PLANNER_HELD: u8 = 2;

/// The longest frame, in bytes.
pub const PLANNER_MAX_FRAME: usize = 55;
const _: () = assert!(PLANNER_MAX_FRAME == MAX_LEN);

/// Places that `planner_shut` names at most.
pub const PLANNER_MAX_SHUT: usize = 8;
const _: () = assert!(PLANNER_MAX_SHUT == MOST_PLACES);

/// Creates a planner in place, or starts it anew. `bytes` is `sizeof(Planner)`: a header
/// and a library of different sizes are told by `PLANNER_RESULT_MEMORY`. After any result
/// but `PLANNER_RESULT_OK` nothing has changed: memory without a planner has none, and a
/// planner that runs goes on.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_create(
    planner: *mut Planner,
    bytes: usize,
    config: *const PlannerConfig,
) -> PlannerResult {
    answer(|| {
        let config = *input(config)?;
        fits::<Planner>(bytes)?;
        let extent = Extent::new(config.width, config.height);
        let start = Cell::new(config.start.x, config.start.y);
        // All of it before the memory is touched.
        let is_large = config.width.max(config.height) > PLANNER_MAX_CELLS;
        if is_large || !extent.contains(start) {
            return Err(PlannerResult::Extent);
        }
        if config.cell_mm == 0 {
            return Err(PlannerResult::CellSize);
        }
        let mut explorer = Config::new();
        explorer.sensor = config.sensor().ok_or(PlannerResult::Sensor)?;
        explorer.patrol = config.patrol_ticks;
        if config.clearance > MAX_CLEARANCE {
            return Err(PlannerResult::Clearance);
        }
        explorer.clearance = config.clearance;
        explorer.come_home = config.come_home != 0;
        explorer.link = LinkConfig {
            origin_mm: (config.origin_x_mm, config.origin_y_mm),
            cell_mm: config.cell_mm,
            bytes_per_tick: config.bytes_per_tick,
            key: (config.is_keyed != 0).then_some(Key(config.key)),
        };
        create(planner, config.id, config.bytes_per_tick)?
            .reset(explorer, RobotId(config.id), extent, start)
            .map_err(|_| PlannerResult::Extent)
    })
}

/// The direction `radians` from the robot's heading; grows from east to south. Make it
/// once for each beam of a sensor: it takes a sine and a cosine. An angle that is not
/// finite gives a direction whose beams say nothing.
///
/// Stack: 256 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_bearing(radians: f32) -> PlannerBearing {
    Bearing::from_radians(radians).into()
}

/// Takes in a range scan: a lidar, a multi-ranger, an 8×8 time-of-flight sensor (by
/// `planner_zone_beams`). Work: at most 32 cells a beam. Any result but `PLANNER_RESULT_OK` and
/// `PLANNER_RESULT_OFF_GRID` changes nothing.
///
/// `max_range`: distance in cells up to which every obstacle gives a measurement.
///
/// `tolerance`: how far, in cells, the end of a beam may lie from where it is reported,
/// 0 to 0.25: (range error + position error + max_range × heading error) / side of a
/// cell, rounding among the errors. `PLANNER_TOLERANCE` is the usual one.
///
/// What the proof of completeness needs of looks, of scans and of cells: standing on a
/// free cell, looks (after a turn where `wait` says `PLANNER_WAIT_LOOK`) must in the end
/// show each of the four neighbours as free or blocked. A neighbour that no look shows
/// (glass, matt black, a sensor that does not point there) is set aside after a few
/// looks, and if nothing else is left the robot stops with `PLANNER_STOP_UNSEEN`. The
/// cell that the robot stands on is free, whatever was seen of it from elsewhere.
///
/// Stack: 4224 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_observe_scan(
    planner: *mut Planner,
    pose: *const PlannerPose,
    max_range: f32,
    tolerance: f32,
    beams: *const PlannerBeam,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let pose = input(pose)?;
        let scan = read_scan(pose, max_range, tolerance, inputs(beams, count)?);
        let sighting = or_astray(scan.sighting(), pose)?;
        observe(&mut robot.planner, &sighting)
    })
}

/// As `planner_observe_scan`, for a sensor that reaches more than 15 cells: its beams end at
/// 31. Of what lies more than 15 cells away each way, only cells of which nothing is known
/// count.
///
/// Stack: 8448 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_observe_long_scan(
    planner: *mut Planner,
    pose: *const PlannerPose,
    max_range: f32,
    tolerance: f32,
    beams: *const PlannerBeam,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let pose = input(pose)?;
        let scan = read_scan(pose, max_range, tolerance, inputs(beams, count)?);
        let look = or_astray(scan.long_sighting(), pose)?;
        observe(&mut robot.planner, &look.near())?;
        for (at, free, blocked) in look.far_tiles() {
            robot.planner.observe_far(at, free, blocked);
        }
        Ok(())
    })
}

/// Takes in cells that were seen from the cell `centre`, where the robot stands and
/// which is free. Leave out the cells of which nothing was seen. `planner_observe_scan`
/// says what looks must show.
///
/// Stack: 3328 bytes.
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
        observe(&mut robot.planner, &sighting)
    })
}

/// Decides what the robot does now. Call it once a tick.
///
/// Stack: 3328 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_tick(planner: *mut Planner, action: *mut PlannerAction) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let action = output(action)?;
        let decided = robot.planner.tick();
        action.write(PlannerAction::new(decided, robot.planner.waiting()));
        Ok(())
    })
}

/// Goes on after a stop with the map at hand: somebody opened a door, carried the robot,
/// or wants it to try again what it gave up. Without a stop, what refused a step or
/// showed nothing is tried anew.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_resume(planner: *mut Planner) -> PlannerResult {
    answer(|| {
        robot(planner)?.planner.resume();
        Ok(())
    })
}

/// Sends the robot home, to where it started, also from a stop. It stops there with
/// `PLANNER_STOP_HOME`, or says why not: `PLANNER_STOP_NO_WAY`, `PLANNER_STOP_BLOCKED` or
/// `PLANNER_STOP_HELD`. `planner_resume` then goes on exploring.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_go_home(planner: *mut Planner) -> PlannerResult {
    answer(|| {
        robot(planner)?.planner.go_home();
        Ok(())
    })
}

/// As `planner_go_home`, to any cell: it stops there with `PLANNER_STOP_ARRIVED`. Off the
/// grid: `PLANNER_RESULT_OFF_GRID`, and nothing has changed.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_go_to(planner: *mut Planner, cell: PlannerCell) -> PlannerResult {
    answer(|| {
        let is_sent = robot(planner)?.planner.go_to(Cell::new(cell.x, cell.y));
        is_sent.then_some(()).ok_or(PlannerResult::OffGrid)
    })
}

/// Tells the planner how many more steps the robot's energy allows; each step that is
/// reported as `PLANNER_MOVED` takes one off until it is told again. It turns back while that lasts for the shortest way home that it
/// knows, and stops there with `PLANNER_STOP_HOME`; told more, `planner_resume` goes on
/// exploring. Without this call there is no limit.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_energy(planner: *mut Planner, steps: u32) -> PlannerResult {
    answer(|| {
        robot(planner)?.planner.energy(steps);
        Ok(())
    })
}

/// Whether a robot that stopped for this reason, a `PlannerStop`, knows everything that
/// it could reach within its map; otherwise it gave up.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_stop_is_complete(stop: u8) -> bool {
    let code = stop.checked_sub(1);
    code.and_then(Reason::from_code)
        .is_some_and(Reason::is_complete)
}

/// Says how the step of the last move went: [`PLANNER_MOVED`],
/// [`PLANNER_BLOCKED`] or [`PLANNER_HELD`].
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_report(planner: *mut Planner, motion: u8) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        robot.planner.report(match motion {
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
/// nothing to send in this tick any more. A mute planner never has anything to send:
/// see `planner_is_mute`.
///
/// Stack: 1024 bytes.
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
        let written = robot.planner.transmit(&mut buffer);
        frame.write(buffer);
        length.write(written.unwrap_or(0));
        Ok(())
    })
}

/// Whether the configuration lets the robot send nothing: its `bytes_per_tick` is 0.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_is_mute(planner: *mut Planner, is_mute: *mut bool) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        output(is_mute)?.write(robot.is_mute);
        Ok(())
    })
}

/// Takes in a frame of another robot, at any time. A result from
/// `PLANNER_RESULT_FRAME_LENGTH` on tells why it was not taken; nothing has changed then.
///
/// Stack: 896 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_receive(
    planner: *mut Planner,
    frame: *const u8,
    length: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let frame = inputs(frame, length)?;
        robot.planner.receive(frame)?;
        Ok(())
    })
}

/// Writes how many cells were free and are walls now (doors that somebody shut), and the
/// last of them into `places`: at most `room` of at most [`PLANNER_MAX_SHUT`], the latest
/// one last; `count` is how many. A stop with `planner_stop_is_complete` means complete as
/// seen: what lies behind these is not part of it.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_shut(
    planner: *mut Planner,
    cells: *mut u32,
    places: *mut PlannerCell,
    room: usize,
    count: *mut usize,
) -> PlannerResult {
    answer(|| {
        let shut = robot(planner)?.planner.map().shut();
        let (cells, count) = (output(cells)?, output(count)?);
        let last = shut.places();
        let last = last.get(last.len().saturating_sub(room)..).unwrap_or(&[]);
        for (i, at) in last.iter().enumerate() {
            output(places.wrapping_add(i))?.write(PlannerCell::from(*at));
        }
        cells.write(shut.cells());
        count.write(last.len());
        Ok(())
    })
}

fn read_scan(
    pose: &PlannerPose,
    max_range: f32,
    tolerance: f32,
    beams: &[PlannerBeam],
) -> RangeScan<impl Iterator<Item = Beam>> {
    RangeScan {
        pose: pose.into(),
        sensor: RangeSensor {
            max_range,
            tolerance,
        },
        beams: beams.iter().filter_map(PlannerBeam::read),
    }
}

/// What a scan shows; from farther than cells have names, nothing, and from off the grid.
fn or_astray<R: Row, const SPAN: usize>(
    scanned: Result<Look<R, SPAN>, ScanError>,
    pose: &PlannerPose,
) -> Result<Look<R, SPAN>, PlannerResult> {
    match scanned {
        Ok(look) => Ok(look),
        Err(ScanError::Pose) if pose.is_finite() => Ok(Look::new(Cell::new(-1, -1))),
        Err(ScanError::Pose | ScanError::MaxRange | ScanError::Tolerance) => {
            Err(PlannerResult::Scan)
        }
    }
}

/// Hands a sighting to the planner, also one from off the grid: it waits then.
fn observe(
    explorer: &mut Explorer<{ place::TILES }, { place::TILES }>,
    sighting: &Sighting,
) -> Result<(), PlannerResult> {
    explorer.observe(sighting);
    if explorer.map().extent().contains(sighting.centre()) {
        Ok(())
    } else {
        Err(PlannerResult::OffGrid)
    }
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
