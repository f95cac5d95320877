//! What to send next, with constant memory.

use crate::map::{TileIndex, TileSet};

/// Tiles to send: what was newly seen first, then the same once more, then every
/// tile in turn, for those who missed it or came late.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Outbox<const TH: usize> {
    fresh: TileSet<TH>,
    again: TileSet<TH>,
    /// Where the turn through all tiles stands.
    turn: TileIndex,
}

impl<const TH: usize> Outbox<TH> {
    pub(crate) const fn new() -> Self {
        Self {
            fresh: TileSet::new(),
            again: TileSet::new(),
            turn: TileIndex { x: 0, y: 0 },
        }
    }

    /// Tiles that the robot has seen change.
    pub(crate) fn add(&mut self, tiles: &TileSet<TH>) {
        self.fresh.extend(tiles);
    }

    /// The tile to send next; `None` where the turn comes upon one of which
    /// nothing is known. Work: a few words.
    pub(crate) fn next(
        &mut self,
        tile_extent: (u8, u8),
        is_worth_sending: impl Fn(TileIndex) -> bool,
    ) -> Option<TileIndex> {
        if let Some(tile) = self.fresh.pop_first() {
            self.again.insert(tile);
            return Some(tile);
        }
        if let Some(tile) = self.again.pop_first() {
            return Some(tile);
        }
        let tile = self.turn;
        self.turn.x += 1;
        if self.turn.x >= tile_extent.0 {
            self.turn = TileIndex {
                x: 0,
                y: if tile.y + 1 < tile_extent.1 {
                    tile.y + 1
                } else {
                    0
                },
            };
        }
        is_worth_sending(tile).then_some(tile)
    }

    /// Everything that waits to be sent for the first time, taken out.
    pub(crate) fn take_fresh(&mut self) -> TileSet<TH> {
        core::mem::take(&mut self.fresh)
    }
}
