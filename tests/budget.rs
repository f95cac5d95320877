//! The sizes of whole planners against `fixtures/budget.txt`.

#[allow(dead_code, unreachable_pub)]
#[path = "../xtask/src/budget.rs"]
mod file;

use std::path::Path;

use planner_core::explorer::Explorer;

#[test]
fn planners_fit_their_budget() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let budget = file::Budget::read(root).unwrap_or_else(|error| panic!("{error}"));
    let measured = [
        ("explorer_64x64_bytes", size_of::<Explorer<8, 8>>() as u64),
        (
            "explorer_128x128_bytes",
            size_of::<Explorer<16, 16>>() as u64,
        ),
    ];
    if let Err(error) = budget.check("explorer_", &measured) {
        panic!("{error}");
    }
}
