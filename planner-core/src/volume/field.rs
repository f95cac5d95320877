//! What a sensor shows of what is in sight: its field of view, and where it is turned.

use super::{MAX_REACH, Voxel};
use crate::math;

/// Furthest voxel of a row.
const REACH: i32 = MAX_REACH as i32;

/// Where a sensor is turned on the plan: one of eight directions, 45 degrees apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Heading(u8);

impl Heading {
    /// Towards greater x.
    pub const EAST: Self = Self(0);

    /// So many eighths of a turn from x to y.
    pub const fn new(eighths: u8) -> Self {
        Self(eighths % 8)
    }

    /// Eighths of a turn from x to y, 0 to 7: from east to north in a scene of a file, whose y leads
    /// north.
    pub const fn eighths(self) -> u8 {
        self.0 % 8
    }

    /// All eight, from east on.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..8).map(Self)
    }

    /// This one, turned towards `to` the shorter way round, at most `eighths` of a turn.
    pub fn turned(self, to: Self, eighths: u8) -> Self {
        let over_south = (to.eighths() + 8 - self.eighths()) % 8;
        let over_north = (8 - over_south) % 8;
        if over_south <= over_north {
            Self::new(self.eighths() + over_south.min(eighths))
        } else {
            Self::new(self.eighths() + 8 - over_north.min(eighths))
        }
    }

    /// A step that way: east, south.
    const fn step(self) -> (i64, i64) {
        match self.eighths() {
            0 => (1, 0),
            1 => (1, 1),
            2 => (0, 1),
            3 => (-1, 1),
            4 => (-1, 0),
            5 => (-1, -1),
            6 => (0, -1),
            _ => (1, -1),
        }
    }

    /// One bit of eight.
    pub(crate) const fn bit(self) -> u8 {
        1 << self.eighths()
    }
}

/// A field of view: of what is within range and in sight, what one look shows.
///
/// Angles are told by their tangents, in 256ths, so that whole numbers decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Field {
    /// How far up it shows: the tangent of the highest elevation. [`STEEP`](Self::STEEP):
    /// up to straight above.
    pub up: u16,
    /// The same down.
    pub down: u16,
    /// The tangent of half its width on the plan, as an image is flat: elevations are those
    /// of the image too. `None`: it shows all round, wherever it is turned.
    pub side: Option<u16>,
    /// Distance in voxels within which a look shows everything, in whatever direction: what
    /// range finders all round tell. A robot that feels less than one more than its clearance
    /// flies only where its field itself has shown room for its body: it may survey little, or not
    /// leave its start, and stop as out of reach, which counts as complete.
    /// [`for_body`](Self::for_body) sets what a body needs.
    pub near: u8,
}

impl Field {
    /// As an angle's tangent: a right angle.
    pub const STEEP: u16 = u16::MAX;

    /// Shows nothing; all zero.
    pub(crate) const NONE: Self = Self {
        up: 0,
        down: 0,
        side: None,
        near: 0,
    };

    /// Everything.
    pub const ALL_ROUND: Self = Self {
        up: Self::STEEP,
        down: Self::STEEP,
        side: None,
        near: 2,
    };

    /// What is no higher than the robot, as of a sensor of half a sphere under it.
    pub const DOWNWARD: Self = Self {
        up: 0,
        ..Self::ALL_ROUND
    };

    /// The robot's own level: a lidar that turns in a plane.
    pub const LIDAR: Self = Self {
        up: 0,
        down: 0,
        ..Self::ALL_ROUND
    };

    /// A depth camera of 90×60 degrees, turned ahead.
    pub const CAMERA: Self = Self {
        up: 148,
        down: 148,
        side: Some(256),
        near: 2,
    };

    /// That of a sensor that shows so far up and down, and `side` to each side, in radians, 0 to
    /// π/2; π/2 up or down is all of it. Other angles count as the nearest of these. A
    /// VL53L5CX that points ahead has `Field::of_angles(FRAC_PI_8, FRAC_PI_8, Some(FRAC_PI_8),
    /// 0)`: 106, 106 and 106. Work: three sines and cosines.
    pub fn of_angles(up: f32, down: f32, side: Option<f32>, near: u8) -> Self {
        Self {
            up: slope(up),
            down: slope(down),
            side: side.map(|side| slope(side).min(Self::STEEP - 1)),
            near,
        }
    }

