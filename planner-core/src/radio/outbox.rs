//! What to send next, with constant memory.

use crate::tile::{TileIndex, TileSet};

/// Every so many tiles one is sent in turn, whatever else waits.
const TURN: u8 = 8;
/// Of the others, every so many one is a repetition, as long as there is one due.
const REPEAT: u8 = 3;
/// Unknown tiles that the turn passes over at a time.
const STRIDE: u8 = 8;

/// Tiles to send: what was newly seen first, then the same once more (unless others
/// have told it), then every tile in turn, for those who missed it or came late.
///
/// Nothing starves: new tiles are taken round and round, so one that keeps
/// changing waits for the others; while they come faster than they can be sent,
/// some of the tiles are repetitions all the same; and every [`TURN`]th tile is the
/// turn's, so every known tile is sent again and again as long as the robot may send.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Outbox<const TH: usize> {
    fresh: TileSet<TH>,
    again: TileSet<TH>,
    /// The last new tile that was sent.
    last: TileIndex,
    /// Where the turn through all tiles stands.
    turn: TileIndex,
    /// Tiles sent since the last one in turn.
    since_turn: u8,
}

impl<const TH: usize> Outbox<TH> {
    pub(crate) const fn new() -> Self {
        Self {
            fresh: TileSet::new(),
            again: TileSet::new(),
            last: TileIndex { x: 0, y: 0 },
            turn: TileIndex { x: 0, y: 0 },
            since_turn: 0,
        }
    }

    /// Tiles that the robot has seen change.
    pub(crate) fn add(&mut self, tiles: &TileSet<TH>) {
        self.fresh.extend(tiles);
    }

    /// Somebody else has told all that this robot knows of the tile: once is as
    /// good as telling it, twice as good as repeating it.
    pub(crate) fn told(&mut self, tile: TileIndex) {
        if self.fresh.contains(tile) {
            self.fresh.remove(tile);
            self.again.insert(tile);
        } else {
            self.again.remove(tile);
        }
    }

    /// The tile to send next; `None` where the turn meets [`STRIDE`] tiles on end
    /// of which nothing is known. Work: a few words, and these tiles.
    pub(crate) fn next(
        &mut self,
        tile_extent: (u8, u8),
        is_worth_sending: impl Fn(TileIndex) -> bool,
    ) -> Option<TileIndex> {
        self.since_turn += 1;
        if self.since_turn < TURN {
            let repeats = self.since_turn.is_multiple_of(REPEAT);
            let sent = if repeats { self.repeat() } else { None };
            let sent = sent.or_else(|| self.tell()).or_else(|| self.repeat());
            if sent.is_some() {
                return sent;
            }
        }
        self.since_turn = 0;
        (0..STRIDE)
            .map(|_| self.take_turn(tile_extent))
            .find(|&tile| is_worth_sending(tile))
    }

    /// A tile that has changed.
    fn tell(&mut self) -> Option<TileIndex> {
        let tile = self.fresh.pop_after(self.last)?;
        self.again.insert(tile);
        self.last = tile;
        Some(tile)
    }

    /// A tile that was sent once since it changed.
    fn repeat(&mut self) -> Option<TileIndex> {
        self.again.pop_after(self.last)
    }

    fn take_turn(&mut self, tile_extent: (u8, u8)) -> TileIndex {
        let tile = self.turn;
        self.turn = tile.after(tile_extent);
        tile
    }

    /// Everything that waits to be sent for the first time, taken out.
    pub(crate) fn take_fresh(&mut self) -> TileSet<TH> {
        core::mem::take(&mut self.fresh)
    }
}

#[cfg(test)]
mod tests;
