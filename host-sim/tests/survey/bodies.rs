//! Over heights, with robots that have a width.

use std::collections::HashSet;

use host_sim::record::heights::Trace;
use host_sim::run::heights::run;
use host_sim::scenario::Wind;
use host_sim::scenario::heights::{Planner, Scenario, clearance_for};
use host_sim::summary::heights::Summary;
use host_sim::terrain::Terrain;
use planner_core::surface::Height;
use planner_core::{Cell, Extent, Point, Stop};
use proptest::prelude::*;

use crate::heights::{ALL, OWN};
use crate::visible::visible;

/// Whether a ball about `at` reaches into the ground of some column.
fn touches(terrain: &Terrain, at: Point, radius: f32) -> bool {
    let reach = radius as i16 + 1;
    let middle = at.cell();
    let columns = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
    columns
        .map(|(dx, dy)| Cell::new(middle.x + dx, middle.y + dy))
        .filter_map(|cell| Some((cell, terrain.height(cell)?)))
        .any(|(cell, ground)| {
            let (west, north) = (f32::from(cell.x), f32::from(cell.y));
            let dx = at.x - at.x.clamp(west, west + 1.0);
            let dy = at.y - at.y.clamp(north, north + 1.0);
            let dz = at.z - at.z.min(ground.cells());
            (dx * dx + dy * dy + dz * dz).sqrt() < radius - 1e-3
        })
}

/// No ball of that radius touches the ground or another one wherever one is, and all are over
/// the terrain. A trace that was written and read is the same.
fn check(trace: &Trace, radius: f32) {
    let Extent { width, height } = trace.extent;
    for robot in 0..trace.robots {
        let way = trace.way(robot, u32::MAX);
        for pair in way.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            for share in (0..=20u8).map(|i| f32::from(i) / 20.0) {
                let part = |from: f32, to: f32| from + (to - from) * share;
                let at = Point::new(part(from.x, to.x), part(from.y, to.y), part(from.z, to.z));
                assert!(!touches(&trace.terrain, at, radius), "{robot} at {at:?}");
                assert!(radius <= at.x && at.x <= f32::from(width) - radius);
                assert!(radius <= at.y && at.y <= f32::from(height) - radius);
            }
        }
    }
    assert_eq!(trace.safety, Default::default());
    let mut file = Vec::new();
    trace.write(&mut file).unwrap();
    let read = Trace::read(file.as_slice()).unwrap();
    assert_eq!(read.scenario, trace.scenario);
    assert_eq!((&read.seen, read.safety), (&trace.seen, trace.safety));
}

/// Hills with slopes of 26 degrees, and flat tops.
fn gentle(side: u16) -> Terrain {
    Terrain::from_fn(Extent::new(side, side), |cell| {
        let away = (cell.x % 24 - 12).abs().max((cell.y % 24 - 12).abs());
        Height(2 * (10 - away.clamp(2, 10)) as u8)
    })
}

/// Alone and in fleets, with all planners: wide robots see all of a terrain whose slopes they
/// see down, touch nothing on the way, and come home in time.
#[test]
fn wide_robots_see_all_and_touch_nothing() {
    for (seed, planner) in (0..).zip(ALL) {
        for (clearance, robots, energy) in [(1, 3, 0), (2, 1, 90), (3, 2, 0)] {
            let mut scenario = Scenario::new(planner, robots, seed).with_clearance(clearance);
            scenario.conditions.mission.come_home = true;
            scenario.conditions.mission.energy = energy;
            let trace = run(&gentle(36), &scenario).unwrap();
            let case = format!("{planner} {clearance} {robots}: {:?}", trace.stops);
            check(&trace, f32::from(clearance));
            assert!(trace.all_stopped, "{case}");
            assert!(energy > 0 || trace.complete(), "{case}");
            let summary = Summary::new(&trace);
            assert!(
                summary.robots.iter().all(|robot| robot.flown.is_home),
                "{case}"
            );
        }
    }
    let clearances = [0.0, 0.1, 1.0, 1.1, 3.0, 3.1].map(clearance_for);
    assert_eq!(
        clearances,
        [Some(0), Some(1), Some(1), Some(2), Some(3), None]
    );
}

