//! What a pose would show.

use core::ops::ControlFlow;

use super::{SLICE, VoxelSurvey};
use crate::tile::{TILE, TileIndex, bits};
use crate::volume::{Field, Heading, Layer, Row, View, Volume, Voxel, word_work};

/// Work of a word of which the poses are found.
const WORD: u32 = 10;

/// Work of telling which headings show a row, or what of it is looked for.
const SHOWN: u32 = 3;

/// What sight goes over.
#[derive(Clone, Copy)]
enum Between {
    Free,
    NotOccupied,
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Number of unknown voxels in sight of `pose` where unknown voxels do not block
    /// sight, at most `enough`; of a sensor that does not show all round, that of the best
    /// heading. At 0 the pose is done.
    ///
    /// Cost: every tile of a level within range; a view, and its rays, if something there is
    /// unknown.
    pub(super) fn gain(&mut self, pose: Voxel, enough: u32) -> u32 {
        self.best_heading(pose, enough).0
    }

    /// The same, and that heading. Headings that were looked at from there show nothing more.
    pub(super) fn best_heading(&mut self, pose: Voxel, enough: u32) -> (u32, Heading) {
        let best = self.count(pose, enough, Between::NotOccupied);
        if best.0 == 0 {
            self.finish(pose);
        }
        best
    }

    /// The same where only what is known to be free does not block sight: a look from there shows
    /// these for certain. Of a pose that shows none others may still be in sight.
    pub(super) fn sure_gain(&mut self, pose: Voxel, enough: u32) -> u32 {
        self.count(pose, enough, Between::Free).0
    }

    /// Finishes all `open` poses of a tile of a level if none of them can show anything; says
    /// whether it did. A line of sight comes to unknown voxels over the face of a free one, so
    /// without any such face within range there is none.
    ///
    /// Cost: 14 words for each tile of a level within range, until there is one.
    pub(super) fn finish_word(&mut self, tile: TileIndex, z: u8, open: u64) -> bool {
        for (tile, z) in within(self.range, tile, z) {
            // Where all is known this takes half as much, and beside what is unknown twice.
            self.work = self.work.saturating_add(1);
            if self.volume.unknown_beside_free(tile, z) != 0 {
                return false;
            }
        }
        self.done.add(tile, z, open);
        self.fruitless = 0;
        true
    }

    /// Spends what a step on the way leaves over on poses anywhere that show nothing any
    /// more: searches then pass over them.
    pub(super) fn look_ahead(&mut self) {
        while self.work < SLICE {
            let (tile, z) = self.turn;
            let mut open = self.volume.free(tile, z) & !self.done.word(tile, z) & !self.passed;
            self.work = self.work.saturating_add(1);
            if open != 0 {
                open &= self.volume.poses(tile, z, self.clearance);
                let work = WORD + word_work(self.clearance);
                self.work = self.work.saturating_add(work);
            }
            if open == 0 {
                self.passed = 0;
                self.turn = self.volume.after(tile, z);
                continue;
            }
            if self.passed == 0 && self.finish_word(tile, z, open) {
                continue;
            }
            let bit = open.trailing_zeros();
            self.passed |= 1 << bit;
            self.gain(Voxel::of(tile, z, bit), 1);
        }
    }

    fn count(&mut self, pose: Voxel, enough: u32, between: Between) -> (u32, Heading) {
        let volume = &self.volume;
        let mut view = View::new(pose, self.range);
        let mut gain = Gain {
            given_up: (self.doubts.is_weary(volume.known_voxels())).then_some(&self.missed),
            field: self.field,
            looked: self.looked_from(pose),
            enough,
            most: 0,
            by_heading: Gains::default(),
            rows: 0,
        };
        if view.aim(|tile, z| volume.unknown(tile, z)) {
            look(
                volume,
                &mut view,
                between,
                false,
                &mut Tally::Gain(&mut gain),
            );
        }
        let work = view.work.saturating_add(gain.rows.saturating_mul(SHOWN));
        self.work = self.work.saturating_add(work);
        (gain.most.min(enough), gain.by_heading.best().1)
    }

    /// Notes the voxels that the look from here should have shown and did not: unknown
    /// ones beside a free one, in the field, in sight over free ones alone. Of a look that only
    /// `stands_for` one in that heading, all that it may have shown.
    ///
    /// Cost: 28 words for every tile of a level within range, and a view if any is new.
    pub(super) fn note_missed(&mut self, heading: Heading, stands_for: bool) {
        let (volume, missed) = (&self.volume, &mut self.missed);
        let (here, field) = (self.position, self.field);
        let unknown = |tile, z| match stands_for {
            true => volume.unknown(tile, z),
            false => volume.unknown_beside_free(tile, z),
        };
        let mut view = View::new(here, self.range);
        if !view.aim(|tile, z| unknown(tile, z) & !missed.word(tile, z)) {
            return;
        }
        let between = match stands_for {
            true => Between::NotOccupied,
            false => Between::Free,
        };
        let mut tally = Tally::Missed {
            missed,
            has_missed: &mut self.has_missed,
            field,
            heading,
        };
        look(volume, &mut view, between, !stands_for, &mut tally);
    }
}

