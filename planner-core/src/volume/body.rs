//! Configuration space: where the middle of a body can be.
//!
//! The body of clearance c is the ball of the voxels at most c from its middle, and may be
//! where all of them are known to be free. From there the body one voxel on is in sight: its
//! voxels are at most c + 1 away, and rays to them pass the two bodies alone.

use super::{Volume, Voxel, beside};
use crate::cell::Direction;
use crate::tile::{TileIndex, across, along, carried, shifted};

/// The largest clearance of a body, in voxels.
pub const MAX_CLEARANCE: u8 = 3;

/// Work that a body takes more than one of clearance 1: for a word, and for a voxel.
const WORD_WORK: [u32; MAX_CLEARANCE as usize + 1] = [0, 0, 32, 64];
const VOXEL_WORK: [u32; MAX_CLEARANCE as usize + 1] = [0, 0, 14, 32];

/// Higher than the highest level.
const NO_LEVEL: u8 = u8::MAX;

/// Clearances that there are, and distances along an axis.
const SIDES: usize = MAX_CLEARANCE as usize + 1;

/// Of the ball of each clearance, how far it reaches along a row that is so far away along the
/// other axes; [`NO_ROW`] where it has none.
const REACHES: [[[u8; SIDES]; SIDES]; SIDES] = reaches();
const NO_ROW: u8 = u8::MAX;

const fn reaches() -> [[[u8; SIDES]; SIDES]; SIDES] {
    let mut reaches = [[[NO_ROW; SIDES]; SIDES]; SIDES];
    let mut number = 0;
    while number < SIDES * SIDES * SIDES {
        let [c, y, z] = [
            number / SIDES / SIDES,
            number / SIDES % SIDES,
            number % SIDES,
        ];
        if let Some(rest) = (c * c).checked_sub(y * y + z * z) {
            reaches[c][y][z] = rest.isqrt() as u8;
        }
        number += 1;
    }
    reaches
}

/// How far the ball reaches along a row that is so far away along the other axes; `None` where
/// it has none.
fn reach(clearance: u8, dy: i16, dz: i16) -> Option<i16> {
    let [y, z] = [dy, dz].map(|d| usize::from(d.unsigned_abs()));
    match *REACHES.get(usize::from(clearance))?.get(y)?.get(z)? {
        NO_ROW => None,
        reach => Some(reach.into()),
    }
}

/// The rows of a ball: how far each is away along y and z, and its reach.
fn rows(clearance: u8) -> impl Iterator<Item = (i16, i16, i16)> {
    let clearance = clearance.min(MAX_CLEARANCE);
    let last = i16::from(clearance);
    (-last..=last)
        .flat_map(move |dz| (-last..=last).map(move |dy| (dy, dz)))
        .filter_map(move |(dy, dz)| Some((dy, dz, reach(clearance, dy, dz)?)))
}

/// The voxels that a body with its middle in a voxel takes up, row by row.
pub fn body_voxels(clearance: u8, middle: Voxel) -> impl Iterator<Item = Voxel> {
    let Voxel { x, y, z } = middle;
    rows(clearance).flat_map(move |(dy, dz, reach)| {
        (-reach..=reach).map(move |dx| {
            Voxel::new(
                x.saturating_add(dx),
                y.saturating_add(dy),
                z.saturating_add(dz),
            )
        })
    })
}

/// What [`Volume::poses`] takes with this clearance more than with 1, as
/// [`work`](crate::voxel_survey::VoxelSurvey::work) counts.
pub(crate) fn word_work(clearance: u8) -> u32 {
    WORD_WORK
        .get(usize::from(clearance))
        .copied()
        .unwrap_or_default()
}

/// The same of [`Volume::is_pose`].
pub(crate) fn voxel_work(clearance: u8) -> u32 {
    VOXEL_WORK
        .get(usize::from(clearance))
        .copied()
        .unwrap_or_default()
}

impl<const TW: usize, const TH: usize, const L: usize> Volume<TW, TH, L> {
    /// Whether a robot of this clearance, 0 to [`MAX_CLEARANCE`], may be at `voxel`: its body
    /// is known to be free. With 1 that is the voxel and those that share a face with it.
    /// Outside of the box nothing is.
    ///
    /// Cost: at most 10 words with a clearance of 1; with more, two for each row of the body.
    pub fn is_pose(&self, voxel: Voxel, clearance: u8) -> bool {
        let Some((tile, z, bit)) = voxel.place().filter(|_| self.contains(voxel)) else {
            return false;
        };
        match clearance {
            0 => self.bad(tile, z) & bit == 0,
            1 => self.has_room(tile, z, bit),
            _ => self.has_wide_room(voxel, clearance),
        }
    }

