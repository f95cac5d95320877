//! Robots that fly among voxels.

use host_sim::chip::{ChipError, Machine, Swarm};
use host_sim::measured::{Call, Measured};
use host_sim::record::voxels::VoxelTrace;
use host_sim::run::voxels;
use host_sim::scenario::voxels::{Planner, Scenario};
use host_sim::scenario::{Event, MediumKind};
use host_sim::scene::Scene;
use planner_core::volume::Field;

use crate::{Largest, image};

fn on_chips(scene: &Scene, scenario: &Scenario) -> Result<(VoxelTrace, Measured), ChipError> {
    let machine = Machine::Netduinoplus2;
    let swarm = Swarm::new(machine, image(machine, "voxels"));
    let trace = voxels::run_on(&swarm, scene, scenario).unwrap();
    Ok((trace, swarm.finish()?))
}

/// Robots in a town of that seed, with this range, field of view, medium and loss.
fn survey(
    robots: usize,
    seed: u64,
    range: u8,
    field: Field,
    (medium, loss): (MediumKind, f64),
) -> Scenario {
    let mut scenario = Scenario::new(robots, seed);
    (scenario.range, scenario.field) = (range, field);
    (scenario.conditions.medium, scenario.conditions.loss) = (medium, loss);
    scenario
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn robots_among_voxels_decide_on_the_chip_as_on_the_host() {
    use MediumKind::{Ideal, Radio};
    let whole = Field::ALL_ROUND;
    let mut closest = survey(2, 3, 6, whole, (Radio, 0.3));
    closest.planner = Planner::ClosestFrontier;
    let mut in_trouble = survey(3, 2, 6, whole, (Radio, 0.3));
    let faults = &mut in_trouble.conditions.faults;
    faults.deaths = vec![Event::from((1, 20))];
    faults.restarts = vec![Event::from((2, 30))];
    faults.resumes = vec![Event::from((0, 40))];
    let surveys = [
        (24, survey(1, 1, 8, whole, (Radio, 0.0))),
        (24, in_trouble),
        (24, survey(3, 4, 6, Field::CAMERA, (Radio, 0.3))),
        (20, survey(3, 5, 5, Field::LIDAR, (Ideal, 0.3))),
        (20, closest),
        (40, survey(3, 6, 8, whole, (Radio, 0.6))),
        (20, survey(2, 7, 12, Field::DOWNWARD, (Ideal, 0.0))),
    ];
    let mut largest = Largest::default();
    let mut explorations = 0;
    for (side, scenario) in surveys {
        let scene = Scene::town(scenario.conditions.seed, side);
        let (there, measured) =
            on_chips(&scene, &scenario).unwrap_or_else(|error| panic!("{error}"));
        let here = voxels::run(&scene, &scenario).unwrap();
        let title = format!(
            "{:?} with {} robots in {}",
            scenario.planner,
            scenario.robots,
            scene.extent()
        );
        for (here, there) in here.records.iter().zip(&there.records) {
            assert_eq!(here, there, "{title}");
        }
        assert_eq!(here.records.len(), there.records.len(), "{title}");
        assert_eq!(here.digest(), there.digest(), "{title}");
        assert!(here.complete(), "{title}");
        let tick = measured.calls[&Call::Tick];
        println!(
            "{title:<45} range {:>2} {:>5} steps {}  mean {:>7} largest {:>7}",
            scenario.range,
            here.seen.len() - 1,
            here.digest(),
            tick.mean,
            tick.largest
        );
        let calls = [Call::Observe, Call::Tick, Call::Transmit, Call::Receive];
        let name = match (scenario.field.is_round(), scenario.range) {
            (false, _) => "voxel_survey_camera",
            (true, ..=8) => "voxel_survey",
            (true, _) => "voxel_survey_range_12",
        };
        largest.take_calls(name, &calls, &measured);
        largest.take_image("voxel_survey_", &measured);
        explorations += 1;
    }
    largest.print();
    println!("explorations: {explorations}");
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn a_box_or_planner_that_the_chip_has_no_room_for_ends_the_survey_with_a_reason() {
    let scenario = Scenario::new(1, 1);
    let error = on_chips(&Scene::town(1, 48), &scenario).unwrap_err();
    assert!(error.to_string().contains("does not fit"), "{error}");
    let machine = Machine::Netduinoplus2;
    let swarm = Swarm::new(machine, image(machine, "robot"));
    voxels::run_on(&swarm, &Scene::town(1, 24), &scenario).unwrap();
    let error = swarm.finish().unwrap_err();
    assert!(error.to_string().contains("`voxels`"), "{error}");
}
