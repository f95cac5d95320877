//! `host-sim generate`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use host_sim::world::{Family, Recipe};
use planner_core::Extent;

use super::Done;

#[derive(Args)]
pub(crate) struct Generate {
    /// Kind of world.
    family: Family,
    /// Width and height in cells, for example 64x48.
    #[arg(long, value_name = "WxH", default_value = "64x64", value_parser = parse_size)]
    size: Extent,
    /// Same seed, same world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// File to write: .png, .pgm, .map (MovingAI) or .txt.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Side of a cell in the pixels of an image.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pixels_per_cell: u32,
}

impl Generate {
    pub(crate) fn run(self) -> Done {
        let world = Recipe::new(self.family, self.size, self.seed).generate()?;
        world.write(&self.output, self.pixels_per_cell)?;
        println!(
            "{}: {}, {} cells, {} of them free",
            self.output.display(),
            world.name(),
            world.extent(),
            world.free_cells().count()
        );
        Ok(ExitCode::SUCCESS)
    }
}

pub(super) fn parse_size(text: &str) -> Result<Extent, String> {
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some(Extent::new(width.parse().ok()?, height.parse().ok()?)))
        .ok_or_else(|| "expected WIDTHxHEIGHT in cells, for example 64x48".into())
}
