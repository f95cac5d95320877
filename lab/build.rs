//! Gives the page a stack that a planner among voxels fits on: the usual MiB does not do.

/// In bytes.
const STACK: usize = 4 << 20;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = std::env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    if target == "wasm32" {
        println!("cargo::rustc-link-arg-cdylib=-zstack-size={STACK}");
    }
}
