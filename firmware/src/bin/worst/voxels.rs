//! The calls of the planner among voxels, in boxes of 40×40×16 and 40×40×18 of them.

use core::fmt::{self, Write as _};

use cortex_m_semihosting::hio;
use firmware::Stopwatch;
use planner_core::radio::MAX_LEN;
use planner_core::rng::Rng;
use planner_core::tile::TileIndex;
use planner_core::volume::{Field, Voxel, VoxelPatch};
use planner_core::voxel_survey::{Config, MAX_RANGE, Sensor, VoxelSurvey};
use planner_core::{Action, Extent, RobotId};
use static_cell::ConstStaticCell;

use crate::Most;

/// As many as towns have.
const LEVELS: u8 = 18;

/// How far the robot sees, in voxels.
const RANGE: u8 = 8;

/// Where it looks around.
const EYE: Voxel = Voxel::new(20, 20, 8);

/// Voxels within the range.
const SEEN: usize = 2109;

/// Ticks in each place.
const TICKS: usize = 24;

/// Frames that the robot hears.
const FRAMES: usize = 24;

static ROBOT: ConstStaticCell<Robot> = ConstStaticCell::new(Robot::vacant());
static LOOK: ConstStaticCell<Look> = ConstStaticCell::new(Look {
    voxels: [(Voxel::new(0, 0, 0), false); SEEN],
    length: 0,
});

type Robot = VoxelSurvey<5, 5, { LEVELS as usize }>;

/// A sensor, a body, and the height of the box in which they are tried.
struct Setup {
    /// As in the names of what is measured.
    name: &'static str,
    range: u8,
    field: Field,
    levels: u8,
    clearance: u8,
}

const SETUPS: [Setup; 8] = [
    Setup::new("", RANGE, Field::ALL_ROUND, 16),
    Setup::new("_18_levels", RANGE, Field::ALL_ROUND, LEVELS),
    Setup::new("_camera", RANGE, Field::CAMERA, LEVELS),
    Setup::new("_downward", RANGE, Field::DOWNWARD, LEVELS),
    Setup::new("_lidar", RANGE, Field::LIDAR, LEVELS),
    Setup::new("_range_12", MAX_RANGE, Field::ALL_ROUND, LEVELS),
    Setup::new("_clearance_2", RANGE, Field::ALL_ROUND, LEVELS).wide(2),
    Setup::new("_clearance_3", RANGE, Field::ALL_ROUND, LEVELS).wide(3),
];

impl Setup {
    const fn new(name: &'static str, range: u8, field: Field, levels: u8) -> Self {
        Self {
            name,
            range,
            field,
            levels,
            clearance: 1,
        }
    }

    /// The same with a larger body.
    const fn wide(self, clearance: u8) -> Self {
        Self { clearance, ..self }
    }

    /// What a robot with it knows of a voxel of `place`: room for its body, and that.
    fn kind(&self, place: Place, at: Voxel) -> Kind {
        let reach = u32::from(self.clearance);
        match at.distance_squared(place.own()) <= (reach * reach).max(3) {
            true => Kind::Free,
            false => place.kind(at),
        }
    }
}

/// What a look shows.
struct Look {
    voxels: [(Voxel, bool); SEEN],
    length: usize,
}

impl Look {
    fn add(&mut self, voxel: Voxel, is_occupied: bool) {
        if let Some(place) = self.voxels.get_mut(self.length) {
            *place = (voxel, is_occupied);
            self.length += 1;
        }
    }

    fn seen(&self) -> &[(Voxel, bool)] {
        self.voxels.get(..self.length).unwrap_or_default()
    }
}

/// What a robot knows of a voxel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Unknown,
    Free,
    Occupied,
}

/// A box that the robot knows, but for some of its voxels.
#[derive(Clone, Copy)]
enum Place {
    /// Voxels that are unknown or occupied by chance: nearly every one of them takes a ray
    /// of its own.
    Scattered(u8),
    /// Rooms of 7×7×7 voxels behind doors of 3×3; some rooms are unknown.
    Rooms(u8),
    /// Walls with a gap at their ends by turns: the longest way that fits. At its end is
    /// something unknown.
    Winding,
    /// Open, but for voxels that nothing shows.
    Open,
    /// Open below a roof; all above it is unknown.
    Roofed,
}

/// Places of each kind that chance makes.
const SEEDS: u8 = 16;

fn chance(seed: u8, Voxel { x, y, z }: Voxel) -> u32 {
    let place = (x as u64) << 32 | (y as u64) << 16 | z as u64;
    Rng::new(u64::from(seed), place).next_u32()
}

