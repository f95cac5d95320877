//! What Cargo cannot say by itself: every check in one command, the image for
//! the chip, long runs. `cargo xtask --help` tells more.

/// In place of the standard library's, which panics when nobody reads any more, and
/// which cannot be kept: see [`output`].
macro_rules! println {
    ($($words:tt)*) => { print!("{}\n", format_args!($($words)*)) };
}

/// See [`println!`].
macro_rules! print {
    ($($words:tt)*) => {
        crate::output::write(format!($($words)*).as_bytes(), std::io::stdout())
    };
}

/// See [`println!`].
macro_rules! eprintln {
    ($($words:tt)*) => { eprint!("{}\n", format_args!($($words)*)) };
}

/// See [`println!`].
macro_rules! eprint {
    ($($words:tt)*) => {
        crate::output::write(format!($($words)*).as_bytes(), std::io::stderr())
    };
}

mod budget;
mod c_interface;
mod c_library;
mod c_stack;
mod checks;
mod crazyflie;
mod documents;
mod embassy;
mod figures;
mod firmware;
mod fuzz;
mod host;
mod install;
mod lab;
mod lines;
mod notices;
mod output;
mod ros;
mod shell;
mod site;
mod slurm;
mod tools;
mod worst;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Checks, builds and long runs of this project.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Runs every check, and installs what it needs for that.
    ///
    /// Rust targets, Miri, cargo-fuzz and QEMU are installed when they are missing. Where
    /// that is not possible, the check fails and prints the command to run.
    /// All checks run, also after one has failed.
    Test {
        /// Runs only this check; may be given several times.
        #[arg(long, value_name = "CHECK", value_parser = checks::named)]
        only: Vec<&'static checks::Check>,

        /// Lists the checks and runs none.
        #[arg(long)]
        list: bool,
    },
    /// Builds the images for a chip; prints their path, flash and static RAM.
    BuildFirmware {
        /// The board, by QEMU's name of it.
        #[arg(long, value_name = "NAME", default_value = "netduinoplus2")]
        machine: firmware::Machine,
    },
    /// Builds the image and runs it in QEMU (an emulated STM32F405).
    RunFirmware,
    /// Fuzzes radio, robot and readers of files: each target for so many seconds.
    Fuzz {
        /// For how long, each.
        #[arg(long, value_name = "N", default_value_t = 600)]
        seconds: u32,
    },
    /// Holds the figures in the documents against what their commands say.
    FiguresHold(figures::Options),
    /// Builds the lab as a web page into dist/, for any file server.
    LabWeb,
    /// Builds the book, the documentation of the code and the lab's page into site/.
    Site,
    /// Writes the licences of all that the programs embed, dist/THIRD-PARTY.md.
    Notices,
    /// Writes the header of the C interface, c-api/include/planner.h.
    CHeader,
    /// Builds the library for C as one object; prints its path.
    CLibrary {
        /// The processor, by Rust's name of it; `hf` has a floating-point unit.
        #[arg(long, value_name = "NAME", default_value = firmware::TARGET, value_parser = c_library::TARGETS)]
        target: String,
        /// Largest width and height of a map, in cells.
        #[arg(long, value_name = "N", default_value = "128")]
        cells: c_library::Cells,
    },
    /// Counts the lines of code of each package, without comments, blank lines and tests.
    Lines {
        /// Where to count.
        #[arg(default_value = ".")]
        folder: PathBuf,
    },
    /// Explores random small worlds until one of them goes wrong.
    Soak {
        /// How many worlds.
        #[arg(long, value_name = "N", default_value_t = 100_000)]
        runs: u64,
        /// In the simulator, where worlds mislead: looks err, poses slip, people and doors
        /// are in the way. Wrong is only a robot that never stops.
        #[arg(long)]
        misled: bool,
    },
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::Test { list: true, .. } => {
            checks::list();
            Ok(())
        }
        Task::Test { only, .. } => checks::run(&only),
        Task::BuildFirmware { machine } => firmware::build_images(machine)
            .map(|images| images.iter().for_each(|image| println!("{image}"))),
        Task::RunFirmware => firmware::build_and_run(),
        Task::Fuzz { seconds } => fuzz::run(seconds).map(drop),
        Task::FiguresHold(options) => figures::hold(&options).map(|remark| println!("{remark}")),
        Task::LabWeb => lab::build_page().map(|size| println!("{size}")),
        Task::Site => site::build().map(|holds| println!("{holds}")),
        Task::Notices => notices::write().map(|crates| println!("{crates}")),
        Task::CHeader => c_interface::write_header(),
        Task::CLibrary { target, cells } => c_library::build_and_tell(&target, cells),
        Task::Lines { folder } => lines::print(&folder),
        Task::Soak { runs, misled } => soak(runs, misled),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn soak(runs: u64, misled: bool) -> anyhow::Result<()> {
    let test = shell::cargo(["test", "--release"]);
    let test = match misled {
        true => test.args(["-p", "host-sim", "--test", "trouble", "--", "every_misled"]),
        false => test.args(["-p", "planner-core", "--lib", "--", "every_robot"]),
    };
    test.env("PROPTEST_CASES", runs.to_string()).run()?;
    println!("{runs} worlds, and none went wrong");
    Ok(())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }
}