    /// The same field of a robot whose body reaches `clearance` voxels beyond the one of its
    /// middle: it feels at least where the body comes to next, `clearance` + 1 voxels far.
    pub const fn for_body(self, clearance: u8) -> Self {
        let next = clearance.saturating_add(1);
        if self.is_whole() || self.near >= next {
            return self;
        }
        Self { near: next, ..self }
    }

    /// Whether a look shows the same wherever the sensor is turned.
    pub const fn is_round(&self) -> bool {
        self.side.is_none()
    }

    /// Whether it shows all that is in sight.
    pub const fn is_whole(&self) -> bool {
        self.is_round() && self.up == Self::STEEP && self.down == Self::STEEP
    }

    /// Whether a sensor at `eye` that is turned to `heading` has `voxel` in its field.
    pub fn shows(&self, eye: Voxel, heading: Heading, voxel: Voxel) -> bool {
        let near = u32::from(self.near) * u32::from(self.near);
        if self.is_whole() || eye.distance_squared(voxel) <= near {
            return true;
        }
        let [x, y, z] = [(eye.x, voxel.x), (eye.y, voxel.y), (eye.z, voxel.z)]
            .map(|(from, to)| i64::from(to) - i64::from(from));
        // How deep in the image it lies, squared, and the square of the unit of that.
        let (depth, unit) = match self.side {
            None => (x * x + y * y, 1),
            Some(side) => {
                let (east, south) = heading.step();
                let ahead = x * east + y * south;
                let aside = (x * south - y * east).abs();
                if ahead < 0 || 256 * aside > ahead * i64::from(side) {
                    return false;
                }
                (ahead * ahead, east * east + south * south)
            }
        };
        let slope = if z > 0 { self.up } else { self.down };
        let [high, deep] = [(z, 256), (1, i64::from(slope))].map(|(a, b)| a * a * b * b);
        slope == Self::STEEP || high.saturating_mul(unit) <= deep.saturating_mul(depth)
    }

    /// That of [`rows`](Self::rows) for a heading.
    pub(crate) fn row(&self, heading: Heading, south: i16, up: i16) -> u32 {
        let rows = self.rows(south, up);
        rows.get(usize::from(heading.eighths()))
            .copied()
            .unwrap_or(0)
    }

    /// Of the row of voxels `south` and `up` of a sensor, those that it shows, for each heading
    /// from east on: bit [`MAX_REACH`] + x is the voxel that far east of it.
    ///
    /// Cost: some 300 instructions on a Cortex-M4.
    pub(crate) fn rows(&self, south: i16, up: i16) -> [u32; 8] {
        let (y, z) = (i32::from(south), i32::from(up));
        let near = i32::from(self.near).pow(2) - y * y - z * z;
        let near = near.checked_isqrt().map_or(0, |far| between(-far, far));
        let slope = u32::from(if z > 0 { self.up } else { self.down });
        // The square of how deep in the image the row has to lie, for a square of the unit.
        let depth = |unit: u32| match slope as u16 {
            Self::STEEP => 0,
            _ => times(
                slope * slope,
                (256 * up.unsigned_abs() as u32).pow(2) * unit,
            ),
        };
        let Some(side) = self.side else {
            let hidden = depth(1).saturating_sub((y * y) as u32);
            let hidden = root(hidden) - 1;
            return [near | !between(-hidden, hidden); 8];
        };
        let side = i32::from(side);
        let (straight, diagonal) = (root(depth(1)), root(depth(2)));
        let edge = times(side as u32, 256 * south.unsigned_abs() as u32) as i32;
        let east = between(edge.max(straight), REACH);
        let south = |y: i32| match y >= straight {
            true => between(-(y * side / 256), y * side / 256),
            false => 0,
        };
        // Between two lines from the eye, y·(256 + side) = x·(256 - side) and x and y the other
        // way round.
        let southeast = |y: i32| {
            let (wide, narrow) = (256 + side, 256 - side);
            let below = -floor(-y * narrow, wide);
            let least = below.max(diagonal - y);
            match narrow {
                1.. => between(least, floor(y * wide, narrow)),
                0 if y < 0 => 0,
                0 => between(least, REACH),
                _ => between(least.max(-floor(y * wide, -narrow)), REACH),
            }
        };
        let [southeast, northeast] = [southeast(y), southeast(-y)];
        let rows = [
            east,
            southeast,
            south(y),
            mirrored(southeast),
            mirrored(east),
            mirrored(northeast),
            south(-y),
            northeast,
        ];
        rows.map(|row| near | row)
    }
}

