//! Gives the image its memory layout, by the target.
//!
//! The linker's arguments are passed from here, not from `.cargo/config.toml`:
//! those vanish as soon as anybody sets `RUSTFLAGS`, and the image then links
//! without a vector table.

use std::path::Path;
use std::{env, fs};

/// Target, the board that it stands for, and the board's memory layout.
const BOARDS: [(&str, &str, &str); 3] = [
    ("thumbv7em-none-eabihf", "stm32f405", "../memory-layout.x"),
    ("thumbv7m-none-eabi", "mps2-an385", "layouts/mps2-an385.x"),
    ("thumbv6m-none-eabi", "microbit", "layouts/microbit.x"),
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!(r#"cargo::rustc-check-cfg=cfg(board, values("stm32f405", "mps2-an385", "microbit"))"#);
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os != "none") {
        return;
    }
    let target = env::var("TARGET").expect("Cargo sets TARGET");
    let Some((_, board, layout)) = BOARDS.iter().find(|(of, ..)| *of == target) else {
        let known = BOARDS.map(|(target, ..)| target).join(", ");
        panic!("no memory layout for {target}; firmware/build.rs knows {known}");
    };
    println!(r#"cargo::rustc-cfg=board="{board}""#);
    println!("cargo::rerun-if-changed={layout}");
    let out = env::var("OUT_DIR").expect("Cargo sets OUT_DIR");
    fs::copy(layout, Path::new(&out).join("memory.x"))
        .unwrap_or_else(|error| panic!("{layout}, the memory layout of the image: {error}"));
    println!("cargo::rustc-link-search={out}");
    println!("cargo::rustc-link-arg=-Tlink.x");
    // Sections need no alignment to pages: there are none.
    println!("cargo::rustc-link-arg=--nmagic");
}
