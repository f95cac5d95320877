//! The command `host-sim`.

mod command;

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
    /// Write a map that is made from a seed.
    Generate(command::Generate),
}

fn main() -> ExitCode {
    let done = match Command::parse() {
        Command::Explore(explore) => explore.run(),
        #[cfg(unix)]
        Command::Firmware(firmware) => firmware.run(),
        Command::Generate(generate) => generate.run(),
    };
    done.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        ExitCode::from(2)
    })
}
