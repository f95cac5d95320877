//! Where the results of a run go, as options of every command that runs one.

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::folder::{Folder, FolderError};

/// Options of the results.
#[derive(Args)]
pub(super) struct OutputArgs {
    /// Folder for pictures, trace and summary. Default: out/ and the map's name.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the summary as one JSON object.
    #[arg(long)]
    pub(super) json: bool,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

impl OutputArgs {
    /// The folder for what is run in the world of this name.
    pub(super) fn folder(&self, world: &str) -> Result<Folder, FolderError> {
        let out = self.out.clone();
        Folder::open(out.unwrap_or_else(|| PathBuf::from("out").join(world)))
    }

    /// A bar for so many things to see, called `things`.
    pub(super) fn bar(&self, all: u32, things: &str) -> ProgressBar {
        if self.json || self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let style = format!(
            "{{spinner}} {{percent:>3}} % {{wide_bar}} {{pos}}/{{len}} {things} seen, {{msg}} [{{elapsed}}]"
        );
        ProgressBar::new(all.into())
            .with_style(ProgressStyle::with_template(&style).expect("the template is well-formed"))
    }
}
