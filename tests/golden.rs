//! Golden traces: the decisions of a few whole explorations and surveys, bit for bit.
//!
//! `fixtures/golden.txt` and `fixtures/golden-surveys.txt` name the scenarios and their
//! digests. After a change that is meant to change decisions, `GOLDEN=refresh cargo test
//! --test golden` writes the files anew.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use clap::ValueEnum;
use host_sim::planners::PlannerKind;
use host_sim::run::{self, Options, run};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Conditions, MediumKind, heights, voxels};
use host_sim::terrain::TerrainSource;
use host_sim::world::{ReadOptions, World};

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
    let mut scenario = Scenario::new(world, starts, planner);
    scenario.conditions.medium = MediumKind::from_str(medium, false).unwrap();
    scenario.conditions.loss = loss.parse().unwrap();
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (outcome, trace) = run(&scenario, options).unwrap();
    format!("{} {}", outcome.ticks, trace.unwrap().digest())
}

/// Steps and digest of the scenario `terrain side planner robots medium loss kill`.
fn survey_of(scenario: &str) -> String {
    let fields: Vec<&str> = scenario.split_whitespace().collect();
    let [terrain, side, planner, robots, medium, loss, kill] = fields[..] else {
        panic!(
            "expected `terrain side planner robots medium loss kill`, or `-` for what there is not, found `{scenario}`"
        );
    };
    const SEED: u64 = 1;
    let (terrain, side): (TerrainSource, u16) = (terrain.parse().unwrap(), side.parse().unwrap());
    let robots = robots.parse().unwrap();
    let mut conditions = Conditions {
        medium: MediumKind::from_str(medium, false).unwrap(),
        loss: loss.parse().unwrap(),
        ..Conditions::flown(SEED)
    };
    if kill != "-" {
        conditions.faults.deaths.push(kill.parse().unwrap());
    }
    if let Some(scene) = terrain.scene(side) {
        assert_eq!(planner, "voxel-survey");
        let scenario = voxels::Scenario {
            range: 6,
            conditions,
            ..voxels::Scenario::new(robots, 0)
        };
        let trace = run::voxels::run(&scene, &scenario).unwrap();
        return format!("{} {}", trace.seen.len() - 1, trace.digest());
    }
    let planner = heights::Planner::from_str(planner, false).unwrap();
    let scenario = heights::Scenario {
        conditions,
        ..heights::Scenario::new(planner, robots, SEED)
    };
    let trace = run::heights::run(&terrain.load(side).unwrap(), &scenario).unwrap();
    format!("{} {}", trace.seen.len() - 1, trace.digest())
}

/// Compares every line of `file` with what `trace_of` makes of its scenario, or writes
/// it anew.
fn check(file: &str, trace_of: impl Fn(&str) -> String) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fixtures")
        .join(file);
    let golden = std::fs::read_to_string(&file).unwrap();
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
            "{scenario}: length and digest were {expected}, now {found}; if that is meant: GOLDEN=refresh cargo test --test golden"
        );
        writeln!(fresh, "{scenario} = {found}").unwrap();
    }
    if refresh {
        std::fs::write(file, fresh).unwrap();
    }
}

#[test]
fn explorations_are_those_of_the_golden_traces() {
    check("golden.txt", trace_of);
}

#[test]
fn surveys_are_those_of_the_golden_traces() {
    check("golden-surveys.txt", survey_of);
}
