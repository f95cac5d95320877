//! Robots that fly, over 3-D terrain.

use host_sim::chip::{ChipError, Machine, Swarm};
use host_sim::measured::{Call, Measured};
use host_sim::record::heights::Trace;
use host_sim::run::heights;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{Event, Mission};
use host_sim::terrain::Terrain;
use planner_core::surface::Height;
use planner_core::{Extent, Reason};

use crate::{Largest, image};

fn on_chips(
    terrain: &Terrain,
    scenario: &Scenario,
    machine: Machine,
) -> Result<(Trace, Measured), ChipError> {
    let swarm = Swarm::new(machine, image(machine, "robot"));
    let trace = heights::run_on(&swarm, terrain, scenario).unwrap();
    Ok((trace, swarm.finish()?))
}

/// Hills whose slopes wide robots see down.
fn hills(side: u16) -> Terrain {
    Terrain::from_fn(Extent::new(side, side), |cell| {
        let away = (cell.x % 24 - 12).abs().max((cell.y % 24 - 12).abs());
        Height(2 * (10 - away.clamp(2, 10)) as u8)
    })
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn flying_robots_decide_on_the_chip_as_on_the_host() {
    // The terrain, robots, share of messages lost and of steps slept through, clearance.
    let surveys = [
        (Terrain::gaussian(1, 40), 1, 0.0, 0.0, 0),
        (Terrain::urban(2, 48), 3, 0.3, 0.0, 0),
        (Terrain::gaussian(3, 60), 4, 0.6, 0.2, 0),
        (Terrain::gaussian(4, 100), 4, 0.3, 0.0, 0),
        (hills(48), 3, 0.3, 0.0, 1),
        (hills(48), 2, 0.0, 0.0, 3),
    ];
    let planners = [
        (Planner::Fcao, ["fcao", "wide_fcao"]),
        (
            Planner::CoordinatedSurvey,
            ["coordinated_survey", "wide_coordinated_survey"],
        ),
        (
            Planner::CoordinatedCubic,
            ["coordinated_survey", "wide_coordinated_survey"],
        ),
    ];
    let mut largest = Largest::default();
    let mut explorations = 0;
    for (seed, (terrain, robots, loss, skip, clearance)) in (0..).zip(surveys) {
        for (planner, [narrow, wide]) in planners {
            let scenario = Scenario::new(planner, robots, seed);
            let mut scenario = scenario.with_clearance(clearance);
            (scenario.conditions.loss, scenario.skip) = (loss, skip);
            if robots > 2 {
                scenario.conditions.faults.deaths = vec![Event::from((1, 20))];
            }
            let (there, measured) = on_chips(&terrain, &scenario, Machine::Netduinoplus2)
                .unwrap_or_else(|error| panic!("{error}"));
            let here = heights::run(&terrain, &scenario).unwrap();
            let title = format!(
                "{planner:?} with {robots} robots of clearance {clearance} over {}",
                terrain.extent()
            );
            for (here, there) in here.records.iter().zip(&there.records) {
                assert_eq!(here, there, "{title}");
            }
            assert_eq!(here.records.len(), there.records.len(), "{title}");
            assert_eq!(here.digest(), there.digest(), "{title}");
            assert!(here.complete(), "{title}");
            let tick = measured.calls[&Call::Tick];
            println!(
                "{title:<66} {:>5} steps {}  mean {:>7} largest {:>7}",
                here.seen.len() - 1,
                here.digest(),
                tick.mean,
                tick.largest
            );
            let calls = [Call::Observe, Call::Tick, Call::Hear, Call::Join];
            let name = if clearance == 0 { narrow } else { wide };
            largest.take(name, &calls, &measured);
            explorations += 1;
        }
    }
    largest.print();
    println!("explorations: {explorations}");
}

/// A mission is part of what a chip is set up with.
#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn flying_robots_come_home_on_the_chip_as_on_the_host() {
    for planner in [Planner::Fcao, Planner::CoordinatedSurvey] {
        let terrain = Terrain::urban(2, 32);
        let mut scenario = Scenario::new(planner, 2, 1);
        scenario.conditions.mission = Mission {
            come_home: true,
            energy: 60,
        };
        scenario.conditions.faults.resumes = vec![Event::from((0, 90))];
        let (there, _) = on_chips(&terrain, &scenario, Machine::Netduinoplus2)
            .unwrap_or_else(|error| panic!("{error}"));
        let here = heights::run(&terrain, &scenario).unwrap();
        assert_eq!(here.records, there.records, "{planner}");
        assert_eq!(here.stops[1].map(|stop| stop.reason()), Some(Reason::Home));
    }
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn a_chip_that_cannot_fly_ends_the_survey_with_a_reason() {
    let scenario = Scenario::new(Planner::Fcao, 1, 0);
    let terrain = Terrain::gaussian(0, 40);
    let error = on_chips(&terrain, &scenario, Machine::Mps2An385).unwrap_err();
    assert!(error.to_string().contains("hosts no planner"), "{error}");
    let terrain = Terrain::gaussian(0, 105);
    let error = on_chips(&terrain, &scenario, Machine::Netduinoplus2).unwrap_err();
    assert!(error.to_string().contains("does not fit"), "{error}");
}
