//! The planner among voxels, against that in Rust.

mod looks;
mod misuse;
mod zones;

use planner_core::radio::LinkConfig;
use planner_core::volume::{Field, Heading, Voxel, in_sight};
use planner_core::voxel_survey::{self, Sensor, VoxelSurvey};

use super::*;

const OK: PlannerResult = PlannerResult::Ok;
const BYTES: usize = size_of::<PlannerVoxelSurvey>();

const BOX: PlannerVoxelConfig = PlannerVoxelConfig {
    id: 1,
    width: 6,
    depth: 5,
    levels: 4,
    range: 3,
    clearance: 1,
    come_home: 0,
    errs: 0,
    field: PlannerVoxelField::AllRound as u8,
    up: 0,
    down: 0,
    side: 0,
    near: 0,
    cell_mm: 500,
    origin_x_mm: 0,
    origin_y_mm: 0,
    bytes_per_tick: 550,
    is_keyed: 0,
    key: [0; 16],
};

const START: Voxel = Voxel::new(1, 1, 1);
/// A post from the floor to the ceiling.
const POST: (i16, i16) = (4, 3);

/// An action to be overwritten.
const UNTOLD: PlannerVoxelAction = PlannerVoxelAction {
    kind: PlannerActionKind::Wait,
    to: PlannerVoxel { x: 9, y: 9, z: 9 },
    heading: 9,
    wait: PlannerWait::None,
    stop: PlannerStop::None,
    frontiers: 9,
    at: PlannerVoxel { x: 9, y: 9, z: 9 },
};

/// A status to be overwritten.
const UNASKED: PlannerVoxelStatus = PlannerVoxelStatus {
    position: UNTOLD.at,
    goal: UNTOLD.at,
    has_goal: 9,
    has_stopped: 9,
    is_mute: 9,
    known: 9,
    frontiers: 9,
    heard_voxels: 9,
    same_id: 9,
    refused: 9,
};

fn room() -> Box<[u64]> {
    vec![0; PLANNER_VOXEL_SURVEY_WORDS].into()
}

fn place(memory: &mut [u64]) -> *mut PlannerVoxelSurvey {
    memory.as_mut_ptr().cast()
}

fn ready(memory: &mut [u64], config: PlannerVoxelConfig) -> *mut PlannerVoxelSurvey {
    let survey = place(memory);
    assert_eq!(planner_voxel_create(survey, BYTES, &config), OK);
    survey
}

/// What a sensor at `eye` that is turned to `heading` shows of the box with its post.
fn view(field: Field, eye: Voxel, heading: Heading) -> Vec<(Voxel, bool)> {
    let is_post = |at: Voxel| (at.x, at.y) == POST;
    let levels = 0..BOX.levels as i16;
    let all = levels.flat_map(|z| (0..30).map(move |i| Voxel::new(i % 6, i / 6, z)));
    all.filter(|&it| eye.distance_squared(it) <= u32::from(BOX.range * BOX.range))
        .filter(|&it| in_sight(eye, it, |at| !is_post(at)) && field.shows(eye, heading, it))
        .map(|it| (it, is_post(it)))
        .collect()
}

fn observe(
    survey: *mut PlannerVoxelSurvey,
    at: Voxel,
    heading: Heading,
    view: &[(Voxel, bool)],
) -> PlannerResult {
    let seen = |&(voxel, occupied): &(Voxel, bool)| PlannerVoxelSeen {
        voxel: voxel.into(),
        occupied: u8::from(occupied) * 7,
    };
    let seen: Vec<_> = view.iter().map(seen).collect();
    planner_voxel_observe(
        survey,
        at.into(),
        heading.eighths(),
        seen.as_ptr(),
        seen.len(),
    )
}

fn decide(survey: *mut PlannerVoxelSurvey) -> PlannerVoxelAction {
    let mut action = UNTOLD;
    assert_eq!(planner_voxel_tick(survey, &mut action), OK);
    action
}

fn told(survey: *mut PlannerVoxelSurvey) -> PlannerVoxelStatus {
    let mut status = UNASKED;
    assert_eq!(planner_voxel_status(survey, &mut status), OK);
    status
}

