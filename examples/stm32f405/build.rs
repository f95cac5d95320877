//! Gives the image the memory layout of the chip, and defmt its section.

use std::path::Path;
use std::{env, fs};

/// In a copy of this folder, and in the planner's own repository.
const LAYOUTS: [&str; 2] = ["memory-layout.x", "../../memory-layout.x"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os != "none") {
        return;
    }
    let out = env::var("OUT_DIR").expect("Cargo sets OUT_DIR");
    let layout = LAYOUTS
        .into_iter()
        .find(|layout| Path::new(layout).exists());
    let layout = layout.expect("copy memory-layout.x, the memory layout of the image, here");
    println!("cargo::rerun-if-changed={layout}");
    fs::copy(layout, Path::new(&out).join("memory.x"))
        .unwrap_or_else(|error| panic!("{layout}, the memory layout of the image: {error}"));
    println!("cargo::rustc-link-search={out}");
    // Without DEFMT_LOG, defmt leaves out all logs but errors.
    println!("cargo::rerun-if-env-changed=DEFMT_LOG");
    if env::var_os("DEFMT_LOG").is_none() {
        println!("cargo::rustc-env=DEFMT_LOG=debug");
    }
    for argument in ["-Tlink.x", "-Tdefmt.x", "--nmagic"] {
        println!("cargo::rustc-link-arg={argument}");
    }
}
