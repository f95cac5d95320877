//! The planner among voxels: robots that fly under bridges, through doors, around towers.

use planner_core::radio::{Key, LinkConfig, MAX_LEN};
use planner_core::volume::{Content, Field, Heading, MAX_CLEARANCE, Volume, Voxel};
use planner_core::voxel_survey::{Config, MAX_RANGE, Sensor, VoxelSurvey};
use planner_core::{Action, Activity, Extent, RobotId, Status};

use crate::answer;
use crate::place::{Memory, create, fits, input, inputs, output, robot};
use crate::types::{PlannerActionKind, PlannerResult, PlannerState, PlannerStop, PlannerWait};

/// Largest width and depth of a box, in voxels.
pub const PLANNER_VOXEL_MAX_SIDE: u16 = 40;
/// Most levels of a box.
pub const PLANNER_VOXEL_MAX_LEVELS: u8 = 16;
/// Largest range of a sensor, in voxels.
pub const PLANNER_VOXEL_MAX_RANGE: u8 = 12;
const _: () = assert!(PLANNER_VOXEL_MAX_RANGE == MAX_RANGE);

/// Size of a planner among voxels in words of 8 bytes: what it may take by
/// `fixtures/budget.txt`, and one that tells that it is there.
pub const PLANNER_VOXEL_SURVEY_WORDS: usize = 3073;

const TILES: usize = PLANNER_VOXEL_MAX_SIDE as usize / 8;
const LEVELS: usize = PLANNER_VOXEL_MAX_LEVELS as usize;

/// Memory for one planner among voxels. `planner_voxel_create` makes one in it. Do not copy
/// it.
#[repr(C)]
pub struct PlannerVoxelSurvey {
    words: [u64; PLANNER_VOXEL_SURVEY_WORDS],
}

impl Memory for PlannerVoxelSurvey {
    type Planner = VoxelSurvey<TILES, TILES, LEVELS>;
    const VACANT: Self::Planner = VoxelSurvey::vacant();
    const CREATED: u32 = 0x85eb_ca6b;
}

/// One voxel of the box.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerVoxel {
    /// Column, growing to the east.
    pub x: i16,
    /// Row, growing to the south.
    pub y: i16,
    /// Level; 0 is the lowest.
    pub z: i16,
}

impl From<Voxel> for PlannerVoxel {
    fn from(Voxel { x, y, z }: Voxel) -> Self {
        Self { x, y, z }
    }
}

impl From<PlannerVoxel> for Voxel {
    fn from(PlannerVoxel { x, y, z }: PlannerVoxel) -> Self {
        Self { x, y, z }
    }
}

/// What of the voxels within range and in sight a look shows. All but the last also show what
/// is within 2 voxels, or `clearance` + 1 if that is more, in every direction, as by range
/// finders all round: give these voxels with every look.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerVoxelField {
    /// All of them.
    AllRound = 0,
    /// Those no higher than the robot.
    Downward = 1,
    /// Those of the robot's level: a lidar that turns in a plane.
    Lidar = 2,
    /// Those in a cone of 90×60 degrees: a depth camera, turned to a heading.
    Camera = 3,
    /// Those within `up`, `down`, `side` and `near` of the configuration.
    Custom = 4,
}

