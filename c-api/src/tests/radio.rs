//! What robots tell each other.

use super::*;

#[test]
fn a_frame_that_is_not_taken_says_why() {
    let mut memories = [memory(), memory(), memory()];
    let [one, two, elsewhere] = &mut memories;
    let one = created(one, CONFIG);
    let two = created(two, PlannerConfig { id: 2, ..CONFIG });
    let elsewhere = created(
        elsewhere,
        PlannerConfig {
            id: 3,
            origin_x_mm: 1,
            ..CONFIG
        },
    );
    let frame = frame_of(one);
    let receive = |by, frame: &[u8]| planner_receive(by, frame.as_ptr(), frame.len());
    let changed = |at: usize| {
        let mut bytes = frame.clone();
        bytes[at] ^= 0x80;
        bytes
    };
    assert_eq!(receive(two, &frame), PlannerResult::Ok);
    assert_eq!(receive(two, &frame[1..]), PlannerResult::FrameLength);
    assert_eq!(receive(two, &[]), PlannerResult::FrameLength);
    assert_eq!(receive(two, &changed(0)), PlannerResult::FrameVersion);
    assert_eq!(receive(two, &changed(1)), PlannerResult::FrameKind);
    assert_eq!(receive(two, &changed(9)), PlannerResult::FrameCheck);
    assert_eq!(receive(elsewhere, &frame), PlannerResult::FrameOtherGrid);
    assert_eq!(receive(one, &frame), PlannerResult::FrameOwn);
    let field = FrameError::Field(Field::State);
    assert_eq!(PlannerResult::from(field), PlannerResult::FrameField);
}

/// What the robot sends of what it saw.
fn frame_of(robot: *mut Planner) -> Vec<u8> {
    assert_eq!(look(robot, CONFIG.start), PlannerResult::Ok);
    tick(robot);
    let (mut frame, mut length) = ([0; PLANNER_MAX_FRAME], 0);
    let result = planner_transmit(robot, frame.as_mut_ptr(), &mut length);
    assert_eq!(result, PlannerResult::Ok);
    frame[..length].to_vec()
}

#[test]
fn robots_hear_those_with_their_key_and_nobody_else() {
    let keys = [(0, [0; 16]), (1, [7; 16]), (255, [8; 16])];
    for (ours, one) in keys.into_iter().enumerate() {
        for (theirs, two) in keys.into_iter().enumerate() {
            let robot = |id, (is_keyed, key)| PlannerConfig {
                id,
                is_keyed,
                key,
                ..CONFIG
            };
            let mut memory = memory();
            let frame = frame_of(created(&mut memory, robot(1, one)));
            let listener = created(&mut memory, robot(2, two));
            let result = planner_receive(listener, frame.as_ptr(), frame.len());
            if ours == theirs {
                assert_eq!(result, PlannerResult::Ok);
            } else {
                assert_ne!(result, PlannerResult::Ok, "{ours} heard by {theirs}");
            }
        }
    }
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
            assert_eq!(look(robot, *at), PlannerResult::Ok);
            let action = tick(robot);
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
    let now = status(robots[0]);
    assert_eq!(now.frontiers, 0);
    assert!(now.known >= 7 * 9 + 2 * 7, "{now:?}");
    assert!(now.heard_cells > 0 && now.contradictions == 0, "{now:?}");
}