/// The tangent of an angle of 0 to π/2 in 256ths, rounded down.
fn slope(angle: f32) -> u16 {
    let (sin, cos) = math::direction(angle.clamp(0.0, core::f32::consts::FRAC_PI_2));
    let tangent = 256.0 * sin / cos.max(0.0);
    match tangent < f32::from(Field::STEEP) {
        true => tangent as u16,
        false => Field::STEEP,
    }
}

/// The voxels from `least` to `most` of a row.
fn between(least: i32, most: i32) -> u32 {
    let (least, most) = (least.max(-REACH), most.min(REACH));
    if least > most {
        return 0;
    }
    (2 << (REACH + most)) - (1 << (REACH + least))
}

/// A row from its other end.
const fn mirrored(row: u32) -> u32 {
    row.reverse_bits() >> (u32::BITS - 1 - 2 * REACH as u32)
}

/// The least number of times that `of` makes `sum`; very many if none does.
fn times(of: u32, sum: u32) -> u32 {
    match of {
        0 if sum == 0 => 0,
        0 => 1 << 16,
        _ => sum.div_ceil(of),
    }
}

/// The least number whose square is at least `square`.
fn root(square: u32) -> i32 {
    square
        .checked_sub(1)
        .map_or(0, |below| below.isqrt() as i32 + 1)
}

