//! A robot fed arbitrary frames between its ticks: see `hostile.rs`.
#![no_main]

#[path = "../src/hostile.rs"]
mod hostile;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|script: &[u8]| hostile::explore(script));
