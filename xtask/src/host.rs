//! Tests and programs for the machine at hand.
//!
//! All of them are built in one way: for another choice of packages or features, Cargo
//! would compile the simulator and half of what it depends on once more. Without default
//! features, the lab has no window; it needs none for its tests. The tools of the checks
//! stay out: one of them asks serde_json to keep all digits of numbers, and then it reads
//! those of flattened settings otherwise than the programs that people build.

use std::path::PathBuf;

use anyhow::Result;

use crate::shell::{Command, cargo, root};

const WAY: [&str; 5] = [
    "--workspace",
    "--exclude=xtask-tools",
    "--no-default-features",
    "--features=host-sim/parquet,host-sim/mcap",
    "--locked",
];

/// `cargo test`, for whatever tests are then chosen.
pub(crate) fn test() -> Command {
    cargo(["test"]).args(WAY)
}

/// Builds host-sim and its examples as its tests use them; returns their folder.
pub(crate) fn build_simulator() -> Result<PathBuf> {
    cargo(["build"])
        .args(WAY)
        .args(["--profile=test", "--bin=host-sim", "--examples"])
        .run()?;
    Ok(built().join("debug"))
}

/// Where Cargo puts what it builds.
pub(crate) fn built() -> PathBuf {
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
    root().join(folder)
}