/// The slope that a scenario says is about the one from which on wide robots take long.
#[test]
fn wide_robots_are_fast_on_slopes_that_they_see() {
    let steps = |slope: f32, clearance, range| {
        // Waves of hills, whose heights are quarters of a cell.
        let terrain = Terrain::from_fn(Extent::new(48, 48), |cell| {
            let away = (cell.x % 24 - 12).abs();
            Height((4.0 * slope * f32::from(away)) as u8)
        });
        let mut scenario = Scenario::new(Planner::CoordinatedSurvey, 2, 1);
        scenario = scenario.with_clearance(clearance);
        scenario.limits.range = range;
        let trace = run(&terrain, &scenario).unwrap();
        (trace.seen.len(), trace.complete(), scenario.slope())
    };
    for (clearance, range) in [(1, 6.0), (1, 8.0), (2, 8.0), (2, 12.0), (3, 12.0)] {
        let (.., slope) = steps(0.0, clearance, range);
        let slope = slope.expect("it is wide");
        let (within, complete, _) = steps(0.9 * slope, clearance, range);
        let (narrow, ..) = steps(0.9 * slope, 0, range);
        let (beyond, ..) = steps(1.5 * slope + 0.5, clearance, range);
        let case = format!("{clearance} {range} {slope}: {narrow}, {within}; {beyond}");
        assert!(complete && within < 4 * narrow, "{case}");
        assert!(beyond > 4 * within || beyond > 1000, "{case}");
    }
    assert_eq!(steps(0.0, 0, 8.0).2, None);
}

/// What keeps a body out keeps all of it out, and is named.
#[test]
fn bodies_keep_out_of_closed_columns() {
    let terrain = Terrain::from_fn(Extent::new(24, 24), |_| Height(4));
    for planner in ALL {
        let mut scenario = Scenario::new(planner, 1, 5).with_clearance(2);
        let wall = (0..24).map(|y| format!("14,{y}").parse().unwrap());
        scenario.conditions.faults.closures = wall.collect();
        let trace = run(&terrain, &scenario).unwrap();
        check(&trace, 2.0);
        let stop = trace.stops[0].expect("it stops");
        // The last column that its middle could not enter.
        let is_named = matches!(stop, Stop::Blocked { at, .. } if at.x == 12);
        assert!(is_named || stop == Stop::Complete, "{planner}: {stop}");
        assert!(trace.records.iter().all(|record| record.at.x < 12.0));
    }
}

/// Wind pushes bodies to where they have no room, and they fly on from there.
#[test]
fn pushed_bodies_fly_back() {
    for (seed, planner) in (0..).zip(ALL) {
        let mut scenario = Scenario::new(planner, 2, seed).with_clearance(1);
        scenario.conditions.wind = Wind { deviation: 0.2 };
        scenario.conditions.mission.come_home = true;
        let trace = run(&gentle(32), &scenario).unwrap();
        let case = format!("{planner}: {:?}", trace.stops);
        assert_eq!(trace.safety, Default::default(), "{case}");
        assert!(trace.complete() && trace.all_stopped, "{case}");
        let inside = |at: f32| (1.0..31.0).contains(&at);
        let mut places = trace.records.iter().map(|record| record.at);
        assert!(places.all(|at| inside(at.x) && inside(at.y)), "{case}");
        // Starts are little more apart than robots may be: one that is pushed from its own may keep
        // the other from coming home.
        let robots = Summary::new(&trace).robots;
        let mut ends = robots.iter().zip(&trace.stops);
        let is_held = |stop: &Option<Stop>| matches!(stop, Some(Stop::Held { .. }));
        assert!(
            ends.all(|(robot, stop)| robot.flown.is_home || is_held(stop)),
            "{case}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// On small terrains of blocks and cliffs, everything that a body can see from beside what
    /// is known is seen, it touches nothing, and what is left is named.
    #[test]
    fn all_that_bodies_can_see_is_seen(
        heights in prop::collection::vec(prop_oneof![3 => Just(0u8), 1 => 0u8..32], 25),
        planner in prop::sample::select(&OWN[..]),
        clearance in 1u8..4,
        robots in 1usize..3,
        seed in 0u64..1000,
    ) {
        let terrain = Terrain::from_fn(Extent::new(15, 15), |cell| {
            Height(heights[(cell.y / 3 * 5 + cell.x / 3) as usize])
        });
        let mut scenario = Scenario::new(planner, robots, seed).with_clearance(clearance);
        scenario.limits.ceiling = 20.0;
        let trace = run(&terrain, &scenario).unwrap();
        check(&trace, f32::from(clearance));
        prop_assert!(trace.all_stopped);
        let found: HashSet<Cell> = trace.found.iter().map(|(_, column)| column.cell).collect();
        let is_held = trace.stops.iter().flatten().any(|stop| matches!(stop, Stop::Held { .. }));
        let last = trace.records.last().unwrap().at;
        let visible = visible(&terrain, &scenario, last, found.clone());
        prop_assert!(is_held || visible.len() == found.len(), "{} of {}", found.len(), visible.len());
        for stop in trace.stops.iter().flatten() {
            match stop {
                Stop::Complete => prop_assert!(trace.complete()),
                Stop::Unseen { at, .. } | Stop::Held { at, .. } => {
                    let is_left = robots > 1 || !found.contains(at);
                    prop_assert!(is_left && !trace.complete(), "{stop}");
                }
                stop => prop_assert!(false, "{stop}"),
            }
        }
    }
}
