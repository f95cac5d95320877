//! Firmware in the loop: emulated chips decide what the host decides.
//!
//! These tests need QEMU and the images, which `cargo xtask test --only loop`
//! provides; it also holds what they print against `fixtures/budget.txt`.
#![cfg(unix)]

mod endings;
mod explorations;
mod surveys;
mod voxels;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use host_sim::chip::Machine;
use host_sim::measured::{Call, Measured};

/// An image that `cargo xtask` has built for the machine.
fn image(machine: Machine, name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    root.join(machine.image()).with_file_name(name)
}

/// The largest of each figure, by the name of its limit in `fixtures/budget.txt`.
#[derive(Default)]
struct Largest(BTreeMap<String, u64>);

impl Largest {
    fn note(&mut self, name: String, value: u64) {
        let largest = self.0.entry(name).or_default();
        *largest = value.max(*largest);
    }

    /// Notes what a planner of the image `robot` took for some of its calls, and the image.
    fn take(&mut self, planner: &str, calls: &[Call], measured: &Measured) {
        self.take_calls(planner, calls, measured);
        self.take_image("", measured);
    }

    /// Notes what a planner took for some of its calls.
    fn take_calls(&mut self, planner: &str, calls: &[Call], measured: &Measured) {
        for call in calls {
            if let Some(tally) = measured.calls.get(call) {
                self.note(format!("loop_{planner}_{call}_instructions"), tally.largest);
                let stack = tally.stack_bytes.into();
                self.note(format!("loop_{planner}_stack_bytes"), stack);
            }
        }
    }

    /// Notes what an image takes, whose limits have that prefix.
    fn take_image(&mut self, prefix: &str, measured: &Measured) {
        let bytes = [
            ("flash", measured.flash_bytes),
            ("static", measured.static_bytes),
        ];
        for (name, size) in bytes {
            self.note(format!("loop_{prefix}{name}_bytes"), size.into());
        }
    }

    /// Prints `name: value` lines, which `cargo xtask test` reads.
    fn print(&self) {
        println!();
        for (name, value) in &self.0 {
            println!("{name}: {value}");
        }
    }
}
