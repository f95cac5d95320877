//! The Cortex-M image.
fn main() {}
