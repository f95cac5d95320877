//! Looks that are missing, show nothing, or are those of wide robots.

use super::*;

#[test]
fn looks_that_show_nothing_complete_nothing() {
    let off = Voxel::new(900, 1, 1);
    let hit = Voxel::new(4, 1, 1);
    for look in [(off, false), (hit, true)] {
        let mut memory = room();
        let survey = ready(&mut memory, BOX);
        for _ in 0..200 {
            assert_eq!(observe(survey, START, Heading::EAST, &[look]), OK);
            if decide(survey).kind == PlannerActionKind::Stop {
                break;
            }
        }
        let action = decide(survey);
        assert_eq!((action.stop, action.frontiers), (PlannerStop::Unseen, 1));
        assert_eq!(Voxel::from(action.at).distance_squared(START), 1);
    }
}

#[test]
fn before_the_first_look_a_robot_waits() {
    let mut memory = room();
    let survey = ready(&mut memory, BOX);
    for _ in 0..200 {
        let action = decide(survey);
        assert_eq!(action.kind, PlannerActionKind::Wait);
        assert_eq!(action.wait, PlannerWait::Sight);
    }
}

#[test]
fn wide_robots_feel_where_they_fly() {
    let kinds = [
        (PlannerVoxelField::Downward, Field::DOWNWARD),
        (PlannerVoxelField::Lidar, Field::LIDAR),
    ];
    for (kind, field) in kinds {
        let config = PlannerVoxelConfig {
            field: kind as u8,
            clearance: 2,
            ..BOX
        };
        let survey = survey_box(config, field.for_body(2));
        assert!(told(survey).known > 100, "{}", told(survey).known);
    }
}

#[test]
fn where_the_robot_is_nothing_else_is() {
    let mut memory = room();
    let survey = ready(&mut memory, BOX);
    let view = view(Field::ALL_ROUND, START, Heading::EAST);
    let post = Voxel::new(POST.0, POST.1, 1);
    let mut state = 9;
    for (at, wanted) in [
        (Voxel::new(4, 2, 1), PlannerState::Obstacle),
        (post, PlannerState::Frontier),
    ] {
        let seen = [&view[..], &[(post, true)]].concat();
        assert_eq!(observe(survey, at, Heading::EAST, &seen), OK);
        assert_eq!(planner_voxel_state(survey, post.into(), &mut state), OK);
        assert_eq!(state, wanted as u8);
    }
}
