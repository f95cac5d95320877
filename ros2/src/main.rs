//! Explores, as a ROS 2 node; docs/ros2.md has its topics and parameters.

mod arguments;
mod drive;
mod geometry;
mod nav2;
mod node;
mod parameters;
mod robot;
mod sight;
mod views;

use std::error::Error;
use std::process::ExitCode;

use arguments::Arguments;
use parameters::Parameters;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("explore: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let words = std::env::args().skip(1);
    let arguments = Arguments::parse(words, |path| std::fs::read_to_string(path))?;
    let (parameters, notes) = Parameters::read(arguments.parameters.clone())?;
    for note in arguments.notes.iter().chain(&notes) {
        eprintln!("[{}]: {note}", arguments.node());
    }
    node::run(&arguments, parameters)?;
    Ok(())
}