/// The frames of one tick.
fn frames(survey: *mut PlannerVoxelSurvey) -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    loop {
        let (mut frame, mut length) = ([0xa5; PLANNER_MAX_FRAME], 9);
        let result = planner_voxel_transmit(survey, frame.as_mut_ptr(), &mut length);
        assert_eq!(result, OK);
        if length == 0 {
            return frames;
        }
        frames.push(frame[..length].to_vec());
    }
}

/// The same planner in Rust.
fn twin(ours: PlannerVoxelConfig, field: Field) -> Box<VoxelSurvey<5, 5, 16>> {
    let link = LinkConfig {
        origin_mm: (BOX.origin_x_mm, BOX.origin_y_mm),
        cell_mm: BOX.cell_mm,
        bytes_per_tick: BOX.bytes_per_tick,
        key: None,
    };
    let config = voxel_survey::Config {
        range: ours.range,
        clearance: ours.clearance,
        field,
        come_home: ours.come_home != 0,
        sensor: match ours.errs {
            0 => Sensor::Truthful,
            _ => Sensor::Errs,
        },
        link,
        ..voxel_survey::Config::new()
    };
    let mut twin = Box::new(VoxelSurvey::vacant());
    let extent = Extent::new(BOX.width, BOX.depth);
    twin.reset(config, RobotId(BOX.id), extent, BOX.levels)
        .unwrap();
    twin
}

/// Surveys the box until the stop, and decides each time as the same planner in Rust.
fn survey_box(config: PlannerVoxelConfig, field: Field) -> *mut PlannerVoxelSurvey {
    let survey = ready(Box::leak(room()), config);
    fly(survey, &mut twin(config, field), field, START, 2000);
    survey
}

/// Flies until the stop, or so many ticks, and decides each time as the same planner in Rust:
/// why it stopped, and where it is.
fn fly(
    survey: *mut PlannerVoxelSurvey,
    twin: &mut VoxelSurvey<5, 5, 16>,
    field: Field,
    from: Voxel,
    ticks: u32,
) -> (PlannerStop, Voxel) {
    let look = |_, at, heading| view(field, at, heading);
    fly_seeing(survey, twin, look, from, ticks)
}

/// The same with what a look shows, by its number.
fn fly_seeing(
    survey: *mut PlannerVoxelSurvey,
    twin: &mut VoxelSurvey<5, 5, 16>,
    look: impl Fn(u32, Voxel, Heading) -> Vec<(Voxel, bool)>,
    from: Voxel,
    ticks: u32,
) -> (PlannerStop, Voxel) {
    let (mut at, mut heading) = (from, twin.heading());
    for tick in 0..ticks {
        let view = look(tick, at, heading);
        assert_eq!(observe(survey, at, heading, &view), OK);
        twin.observe_towards(at, heading, &view);
        let action = decide(survey);
        let wanted = twin.tick();
        heading = Heading::new(action.heading);
        assert_eq!(heading, twin.heading());
        assert_eq!(action.wait, PlannerWait::from(twin.waiting()));
        let mut buffer = [0; PLANNER_MAX_FRAME];
        for frame in frames(survey) {
            assert_eq!(twin.transmit(&mut buffer), Some(frame.len()));
            assert_eq!(buffer[..frame.len()], frame);
        }
        match wanted {
            Action::Move(to) => {
                assert_eq!(action.kind, PlannerActionKind::Move);
                assert_eq!(action.to, to.into());
                at = to;
            }
            Action::Wait => assert_eq!(action.kind, PlannerActionKind::Wait),
            Action::Stop(stop) => {
                assert_eq!(action.kind, PlannerActionKind::Stop);
                assert_eq!(action.stop, stop.reason().into());
                assert_eq!(action.frontiers, stop.left());
                return (action.stop, at);
            }
        }
    }
    (PlannerStop::None, at)
}

