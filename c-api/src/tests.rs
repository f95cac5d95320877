use std::ptr::{null, null_mut};

use super::*;

const CONFIG: PlannerConfig = PlannerConfig {
    id: 1,
    width: 9,
    height: 9,
    start: PlannerCell { x: 1, y: 1 },
    cell_mm: 100,
    origin_x_mm: 0,
    origin_y_mm: 0,
    bytes_per_tick: 55,
};

fn memory() -> Box<[u64]> {
    vec![0; PLANNER_WORDS].into()
}

fn planner(memory: &mut [u64]) -> *mut Planner {
    memory.as_mut_ptr().cast()
}

fn created(memory: &mut [u64], config: PlannerConfig) -> *mut Planner {
    let planner = planner(memory);
    assert_eq!(planner_create(planner, &config), PlannerResult::Ok);
    planner
}

#[test]
fn null_is_answered() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let (mut action, mut frame, mut length) =
        (PlannerAction::from(planner_core::Action::Wait), [0; 55], 0);
    let pose = PlannerPose {
        x: 1.5,
        y: 1.5,
        heading: 0.0,
    };
    let centre = CONFIG.start;
    for result in [
        planner_create(null_mut(), &CONFIG),
        planner_create(ready, null()),
        planner_observe_scan(ready, null(), 4.0, null(), 0),
        planner_observe_scan(ready, &pose, 4.0, null(), 1),
        planner_observe_cells(null_mut(), centre, null(), 0),
        planner_observe_cells(ready, centre, null(), 1),
        planner_tick(null_mut(), &mut action),
        planner_tick(ready, null_mut()),
        planner_report(null_mut(), PLANNER_MOVED),
        planner_transmit(ready, null_mut(), &mut length),
        planner_transmit(ready, frame.as_mut_ptr(), null_mut()),
        planner_receive(ready, null(), 16),
        planner_known(ready, null_mut(), null_mut()),
    ] {
        assert_eq!(result, PlannerResult::Null);
    }
}

#[test]
fn misaligned_is_answered() {
    let mut memory = memory();
    let crooked = planner(&mut memory).wrapping_byte_add(1);
    assert_eq!(planner_create(crooked, &CONFIG), PlannerResult::Misaligned);
    assert_eq!(
        planner_report(crooked, PLANNER_MOVED),
        PlannerResult::Misaligned
    );
    let ready = created(&mut memory, CONFIG);
    // Large enough and aligned for anything, and then one byte further.
    let mut place = [0u64; 8];
    let crooked = place.as_mut_ptr().wrapping_byte_add(1);
    let straight = place.as_mut_ptr();
    let pose = PlannerPose {
        x: 1.5,
        y: 1.5,
        heading: 0.0,
    };
    let centre = CONFIG.start;
    for result in [
        planner_create(ready, crooked.cast()),
        planner_observe_scan(ready, crooked.cast(), 4.0, null(), 0),
        planner_observe_scan(ready, &pose, 4.0, crooked.cast(), 1),
        planner_observe_cells(ready, centre, crooked.cast(), 1),
        planner_tick(ready, crooked.cast()),
        planner_transmit(ready, straight.cast(), crooked.cast()),
        planner_known(ready, crooked.cast(), straight.cast()),
        planner_known(ready, straight.cast(), crooked.cast()),
    ] {
        assert_eq!(result, PlannerResult::Misaligned);
    }
    // Frames are bytes: they lie anywhere.
    let frame = crooked.cast::<u8>();
    assert_eq!(
        planner_transmit(ready, frame, straight.cast()),
        PlannerResult::Ok
    );
}

#[test]
fn memory_without_a_planner_and_values_out_of_range_are_answered() {
    let mut memory = memory();
    let ready = planner(&mut memory);
    assert_eq!(
        planner_report(ready, PLANNER_MOVED),
        PlannerResult::NotCreated
    );
    let wide = PlannerConfig {
        width: 129,
        ..CONFIG
    };
    assert_eq!(planner_create(ready, &wide), PlannerResult::Extent);
    let outside = PlannerConfig {
        start: PlannerCell { x: 9, y: 0 },
        ..CONFIG
    };
    assert_eq!(planner_create(ready, &outside), PlannerResult::Extent);
    assert_eq!(planner_create(ready, &CONFIG), PlannerResult::Ok);
    assert_eq!(planner_report(ready, 3), PlannerResult::Motion);
    let pose = PlannerPose {
        x: f32::NAN,
        y: 1.5,
        heading: 0.0,
    };
    assert_eq!(
        planner_observe_scan(ready, &pose, 4.0, null(), 0),
        PlannerResult::Scan
    );
    let beams = [PlannerBeam {
        bearing: 0.0,
        range: 1.0,
    }; PLANNER_MAX_BEAMS + 1];
    let pose = PlannerPose { x: 1.5, ..pose };
    let scan = planner_observe_scan(ready, &pose, 4.0, beams.as_ptr(), beams.len());
    assert_eq!(scan, PlannerResult::TooMany);
    assert_eq!(
        planner_receive(ready, [0; 9].as_ptr(), 9),
        PlannerResult::Frame
    );
}

#[test]
fn two_robots_explore_a_hall_and_hear_each_other() {
    let mut memories = [memory(), memory()];
    let [one, two] = &mut memories;
    let robots = [
        created(one, CONFIG),
        created(two, PlannerConfig { id: 2, ..CONFIG }),
    ];
    let mut positions = [CONFIG.start; 2];
    let mut stopped = 0;
    for _ in 0..200 {
        stopped = 0;
        for (index, &robot) in robots.iter().enumerate() {
            let at = &mut positions[index];
            let seen: Vec<_> = (-3..=3)
                .flat_map(|y| (-3..=3).map(move |x| (x, y)))
                .map(|(x, y)| PlannerSeen {
                    cell: PlannerCell {
                        x: at.x + x,
                        y: at.y + y,
                    },
                    blocked: 0,
                })
                .collect();
            assert_eq!(
                planner_observe_cells(robot, *at, seen.as_ptr(), seen.len()),
                PlannerResult::Ok
            );
            let mut action = PlannerAction::from(planner_core::Action::Wait);
            assert_eq!(planner_tick(robot, &mut action), PlannerResult::Ok);
            match action.kind {
                PlannerActionKind::Wait => {}
                PlannerActionKind::Stop => {
                    assert_eq!(action.stop, PlannerStop::Complete);
                    stopped += 1;
                }
                PlannerActionKind::Move => {
                    let (x, y) = [(1, 0), (0, 1), (-1, 0), (0, -1)][action.direction as usize];
                    *at = PlannerCell {
                        x: at.x + x,
                        y: at.y + y,
                    };
                    assert_eq!(planner_report(robot, PLANNER_MOVED), PlannerResult::Ok);
                }
            }
            let (mut frame, mut length) = ([0; PLANNER_MAX_FRAME], 0);
            assert_eq!(
                planner_transmit(robot, frame.as_mut_ptr(), &mut length),
                PlannerResult::Ok
            );
            if length > 0 {
                assert_eq!(
                    planner_receive(robots[1 - index], frame.as_ptr(), length),
                    PlannerResult::Ok
                );
            }
        }
    }
    assert_eq!(stopped, 2);
    let (mut known, mut frontiers) = (0, 1);
    assert_eq!(
        planner_known(robots[0], &mut known, &mut frontiers),
        PlannerResult::Ok
    );
    assert_eq!((known, frontiers), (81, 0));
}