/// How a planner among voxels is set up. All robots of a fleet agree on everything but the
/// id, in which all differ.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerVoxelConfig {
    /// The robot's number, its own in the fleet; lower ones win ties.
    pub id: u8,
    /// Width of the box, in voxels.
    pub width: u16,
    /// Its depth from north to south, in voxels.
    pub depth: u16,
    /// Its levels.
    pub levels: u8,
    /// How far a look reaches, in voxels: 2 to `PLANNER_VOXEL_MAX_RANGE`, and more than
    /// `clearance`.
    pub range: u8,
    /// How far the robot's body reaches beyond the voxel of its middle: 0 to 3. With 0 it
    /// stays in its voxel, with 1 those that share a face with it are kept free, then all
    /// within so many voxels.
    pub clearance: u8,
    /// Not 0: a robot that has surveyed all flies home, to where it was first, before it stops.
    pub come_home: u8,
    /// Not 0: looks err now and then, and three in a row against the map change it. What is
    /// occupied can be free again then, which others are told of, for good. 0: every look is
    /// believed.
    pub errs: u8,
    /// What a look shows: a `PlannerVoxelField`.
    pub field: u8,
    /// For `PLANNER_VOXEL_FIELD_CUSTOM`, how far up it shows: the tangent of the highest
    /// elevation, in 256ths; 65535: up to straight above.
    pub up: u16,
    /// The same down.
    pub down: u16,
    /// The tangent of half its width on the plan, in 256ths; 0: it shows all round.
    pub side: u16,
    /// Distance in voxels within which it shows everything in all directions: `clearance` + 1
    /// for a robot that is to fly everywhere. With less it flies only where its field itself
    /// has shown room for its body: it may survey little, or not leave its start, and stop with
    /// `PLANNER_STOP_OUT_OF_REACH`, which counts as complete.
    pub near: u8,
    /// Side of a voxel in millimetres, above 0.
    pub cell_mm: u16,
    /// Where the north-western corner of the lowest level lies in the common frame, in
    /// millimetres.
    pub origin_x_mm: i32,
    /// The same along y.
    pub origin_y_mm: i32,
    /// Bytes that the robot may send a tick on average; 0: it only listens, which
    /// `planner_voxel_status` tells.
    pub bytes_per_tick: u16,
    /// As of `PlannerConfig`: 0 for frames without a signature, anything else for those that
    /// are signed with `key`.
    pub is_keyed: u8,
    /// The key of the fleet.
    pub key: [u8; 16],
}

impl PlannerVoxelConfig {
    /// What a look shows; `None` if there is no such field.
    fn field(&self) -> Option<Field> {
        const ALL_ROUND: u8 = PlannerVoxelField::AllRound as u8;
        const DOWNWARD: u8 = PlannerVoxelField::Downward as u8;
        const LIDAR: u8 = PlannerVoxelField::Lidar as u8;
        const CAMERA: u8 = PlannerVoxelField::Camera as u8;
        const CUSTOM: u8 = PlannerVoxelField::Custom as u8;
        match self.field {
            ALL_ROUND => Some(Field::ALL_ROUND),
            DOWNWARD => Some(Field::DOWNWARD.for_body(self.clearance)),
            LIDAR => Some(Field::LIDAR.for_body(self.clearance)),
            CAMERA => Some(Field::CAMERA.for_body(self.clearance)),
            CUSTOM => Some(Field {
                up: self.up,
                down: self.down,
                side: (self.side > 0).then_some(self.side),
                near: self.near,
            }),
            _ => None,
        }
    }
}

/// One voxel that was seen.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerVoxelSeen {
    /// Which one.
    pub voxel: PlannerVoxel,
    /// 0: it is free. Anything else: something is there.
    pub occupied: u8,
}

/// What a tick decided.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerVoxelAction {
    /// What to do. Nothing is reported after a move: the next look tells where the robot is.
    pub kind: PlannerActionKind,
    /// For a move, where to fly: a voxel that shares a face with the robot's, and that has
    /// room for its body. Otherwise where the robot is.
    pub to: PlannerVoxel,
    /// Where the sensor should be turned in the next look, which is 0 before the first tick:
    /// eighths of a turn from the east over the south, 0 to 7. It may turn while the robot
    /// flies.
    pub heading: u8,
    /// Why, for a wait; `PLANNER_WAIT_NONE`: it chooses where to fly next, or turns.
    pub wait: PlannerWait,
    /// Why, for a stop.
    pub stop: PlannerStop,
    /// Free voxels beside unknown ones, for a stop.
    pub frontiers: u32,
    /// The voxel that could not be entered, for `PLANNER_STOP_BLOCKED`, or be seen, for
    /// `PLANNER_STOP_UNSEEN`; home, for `PLANNER_STOP_NO_WAY`.
    pub at: PlannerVoxel,
}

