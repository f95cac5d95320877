//! What is in sight of one voxel, a row of voxels at a time.
//!
//! As [`in_sight`](super::in_sight) of every voxel about an eye that is asked for. Two bounds
//! spare most rays. If all of the box between the eye and a voxel is clear, the voxel is in
//! sight. If no way of faces leads to it over clear voxels, each step away from the eye, it is
//! not: a ray that nothing stops is such a way, led round the edges and corners that it passes
//! through. Both are carried from row to row of an octant in whole words; a ray is walked for
//! what lies between the bounds.

use core::ops::ControlFlow;

use super::Voxel;
use crate::tile::{TILE, TileIndex, bits};

/// Furthest that a view reaches, in voxels.
pub(crate) const MAX_REACH: u8 = 12;

const REACH: usize = MAX_REACH as usize;

/// Rows of a level, and voxels of a row.
const SPAN: usize = 2 * REACH + 1;
const _: () = assert!(SPAN <= u32::BITS as usize, "a row is a u32");

/// Work of beginning a look, and of a ray.
const BEGIN: u32 = 32;
const RAY: u32 = 3;

/// The rows of one level: bit `REACH + dx` of row `REACH + dy`.
type Slab = [u32; SPAN];

/// A look from an eye: how far it goes, and what it takes.
pub(crate) struct View {
    eye: Voxel,
    reach: u8,
    /// How far to look east, south and up, and how far west, north and down.
    ahead: [u8; 3],
    back: [u8; 3],
    /// Words and rows looked at, and 3 for each ray: some 150 instructions each on a
    /// Cortex-M4.
    pub(crate) work: u32,
}

/// Voxels of a row that are in sight.
pub(crate) struct Row {
    eye: Voxel,
    /// How far south and up of the eye it lies.
    pub(crate) south: i16,
    pub(crate) up: i16,
    /// Bit `MAX_REACH` + x is the voxel that far east of the eye.
    pub(crate) bits: u32,
}

impl Row {
    /// How many they are.
    pub(crate) const fn count(&self) -> u32 {
        self.bits.count_ones()
    }

    /// Leaves out those of a layer.
    pub(crate) fn leave_out(&mut self, layer: impl Fn(Voxel) -> bool) {
        for voxel in self.voxels(u32::MAX).filter(|&voxel| layer(voxel)) {
            self.bits &= !(1 << index(voxel.x.saturating_sub(self.eye.x)));
        }
    }

    /// Those of `bits`.
    pub(crate) fn voxels(&self, among: u32) -> impl Iterator<Item = Voxel> + use<> {
        let Self {
            eye,
            south,
            up,
            bits: own,
        } = *self;
        let (x, y, z) = (
            eye.x.saturating_sub(REACH as i16),
            eye.y.saturating_add(south),
            eye.z.saturating_add(up),
        );
        bits((own & among).into()).map(move |bit| Voxel::new(x.saturating_add(bit as i16), y, z))
    }
}

/// What the bounds say of a row of an octant, the eye's side at bit 0.
#[derive(Clone, Copy)]
struct Front {
    /// All of the box between the eye and these is clear, they too.
    open: u32,
    /// A way leads to these, and they are clear.
    reached: u32,
}

/// Beside the first row nothing is in the way, and nothing comes from there.
const START: Front = Front {
    open: u32::MAX,
    reached: 0,
};

/// Behind a row that nothing comes to.
const NOTHING: Front = Front {
    open: 0,
    reached: 0,
};

/// The directions of an octant: of its voxels, those at distance 0 belong to the first of
/// the two that share them.
#[derive(Clone, Copy)]
struct Octant {
    is_west: bool,
    is_north: bool,
    is_down: bool,
    /// How far it is looked at.
    columns: u32,
    rows: u32,
}

impl View {
    /// From `eye`, at most [`MAX_REACH`] voxels far; nothing is in the way, and nothing is
    /// looked for.
    pub(crate) const fn new(eye: Voxel, reach: u8) -> Self {
        Self {
            eye,
            reach: if reach > MAX_REACH { MAX_REACH } else { reach },
            ahead: [0; 3],
            back: [0; 3],
            work: 0,
        }
    }

