//! The command `host-sim`.

#[macro_use]
mod output;
mod command;
mod interrupt;

use std::process::ExitCode;

use clap::Parser;

/// Robot swarms that explore unknown maps, simulated tick by tick.
#[derive(Parser)]
#[command(name = "host-sim", version)]
enum Command {
    /// Let robots explore a map; leaves pictures, the trace and a summary.
    ///
    /// Exit status: 0 every reachable cell was seen, 1 something was left, 2
    /// bad input.
    Explore(command::Explore),
    /// The same with every robot's planner on an emulated chip of its own.
    ///
    /// Decides what `explore` decides, and tells what it takes of the chip.
    /// Exit status: as of `explore`.
    #[cfg(unix)]
    Firmware(command::Firmware),
    /// Run planners in many worlds and compare them with a reference, in pairs.
    Compare(command::Compare),
    /// Draw the figures of the papers anew, with a page that shows them.
    Figures(command::Figures),
    /// Map an unknown surface with flying robots.
    ///
    /// Exit status: 0 every column was seen, 1 something was left, 2 bad input.
    Survey(command::Survey),
    /// Feed logs of real scans through a planner's map; draw what it believes beside the
    /// vote of all beams.
    ReplayScans(command::ReplayScans),
    /// Write a map that is made from a seed.
    Generate(command::Generate),
    /// Serve a map to robots that are processes of their own.
    ///
    /// Exit status: 0 every reachable cell was seen and every robot has stopped,
    /// 1 something was left, 2 bad input.
    World(command::World),
    /// Be one robot in a served world; talks to the others by UDP.
    Robot(command::Robot),
}

fn main() -> ExitCode {
    interrupt::leave_no_half_files();
    let command = match Command::try_parse() {
        Ok(command) => command,
        Err(words) => return explain(&words),
    };
    let done = match command {
        Command::Explore(explore) => explore.run(),
        #[cfg(unix)]
        Command::Firmware(firmware) => firmware.run(),
        Command::Compare(compare) => compare.run(),
        Command::Figures(figures) => figures.run(),
        Command::Survey(survey) => survey.run(),
        Command::ReplayScans(replay) => replay.run(),
        Command::Generate(generate) => generate.run(),
        Command::World(world) => world.run(),
        Command::Robot(robot) => robot.run(),
    };
    done.and_then(|status| Ok(output::close().map(|()| status)?))
        .unwrap_or_else(|error| {
            eprintln!("error: {error}");
            ExitCode::from(2)
        })
}

/// Prints the help that was asked for, or what is wrong with the arguments.
fn explain(words: &clap::Error) -> ExitCode {
    match (words.exit_code(), words.print()) {
        (0, Err(error)) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            eprintln!("error: standard output cannot be written: {error}");
            ExitCode::from(2)
        }
        (status, _) => ExitCode::from(status as u8),
    }
}