    /// Those of a tile of a level. Cost: 14 words with a clearance of 1; with more, 18 for
    /// each level of the body.
    pub(crate) fn poses(&self, tile: TileIndex, z: u8, clearance: u8) -> u64 {
        let inside = self.inside(tile, z);
        match clearance {
            0 => inside & !self.bad(tile, z),
            1 => {
                let bad = self.bad(tile, z) | beside(tile, z, |tile, z| self.bad(tile, z));
                inside & !bad
            }
            _ => inside & !self.bad_about(tile, z, clearance),
        }
    }

    /// Whether the voxel of this bit and its neighbours are free.
    fn has_room(&self, tile: TileIndex, z: u8, bit: u64) -> bool {
        let about = Direction::ALL
            .into_iter()
            .fold(bit, |about, direction| about | shifted(bit, direction));
        let is_free_in_tile = self.bad(tile, z) & about == 0
            && (self.bad(tile, z.wrapping_add(1)) | self.bad(tile, z.wrapping_sub(1))) & bit == 0;
        is_free_in_tile
            && Direction::ALL.into_iter().all(|direction| {
                let beyond = carried(bit, direction);
                beyond == 0 || self.bad(tile.beside(direction), z) & beyond == 0
            })
    }

    // Not in line: most robots are small.
    #[inline(never)]
    fn has_wide_room(&self, middle: Voxel, clearance: u8) -> bool {
        rows(clearance).all(|(dy, dz, reach)| {
            let first = Voxel::new(
                middle.x.saturating_sub(reach),
                middle.y.saturating_add(dy),
                middle.z.saturating_add(dz),
            );
            let wide = (2u32 << (2 * reach)) - 1;
            self.bad_from(first, 2 * reach) & wide == 0
        })
    }

    /// The voxels that are not free from `first` on eastward, a bit each, up to the one
    /// `more` behind it at least.
    fn bad_from(&self, first: Voxel, more: i16) -> u32 {
        let byte = |x: i16| {
            let at = Voxel::new(x, first.y, first.z).place();
            at.map_or(0, |(tile, z, bit)| {
                let row = bit.trailing_zeros() & !7;
                (self.bad(tile, z) >> row) as u32 & 0xff
            })
        };
        let shift = first.x & 7;
        let behind = match shift + more > 7 {
            true => byte(first.x.saturating_add(8)) << 8,
            false => 0,
        };
        (byte(first.x) | behind) >> shift
    }

    /// The voxels of a tile of a level about which a body is not free.
    ///
    /// A ball is the same above and below, and to the north and to the south: what is not free
    /// is joined first, and spread along its rows once for all rows of the same reach.
    #[inline(never)]
    fn bad_about(&self, tile: TileIndex, z: u8, clearance: u8) -> u64 {
        let clearance = clearance.min(MAX_CLEARANCE);
        let mut all = 0;
        for dz in 0..=clearance {
            let above = z.saturating_add(dz);
            let below = match dz {
                0 => NO_LEVEL,
                _ => z.checked_sub(dz).unwrap_or(NO_LEVEL),
            };
            let bad = |tile| self.bad(tile, above) | self.bad(tile, below);
            // Of the tiles to the north and to the south of this one, and of it, with those
            // to both sides.
            let rows = [
                tile.beside(Direction::North),
                tile,
                tile.beside(Direction::South),
            ]
            .map(|tile| {
                let sides = [
                    tile.beside(Direction::West),
                    tile,
                    tile.beside(Direction::East),
                ];
                sides.map(bad)
            });
            if rows.as_flattened().iter().all(|&bad| bad == 0) {
                continue;
            }
            let (mut wide, mut width) = (rows.map(|[_, own, _]| own), 0);
            for dy in 0..=clearance {
                let Some(reach) = reach(clearance, dy.into(), dz.into()) else {
                    break;
                };
                if reach != width {
                    wide = rows.map(|row| along(row, reach as u32));
                    width = reach;
                }
                all |= across(wide, dy.into());
            }
        }
        all
    }
}