    /// Looks where anything of `wanted` may be within reach; says whether there is any.
    ///
    /// Cost: every tile of a level within reach.
    pub(crate) fn aim(&mut self, wanted: impl Fn(TileIndex, u8) -> u64) -> bool {
        let Self { eye, reach, .. } = *self;
        let (columns, rows) = (span(eye.x, reach, reach, 3), span(eye.y, reach, reach, 3));
        let levels = span(eye.z, reach, reach, 0);
        // They take less than others do.
        let words = columns.len() * rows.len() * levels.len() / 2;
        self.work = self.work.saturating_add(words as u32);
        // The columns, rows and levels that have any, a bit each from the first on.
        let (mut in_columns, mut in_rows, mut on_levels) = (0u32, 0u32, 0u32);
        for (z, level) in levels.clone().zip(0..) {
            let mut in_rows_here = 0;
            for (y, row) in rows.clone().zip(0..) {
                let mut in_columns_here = 0;
                for (x, column) in columns.clone().zip(0..) {
                    if wanted(TileIndex { x, y }, z) != 0 {
                        in_columns_here |= 1 << column;
                    }
                }
                in_columns |= in_columns_here;
                in_rows_here |= u32::from(in_columns_here != 0) << row;
            }
            in_rows |= in_rows_here;
            on_levels |= u32::from(in_rows_here != 0) << level;
        }
        let first = |from: u8, any: u32| i16::from(from) + any.trailing_zeros() as i16;
        let last = |from: u8, any: u32| i16::from(from) + any.checked_ilog2().unwrap_or(0) as i16;
        let tile = |at: i16| at * TILE as i16;
        let from = [
            tile(first(columns.start, in_columns)),
            tile(first(rows.start, in_rows)),
            first(levels.start, on_levels),
        ];
        let to = [
            tile(last(columns.start, in_columns)) + 7,
            tile(last(rows.start, in_rows)) + 7,
            last(levels.start, on_levels),
        ];
        let far = |d: i16| d.clamp(0, reach.into()) as u8;
        let [x, y, z] = [eye.x, eye.y, eye.z];
        self.ahead = [
            far(to[0].saturating_sub(x)),
            far(to[1].saturating_sub(y)),
            far(to[2].saturating_sub(z)),
        ];
        self.back = [
            far(x.saturating_sub(from[0])),
            far(y.saturating_sub(from[1])),
            far(z.saturating_sub(from[2])),
        ];
        on_levels != 0
    }

