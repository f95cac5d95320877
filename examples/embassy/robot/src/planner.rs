//! The task that decides: look, listen, decide, move.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use embassy_time::{Duration, Instant, Timer, with_timeout};
use embedded_hal::digital::OutputPin;
use planner_core::explorer::{Config, Explorer, SensorModel};
use planner_core::radio::MAX_LEN;
use planner_core::sight::{Beam, Distances, Pose, RangeScan, Zone, ZoneBeams, ZoneSensor};
use planner_core::{Action, Cell, Direction, Extent, Motion, Planner, RobotId, Wait};
use static_cell::ConstStaticCell;

use crate::{FRAMES, Frame, OUTBOX, Wheels, ZONES};

/// The planner's whole memory, for a map of 64×64 cells.
static EXPLORER: ConstStaticCell<Explorer<8, 8>> = ConstStaticCell::new(Explorer::vacant());

/// Side of a cell in millimetres. All robots of a fleet have the same.
const CELL_MM: u16 = 250;
const EXTENT: Extent = Extent::new(64, 64);

/// A VL53L5CX at the front, level.
const FRONT: ZoneSensor = ZoneSensor {
    distances: Distances::Perpendicular,
    field_of_view: FRAC_PI_4,
    max_range_mm: 1000,
    yaw: 0.0,
    pitch: 0.0,
    ahead_mm: 60,
    height_mm: 90,
    floor_mm: 40,
    top_mm: 150,
    cell_mm: CELL_MM,
};

/// Ranges err by 30 mm, the robot by as much: 60 mm / 250 mm.
const TOLERANCE: f32 = 0.24;

/// A decision that waits takes so long; a step takes longer.
const TICK: Duration = Duration::from_millis(200);

/// The deadline of a look: three measurements at 15 Hz. A sensor that is later has seen nothing.
const LOOK: Duration = Duration::from_millis(200);

/// Which robot it is and where it is switched on, in the frame that the fleet shares.
pub struct Place {
    /// No two robots have the same.
    pub id: RobotId,
    /// The cell that it stands on.
    pub start: Cell,
    /// Where it looks to.
    pub heading: Direction,
}

/// Explores until it stops. Only this task calls the planner.
pub async fn planner<P: OutputPin>(place: Place, mut wheels: Wheels<P>) {
    let explorer = EXPLORER.take();
    let mut config = Config::new();
    config.sensor = SensorModel::rangers();
    config.link.cell_mm = CELL_MM;
    if let Err(error) = explorer.reset(config, place.id, EXTENT, place.start) {
        defmt::panic!("{}", error);
    }
    let front = match FRONT.beams() {
        Ok(front) => front,
        Err(error) => defmt::panic!("{}", error),
    };
    let (mut position, mut heading) = (place.start, place.heading);
    let mut buffer = [0; MAX_LEN];
    loop {
        let begin = Instant::now();
        let beams = look(&front).await;
        let scan = RangeScan {
            pose: pose(position, heading),
            sensor: front.sensor(TOLERANCE),
            beams,
        };
        match scan.sighting() {
            Ok(sighting) => drop(explorer.observe(&sighting)),
            Err(error) => defmt::warn!("a scan without a use: {}", error),
        }
        while let Ok(frame) = FRAMES.try_receive() {
            // The planner logs what it refuses, and why.
            let _ = explorer.receive(&frame);
        }
        let action = explorer.tick();
        while let Some(length) = explorer.transmit(&mut buffer) {
            let frame = buffer
                .get(..length)
                .and_then(|bytes| Frame::from_slice(bytes).ok());
            // What the radio has no room for is told again.
            let _ = frame.map(|frame| OUTBOX.try_send(frame));
        }
        match action {
            Action::Move(direction) => {
                wheels.turn(heading, direction).await;
                heading = direction;
                let motion = step(&front, &mut wheels).await;
                if motion == Motion::Moved {
                    position = position.step(direction);
                }
                explorer.report(motion);
            }
            Action::Wait => {
                if let Some(Wait::Look(direction)) = explorer.waiting() {
                    wheels.turn(heading, direction).await;
                    heading = direction;
                }
                Timer::at(begin + TICK).await;
            }
            Action::Stop(stop) => {
                let known = explorer.map().known_cells();
                defmt::info!("{}; {=u32} cells known", stop, known);
                return;
            }
        }
    }
}

/// What is in front now: what was measured before is of another place.
async fn look(front: &ZoneBeams) -> [Beam; 8] {
    ZONES.reset();
    let zones = with_timeout(LOOK, ZONES.wait()).await;
    front.read(&zones.unwrap_or([Zone::Invalid; 64]))
}

/// Goes one cell ahead, unless something is in the way.
async fn step<P: OutputPin>(front: &ZoneBeams, wheels: &mut Wheels<P>) -> Motion {
    /// From the middle of a cell, in cells: a wall is half a cell away.
    const NEXT_TO_IT: f32 = 0.8;

    let beams = look(front).await;
    if beams.iter().any(|beam| beam.range < NEXT_TO_IT) {
        return Motion::Blocked;
    }
    wheels.go().await;
    Motion::Moved
}

/// The middle of a cell.
fn pose(cell: Cell, heading: Direction) -> Pose {
    Pose {
        x: f32::from(cell.x) + 0.5,
        y: f32::from(cell.y) + 0.5,
        heading: f32::from(heading as u8) * FRAC_PI_2,
    }
}
