//! How bodies move beside unit steps: in metres and seconds; and its options.

use std::fmt;

use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

use super::{ScenarioError, check_share};
use crate::world::World;

/// Side of a cell in metres where neither the map nor the user says it.
const CELL: f64 = 0.5;
/// Share of what fits that a body is wide, where the user does not say it: the rest is for
/// what its driver errs.
const USUAL_WIDTH: f64 = 0.8;
/// The same, at most.
const MOST_WIDTH: f64 = 0.96;
/// How far from the nearest cell that it may not touch the centre of a body is, in cells,
/// wherever it stands in an open cell, by clearance. Without clearance it has to keep to
/// the middle of its cell where a corner is near.
const ROOM: [f64; 4] = [0.5, 1.0, std::f64::consts::SQRT_2, 2.236];

/// A body that moves, a disc, and the ticks of its planner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// How it is driven.
    pub drive: Drive,
    /// Its largest speed, in metres a second.
    pub speed: f64,
    /// Its largest rate of turning, in radians a second; of no use to a drone, which flies to
    /// any side.
    pub turn_rate: f64,
    /// How fast it gains and loses speed, in metres a second each second. A differential
    /// drive's wheels do.
    pub acceleration: f64,
    /// Its radius in metres.
    pub radius: f64,
    /// Side of a cell in metres.
    pub cell: f64,
    /// Milliseconds between two ticks of its planner: a look, and a decision.
    pub tick_ms: u16,
    /// Share of its way that a wheel (a drone: an axis) loses at most, drawn each tick, 0 to
    /// 1; its odometry does not notice.
    pub slip: f64,
    /// Share by which its odometry errs at most, drawn once for each wheel or axis, 0 to 1.
    pub odometry_error: f64,
}

/// How a body is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Drive {
    /// Two wheels: ahead, and turns in place. By default as a TurtleBot3 Burger: 0.22 m/s,
    /// 2.84 rad/s.
    DiffDrive,
    /// To any side without turning, as a drone. By default 0.5 m/s.
    Omni,
}

/// The name used on the command line, for example `diff-drive`.
impl fmt::Display for Drive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no drive is hidden");
        f.write_str(value.get_name())
    }
}

impl Motion {
    /// The usual body on cells of so many metres that fits this clearance, without slip and
    /// with an odometry that does not err.
    pub fn new(drive: Drive, cell: f64, clearance: u8) -> Self {
        let (speed, turn_rate) = match drive {
            Drive::DiffDrive => (0.22, 2.84),
            Drive::Omni => (0.5, 0.0),
        };
        Self {
            drive,
            speed,
            turn_rate,
            acceleration: 1.0,
            radius: USUAL_WIDTH * room(clearance) * cell,
            cell,
            tick_ms: 100,
            slip: 0.0,
            odometry_error: 0.0,
        }
    }

    /// Seconds between two ticks.
    pub fn tick(&self) -> f64 {
        f64::from(self.tick_ms) / 1000.0
    }

    /// Seconds that a step from rest to rest takes, with a quarter turn before it.
    pub fn step(&self) -> f64 {
        let way = from_rest_to_rest(self.cell, self.speed, self.acceleration);
        way + match self.drive {
            Drive::Omni => 0.0,
            Drive::DiffDrive => from_rest_to_rest(
                std::f64::consts::FRAC_PI_2,
                self.turn_rate,
                // As the wheels gain speed.
                self.acceleration * self.turn_rate / self.speed,
            ),
        }
    }

    /// The same in ticks, rounded up.
    pub fn ticks_a_step(&self) -> u32 {
        (self.step() / self.tick()).ceil().max(1.0) as u32
    }

    pub(super) fn check(&self, clearance: u8) -> Result<(), ScenarioError> {
        let positive = |option, value: f64, most: f64| match value > 0.0 && value <= most {
            true => Ok(()),
            false => Err(ScenarioError::setting(
                option,
                value,
                format!("more than 0, and at most {most}"),
            )),
        };
        positive("cell", self.cell, 100.0)?;
        positive("speed", self.speed, 100.0)?;
        positive("acceleration", self.acceleration, 1000.0)?;
        if self.drive == Drive::DiffDrive {
            positive("turn-rate", self.turn_rate, 100.0)?;
        }
        check_share("slip", self.slip)?;
        check_share("odometry-error", self.odometry_error)?;
        if !(10..=1000).contains(&self.tick_ms) {
            let expected = "10 to 1000 milliseconds";
            return Err(ScenarioError::setting("tick-ms", self.tick_ms, expected));
        }
        // It must not run past a cell unseen.
        let most = self.cell / (2.0 * self.speed) * 1000.0;
        if f64::from(self.tick_ms) > most {
            return Err(ScenarioError::setting(
                "tick-ms",
                self.tick_ms,
                format!(
                    "at most {:.0}, in which the robot goes half a cell; or a lower --speed",
                    most.floor()
                ),
            ));
        }
        let most = MOST_WIDTH * room(clearance) * self.cell;
        if !(self.radius > 0.0 && self.radius <= most) {
            return Err(ScenarioError::setting(
                "radius",
                self.radius,
                format!(
                    "more than 0 and at most {most:.3} metres, with cells of {} metres and \
                     --clearance {clearance}; or a larger clearance, or larger cells",
                    self.cell
                ),
            ));
        }
        Ok(())
    }
}