    /// Gives those of `wanted` that are looked at, within reach and in sight where `blocked` is
    /// in the way to `found`, row by row, until that breaks off.
    ///
    /// Cost: every tile of a level twice and every row four times, level by level from the eye
    /// up and then down until it breaks off, and a ray for each voxel between the bounds.
    pub(crate) fn look(
        &mut self,
        blocked: impl Fn(TileIndex, u8) -> u64,
        wanted: impl Fn(TileIndex, u8) -> u64,
        mut found: impl FnMut(Row) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Self { ahead, back, .. } = *self;
        self.work = self.work.saturating_add(BEGIN);
        // Level by level, from the lowest.
        let mut levels = [[0; SPAN]; SPAN];
        for is_down in [false, true] {
            let mut fronts = [[START; REACH + 1]; 4];
            let most = if is_down { back[2] } else { ahead[2] };
            if is_down && most == 0 {
                break;
            }
            for k in 0..=u32::from(most) {
                let dz = signed(k, is_down);
                let stops = self.slab(dz, &blocked);
                if let Some(place) = levels.get_mut(index(dz)) {
                    *place = stops;
                }
                let slab = self.slab(dz, &wanted);
                let mut is_reached = false;
                for (number, fronts) in fronts.iter_mut().enumerate() {
                    let (is_west, is_north) = (number & 1 != 0, number & 2 != 0);
                    let octant = Octant {
                        is_west,
                        is_north,
                        is_down,
                        columns: if is_west { back[0] } else { ahead[0] }.into(),
                        rows: if is_north { back[1] } else { ahead[1] }.into(),
                    };
                    let is_empty = is_west && back[0] == 0 || is_north && back[1] == 0;
                    if !is_empty {
                        is_reached |=
                            self.look_at_level(octant, k, &levels, &slab, fronts, &mut found)?;
                    }
                }
                if !is_reached {
                    break;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Level `k` of an octant; `fronts` are those of the level before, and then of this one.
    /// Says whether a way leads on.
    #[inline(never)]
    fn look_at_level(
        &mut self,
        octant: Octant,
        k: u32,
        levels: &[Slab; SPAN],
        wanted: &Slab,
        fronts: &mut [Front; REACH + 1],
        found: &mut impl FnMut(Row) -> ControlFlow<()>,
    ) -> ControlFlow<(), bool> {
        let Self {
            eye,
            reach,
            ref mut work,
            ..
        } = *self;
        let Some(blocked) = levels.get(index(signed(k, octant.is_down))) else {
            return ControlFlow::Continue(false);
        };
        let square = u32::from(reach) * u32::from(reach);
        let mut before = START;
        let mut width = u32::from(reach);
        let mut is_reached = false;
        for (j, front) in (0..=octant.rows).zip(fronts) {
            let is_first = j == 0 && k == 0;
            let enters = before.reached | front.reached | u32::from(is_first);
            if enters == 0 {
                (before, *front) = (NOTHING, NOTHING);
                continue;
            }
            let Some(rest) = square.checked_sub(j * j + k * k) else {
                break;
            };
            while width * width > rest {
                width -= 1;
            }
            *work = work.saturating_add(1);
            let within = (2 << width.min(octant.columns)) - 1;
            let row = index(signed(j, octant.is_north));
            let (Some(&blocked), Some(&wanted)) = (blocked.get(row), wanted.get(row)) else {
                break;
            };
            // The eye itself stops nothing.
            let clear = !octant.turned(blocked) & within | u32::from(is_first);
            let seeds = enters & clear;
            // Carries run through clear voxels, from each seed on.
            let carried = clear.wrapping_add(seeds) ^ clear ^ seeds;
            let run = (!clear & clear.wrapping_add(1)).wrapping_sub(1);
            let open = before.open & front.open;
            let wanted = octant.turned(wanted) & within & octant.owned(j, k);
            let mut seen = wanted & open & (run << 1 | 1);
            for i in bits((wanted & (enters | carried) & !seen).into()) {
                *work = work.saturating_add(RAY);
                if is_clear(levels, [i, j, k], octant) {
                    seen |= 1 << i;
                }
            }
            before = Front {
                open: open & run,
                reached: seeds | carried & clear,
            };
            *front = before;
            is_reached |= before.reached != 0;
            if seen != 0 {
                found(Row {
                    eye,
                    south: signed(j, octant.is_north),
                    up: signed(k, octant.is_down),
                    bits: octant.turned_back(seen),
                })?;
            }
        }
        ControlFlow::Continue(is_reached)
    }

    /// The rows of the level that far above the eye.
    fn slab(&mut self, dz: i16, layer: impl Fn(TileIndex, u8) -> u64) -> Slab {
        let mut slab = [0; SPAN];
        let Ok(z) = u8::try_from(self.eye.z.saturating_add(dz)) else {
            return slab;
        };
        // Where a tile begins, seen from the corner of the slab.
        let begin =
            |tile: u8, eye: i16| i32::from(tile) * TILE as i32 - i32::from(eye) + REACH as i32;
        let columns = span(self.eye.x, self.back[0], self.ahead[0], 3);
        for y in span(self.eye.y, self.back[1], self.ahead[1], 3) {
            for x in columns.clone() {
                let cells = layer(TileIndex { x, y }, z);
                self.work = self.work.saturating_add(1);
                if cells == 0 {
                    continue;
                }
                self.work = self.work.saturating_add(1);
                let column = begin(x, self.eye.x);
                let (left, right) = (column.max(0) as u32, column.min(0).unsigned_abs());
                let mut row = begin(y, self.eye.y);
                for half in [cells as u32, (cells >> 32) as u32] {
                    for byte in half.to_le_bytes() {
                        if let Some(place) = slab.get_mut(row as usize) {
                            *place |= u32::from(byte) << (left & 31) >> (right & 31);
                        }
                        row += 1;
                    }
                }
            }
        }
        slab
    }
}

/// [`in_sight`](super::in_sight) of the voxel that many steps away along each axis, where
/// `levels` are in the way.
///
/// Cost: at most 7 bits for each voxel on the line.
// [Amanatides1987]
fn is_clear(levels: &[Slab; SPAN], away: [u32; 3], octant: Octant) -> bool {
    let [i, j, k] = away;
    let rows = levels.as_flattened();
    let is_blocked = |(x, row): (u32, usize)| rows.get(row).is_none_or(|row| row >> x & 1 != 0);
    let stride = |is_back: bool, by: usize| if is_back { by.wrapping_neg() } else { by };
    let east = stride(octant.is_west, 1) as u32;
    let south = stride(octant.is_north, 1);
    let up = stride(octant.is_down, SPAN);
    let in_x = |(x, row): (u32, usize)| (x.wrapping_add(east) & 31, row);
    let in_y = |(x, row): (u32, usize)| (x, row.wrapping_add(south));
    let in_z = |(x, row): (u32, usize)| (x, row.wrapping_add(up));

    // The line crosses the n-th border along an axis at (2·n + 1) / (2·length), here over
    // a common denominator.
    let (a, b, c) = (i.max(1), j.max(1), k.max(1));
    let steps = [b * c, a * c, a * b];
    let first = |length: u32, step| if length == 0 { u32::MAX } else { step };
    let [mut x, mut y, mut z] = [first(i, steps[0]), first(j, steps[1]), first(k, steps[2])];
    let mut here = (REACH as u32, REACH * SPAN + REACH);
    let mut left = i + j + k;
    loop {
        // A border along one axis alone comes most often, and costs least so.
        let mut crossed = 1;
        if x < y && x < z {
            here = in_x(here);
            x += 2 * steps[0];
        } else if y < x && y < z {
            here = in_y(here);
            y += 2 * steps[1];
        } else if z < x && z < y {
            here = in_z(here);
            z += 2 * steps[2];
        } else {
            let (after, is_open) = if z > x {
                let beside = [in_x(here), in_y(here)];
                (in_x(beside[1]), !beside.into_iter().all(is_blocked))
            } else if y > x {
                let beside = [in_x(here), in_z(here)];
                (in_x(beside[1]), !beside.into_iter().all(is_blocked))
            } else if x > y {
                let beside = [in_y(here), in_z(here)];
                (in_y(beside[1]), !beside.into_iter().all(is_blocked))
            } else {
                let [xy, xz, yz] = [in_x(in_y(here)), in_x(in_z(here)), in_y(in_z(here))];
                let leads = |by: (u32, usize), or: (u32, usize), from: (u32, usize)| {
                    !(is_blocked(from) || is_blocked(by) && is_blocked(or))
                };
                let is_open = leads(xy, xz, in_x(here))
                    || leads(xy, yz, in_y(here))
                    || leads(xz, yz, in_z(here));
                (in_x(yz), is_open)
            };
            if !is_open {
                return false;
            }
            here = after;
            let next = x.min(y).min(z);
            crossed = 0;
            if x == next {
                x += 2 * steps[0];
                crossed += 1;
            }
            if y == next {
                y += 2 * steps[1];
                crossed += 1;
            }
            if z == next {
                z += 2 * steps[2];
                crossed += 1;
            }
        }
        left = left.saturating_sub(crossed);
        if left == 0 {
            return true;
        }
        if is_blocked(here) {
            return false;
        }
    }
}

/// What lies from `back` before `at` to `ahead` behind it, by levels or by tiles.
fn span(at: i16, back: u8, ahead: u8, shift: u32) -> core::ops::Range<u8> {
    let place = |at: i16| (at.max(0) >> shift).min(u8::MAX.into()) as u8;
    let last = at.saturating_add(ahead.into());
    if last < 0 {
        return 0..0;
    }
    place(at.saturating_sub(back.into()))..place(last).saturating_add(1)
}

impl Octant {
    /// A row, from the eye on.
    const fn turned(self, row: u32) -> u32 {
        if self.is_west {
            row.reverse_bits() >> (u32::BITS - 1 - REACH as u32)
        } else {
            row >> REACH
        }
    }

    /// A row as it was.
    const fn turned_back(self, row: u32) -> u32 {
        if self.is_west {
            (row << (u32::BITS - 1 - REACH as u32)).reverse_bits()
        } else {
            row << REACH
        }
    }

    /// Those of row `j` of level `k` that belong to no octant before.
    const fn owned(self, j: u32, k: u32) -> u32 {
        if self.is_north && j == 0 || self.is_down && k == 0 {
            0
        } else if self.is_west {
            !1
        } else {
            !0
        }
    }
}

const fn signed(away: u32, is_back: bool) -> i16 {
    if is_back { -(away as i16) } else { away as i16 }
}

const fn index(d: i16) -> usize {
    (REACH as i16).saturating_add(d) as usize
}

#[cfg(test)]
mod tests;