#[test]
fn a_box_is_surveyed_as_in_rust() {
    let kinds = [
        (PlannerVoxelField::AllRound, Field::ALL_ROUND),
        (PlannerVoxelField::Downward, Field::DOWNWARD),
        (PlannerVoxelField::Lidar, Field::LIDAR),
        (PlannerVoxelField::Camera, Field::CAMERA),
        (
            PlannerVoxelField::Custom,
            Field {
                up: 60,
                down: 148,
                side: Some(110),
                near: 2,
            },
        ),
        (
            PlannerVoxelField::Custom,
            Field {
                side: None,
                near: 3,
                ..Field::LIDAR
            },
        ),
    ];
    for (kind, field) in kinds {
        let config = PlannerVoxelConfig {
            field: kind as u8,
            up: field.up,
            down: field.down,
            side: field.side.unwrap_or(0),
            near: field.near,
            ..BOX
        };
        let survey = survey_box(config, field);
        let now = told(survey);
        assert_eq!((now.has_stopped, now.has_goal, now.is_mute), (1, 0, 0));
        assert_eq!((now.heard_voxels, now.frontiers > 0), (0, now.known < 120));
        if kind == PlannerVoxelField::AllRound {
            assert_eq!(now.known, 120);
        }
        let mut state = 9;
        for (x, y, wanted) in [(4, 3, PlannerState::Obstacle), (1, 1, PlannerState::Free)] {
            let voxel = PlannerVoxel { x, y, z: 1 };
            assert_eq!(planner_voxel_state(survey, voxel, &mut state), OK);
            assert_eq!(state, wanted as u8);
        }
        assert_eq!(planner_voxel_resume(survey), OK);
        assert_eq!(told(survey).has_stopped, 0);
    }
}

#[test]
fn a_box_is_left_for_home_as_in_rust() {
    let field = Field::ALL_ROUND;
    let small = PlannerVoxelConfig {
        clearance: 0,
        ..BOX
    };
    for config in [BOX, small] {
        let come_home = PlannerVoxelConfig {
            come_home: 1,
            ..config
        };
        let survey = ready(Box::leak(room()), come_home);
        let mut robot = twin(come_home, field);
        let end = fly(survey, &mut robot, field, START, 2000);
        assert_eq!(end, (PlannerStop::Complete, START));

        let survey = ready(Box::leak(room()), config);
        let mut robot = twin(config, field);
        let (stop, away) = fly(survey, &mut robot, field, START, 5);
        assert!(stop == PlannerStop::None && away != START);
        assert_eq!(planner_voxel_go_home(survey), OK);
        robot.go_home();
        let end = fly(survey, &mut robot, field, away, 50);
        assert_eq!(end, (PlannerStop::Home, START));

        // With energy for a few ticks it comes back; with more it goes on.
        for ticks in [9, 1000] {
            assert_eq!(planner_voxel_resume(survey), OK);
            robot.resume();
            assert_eq!(planner_voxel_energy(survey, ticks), OK);
            robot.energy(ticks);
            let (stop, at) = fly(survey, &mut robot, field, START, 2000);
            match ticks {
                9 => assert_eq!((stop, at), (PlannerStop::Home, START)),
                _ => assert_eq!(stop, PlannerStop::Complete),
            }
        }
    }
}

/// Each fifth look takes all that it shows of one level for occupied.
#[test]
fn a_box_is_surveyed_with_a_sensor_that_errs_as_in_rust() {
    let look = |number: u32, at: Voxel, heading| {
        let mut view = view(Field::ALL_ROUND, at, heading);
        if number % 5 == 1 {
            let level = (number / 5 % 4) as i16;
            view.retain(|(voxel, _)| voxel.distance_squared(at) <= 4);
            for (voxel, occupied) in &mut view {
                *occupied |= *voxel != at && voxel.z == level;
            }
        }
        view
    };
    let posts = 4;
    for errs in [0, 1, 255] {
        let config = PlannerVoxelConfig { errs, ..BOX };
        let mut memory = room();
        let survey = ready(&mut memory, config);
        let mut robot = twin(config, Field::ALL_ROUND);
        let (stop, _) = fly_seeing(survey, &mut robot, look, START, 2000);
        assert_ne!(stop, PlannerStop::None);
        let occupied = |voxel: &Voxel| {
            let mut state = 9;
            assert_eq!(planner_voxel_state(survey, (*voxel).into(), &mut state), OK);
            state == PlannerState::Obstacle as u8
        };
        let all = (0..4).flat_map(|z| (0..30).map(move |i| Voxel::new(i % 6, i / 6, z)));
        let obstacles = all.filter(occupied).count();
        match errs {
            0 => assert!(obstacles > posts, "{obstacles}"),
            _ => assert_eq!(obstacles, posts),
        }
    }
}

