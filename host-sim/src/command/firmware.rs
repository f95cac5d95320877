//! `host-sim firmware`.

use std::path::PathBuf;

use clap::Args;
use host_sim::chip::{Machine, Swarm};

use super::{Done, Explore};

#[derive(Args)]
pub(crate) struct Firmware {
    #[command(flatten)]
    explore: Explore,
    /// The board that QEMU emulates.
    #[arg(long, value_name = "NAME", default_value = "netduinoplus2")]
    machine: Machine,
    /// The image. Default: what `cargo xtask build-firmware` has built for the machine.
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
}

impl Firmware {
    pub(crate) fn run(self) -> Done {
        if self.explore.has_key() {
            return Err(
                "--key: the image is built without keys; explore, and robot, sign frames".into(),
            );
        }
        if self.explore.has_motion() {
            return Err(
                "--motion: emulated chips make unit steps; explore moves bodies in metres".into(),
            );
        }
        if let Some(option) = self.explore.limit() {
            return Err(
                format!("--{option}: the image is told of no such cells; explore is").into(),
            );
        }
        if let Some(option) = self.explore.of_saves() {
            return Err(format!("--{option}: the image saves nothing; explore does").into());
        }
        let image = self.image.unwrap_or_else(|| self.machine.image());
        let swarm = Swarm::new(self.machine, image);
        self.explore.run_by(|scenario, options| {
            let (outcome, trace) = swarm.explore(scenario, options)?;
            Ok((outcome, trace, Some(swarm.finish()?)))
        })
    }
}
