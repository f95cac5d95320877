//! The main loop: look, decide, move.

use core::f32::consts::FRAC_PI_2;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::I2c;
use embedded_hal::pwm::SetDutyCycle;
use planner_core::explorer::{Config, Explorer, SensorModel};
use planner_core::radio::MAX_LEN;
use planner_core::sight::{Pose, RangeScan};
use planner_core::{Action, Cell, Direction, Extent, Motion, Planner, RobotId, Wait};

use crate::radio::Radio;
use crate::rangers::{CELL_MM, Rangers, SENSOR};
use crate::wheels::Wheels;

/// The planner, for a map of 64×64 cells: 16×16 metres.
pub(crate) type Robot = Explorer<8, 8>;

pub(crate) const EXTENT: Extent = Extent::new(64, 64);
/// Where the robot is switched on: in the middle of the map, looking east.
pub(crate) const START: Cell = Cell::new(32, 32);

/// What robots of the fleet agree upon.
pub(crate) fn config() -> Config {
    let mut config = Config::new();
    config.sensor = SensorModel::rangers();
    config.link.cell_mm = CELL_MM;
    config
}

/// Explores, and then rests.
pub(crate) fn run<I, P, Q, A, B, D>(
    explorer: &mut Robot,
    mut radio: impl Radio,
    mut rangers: Rangers<I>,
    mut wheels: Wheels<P, Q, A, B, D>,
) -> !
where
    I: I2c,
    P: SetDutyCycle,
    Q: SetDutyCycle,
    A: OutputPin,
    B: OutputPin,
    D: DelayNs,
{
    if let Err(error) = explorer.reset(config(), RobotId(0), EXTENT, START) {
        defmt::panic!("{}", error);
    }
    let (mut position, mut heading) = (START, Direction::East);
    let mut buffer = [0; MAX_LEN];
    loop {
        let scan = RangeScan {
            pose: pose(position, heading),
            sensor: SENSOR,
            beams: rangers.scan(),
        };
        match scan.sighting() {
            Ok(sighting) => {
                let learnt = explorer.observe(&sighting);
                defmt::debug!("at {}: learnt {}", position, learnt);
            }
            Err(error) => defmt::warn!("a scan without a use: {}", error),
        }
        while let Some(frame) = radio.receive() {
            // The planner logs what it refuses, and why.
            let _ = explorer.receive(&frame);
        }
        while let Some(length) = explorer.transmit(&mut buffer) {
            radio.send(buffer.get(..length).unwrap_or(&[]));
        }
        match explorer.tick() {
            Action::Move(direction) => {
                wheels.turn(heading, direction);
                heading = direction;
                let motion = step(&mut rangers, &mut wheels);
                if motion == Motion::Moved {
                    position = position.step(direction);
                } else {
                    defmt::debug!("stopped on the way to {}", position.step(direction));
                }
                explorer.report(motion);
            }
            Action::Wait => match explorer.waiting() {
                // No sensor has shown what is there: another one looks at it.
                Some(Wait::Look(direction)) => {
                    defmt::debug!("looks {}", direction);
                    wheels.turn(heading, direction);
                    heading = direction;
                }
                // Never with these wheels; a robot that is located from outside waits
                // here until its pose lies on the grid again.
                Some(Wait::Pose) => {
                    defmt::warn!("the pose {} lies off the grid", position);
                    wheels.wait();
                }
                reason => {
                    defmt::debug!("waits: {}", reason);
                    wheels.wait();
                }
            },
            Action::Stop(stop) => {
                let known = explorer.map().known_cells();
                if stop.is_complete() {
                    defmt::info!("{}; {=u32} cells known", stop, known);
                } else {
                    defmt::warn!("gave up: {}; {=u32} cells known", stop, known);
                }
                // `explorer.resume()` goes on: after an order, or when a door opened.
                crate::rest();
            }
        }
    }
}

/// Goes one cell ahead, and says whether it came there: not if something was in the way,
/// and not if afterwards nothing is nearer ahead, and nothing farther behind. Wheels that
/// push against glass say the same of themselves as wheels that drive.
fn step<I, P, Q, A, B, D>(rangers: &mut Rangers<I>, wheels: &mut Wheels<P, Q, A, B, D>) -> Motion
where
    I: I2c,
    P: SetDutyCycle,
    Q: SetDutyCycle,
    A: OutputPin,
    B: OutputPin,
    D: DelayNs,
{
    /// From the middle of a cell, in cells: a wall is half a cell away.
    const NEXT_TO_IT: f32 = 0.8;
    /// The least by which a step of one cell shows.
    const SHOWS: f32 = 0.5;

    let (ahead, behind) = rangers.along();
    if ahead < NEXT_TO_IT {
        return Motion::Blocked;
    }
    wheels.go();
    let (ahead_now, behind_now) = rangers.along();
    // A distance that was not measured says nothing against it.
    let stayed = |grew: f32| grew < SHOWS;
    match stayed(ahead - ahead_now) && stayed(behind_now - behind) {
        true => Motion::Blocked,
        false => Motion::Moved,
    }
}

/// The middle of a cell.
fn pose(cell: Cell, heading: Direction) -> Pose {
    Pose {
        x: f32::from(cell.x) + 0.5,
        y: f32::from(cell.y) + 0.5,
        heading: f32::from(heading as u8) * FRAC_PI_2,
    }
}