/// Seconds for a way with a largest speed, gained and lost at a rate.
fn from_rest_to_rest(way: f64, speed: f64, acceleration: f64) -> f64 {
    match way >= speed * speed / acceleration {
        true => way / speed + speed / acceleration,
        false => 2.0 * (way / acceleration).sqrt(),
    }
}

fn room(clearance: u8) -> f64 {
    ROOM[usize::from(clearance).min(ROOM.len() - 1)]
}

/// The kinds of motion on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A cell a tick.
    Unit,
    /// Two wheels, as a TurtleBot3 Burger.
    DiffDrive,
    /// To any side, as a drone.
    Omni,
}

/// The options that set a [`Motion`].
#[derive(Args, Clone)]
#[command(next_help_heading = "Bodies that move in metres and seconds")]
pub struct MotionArgs {
    /// How robots move: unit (a cell a tick), diff-drive (two wheels, as a TurtleBot3
    /// Burger), or omni (to any side, as a drone). The last two are discs that collide with
    /// walls and with each other.
    #[arg(long, value_name = "KIND", default_value = "unit")]
    motion: Kind,
    /// Largest speed in metres a second. Default: 0.22, omni 0.5.
    #[arg(long, value_name = "M/S")]
    speed: Option<f64>,
    /// Largest rate of turning in radians a second, of a differential drive. Default: 2.84.
    #[arg(long, value_name = "RAD/S")]
    turn_rate: Option<f64>,
    /// Metres a second gained or lost each second. Default: 1.
    #[arg(long, value_name = "M/S2")]
    acceleration: Option<f64>,
    /// Radius in metres. Default: four fifths of what fits --clearance, without it 0.4 cells.
    #[arg(long, value_name = "M")]
    radius: Option<f64>,
    /// Side of a cell in metres, where the map does not say it. Default: 0.5.
    #[arg(long, value_name = "M")]
    cell: Option<f64>,
    /// Milliseconds between two ticks of a planner, 10 to 1000. Default: 100.
    #[arg(long, value_name = "MS")]
    tick_ms: Option<u16>,
    /// Share of its way that a wheel, of a drone an axis, loses at most, unnoticed, 0 to 1.
    #[arg(long, value_name = "P")]
    slip: Option<f64>,
    /// Share by which odometry errs at most, for each wheel or axis, 0 to 1: poses drift.
    #[arg(long, value_name = "P")]
    odometry_error: Option<f64>,
}

impl MotionArgs {
    /// Whether bodies move in metres.
    pub fn is_given(&self) -> bool {
        self.motion != Kind::Unit
    }

    /// The motion of bodies with this clearance in a world; `None`: unit steps.
    ///
    /// # Errors
    /// An option that the kind of motion does not have, or that the map contradicts.
    pub fn motion(&self, world: &World, clearance: u8) -> Result<Option<Motion>, ScenarioError> {
        let drive = match self.motion {
            Kind::Unit => return self.unit(),
            Kind::DiffDrive => Drive::DiffDrive,
            Kind::Omni => Drive::Omni,
        };
        if drive == Drive::Omni && self.turn_rate.is_some() {
            return Err(ScenarioError::NoTurning);
        }
        let cell = match (world.metres_per_cell(), self.cell) {
            (Some(metres), Some(_)) => return Err(ScenarioError::CellOfMap { metres }),
            (known, given) => known.or(given).unwrap_or(CELL),
        };
        let usual = Motion::new(drive, cell, clearance);
        Ok(Some(Motion {
            speed: self.speed.unwrap_or(usual.speed),
            turn_rate: self.turn_rate.unwrap_or(usual.turn_rate),
            acceleration: self.acceleration.unwrap_or(usual.acceleration),
            radius: self.radius.unwrap_or(usual.radius),
            tick_ms: self.tick_ms.unwrap_or(usual.tick_ms),
            slip: self.slip.unwrap_or(usual.slip),
            odometry_error: self.odometry_error.unwrap_or(usual.odometry_error),
            ..usual
        }))
    }

    /// Unit steps have no further options.
    fn unit(&self) -> Result<Option<Motion>, ScenarioError> {
        let given = [
            ("speed", self.speed.is_some()),
            ("turn-rate", self.turn_rate.is_some()),
            ("acceleration", self.acceleration.is_some()),
            ("radius", self.radius.is_some()),
            ("cell", self.cell.is_some()),
            ("tick-ms", self.tick_ms.is_some()),
            ("slip", self.slip.is_some()),
            ("odometry-error", self.odometry_error.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(ScenarioError::OnlyInMotion(option)),
            None => Ok(None),
        }
    }
}
