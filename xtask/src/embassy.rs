//! The example on embassy, a workspace of its own: built for both of its chips.

use std::path::PathBuf;

use anyhow::Result;

use crate::shell::{Command, cargo};
use crate::{firmware, host, install};

/// Chips, each with its target.
const CHIPS: [(&str, &str); 2] = [
    ("nrf52840", firmware::TARGET),
    ("rp2040", "thumbv6m-none-eabi"),
];

/// Both images link with the memory layouts of their chips. Returns the flash that they take.
pub(crate) fn links() -> Result<String> {
    in_example(cargo(["fmt", "--all", "--check"])).run()?;
    let mut said = Vec::new();
    for (chip, target) in CHIPS {
        install::target(target)?;
        in_example(cargo(["build", "--release", "--locked", "-p", chip]))
            .args(["--target", target, "--target-dir"])
            .arg(folder())
            .run()?;
        let flash = firmware::flash(&folder().join(target).join("release").join(chip))?;
        said.push(format!("{chip} {flash} bytes"));
    }
    Ok(format!("flash: {}", said.join(", ")))
}

fn in_example(command: Command) -> Command {
    command.arg("--manifest-path=examples/embassy/Cargo.toml")
}

fn folder() -> PathBuf {
    host::built().join("embassy")
}
