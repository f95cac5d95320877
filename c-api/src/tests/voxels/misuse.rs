//! What is answered to what cannot be done.

use super::*;

#[test]
fn what_a_survey_cannot_be_is_answered_and_changes_nothing() {
    let mut memory: Box<[u64]> = vec![0x0123_4567_89ab_cdef; PLANNER_VOXEL_SURVEY_WORDS].into();
    let before = memory.clone();
    let survey = place(&mut memory);
    let bad = [
        (
            PlannerVoxelConfig { width: 0, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { width: 41, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { depth: 0, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { depth: 41, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { levels: 0, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { levels: 17, ..BOX },
            PlannerResult::Extent,
        ),
        (
            PlannerVoxelConfig { cell_mm: 0, ..BOX },
            PlannerResult::CellSize,
        ),
        (PlannerVoxelConfig { range: 1, ..BOX }, PlannerResult::Range),
        (
            PlannerVoxelConfig { range: 13, ..BOX },
            PlannerResult::Range,
        ),
        (
            PlannerVoxelConfig {
                range: 2,
                clearance: 2,
                ..BOX
            },
            PlannerResult::Range,
        ),
        (
            PlannerVoxelConfig {
                clearance: 4,
                ..BOX
            },
            PlannerResult::Clearance,
        ),
        (
            PlannerVoxelConfig { field: 5, ..BOX },
            PlannerResult::Sensor,
        ),
    ];
    for (config, wanted) in bad {
        let result = planner_voxel_create(survey, BYTES, &config);
        assert_eq!(result, wanted, "{config:?}");
    }
    for size in [BYTES - 8, BYTES + 8] {
        let result = planner_voxel_create(survey, size, &BOX);
        assert_eq!(result, PlannerResult::Memory);
    }
    assert_eq!(
        planner_voxel_create(survey, BYTES, null()),
        PlannerResult::Null
    );
    let crooked = survey.wrapping_byte_add(1);
    assert_eq!(
        planner_voxel_create(crooked, BYTES, &BOX),
        PlannerResult::Misaligned
    );
    assert_eq!(planner_voxel_resume(survey), PlannerResult::NotCreated);
    assert!(memory == before);
    let largest = PlannerVoxelConfig {
        width: 40,
        depth: 40,
        levels: 16,
        range: 12,
        ..BOX
    };
    ready(&mut memory, largest);
}

#[test]
fn calls_without_a_survey_are_answered() {
    let mut memory = room();
    let survey = place(&mut memory);
    let (mut action, mut status, mut frame, mut length) = (UNTOLD, UNASKED, [0; 55], 9);
    let at = PlannerVoxel::from(START);
    let mut all = |survey| {
        [
            planner_voxel_observe(survey, at, 0, null(), 0),
            planner_voxel_tick(survey, &mut action),
            planner_voxel_resume(survey),
            planner_voxel_go_home(survey),
            planner_voxel_energy(survey, 9),
            planner_voxel_transmit(survey, frame.as_mut_ptr(), &mut length),
            planner_voxel_receive(survey, frame.as_ptr(), 16),
            planner_voxel_hear(survey, 2, &UNASKED),
            planner_voxel_status(survey, &mut status),
            planner_voxel_state(survey, at, frame.as_mut_ptr()),
        ]
    };
    assert_eq!(all(survey), [PlannerResult::NotCreated; 10]);
    assert_eq!(all(null_mut()), [PlannerResult::Null; 10]);
    assert_eq!(
        all(survey.wrapping_byte_add(1)),
        [PlannerResult::Misaligned; 10]
    );
    // A planner on the ground is none among voxels.
    assert!(size_of::<Planner>() >= BYTES);
    let mut ground = super::super::memory();
    let planner = created(&mut ground, CONFIG);
    assert_eq!(all(planner.cast()), [PlannerResult::NotCreated; 10]);

    let survey = ready(&mut memory, BOX);
    let mut places = [0u64; 8];
    let crooked = places.as_mut_ptr().wrapping_byte_add(1);
    for (pointer, wanted) in [
        (null_mut(), PlannerResult::Null),
        (crooked, PlannerResult::Misaligned),
    ] {
        for result in [
            planner_voxel_observe(survey, at, 0, pointer.cast(), 1),
            planner_voxel_tick(survey, pointer.cast()),
            planner_voxel_transmit(survey, frame.as_mut_ptr(), pointer.cast()),
            planner_voxel_hear(survey, 2, pointer.cast()),
            planner_voxel_status(survey, pointer.cast()),
        ] {
            assert_eq!(result, wanted);
        }
    }
    assert_eq!(
        planner_voxel_observe(survey, at, 8, null(), 0),
        PlannerResult::Heading
    );
    let off = PlannerVoxel { z: 4, ..at };
    assert_eq!(
        planner_voxel_observe(survey, off, 7, null(), 0),
        PlannerResult::OffGrid
    );
    assert_eq!(decide(survey).wait, PlannerWait::Pose);
    assert_eq!(planner_voxel_observe(survey, at, 7, null(), 0), OK);
    assert_eq!(decide(survey).wait, PlannerWait::Sight);
}