/// What a view is looked over for.
enum Tally<'a, 'm, const TW: usize, const TH: usize, const L: usize> {
    Gain(&'a mut Gain<'m, TW, TH, L>),
    Missed {
        missed: &'a mut Layer<TW, TH, L>,
        has_missed: &'a mut bool,
        field: Field,
        heading: Heading,
    },
}

/// What a view would show.
struct Gain<'m, const TW: usize, const TH: usize, const L: usize> {
    /// What looks have missed and is not looked for any more.
    given_up: Option<&'m Layer<TW, TH, L>>,
    field: Field,
    /// Headings that were looked at.
    looked: u8,
    enough: u32,
    most: u32,
    by_heading: Gains,
    /// Rows that took more than others.
    rows: u32,
}

impl<const TW: usize, const TH: usize, const L: usize> Tally<'_, '_, TW, TH, L> {
    /// Adds a row; says whether to look on.
    fn add(&mut self, mut row: Row) -> ControlFlow<()> {
        match self {
            Self::Gain(gain) => {
                if let Some(missed) = gain.given_up {
                    gain.rows = gain.rows.saturating_add(1);
                    row.leave_out(|voxel| missed.get(voxel));
                }
                if gain.field.is_whole() {
                    gain.most = gain.most.saturating_add(row.count());
                } else {
                    gain.rows = gain.rows.saturating_add(1);
                    let shown = gain.field.rows(row.south, row.up);
                    gain.by_heading.add(row.bits, shown, gain.looked);
                    gain.most = gain.by_heading.best().0;
                }
                if gain.most >= gain.enough {
                    return ControlFlow::Break(());
                }
            }
            Self::Missed {
                missed,
                has_missed,
                field,
                heading,
            } => {
                for voxel in row.voxels(field.row(*heading, row.south, row.up)) {
                    **has_missed = true;
                    missed.set(voxel);
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Looks over the unknown voxels of a view, or those of them that are `beside_free` ones.
// In one place for all views, and not in line: the code is large, and one view at a time is on the
// stack.
#[inline(never)]
fn look<const TW: usize, const TH: usize, const L: usize>(
    volume: &Volume<TW, TH, L>,
    view: &mut View,
    between: Between,
    beside_free: bool,
    tally: &mut Tally<'_, '_, TW, TH, L>,
) {
    let _ = view.look(
        |tile, z| match between {
            Between::Free => volume.bad(tile, z),
            Between::NotOccupied => volume.occupied(tile, z),
        },
        |tile, z| match beside_free {
            true => volume.unknown_beside_free(tile, z),
            false => volume.unknown(tile, z),
        },
        |row| tally.add(row),
    );
}

/// Voxels that a look would show, by heading.
#[derive(Default)]
struct Gains([u32; 8]);

impl Gains {
    /// Adds a row, of which each heading shows those of `shown`; headings that were `looked`
    /// at show nothing more.
    fn add(&mut self, row: u32, shown: [u32; 8], looked: u8) {
        let all = || Heading::all().zip(shown);
        let seen = all().filter(|(heading, _)| looked & heading.bit() != 0);
        let left = row & !seen.fold(0, |seen, (_, row)| seen | row);
        for ((_, shown), gain) in all().zip(&mut self.0) {
            *gain = gain.saturating_add((left & shown).count_ones());
        }
    }

    /// The most, and the first heading that has it.
    fn best(&self) -> (u32, Heading) {
        let mut best = (0, Heading::EAST);
        for (heading, &gain) in Heading::all().zip(&self.0) {
            if gain > best.0 {
                best = (gain, heading);
            }
        }
        best
    }
}

/// The tiles of levels, of which some may lie outside of the box, that anything within range of
/// one of them may lie in.
pub(super) fn within(range: u8, tile: TileIndex, z: u8) -> impl Iterator<Item = (TileIndex, u8)> {
    let tiles = range.div_ceil(TILE as u8);
    let first = TileIndex::new(tile.x.saturating_sub(tiles), tile.y.saturating_sub(tiles));
    let last = TileIndex::new(tile.x.saturating_add(tiles), tile.y.saturating_add(tiles));
    // There are at most 255 levels: none has the last number.
    let top = z.saturating_add(range).min(u8::MAX - 1);
    let mut next = (first, z.saturating_sub(range));
    core::iter::from_fn(move || {
        let (tile, level) = next;
        next = if tile.x < last.x {
            (TileIndex::new(tile.x + 1, tile.y), level)
        } else if tile.y < last.y {
            (TileIndex::new(first.x, tile.y + 1), level)
        } else {
            (first, level.saturating_add(1))
        };
        (level <= top).then_some((tile, level))
    })
}

/// The voxels of a tile of a level whose bits are set.
pub(super) fn voxels(tile: TileIndex, z: u8, word: u64) -> impl Iterator<Item = Voxel> {
    bits(word).map(move |bit| Voxel::of(tile, z, bit))
}
