//! The package `xtask-tools`: what few of the checks need, and what takes longer to
//! compile than all of this program.

use std::ffi::OsString;
use std::sync::Once;

use anyhow::{Result, bail};

use crate::shell::cargo;

/// Runs one of the tools; returns what it prints.
pub(crate) fn run<A: Into<OsString>>(
    tool: &str,
    arguments: impl IntoIterator<Item = A>,
) -> Result<String> {
    static BUILT: Once = Once::new();
    let package = ["-p=xtask-tools", "--locked"];
    let mut built = Ok(());
    BUILT.call_once(|| {
        println!("Compiling the tools for the page, logs and the header; minutes the first time.");
        built = cargo(["build"]).args(package).run();
    });
    built?;
    let run = cargo(["run", "--quiet"]).args(package);
    let output = run.arg("--").arg(tool).args(arguments).output()?;
    if !output.success() {
        bail!("{tool}: {}", output.stderr);
    }
    Ok(output.stdout)
}
