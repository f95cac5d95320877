//! The subcommands: from arguments to the library and back.

mod compare;
mod explore;
mod figures;
#[cfg(unix)]
mod firmware;
mod folder;
mod generate;
mod live;
mod output;
mod replay_scans;
mod report;
mod survey;

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

pub(crate) use compare::Compare;
pub(crate) use explore::Explore;
pub(crate) use figures::Figures;
#[cfg(unix)]
pub(crate) use firmware::Firmware;
pub(crate) use generate::Generate;
pub(crate) use live::{Robot, World};
pub(crate) use replay_scans::ReplayScans;
pub(crate) use survey::Survey;

/// Tells the user what there is to say about how a map was read.
fn tell_notes(path: &Path, world: &host_sim::world::World) {
    for note in world.notes() {
        eprintln!("note: {}: {note}", path.display());
    }
}

/// The error for an option that another build of the program has.
fn left_out(option: &str, feature: &str) -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!(
        "{option} was left out of this program; run `cargo run --release --features {feature} \
         -- {}`",
        arguments.join(" ")
    )
}

/// The exit status, or what is wrong with the input.
type Done = Result<ExitCode, Box<dyn Error>>;
