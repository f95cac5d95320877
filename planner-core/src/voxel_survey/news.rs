//! Which pieces of the map the others should hear of next.

use crate::radio::{MAX_PATCHES, VoxelFrame};
use crate::tile::{TileIndex, Tiles};
use crate::volume::{Volume, VoxelPatch};

/// Times that a piece is told after it has changed, so that a lost frame does little
/// harm.
const TELLS: u8 = 2;

/// Every so many frames one is of the turn, whatever else waits.
const TURN: u8 = 4;

/// Pieces passed over until there is one to tell.
const STRIDE: u16 = 256;

/// The tiles of levels that the robot itself has seen change go first, round and round,
/// then the whole map in turn.
#[derive(Clone, Debug)]
pub(super) struct News<const TW: usize, const TH: usize, const L: usize> {
    /// How often each is still to be told.
    left: [Tiles<u8, TW, TH>; L],
    /// Number of those above 0.
    waiting: u32,
    next: (TileIndex, u8),
    turn: (TileIndex, u8),
    since_turn: u8,
}

impl<const TW: usize, const TH: usize, const L: usize> News<TW, TH, L> {
    pub(super) const fn new() -> Self {
        Self {
            left: [Tiles::all(0); L],
            waiting: 0,
            next: (TileIndex { x: 0, y: 0 }, 0),
            turn: (TileIndex { x: 0, y: 0 }, 0),
            since_turn: 0,
        }
    }

    /// Starts anew, in place.
    pub(super) fn reset(&mut self) {
        for level in &mut self.left {
            level.fill(0);
        }
        self.waiting = 0;
        self.next = (TileIndex { x: 0, y: 0 }, 0);
        self.turn = (TileIndex { x: 0, y: 0 }, 0);
        self.since_turn = 0;
    }

    /// Something of this piece was seen for the first time.
    pub(super) fn add(&mut self, tile: TileIndex, z: u8) {
        self.set(tile, z, TELLS);
    }

    /// Everybody has heard of this piece: it waits for the turn only.
    pub(super) fn forget(&mut self, tile: TileIndex, z: u8) {
        self.set(tile, z, 0);
    }

    fn set(&mut self, tile: TileIndex, z: u8, tells: u8) {
        if let Some(left) = self
            .left
            .get_mut(usize::from(z))
            .and_then(|level| level.get_mut(tile))
        {
            self.waiting = self
                .waiting
                .saturating_add(u32::from(*left == 0 && tells > 0));
            self.waiting = self
                .waiting
                .saturating_sub(u32::from(*left > 0 && tells == 0));
            *left = tells;
        }
    }

    fn left(&self, tile: TileIndex, z: u8) -> u8 {
        self.left
            .get(usize::from(z))
            .and_then(|level| level.get(tile))
            .copied()
            .unwrap_or(0)
    }

    /// Fills `frame` with pieces of `volume`.
    ///
    /// Cost: [`STRIDE`] bytes or words for each piece taken, and as many for the last.
    pub(super) fn tell(&mut self, volume: &Volume<TW, TH, L>, frame: &mut VoxelFrame) {
        self.since_turn = (self.since_turn + 1) % TURN;
        if self.since_turn != 0 {
            for _ in 0..MAX_PATCHES {
                let Some((tile, z)) = self.next_waiting(volume) else {
                    break;
                };
                if frame.has(tile, z) {
                    break; // Once round: what waits is in this frame.
                }
                if !frame.add(volume.patch(tile, z)) {
                    return;
                }
                self.set(tile, z, self.left(tile, z).saturating_sub(1));
                self.next = volume.after(tile, z);
            }
        }
        for _ in 0..MAX_PATCHES {
            let Some(patch) = self.next_known(volume) else {
                return;
            };
            if !frame.has(patch.tile, patch.z) && !frame.add(patch) {
                return;
            }
            self.turn = volume.after(patch.tile, patch.z);
        }
    }

    fn next_waiting(&mut self, volume: &Volume<TW, TH, L>) -> Option<(TileIndex, u8)> {
        if self.waiting == 0 {
            return None;
        }
        for _ in 0..STRIDE {
            let (tile, z) = self.next;
            if self.left(tile, z) > 0 {
                return Some((tile, z));
            }
            self.next = volume.after(tile, z);
        }
        None
    }

    fn next_known(&mut self, volume: &Volume<TW, TH, L>) -> Option<VoxelPatch> {
        for _ in 0..STRIDE {
            let (tile, z) = self.turn;
            let patch = volume.patch(tile, z);
            if !patch.is_empty() {
                return Some(patch);
            }
            self.turn = volume.after(tile, z);
        }
        None
    }
}
