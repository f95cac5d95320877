//! Gives the image its memory layout.
//!
//! The linker's arguments are passed from here, not from `.cargo/config.toml`:
//! those vanish as soon as anybody sets `RUSTFLAGS`, and the image then links
//! without a vector table.

use std::path::Path;
use std::{env, fs};

const LAYOUT: &str = "../memory-layout.x";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={LAYOUT}");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os != "none") {
        return;
    }
    let out = env::var("OUT_DIR").expect("Cargo sets OUT_DIR");
    fs::copy(LAYOUT, Path::new(&out).join("memory.x"))
        .unwrap_or_else(|error| panic!("{LAYOUT}, the memory layout of the image: {error}"));
    println!("cargo::rustc-link-search={out}");
    println!("cargo::rustc-link-arg=-Tlink.x");
    // Sections need no alignment to pages: there are none.
    println!("cargo::rustc-link-arg=--nmagic");
}
