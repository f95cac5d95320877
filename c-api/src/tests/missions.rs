//! Why a robot waits and stops, where it is sent, and its way.

use super::*;

#[test]
fn a_wait_has_a_reason_and_a_look_a_direction() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(tick(ready).wait, PlannerWait::Sight);
    let waits = [
        (None, PlannerWait::None),
        (Some(Wait::Sight), PlannerWait::Sight),
        (Some(Wait::Pose), PlannerWait::Pose),
        (Some(Wait::Search), PlannerWait::Search),
        (Some(Wait::Closed), PlannerWait::Closed),
        (Some(Wait::Obstructed), PlannerWait::Obstructed),
        (Some(Wait::Patrol), PlannerWait::Patrol),
        (Some(Wait::Doubt), PlannerWait::Doubt),
        (Some(Wait::Look(Direction::East)), PlannerWait::Look),
    ];
    for (waiting, wait) in waits {
        assert_eq!(PlannerAction::new(Action::Wait, waiting).wait, wait);
    }
    for direction in Direction::ALL {
        let looks = PlannerAction::new(Action::Wait, Some(Wait::Look(direction)));
        assert_eq!(looks.look as u8, direction as u8);
        let moves = PlannerAction::new(Action::Move(direction), None);
        assert_eq!(
            (moves.direction as u8, moves.wait),
            (direction as u8, PlannerWait::None)
        );
    }
}

#[test]
fn stops_have_the_codes_of_traces_and_one_more() {
    let (frontiers, at) = (7, Cell::new(2, 3));
    let stops = [
        Stop::Complete,
        Stop::Enclosed { frontiers },
        Stop::Blocked { frontiers, at },
        Stop::BackAtStart { frontiers },
        Stop::NoTrace { frontiers },
        Stop::AtEdge { cells: 7 },
        Stop::OutOfReach { frontiers },
        Stop::Unseen { frontiers, at },
        Stop::Held { frontiers, at },
        Stop::Home { frontiers },
        Stop::Arrived { frontiers, at },
        Stop::NoWay { frontiers, at },
    ];
    for (stop, code) in stops.into_iter().zip(1..) {
        let told = PlannerAction::new(Action::Stop(stop), None);
        assert_eq!(told.kind, PlannerActionKind::Stop);
        assert_eq!(
            (told.stop as u8, stop.reason().code() + 1),
            (code, code),
            "{stop}"
        );
        assert_eq!(
            planner_stop_is_complete(told.stop as u8),
            stop.is_complete(),
            "{stop}"
        );
        assert_eq!(told.frontiers, stop.left());
        let place = stop.place().map_or((0, 0), |at| (at.x, at.y));
        assert_eq!((told.at.x, told.at.y), place);
    }
    for none in [PlannerStop::None as u8, stops.len() as u8 + 1, 255] {
        assert!(!planner_stop_is_complete(none));
    }
}

#[test]
fn a_robot_is_sent_and_comes_home() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let start = CONFIG.start;
    let seen: Vec<PlannerSeen> = (0..3)
        .map(|step| PlannerSeen {
            cell: PlannerCell {
                x: start.x + step,
                y: start.y,
            },
            blocked: 0,
        })
        .collect();
    let observe = |x: i16| {
        let here = PlannerCell { x, y: start.y };
        let told = planner_observe_cells(ready, here, seen.as_ptr(), seen.len());
        assert_eq!(told, PlannerResult::Ok);
    };
    let run = |mut x: i16| {
        for _ in 0..100 {
            observe(x);
            let action = tick(ready);
            match action.kind {
                PlannerActionKind::Stop => return (x, action),
                PlannerActionKind::Move => {
                    x += Direction::from_index(action.direction as u8).delta().0;
                    assert_eq!(planner_report(ready, PLANNER_MOVED), PlannerResult::Ok);
                }
                PlannerActionKind::Wait => {}
            }
        }
        panic!("still running at {x}");
    };
    let off = PlannerCell { x: -1, y: 0 };
    assert_eq!(planner_go_to(ready, off), PlannerResult::OffGrid);
    let to = PlannerCell {
        x: start.x + 2,
        y: start.y,
    };
    observe(start.x);
    assert_eq!(planner_go_to(ready, to), PlannerResult::Ok);
    let (x, arrived) = run(start.x);
    assert_eq!((x, arrived.stop), (to.x, PlannerStop::Arrived));
    assert_eq!(planner_energy(ready, 2), PlannerResult::Ok);
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    let (x, home) = run(x);
    assert_eq!((x, home.stop), (start.x, PlannerStop::Home));
    assert_eq!(planner_go_home(ready), PlannerResult::Ok);
    assert_eq!(tick(ready).stop, PlannerStop::Home);
}

#[test]
fn a_stopped_robot_goes_on_after_resume() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let closed = [(2, 1), (1, 2), (0, 1), (1, 0)].map(|(x, y)| PlannerSeen {
        cell: PlannerCell { x, y },
        blocked: 1,
    });
    let look_at_walls = || {
        let result = planner_observe_cells(ready, CONFIG.start, closed.as_ptr(), closed.len());
        assert_eq!(result, PlannerResult::Ok);
    };
    look_at_walls();
    assert_eq!(tick(ready).kind, PlannerActionKind::Stop);
    // Told to go on where nothing has changed, it comes to the same end.
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    look_at_walls();
    assert_eq!(tick(ready).kind, PlannerActionKind::Stop);
    // Told before it is carried out of it, or carried to where it learns something.
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    assert_eq!(look(ready, PlannerCell { x: 5, y: 5 }), PlannerResult::Ok);
    assert_ne!(tick(ready).kind, PlannerActionKind::Stop);
}

#[test]
fn the_way_is_told_and_walked_in_a_straight_line() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let look = |x: i16| {
        let free = (1..6).map(|x| (x, 1, 0));
        let walls = (0..9).flat_map(|x| [(x, 0, 1), (x, 2, 1)]);
        let seen: Vec<_> = walls
            .chain([(0, 1, 1)])
            .chain(free)
            .map(|(x, y, blocked)| PlannerSeen {
                cell: PlannerCell { x, y },
                blocked,
            })
            .collect();
        let at = PlannerCell { x, y: 1 };
        let result = planner_observe_cells(ready, at, seen.as_ptr(), seen.len());
        assert_eq!(result, PlannerResult::Ok);
    };
    let waypoint = || {
        let (mut is_there, mut at) = (false, PlannerCell { x: -1, y: -1 });
        let result = planner_waypoint(ready, &mut is_there, &mut at);
        assert_eq!(result, PlannerResult::Ok);
        is_there.then_some((at.x, at.y))
    };
    let way = |room| {
        let (mut cells, mut count) = ([CONFIG.start; 9], 0);
        let result = planner_way(ready, cells.as_mut_ptr(), room, &mut count);
        assert_eq!(result, PlannerResult::Ok);
        let columns = cells[..count].iter().map(|cell| cell.x);
        columns.collect::<Vec<_>>()
    };
    assert_eq!((waypoint(), way(9)), (None, vec![]));
    look(1);
    assert_eq!(tick(ready).kind, PlannerActionKind::Move);
    assert_eq!(waypoint(), Some((5, 1)));
    assert_eq!((way(9), way(2)), (vec![2, 3, 4, 5], vec![2, 3]));
    look(4);
    assert_eq!((waypoint(), way(9)), (Some((5, 1)), vec![5]));
    assert_eq!(status(ready).goal, PlannerCell { x: 5, y: 1 });
}