impl Place {
    fn all() -> impl Iterator<Item = Self> {
        let scattered = (0..SEEDS).map(Self::Scattered);
        let rooms = (0..SEEDS).map(Self::Rooms);
        let made = [Self::Winding, Self::Open, Self::Roofed].into_iter();
        made.chain(scattered).chain(rooms)
    }

    /// Where the robot is.
    const fn own(self) -> Voxel {
        match self {
            Self::Winding => Voxel::new(1, 1, 1),
            Self::Scattered(_) | Self::Rooms(_) | Self::Open | Self::Roofed => {
                Voxel::new(20, 20, 4)
            }
        }
    }

    fn kind(self, at: Voxel) -> Kind {
        let Voxel { x, y, z } = at;
        match self {
            Self::Scattered(seed) => {
                // Ever more unknown voxels, and ever more that are occupied.
                let unknown = [1, 6, 16, 30][usize::from(seed % 4)];
                let occupied = [0, 1, 3, 6][usize::from(seed / 4 % 4)];
                match chance(seed, at) % 64 {
                    chance if chance < unknown => Kind::Unknown,
                    chance if chance < unknown + occupied => Kind::Occupied,
                    _ => Kind::Free,
                }
            }
            Self::Rooms(seed) => {
                let wall = [x, y, z].map(|a| a % 8 == 0);
                let walls = wall.iter().filter(|&&is_wall| is_wall).count();
                let is_door = |a: i16| (3..=5).contains(&(a % 8));
                let doors = [x, y, z].into_iter().filter(|&a| is_door(a)).count();
                let room = Voxel::new(x / 8, y / 8, z / 8);
                match walls {
                    0 if chance(seed, room) % 8 < u32::from(seed % 6) => Kind::Unknown,
                    0 => Kind::Free,
                    1 if doors == 2 && z % 8 != 0 => Kind::Free,
                    _ => Kind::Occupied,
                }
            }
            Self::Winding => {
                let is_gap = if (y / 4) % 2 == 0 { x > 36 } else { x < 3 };
                let is_open = if (z / 4) % 2 == 0 { y > 36 } else { y < 3 };
                match (y % 4, z % 4) {
                    (_, 3) if !is_open => Kind::Occupied,
                    (3, _) if !is_gap => Kind::Occupied,
                    _ if x == 39 && y == 39 && z == 15 => Kind::Unknown,
                    _ => Kind::Free,
                }
            }
            Self::Open => {
                let beside = |at: i16, middle: i16| (at % 10 - middle).unsigned_abs();
                match beside(x, 5) + beside(y, 5) + beside(z, 8) {
                    0 => Kind::Unknown,
                    1 => Kind::Occupied,
                    _ => Kind::Free,
                }
            }
            Self::Roofed => match z {
                ..7 => Kind::Free,
                7 => Kind::Occupied,
                _ => Kind::Unknown,
            },
        }
    }
}

#[derive(Default)]
struct Calls {
    observe: Most,
    tick: Most,
    transmit: Most,
    receive: Most,
    work: u32,
}

/// Measures, and prints `name: value` lines: all calls of the first setup, the ticks of all, and looks
/// of a sensor that errs.
pub(crate) fn measure(stopwatch: &Stopwatch) -> fmt::Result {
    let (robot, look) = (ROBOT.take(), LOOK.take());
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    for setup in &SETUPS {
        let (mut calls, name) = (Calls::default(), setup.name);
        for place in Place::all() {
            enter(robot, setup, place);
            decide(robot, stopwatch, place, look, &mut calls);
            if name.is_empty() {
                talk(robot, stopwatch, setup, place, look, &mut calls);
            }
        }
        let of = [
            ("tick", calls.tick),
            ("observe", calls.observe),
            ("transmit", calls.transmit),
            ("receive", calls.receive),
        ];
        let measured = if name.is_empty() { of.len() } else { 1 };
        for (call, most) in of.into_iter().take(measured) {
            let instructions = most.instructions();
            writeln!(out, "worst_voxel_survey{name}_{call}: {instructions}")?;
            writeln!(out, "worst_voxel_survey{name}_{call}_stack: {}", most.stack)?;
        }
        writeln!(out, "worst_voxel_survey{name}_work: {}", calls.work)?;
    }
    let most = contradict(robot, stopwatch, look);
    let (name, instructions) = ("worst_voxel_survey_errs_observe", most.instructions());
    writeln!(out, "{name}: {instructions}")?;
    writeln!(out, "{name}_stack: {}", most.stack)
}

