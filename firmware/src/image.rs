//! One robot on the built-in map.

use core::fmt::{self, Write as _};

use cortex_m_rt::entry;
use cortex_m_semihosting::hio;
use firmware::{Ending, Exploration, World, end, explore, stack};
use planner_core::ExtentError;
use planner_core::explorer::{Config, Explorer};
use planner_core::{Planner, RobotId};
use static_cell::ConstStaticCell;

/// The planner of a map of 128×128 cells, whatever the size of the built-in one:
/// the report then tells what the largest map takes.
type Robot = Explorer<16, 16>;

/// The robot's whole memory: all zero, so that it lies in `.bss` and is never
/// copied through the stack.
static ROBOT: ConstStaticCell<Robot> = ConstStaticCell::new(Robot::vacant());

static WORLD: World = World::parse(include_str!("../../fixtures/maps/ward.txt"));

/// How far the robot sees, in cells.
const RANGE: u8 = 5;

#[entry]
fn main() -> ! {
    match run() {
        Ok(ending) => end(ending),
        Err(fmt::Error) => panic!("the host does not take the report; enable semihosting"),
    }
}

fn run() -> Result<Ending, fmt::Error> {
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    let robot = match prepare() {
        Ok(robot) => robot,
        Err(error) => {
            writeln!(out, "error: {error}")?;
            return Ok(Ending::Failure);
        }
    };
    let exploration = explore(robot, &WORLD, RANGE);
    report(&mut out, robot, &exploration)?;
    Ok(match exploration.stop {
        Some(stop) if stop.is_complete() => Ending::Success,
        _ => Ending::Failure,
    })
}

/// Sets the planner up. A function of its own, as [`report`] is.
#[inline(never)]
fn prepare() -> Result<&'static mut Robot, ExtentError> {
    let robot = ROBOT.take();
    robot.reset(Config::new(), RobotId(0), WORLD.extent(), WORLD.start())?;
    Ok(robot)
}

/// Prints the map, then one `key: value` a line: `cargo xtask` reads them. A function of
/// its own: its buffers are not on the stack while the robot explores.
#[inline(never)]
fn report(out: &mut impl fmt::Write, robot: &Robot, exploration: &Exploration) -> fmt::Result {
    let &Exploration {
        ticks,
        steps,
        work,
        stop,
    } = exploration;
    writeln!(out, "{:?}", robot.map())?;
    match stop {
        Some(stop) => writeln!(out, "stop: {stop}")?,
        None => writeln!(out, "stop: none within {ticks} ticks")?,
    }
    writeln!(out, "ticks: {ticks}")?;
    writeln!(out, "steps: {steps}")?;
    writeln!(out, "largest work per tick: {work}")?;
    writeln!(out, "planner bytes: {}", size_of::<Robot>())?;
    writeln!(out, "peak stack bytes: {}", stack::peak())?;
    writeln!(out, "stack bytes: {}", stack::size())
}