/// Enumerations take one byte in the ABI of bare Arm chips; the header checks the same.
#[cfg(all(target_arch = "arm", target_os = "none"))]
const _: () = assert!(size_of::<PlannerVoxelAction>() == 24);

/// Where a robot is, where it goes, what it knows, and what it has from others. Counts begin
/// when the planner is created; those of 16 bits stay at their largest value.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannerVoxelStatus {
    /// Where it is.
    pub position: PlannerVoxel,
    /// Where it flies to; where it is, if it flies nowhere.
    pub goal: PlannerVoxel,
    /// Whether it flies somewhere: 0 or 1.
    pub has_goal: u8,
    /// Whether it has stopped: 0 or 1.
    pub has_stopped: u8,
    /// Whether its configuration lets it send nothing: 0 or 1.
    pub is_mute: u8,
    /// Voxels of the box that are known.
    pub known: u32,
    /// Those of them that are free and beside unknown ones.
    pub frontiers: u32,
    /// Voxels that others told before the robot saw them.
    pub heard_voxels: u32,
    /// Frames of another robot with this robot's id.
    pub same_id: u16,
    /// Frames that were damaged, or not signed with the key.
    pub refused: u16,
}

/// Creates a planner among voxels in place, or starts it anew. `bytes` is
/// `sizeof(PlannerVoxelSurvey)`. After any result but `PLANNER_RESULT_OK` nothing has changed.
///
/// One step of a robot is `planner_voxel_observe`; then `planner_voxel_transmit` until there is
/// nothing to send, and `planner_voxel_receive`; then `planner_voxel_tick`.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_create(
    survey: *mut PlannerVoxelSurvey,
    bytes: usize,
    config: *const PlannerVoxelConfig,
) -> PlannerResult {
    answer(|| {
        let config = *input(config)?;
        fits::<PlannerVoxelSurvey>(bytes)?;
        let sides = [config.width, config.depth];
        let is_box = sides
            .iter()
            .all(|side| (1..=PLANNER_VOXEL_MAX_SIDE).contains(side));
        if !is_box || !(1..=PLANNER_VOXEL_MAX_LEVELS).contains(&config.levels) {
            return Err(PlannerResult::Extent);
        }
        if config.cell_mm == 0 {
            return Err(PlannerResult::CellSize);
        }
        if config.clearance > MAX_CLEARANCE {
            return Err(PlannerResult::Clearance);
        }
        let least = 2.max(config.clearance + 1);
        if !(least..=PLANNER_VOXEL_MAX_RANGE).contains(&config.range) {
            return Err(PlannerResult::Range);
        }
        let ours = Config {
            range: config.range,
            clearance: config.clearance,
            come_home: config.come_home != 0,
            field: config.field().ok_or(PlannerResult::Sensor)?,
            sensor: match config.errs {
                0 => Sensor::Truthful,
                _ => Sensor::Errs,
            },
            link: LinkConfig {
                origin_mm: (config.origin_x_mm, config.origin_y_mm),
                cell_mm: config.cell_mm,
                bytes_per_tick: config.bytes_per_tick,
                key: (config.is_keyed != 0).then_some(Key(config.key)),
            },
            ..Config::new()
        };
        let extent = Extent::new(config.width, config.depth);
        create(survey, config.id, config.bytes_per_tick)?
            .reset(ours, RobotId(config.id), extent, config.levels)
            .map_err(|_| PlannerResult::Extent)
    })
}