#[test]
fn a_voxel_has_a_state() {
    let mut memory = room();
    let survey = ready(&mut memory, BOX);
    let ahead = Voxel::new(2, 1, 1);
    assert_eq!(
        observe(
            survey,
            START,
            Heading::EAST,
            &[(START, false), (ahead, true)]
        ),
        OK
    );
    let mut state = 9;
    for (voxel, wanted) in [
        (START, PlannerState::Frontier),
        (ahead, PlannerState::Obstacle),
        (Voxel::new(3, 1, 1), PlannerState::Unknown),
    ] {
        assert_eq!(planner_voxel_state(survey, voxel.into(), &mut state), OK);
        assert_eq!(state, wanted as u8);
    }
    for off in [
        Voxel::new(6, 0, 0),
        Voxel::new(0, 5, 0),
        Voxel::new(0, 0, 4),
    ] {
        let result = planner_voxel_state(survey, off.into(), &mut state);
        assert_eq!(result, PlannerResult::OffGrid);
    }
}

#[test]
fn robots_among_voxels_hear_each_other() {
    let mut memories = [room(), room(), room()];
    let [one, two, mute] = &mut memories;
    let one = ready(one, BOX);
    let two = ready(two, PlannerVoxelConfig { id: 2, ..BOX });
    let mute = ready(
        mute,
        PlannerVoxelConfig {
            id: 3,
            bytes_per_tick: 0,
            ..BOX
        },
    );
    let view = view(Field::ALL_ROUND, START, Heading::EAST);
    for robot in [one, mute] {
        assert_eq!(observe(robot, START, Heading::EAST, &view), OK);
        decide(robot);
    }
    assert_eq!((told(mute).is_mute, frames(mute).len()), (1, 0));
    let sent = frames(one);
    assert!(!sent.is_empty());
    let receive = |by, frame: &[u8]| planner_voxel_receive(by, frame.as_ptr(), frame.len());
    for frame in &sent {
        assert_eq!(receive(two, frame), OK);
        assert_eq!(receive(one, frame), PlannerResult::FrameOwn);
        assert_eq!(receive(two, &frame[1..]), PlannerResult::FrameVersion);
    }
    let now = told(two);
    assert!(
        now.heard_voxels > 0 && now.known >= now.heard_voxels,
        "{now:?}"
    );
    assert_eq!(receive(two, &[]), PlannerResult::FrameLength);
    // Two planners on the ground and in the air do not read each other's frames.
    let mut memory = memory();
    let ground = created(&mut memory, CONFIG);
    let frame = sent.first().unwrap();
    let result = planner_receive(ground, frame.as_ptr(), frame.len());
    assert!(
        result as u8 >= PlannerResult::FrameLength as u8,
        "{result:?}"
    );

    assert_eq!(planner_voxel_hear(two, 1, &told(one)), OK);
    assert_eq!(
        planner_voxel_hear(two, 2, &told(one)),
        PlannerResult::FrameOwn
    );
    let far = PlannerVoxel { x: 6, y: 0, z: 0 };
    let lost = PlannerVoxelStatus {
        position: far,
        ..told(one)
    };
    assert_eq!(planner_voxel_hear(two, 1, &lost), PlannerResult::OffGrid);
    let misled = PlannerVoxelStatus {
        goal: far,
        has_goal: 1,
        ..told(one)
    };
    assert_eq!(planner_voxel_hear(two, 1, &misled), PlannerResult::OffGrid);
    let at_rest = PlannerVoxelStatus {
        has_goal: 0,
        ..misled
    };
    assert_eq!(planner_voxel_hear(two, 1, &at_rest), OK);
}