fn reset(robot: &mut Robot, setup: &Setup, id: RobotId) {
    reset_with(robot, setup, Sensor::Truthful, id);
}

fn reset_with(robot: &mut Robot, setup: &Setup, sensor: Sensor, id: RobotId) {
    let config = Config {
        range: setup.range,
        field: setup.field,
        clearance: setup.clearance,
        sensor,
        ..Config::new()
    };
    let _ = robot.reset(config, id, Extent::new(40, 40), setup.levels);
}

/// The voxels within the range of the robot that looks around.
fn ball() -> impl Iterator<Item = Voxel> {
    let reach = i16::from(RANGE);
    let cube = (-reach..=reach).flat_map(move |z| {
        (-reach..=reach)
            .flat_map(move |y| (-reach..=reach).map(move |x| Voxel::new(20 + x, 20 + y, 8 + z)))
    });
    cube.filter(|&at| at.distance_squared(EYE) <= u32::from(RANGE).pow(2))
}

/// Looks of a sensor that errs, each of which contradicts all that the one before it showed.
fn contradict(robot: &mut Robot, watch: &Stopwatch, look: &mut Look) -> Most {
    let mut most = Most::default();
    reset_with(robot, &SETUPS[0], Sensor::Errs, RobotId(0));
    for is_occupied in [false, true, true, true, false, false, false] {
        look.length = 0;
        for voxel in ball() {
            look.add(voxel, is_occupied && voxel != EYE);
        }
        most.of(watch, || robot.observe(EYE, look.seen()));
        robot.tick();
    }
    most
}

/// Sets up the robot in a place that it knows.
fn enter(robot: &mut Robot, setup: &Setup, place: Place) {
    reset(robot, setup, RobotId(0));
    for z in 0..i16::from(setup.levels) {
        for (x, y) in (0..5).flat_map(|x| (0..5).map(move |y| (x, y))) {
            let tile = TileIndex::new(x, y);
            let (mut known, mut occupied) = (0, 0);
            for bit in 0..64 {
                let cell = tile.cell(bit);
                match setup.kind(place, Voxel::new(cell.x, cell.y, z)) {
                    Kind::Unknown => {}
                    Kind::Free => known |= 1 << bit,
                    Kind::Occupied => {
                        known |= 1 << bit;
                        occupied |= 1 << bit;
                    }
                }
            }
            robot.merge(&VoxelPatch {
                tile,
                z: z as u8,
                known,
                occupied,
            });
        }
    }
}

/// Decides, and flies where that says.
fn decide(robot: &mut Robot, watch: &Stopwatch, place: Place, look: &mut Look, calls: &mut Calls) {
    let mut at = place.own();
    for _ in 0..TICKS {
        look.length = 0;
        look.add(at, false);
        calls.observe.of(watch, || robot.observe(at, look.seen()));
        let action = calls.tick.of(watch, || robot.tick());
        calls.work = calls.work.max(robot.work());
        match action {
            Action::Move(to) => at = to,
            Action::Wait => {}
            Action::Stop(_) => break,
        }
    }
}

/// Looks around in a place that it does not know, sends what was seen, and lets the robot
/// hear it when it knows nothing.
fn talk(
    robot: &mut Robot,
    watch: &Stopwatch,
    setup: &Setup,
    place: Place,
    look: &mut Look,
    calls: &mut Calls,
) {
    let mut frames = [(0, [0; MAX_LEN]); FRAMES];
    let mut free = frames.iter_mut();
    look.length = 0;
    for voxel in ball() {
        match setup.kind(place, voxel) {
            Kind::Unknown => {}
            Kind::Free => look.add(voxel, false),
            Kind::Occupied => look.add(voxel, true),
        }
    }
    // In the name of another.
    reset(robot, setup, RobotId(1));
    for _ in 0..4 {
        calls.observe.of(watch, || robot.observe(EYE, look.seen()));
        robot.tick();
        let mut frame = [0; MAX_LEN];
        while let Some(length) = calls.transmit.of(watch, || robot.transmit(&mut frame)) {
            if let Some(place) = free.next() {
                *place = (length, frame);
            }
        }
    }
    reset(robot, setup, RobotId(0));
    for (length, frame) in &frames {
        let frame = frame.get(..*length).unwrap_or_default();
        let _ = calls.receive.of(watch, || robot.receive(frame));
    }
}