/// Takes in a look: where the robot is, where its sensor is turned (eighths of a turn from
/// the east over the south; of no matter if it shows all round), and *every* voxel within
/// range, in the field and in sight over free ones, each with whether something is there. One
/// look is one call of an array of any length, at range 8 of 2,109 voxels at most and at range 12 of
/// 7,153, and shows at least the robot's own voxel, which is free whatever the map
/// said of it. A voxel is in sight if the straight line to it, from the middle of the robot's
/// voxel to its own, passes free voxels alone, of the two beside an edge at least one, and
/// about a corner two side by side. A voxel that a look should show and never does ends in
/// `PLANNER_STOP_UNSEEN`. So do 100 looks in a row without a voxel of the box, or ticks without
/// a look, as of a sensor that failed; the robot waits meanwhile, for `PLANNER_WAIT_SIGHT`, and
/// before its first look for as long as there is none. Voxels outside of the box are passed
/// over.
///
/// A robot that is where it was, and not where the last move sent it, was kept from there;
/// one that is elsewhere was pushed, and flies on. `PLANNER_RESULT_OFF_GRID`: it is not in the
/// box; nothing is learnt and nothing decided until it is. Any other result but
/// `PLANNER_RESULT_OK` changes nothing.
///
/// Work: the voxels seen, and at most a ray for each voxel within range.
///
/// Stack: 4352 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_observe(
    survey: *mut PlannerVoxelSurvey,
    at: PlannerVoxel,
    heading: u8,
    seen: *const PlannerVoxelSeen,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(survey)?;
        let seen = inputs(seen, count)?;
        if heading > 7 {
            return Err(PlannerResult::Heading);
        }
        let each = |seen: &PlannerVoxelSeen| (seen.voxel.into(), seen.occupied != 0);
        let (at, heading) = (at.into(), Heading::new(heading));
        robot
            .planner
            .observe_towards(at, heading, seen.iter().map(each));
        in_the_box(robot.planner.volume(), at)
    })
}

/// Decides what the robot does now. Call it once a step. Work: at most about 8,000,000
/// instructions.
///
/// Stack: 9472 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_tick(
    survey: *mut PlannerVoxelSurvey,
    action: *mut PlannerVoxelAction,
) -> PlannerResult {
    answer(|| {
        let planner = &mut robot(survey)?.planner;
        let action = output(action)?;
        let decided = planner.tick();
        let position = planner.position().into();
        let mut told = PlannerVoxelAction {
            kind: PlannerActionKind::Wait,
            to: position,
            heading: planner.heading().eighths(),
            wait: planner.waiting().into(),
            stop: PlannerStop::None,
            frontiers: 0,
            at: position,
        };
        match decided {
            Action::Move(to) => {
                told.kind = PlannerActionKind::Move;
                told.to = to.into();
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                told.kind = PlannerActionKind::Stop;
                told.stop = stop.reason().into();
                told.frontiers = stop.left();
                if let Some(&at) = stop.place() {
                    told.at = at.into();
                }
            }
        }
        action.write(told);
        Ok(())
    })
}

/// Goes on after a stop with the map at hand: what was given up is tried again. Without a
/// stop it does only the latter.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_resume(survey: *mut PlannerVoxelSurvey) -> PlannerResult {
    answer(|| {
        robot(survey)?.planner.resume();
        Ok(())
    })
}

/// Sends the robot home, to where it was first, also from a stop. It stops there with
/// `PLANNER_STOP_HOME`, or says why not: `PLANNER_STOP_NO_WAY` or `PLANNER_STOP_BLOCKED`.
/// `planner_voxel_resume` then goes on surveying.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_go_home(survey: *mut PlannerVoxelSurvey) -> PlannerResult {
    answer(|| {
        robot(survey)?.planner.go_home();
        Ok(())
    })
}

/// Tells the planner for how many ticks in the air the robot's energy lasts from now on; each
/// that does not stop takes one off, in a wait too, until it is told again. The robot turns
/// back in time for the shortest way home that it knows and the search for it, and stops there
/// with `PLANNER_STOP_HOME`; told more, `planner_voxel_resume` goes on surveying. Without this
/// call there is no limit.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_energy(
    survey: *mut PlannerVoxelSurvey,
    ticks: u32,
) -> PlannerResult {
    answer(|| {
        robot(survey)?.planner.energy(ticks);
        Ok(())
    })
}

