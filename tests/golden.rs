//! Golden traces: the decisions of a few whole explorations, bit for bit.
//!
//! `fixtures/golden.txt` names the scenarios and their digests. After a change
//! that is meant to change decisions, `GOLDEN=refresh cargo test --test golden`
//! writes the file anew.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use clap::ValueEnum;
use host_sim::medium::MediumKind;
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Scenario, run};
use host_sim::world::{ReadOptions, World};

fn file() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/golden.txt")
}

/// Ticks and digest of the scenario `map planner robots medium loss`.
fn trace_of(scenario: &str) -> String {
    let fields: Vec<&str> = scenario.split_whitespace().collect();
    let [map, planner, robots, medium, loss] = fields[..] else {
        panic!("expected `map planner robots medium loss`, found `{scenario}`");
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fixtures/maps")
        .join(map);
    let world = Arc::new(World::read(path, &ReadOptions::default()).unwrap());
    let robots = robots.parse().unwrap();
    let starts = world.place(robots, &world.default_starts(), false).unwrap();
    let planner = PlannerKind::from_str(planner, false).unwrap();
    let scenario = Scenario {
        medium: MediumKind::from_str(medium, false).unwrap(),
        loss: loss.parse().unwrap(),
        ..Scenario::new(world, starts, planner)
    };
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (outcome, trace) = run(&scenario, options).unwrap();
    format!("{} {}", outcome.ticks, trace.unwrap().digest())
}

#[test]
fn decisions_are_those_of_the_golden_traces() {
    let golden = std::fs::read_to_string(file()).unwrap();
    let refresh = std::env::var_os("GOLDEN").is_some();
    let mut fresh = String::new();
    for line in golden.lines() {
        if line.starts_with('#') || line.is_empty() {
            writeln!(fresh, "{line}").unwrap();
            continue;
        }
        let (scenario, expected) = line.split_once(" = ").unwrap();
        let found = trace_of(scenario);
        assert!(
            refresh || found == expected,
            "{scenario}: ticks and digest were {expected}, now {found}; if that is meant: GOLDEN=refresh cargo test --test golden"
        );
        writeln!(fresh, "{scenario} = {found}").unwrap();
    }
    if refresh {
        std::fs::write(file(), fresh).unwrap();
    }
}
