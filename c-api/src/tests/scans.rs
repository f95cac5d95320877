//! What scans and poses tell.

use super::*;

/// A hundred beams to the east; those that point nowhere, and those without a
/// measurement, say nothing.
#[test]
fn beams_show_cells_and_bad_ones_nothing() {
    let known_after = |beams: &[PlannerBeam]| {
        let mut memory = memory();
        let ready = created(&mut memory, CONFIG);
        let pose = PlannerPose {
            x: 1.5,
            y: 1.5,
            heading: 0.0,
        };
        let length = beams.len();
        let scan = planner_observe_scan(ready, &pose, 4.0, 0.1, beams.as_ptr(), length);
        assert_eq!(scan, PlannerResult::Ok);
        status(ready).known
    };
    assert_eq!(known_after(&[beam(0.0, 1.0)]), 2);
    assert_eq!(known_after(&[beam(0.0, 2.5); 100]), 4);
    assert_eq!(known_after(&[beam(0.0, f32::INFINITY)]), 5);
    let long = PlannerBearing {
        ahead: 1.0,
        right: 0.1,
    };
    let zero = PlannerBearing {
        ahead: 0.0,
        right: 0.0,
    };
    for bearing in [long, zero, planner_bearing(f32::NAN)] {
        assert_eq!(
            known_after(&[PlannerBeam {
                bearing,
                range: 2.5
            }]),
            1
        );
    }
    for range in [f32::NAN, -1.0] {
        assert_eq!(known_after(&[beam(0.0, range)]), 1);
    }
}

/// What lies farther than 15 cells counts as well, where the sensor reaches so far.
#[test]
fn a_long_scan_shows_what_is_far() {
    let config = PlannerConfig {
        width: 32,
        start: PlannerCell { x: 1, y: 1 },
        ..CONFIG
    };
    type Observe = extern "C" fn(
        *mut Planner,
        *const PlannerPose,
        f32,
        f32,
        *const PlannerBeam,
        usize,
    ) -> PlannerResult;
    let seen = |observe: Observe| {
        let mut memory = memory();
        let ready = created(&mut memory, config);
        let pose = PlannerPose {
            x: 1.5,
            y: 1.5,
            heading: 0.0,
        };
        let beams = [beam(0.0, 25.5)];
        let result = observe(ready, &pose, 28.0, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::Ok);
        let off_grid = PlannerPose { y: 1e30, ..pose };
        let result = observe(ready, &off_grid, 28.0, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::OffGrid);
        let result = observe(ready, &pose, f32::NAN, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::Scan);
        status(ready).known
    };
    assert_eq!(seen(planner_observe_scan), 16);
    assert_eq!(seen(planner_observe_long_scan), 27);
}

#[test]
fn off_the_grid_nothing_is_decided() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    let beam = beam(0.0, 1.0);
    let scan = |x, y| {
        let pose = PlannerPose { x, y, heading: 0.0 };
        planner_observe_scan(ready, &pose, 4.0, 0.1, &beam, 1)
    };
    let before = status(ready);
    for _ in 0..200 {
        assert_eq!(scan(-0.5, 1.5), PlannerResult::OffGrid);
        assert_eq!(tick(ready).wait, PlannerWait::Pose);
        // Also where cells have no name.
        assert_eq!(scan(1.5, 1e30), PlannerResult::OffGrid);
        assert_eq!(tick(ready).wait, PlannerWait::Pose);
        assert_eq!(
            look(ready, PlannerCell { x: 1, y: 9 }),
            PlannerResult::OffGrid
        );
        let action = tick(ready);
        assert_eq!(action.kind, PlannerActionKind::Wait);
        assert_eq!(action.wait, PlannerWait::Pose);
    }
    assert_eq!(status(ready), before);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    assert_eq!(tick(ready).kind, PlannerActionKind::Move);
}