/// Writes the next frame for the other robots into `frame`, which holds `PLANNER_MAX_FRAME`
/// bytes, and its length into `length`: 0 if there is nothing to send any more. Work: 256
/// words for each of at most 12 pieces of the map.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_transmit(
    survey: *mut PlannerVoxelSurvey,
    frame: *mut u8,
    length: *mut usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(survey)?;
        let frame = output(frame.cast::<[u8; MAX_LEN]>())?;
        let length = output(length)?;
        let mut buffer = [0; MAX_LEN];
        let written = robot.planner.transmit(&mut buffer);
        frame.write(buffer);
        length.write(written.unwrap_or(0));
        Ok(())
    })
}

/// Takes in a frame of another robot among voxels, at any time. A result from
/// `PLANNER_RESULT_FRAME_LENGTH` on tells why it was not taken; nothing has changed then.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_receive(
    survey: *mut PlannerVoxelSurvey,
    frame: *const u8,
    length: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(survey)?;
        robot.planner.receive(inputs(frame, length)?)?;
        Ok(())
    })
}

/// Takes in where robot `id` is, where it flies and whether it has stopped, as it was told by
/// other means than frames, which tell it too; of `status` nothing else is read.
/// `PLANNER_RESULT_FRAME_OWN`: the id is the robot's own. `PLANNER_RESULT_OFF_GRID`: the other
/// robot or its goal is not in the box. Then nothing has changed.
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_hear(
    survey: *mut PlannerVoxelSurvey,
    id: u8,
    status: *const PlannerVoxelStatus,
) -> PlannerResult {
    answer(|| {
        let robot = robot(survey)?;
        let told = input(status)?;
        if id == robot.id {
            return Err(PlannerResult::FrameOwn);
        }
        let status = Status {
            position: told.position.into(),
            goal: (told.has_goal != 0).then_some(told.goal.into()),
            activity: Activity::stopped_if(told.has_stopped != 0),
        };
        for place in [Some(status.position), status.goal].into_iter().flatten() {
            in_the_box(robot.planner.volume(), place)?;
        }
        robot.planner.hear(RobotId(id), status);
        Ok(())
    })
}

/// Writes where the robot is, where it flies, what it knows, and what it has from others.
/// Work: 14 words for each of at most 400 tiles of voxels.
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_status(
    survey: *mut PlannerVoxelSurvey,
    status: *mut PlannerVoxelStatus,
) -> PlannerResult {
    answer(|| {
        let robot = robot(survey)?;
        let (now, hearsay) = (robot.planner.status(), robot.planner.hearsay());
        output(status)?.write(PlannerVoxelStatus {
            position: now.position.into(),
            goal: now.goal.unwrap_or(now.position).into(),
            has_goal: now.goal.is_some().into(),
            has_stopped: now.has_stopped().into(),
            is_mute: robot.is_mute.into(),
            known: robot.planner.volume().known_voxels(),
            frontiers: robot.planner.volume().frontiers(),
            heard_voxels: hearsay.cells,
            same_id: hearsay.same_id,
            refused: hearsay.refused,
        });
        Ok(())
    })
}

/// Writes the `PlannerState` of a voxel, none of which is doubtful.
/// `PLANNER_RESULT_OFF_GRID`: there is no such voxel.
///
/// Stack: 256 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_state(
    survey: *mut PlannerVoxelSurvey,
    voxel: PlannerVoxel,
    state: *mut u8,
) -> PlannerResult {
    answer(|| {
        let volume = robot(survey)?.planner.volume();
        let voxel = voxel.into();
        in_the_box(volume, voxel)?;
        let is_unknown = |voxel: &Voxel| volume.content(*voxel) == Content::Unknown;
        let seen = match volume.content(voxel) {
            Content::Unknown => PlannerState::Unknown,
            Content::Occupied => PlannerState::Obstacle,
            Content::Free if voxel.beside().iter().any(is_unknown) => PlannerState::Frontier,
            Content::Free => PlannerState::Free,
        };
        output(state)?.write(seen as u8);
        Ok(())
    })
}

fn in_the_box(volume: &Volume<TILES, TILES, LEVELS>, voxel: Voxel) -> Result<(), PlannerResult> {
    match volume.contains(voxel) {
        true => Ok(()),
        false => Err(PlannerResult::OffGrid),
    }
}