/// The quotient, rounded down; `by` is positive.
fn floor(sum: i32, by: i32) -> i32 {
    sum.checked_div_euclid(by).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const EYE: Voxel = Voxel::new(3, -2, 7);

    fn at(x: i16, y: i16, z: i16) -> Voxel {
        Voxel::new(EYE.x + x, EYE.y + y, EYE.z + z)
    }

    fn a_slope() -> impl Strategy<Value = u16> {
        prop_oneof![0u16..=600, any::<u16>(), Just(Field::STEEP)]
    }

    proptest! {
        /// Against angles in degrees.
        #[test]
        fn a_camera_shows_what_its_image_has(x in -12i16..=12, y in -12i16..=12, z in -12i16..=12) {
            for heading in Heading::all() {
                let yaw = f64::from(heading.eighths()) * 45f64.to_radians();
                let (sin, cos) = yaw.sin_cos();
                let (fx, fy, fz) = (f64::from(x), f64::from(y), f64::from(z));
                let (ahead, aside) = (fx * cos + fy * sin, fy * cos - fx * sin);
                let tall = 148.0 / 256.0;
                // On the rim either is right, as far as this knows.
                let rim = |it: f64| it.abs() < 1e-9;
                prop_assume!(!rim(ahead - aside.abs()) && !rim(fz.abs() - tall * ahead));
                let is_in_image = ahead > 0.0 && aside.abs() < ahead && fz.abs() < tall * ahead;
                let is_near = x * x + y * y + z * z <= 4;
                prop_assert_eq!(
                    Field::CAMERA.shows(EYE, heading, at(x, y, z)),
                    is_in_image || is_near,
                    "{:?}", heading
                );
            }
        }

        #[test]
        fn what_shows_all_round_is_told_by_the_elevation(
            x in -12i16..=12, y in -12i16..=12, z in -12i16..=12, eighths in 0u8..8,
        ) {
            let heading = Heading::new(eighths);
            let shows = |field: Field| field.shows(EYE, heading, at(x, y, z));
            let is_near = x * x + y * y + z * z <= 4;
            prop_assert!(shows(Field::ALL_ROUND));
            prop_assert_eq!(shows(Field::DOWNWARD), z <= 0 || is_near);
            prop_assert_eq!(shows(Field::LIDAR), z == 0 || is_near);
        }

        /// Row by row as voxel by voxel.
        #[test]
        fn rows_are_those_of_their_voxels(
            (up, down) in (a_slope(), a_slope()),
            side in prop_oneof![Just(None), (0u16..=600).prop_map(Some), any::<u16>().prop_map(Some)],
            near in prop_oneof![0u8..=4, any::<u8>()],
            y in -12i16..=12, z in -12i16..=12,
        ) {
            let field = Field { up, down, side, near };
            for (heading, row) in Heading::all().zip(field.rows(y, z)) {
                for (x, bit) in (-12i16..=12).zip(0..) {
                    let is_shown = field.shows(EYE, heading, at(x, y, z));
                    prop_assert_eq!(row >> bit & 1 != 0, is_shown, "{:?}, {}", heading, x);
                }
            }
        }

        /// A turn ends where it leads, by the shorter way.
        #[test]
        fn turns_are_short(from in 0u8..8, to in 0u8..8, most in 0u8..8) {
            let turned = Heading::new(from).turned(Heading::new(to), most);
            let apart = |a: u8, b: u8| ((a + 8 - b) % 8).min((b + 8 - a) % 8);
            let left = apart(to, from) - apart(to, from).min(most);
            prop_assert_eq!(apart(to, turned.eighths()), left);
        }
    }

    /// Against the tangents of doubles; and a body feels where it comes to next.
    #[test]
    fn fields_are_those_of_their_angles() {
        use core::f32::consts::{FRAC_PI_2, FRAC_PI_8};
        let eighth = Some(FRAC_PI_8);
        let zones = Field::of_angles(FRAC_PI_8, FRAC_PI_8, eighth, 0);
        let wanted = Field {
            up: 106,
            down: 106,
            side: Some(106),
            near: 0,
        };
        assert_eq!(zones, wanted);
        for degrees in 0..90u16 {
            let angle = f64::from(degrees).to_radians();
            let field = Field::of_angles(angle as f32, 0.0, None, 3);
            let off = angle.tan() * 256.0 - f64::from(field.up);
            assert!((-0.01..1.01).contains(&off), "{degrees}: {off}");
            assert_eq!((field.down, field.near), (0, 3));
        }
        for right in [FRAC_PI_2, 2.0, f32::INFINITY] {
            let round = Field::of_angles(right, right, None, 2);
            assert_eq!(round, Field::ALL_ROUND);
        }
        assert_eq!(Field::of_angles(-1.0, -1.0, None, 2), Field::LIDAR);
        assert_eq!(Field::ALL_ROUND.for_body(3), Field::ALL_ROUND);
        for (clearance, near) in [(0, 2), (1, 2), (2, 3), (3, 4)] {
            assert_eq!(Field::CAMERA.for_body(clearance).near, near);
        }
    }

    /// Every direction of the plan is within some heading's field.
    #[test]
    fn headings_go_round() {
        for (x, y) in (-12..=12).flat_map(|x| (-12..=12).map(move |y| (x, y))) {
            let is_shown = |heading| Field::CAMERA.shows(EYE, heading, at(x, y, 0));
            assert!(Heading::all().any(is_shown), "{x},{y}");
        }
        let narrow = Field {
            side: Some(107),
            ..Field::CAMERA
        };
        assert!(Heading::all().any(|heading| narrow.shows(EYE, heading, at(9, -4, 1))));
    }

    /// The largest numbers are no others than small ones.
    #[test]
    fn far_voxels_overflow_nothing() {
        let (low, high) = (
            Voxel::new(i16::MIN, i16::MIN, i16::MIN),
            Voxel::new(i16::MAX, i16::MAX, i16::MAX),
        );
        let wide = Field {
            up: u16::MAX - 1,
            side: Some(u16::MAX),
            ..Field::CAMERA
        };
        assert!(wide.shows(low, Heading::new(1), high));
        assert!(!wide.shows(low, Heading::new(5), high));
        assert!(!Field::CAMERA.shows(low, Heading::new(1), high));
    }
}
