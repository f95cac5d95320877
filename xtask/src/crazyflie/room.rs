//! The room, what flies in it, and everything that goes wrong there.

use anyhow::{Result, bail};

use super::stub::{Request, Sensed};

/// Cells of 300 mm; the digits are where Crazyflies start. Not its own
/// mirror image.
const PLAN: [&str; 16] = [
    "########################",
    "#......#...............#",
    "#......#...............#",
    "#......#.....###.......#",
    "#............###.......#",
    "#......................#",
    "#......#...............#",
    "####.###...............#",
    "#........1.2.3....######",
    "#.................#....#",
    "#.................#....#",
    "#......#..........#....#",
    "#......#...............#",
    "#......#...............#",
    "#......#..........#....#",
    "########################",
];
const SIDE: f32 = 0.3;

/// Reasons of stops that mean "complete", by their codes in C.
pub(super) const COMPLETE: [u8; 4] = [1, 2, 6, 7];

/// Half of a Crazyflie with its propellers, in metres.
const RADIUS: f32 = 0.07;

/// A place in metres, in the middle of the room 0, 0; y to the left of x.
type Place = (f32, f32);

pub(super) struct Room(Vec<&'static [u8]>);

impl Room {
    pub(super) fn new() -> Self {
        Self(PLAN.map(str::as_bytes).to_vec())
    }

    fn is_wall(&self, (x, y): Place) -> bool {
        let column = (x / SIDE + 12.0).floor();
        let row = (8.0 - y / SIDE).floor();
        let inside = (0.0..24.0).contains(&column) && (0.0..16.0).contains(&row);
        !inside || self.0[row as usize][column as usize] == b'#'
    }

    pub(super) fn starts(&self) -> Vec<Place> {
        let mut starts = Vec::new();
        for (row, y) in self.0.iter().zip(0u8..) {
            for (sign, x) in row.iter().zip(0u8..) {
                if sign.is_ascii_digit() {
                    let middle = |at: u8| (f32::from(at) + 0.5) * SIDE;
                    starts.push((middle(x) - 12.0 * SIDE, 8.0 * SIDE - middle(y)));
                }
            }
        }
        starts
    }

    /// Free cells, all of which can be reached, and the walls beside them.
    pub(super) fn visible(&self) -> u32 {
        let rows = self.0.len();
        let is_free = |x: usize, y: usize| {
            let sign = self.0.get(y).and_then(|row| row.get(x));
            sign.is_some_and(|&sign| sign != b'#')
        };
        let is_seen = |&(x, y): &(usize, usize)| {
            let beside = [
                (x + 1, y),
                (x, y + 1),
                (x.wrapping_sub(1), y),
                (x, y.wrapping_sub(1)),
            ];
            is_free(x, y) || beside.iter().any(|&(x, y)| is_free(x, y))
        };
        let cells = (0..rows).flat_map(|y| (0..self.0[y].len()).map(move |x| (x, y)));
        cells.filter(is_seen).count() as u32
    }

    /// Metres to a wall or another robot.
    fn range(&self, from: Place, yaw: f32, others: &[Place]) -> f32 {
        let (sin, cos) = yaw.sin_cos();
        let mut far = 0.0;
        while far < 8.0 {
            let at = (from.0 + far * cos, from.1 + far * sin);
            let is_robot = |other: &Place| distance(at, *other) < RADIUS;
            if self.is_wall(at) || others.iter().any(is_robot) {
                return far;
            }
            far += 0.005;
        }
        f32::INFINITY
    }
}

fn distance(a: Place, b: Place) -> f32 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// A Crazyflie in the air.
pub(super) struct Drone {
    at: Place,
    height: f32,
    yaw: f32,
    /// How far it leans, in degrees.
    lean: (f32, f32),
    /// Where it flies from, since when, and where it ends, when.
    leg: Option<Leg>,
    now: u32,
    /// How often a gust has pushed it into another cell.
    pub(super) pushed: u32,
}

struct Leg {
    from: (Place, f32, f32),
    to: (Place, f32, f32),
    begin: u32,
    end: u32,
    gust: Option<Place>,
}

impl Drone {
    pub(super) fn at(place: Place) -> Self {
        Self {
            at: place,
            height: 0.0,
            yaw: 0.0,
            lean: (0.0, 0.0),
            leg: None,
            now: 0,
            pushed: 0,
        }
    }

    pub(super) fn place(&self) -> Place {
        self.at
    }

    /// Begins to do what the app wants, not quite as it wants it.
    pub(super) fn command(&mut self, request: &Request, now: u32, noise: &mut Noise) {
        const TAKE_OFF: u8 = 1;
        const GO: u8 = 2;
        const LAND: u8 = 3;
        let [x, y, z, yaw] = request.target;
        let mut gust = None;
        let to = match request.command {
            TAKE_OFF | LAND => (self.at, z, self.yaw),
            GO => {
                if noise.chance(0.04) {
                    let angle = noise.between(-3.2, 3.2);
                    gust = Some((SIDE * angle.cos(), SIDE * angle.sin()));
                }
                let off = |noise: &mut Noise| noise.normal(0.025);
                (
                    (x + off(noise), y + off(noise)),
                    z,
                    yaw + noise.normal(0.01),
                )
            }
            _ => return,
        };
        self.leg = Some(Leg {
            from: (self.at, self.height, self.yaw),
            to,
            begin: now,
            end: now + (1000.0 * request.duration) as u32,
            gust,
        });
    }

    /// Time goes on until `now`. An error if it hits a wall or another robot.
    pub(super) fn pass(
        &mut self,
        now: u32,
        room: &Room,
        others: &[Place],
        noise: &mut Noise,
    ) -> Result<()> {
        self.now = now;
        let sway = if noise.chance(0.05) { 6.0 } else { 0.7 };
        self.lean = (noise.normal(sway), noise.normal(sway));
        let Some(leg) = &mut self.leg else {
            return Ok(());
        };
        let share = (now - leg.begin) as f32 / (leg.end - leg.begin).max(1) as f32;
        let share = share.min(1.0);
        let mix = |from: f32, to: f32| from + (to - from) * share;
        let (from, to) = (leg.from, leg.to);
        let before = self.at;
        self.at = (mix(from.0.0, to.0.0), mix(from.0.1, to.0.1));
        self.height = mix(from.1, to.1);
        self.yaw = mix(from.2, to.2);
        if share >= 1.0 {
            if let Some((x, y)) = leg.gust.take() {
                let there = (self.at.0 + x, self.at.1 + y);
                let is_free = !is_near(room, there, RADIUS + 0.03)
                    && others.iter().all(|&other| distance(there, other) > 0.3);
                if is_free {
                    self.at = there;
                    self.pushed += 1;
                }
            }
            self.leg = None;
        } else {
            let slope = 200.0 * distance(before, self.at).min(0.05);
            self.lean = (noise.normal(slope), noise.normal(slope));
        }
        if self.height > 0.1 {
            if is_near(room, self.at, RADIUS - 0.03) {
                bail!("one flew into a wall at {:?}", self.at);
            }
            if others
                .iter()
                .any(|&other| distance(self.at, other) < 2.0 * RADIUS)
            {
                bail!("two met at {:?}", self.at);
            }
        }
        Ok(())
    }

    /// What its sensors say: errors of range, place and heading, no answer now and then,
    /// the floor where it leans far.
    pub(super) fn sense(&self, room: &Room, others: &[Place], noise: &mut Noise) -> Sensed {
        let lean = self.lean.0.abs().max(self.lean.1.abs()).to_radians();
        let floor = self.height / lean.sin().max(1e-3);
        let quarter = core::f32::consts::FRAC_PI_2;
        let ranges = [0.0, 2.0 * quarter, quarter, -quarter].map(|side| {
            let range = room.range(self.at, self.yaw + side, others);
            let range = range.min(floor) + noise.normal(0.008);
            match range > 3.5 || noise.chance(0.01) {
                true => 32.767,
                false => range.max(0.001),
            }
        });
        Sensed {
            pose: [
                self.at.0 + noise.normal(0.008),
                self.at.1 + noise.normal(0.008),
                self.height + noise.normal(0.005),
            ],
            angles: [
                self.lean.0,
                self.lean.1,
                self.yaw.to_degrees() + noise.normal(0.4),
            ],
            ranges,
            volts: 4.1 - self.now as f32 * 1e-7 + noise.normal(0.01),
        }
    }
}

fn is_near(room: &Room, (x, y): Place, radius: f32) -> bool {
    let rim = [(radius, 0.0), (-radius, 0.0), (0.0, radius), (0.0, -radius)];
    rim.iter().any(|&(dx, dy)| room.is_wall((x + dx, y + dy)))
}

/// Numbers by chance, the same for the same seed.
pub(super) struct Noise(u64);

impl Noise {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// From 0 to 1; xorshift64*.
    fn unit(&mut self) -> f32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40;
        high as f32 / (1u32 << 24) as f32
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    pub(super) fn chance(&mut self, share: f32) -> bool {
        self.unit() < share
    }

    /// About normal, never beyond 3.5 deviations.
    fn normal(&mut self, deviation: f32) -> f32 {
        let sum: f32 = (0..4).map(|_| self.unit()).sum();
        (sum - 2.0) * 1.732 * deviation
    }
}
