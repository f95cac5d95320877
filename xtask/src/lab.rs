//! The lab as a web page.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use miniz_oxide::deflate::compress_to_vec;

use crate::install;
use crate::shell::{cargo, command, root};

const TARGET: &str = "wasm32-unknown-unknown";

/// Builds the page into the folder `dist/`, which any file server can serve; returns its
/// size.
pub(crate) fn build_page() -> Result<String> {
    install::target(TARGET)?;
    let wasm_bindgen = install::wasm_bindgen(&locked_version("wasm-bindgen")?)?;
    cargo([
        "build",
        "-p=lab",
        "--lib",
        "--no-default-features",
        "--locked",
    ])
    .args(["--profile=web", "--target", TARGET])
    .run()?;
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
    let dist = root().join("dist");
    command(wasm_bindgen)
        .args(["--target=web", "--no-typescript", "--remove-name-section"])
        .args(["--out-name=lab", "--out-dir"])
        .arg(&dist)
        .arg(built.join(TARGET).join("web/lab.wasm"))
        .run()?;
    fs::copy(root().join("lab/index.html"), dist.join("index.html"))?;
    let program = fs::read(dist.join("lab_bg.wasm"))?;
    let compressed = compress_to_vec(&program, 9).len();
    Ok(format!(
        "dist/: {} KiB, compressed {} KiB",
        program.len() / 1024,
        compressed / 1024
    ))
}

/// The window's parts: state, replay, and what is on the screen.
pub(crate) fn window_works() -> Result<()> {
    // The optimised libraries of the other builds would take longer than the tests.
    cargo([
        "test",
        "-p=lab",
        "--no-default-features",
        "--locked",
        "--profile=dev",
    ])
    .run()
}

/// The page in a real browser.
pub(crate) fn page_works() -> Result<String> {
    install::chromium()?;
    let size = build_page()?;
    cargo([
        "test",
        "-p=lab",
        "--no-default-features",
        "--locked",
        "--profile=dev",
    ])
    .args(["--test=page", "--", "--ignored", "--test-threads=1"])
    .run()?;
    Ok(size)
}

/// The version of a package in Cargo.lock.
fn locked_version(package: &str) -> Result<String> {
    let lock = fs::read_to_string(root().join("Cargo.lock"))?;
    let entry = format!("name = \"{package}\"\nversion = \"");
    let version = lock
        .split_once(&entry)
        .and_then(|(_, rest)| rest.split('"').next());
    version
        .map(str::to_owned)
        .with_context(|| format!("Cargo.lock does not name {package}"))
}
