//! The lab as a web page.

use std::fs;

use anyhow::Result;
use miniz_oxide::deflate::compress_to_vec;

use crate::firmware::{self, Machine};
use crate::shell::{cargo, root};
use crate::{host, install, tools};

const TARGET: &str = "wasm32-unknown-unknown";

/// The files of the page, in `dist/`.
pub(crate) const PAGE: [&str; 3] = ["index.html", "lab.js", "lab_bg.wasm"];

/// Builds the page into the folder `dist/`, which any file server can serve; returns its
/// size.
pub(crate) fn build_page() -> Result<String> {
    install::target(TARGET)?;
    cargo([
        "build",
        "-p=lab",
        "--lib",
        "--no-default-features",
        "--locked",
    ])
    .args(["--profile=web", "--target", TARGET])
    .run()?;
    let dist = root().join("dist");
    let program = host::built().join(TARGET).join("web/lab.wasm");
    tools::run("page", [&program, &dist])?;
    fs::copy(root().join("lab/index.html"), dist.join("index.html"))?;
    let program = fs::read(dist.join("lab_bg.wasm"))?;
    let compressed = compress_to_vec(&program, 9).len();
    Ok(format!(
        "dist/: {} KiB, compressed {} KiB",
        program.len() / 1024,
        compressed / 1024
    ))
}

/// The window; what is behind it is tested with all other crates.
pub(crate) fn window_works() -> Result<()> {
    host::test().arg("--test=window").run()
}

/// The page in a real browser, beside the command and emulated chips.
pub(crate) fn page_works() -> Result<String> {
    install::chromium()?;
    install::qemu()?;
    let size = build_page()?;
    firmware::build_images(Machine::Netduinoplus2)?;
    let simulator = host::build_simulator()?.join("host-sim");
    host::test()
        .args(["--test=page", "--", "--ignored", "--test-threads=1"])
        // Measurements and pictures prove nothing.
        .args(["--skip=crowd", "--skip=pictures", "--skip=the_site"])
        .env("HOST_SIM", simulator.display().to_string())
        .run()?;
    Ok(size)
}
