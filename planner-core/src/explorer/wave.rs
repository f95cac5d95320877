//! Waves over the tiles of the whole map, layer by layer, in slices: no queue of
//! cells, 68 bytes a tile.
//!
//! A wave is either the *sweep*, in which several robots' waves run at once and
//! each cell carries the label of the robot that reached it, or a *route*, in
//! which each cell carries the direction back to where the wave started.

use super::others::MAX_OTHERS;
use crate::cell::{Cell, Direction};
use crate::tile::{TileIndex, TileSet, Tiles, carried, shifted};

/// Waves that can run at once: the robot's own and one for each other.
pub(crate) const LABELS: usize = 16;
const _: () = assert!(
    LABELS <= u16::BITS as usize && LABELS <= 1 << 4,
    "a set of labels is a u16, and a cell's label has four bits"
);
const _: () = assert!(
    MAX_OTHERS < LABELS,
    "each robot that is remembered, and the robot itself, needs a label"
);

/// The layers of one tile.
#[derive(Clone, Copy)]
struct WaveTile {
    /// Cells that belong to a wave.
    reached: u64,
    /// Cells reached in the last layer and in this one, by the layer's parity.
    front: [u64; 2],
    /// Frontier cells that are spoken for.
    taken: u64,
    /// Sweep: the label's four bits. Route: the direction's two bits.
    mark: [u64; 4],
}

/// Up to when a tile is current.
#[derive(Clone, Copy)]
struct Stamp {
    /// The wave that everything in the tile is of, but `taken`; 0: of none.
    round: u16,
    /// The labels whose cells have been given up in this tile, a bit a label.
    given_up: u16,
}

impl Stamp {
    const NONE: Self = Self {
        round: 0,
        given_up: 0,
    };
}

/// All cells or none.
const fn all_if(condition: bool) -> u64 {
    (condition as u64).wrapping_neg()
}

impl WaveTile {
    const EMPTY: Self = Self {
        reached: 0,
        front: [0; 2],
        taken: 0,
        mark: [0; 4],
    };

    /// The cells that carry this label.
    fn labelled(&self, label: u8) -> u64 {
        let [a, b, c, d] = self.mark;
        (a ^ all_if(label & 1 == 0))
            & (b ^ all_if(label & 2 == 0))
            & (c ^ all_if(label & 4 == 0))
            & (d ^ all_if(label & 8 == 0))
    }

    /// The number that the marks of a cell spell.
    fn mark_of(&self, bit: u64) -> u8 {
        let [a, b, c, d] = self.mark.map(|plane| u8::from(plane & bit != 0));
        a | b << 1 | c << 2 | d << 3
    }

    /// What the robots in `labels` (a bit a label) had reached belongs to nobody any more.
    fn give_up(&mut self, mut labels: u16) {
        while labels != 0 {
            self.reached &= !self.labelled(labels.trailing_zeros() as u8);
            labels &= labels - 1;
        }
        for plane in self.mark.iter_mut().chain(&mut self.front) {
            *plane &= self.reached;
        }
    }

    /// Adds `cells`, which nobody has, to the layer after the one of this parity.
    #[inline(always)] // in the innermost loop
    fn advance(&mut self, cells: u64, mut number: u8, parity: usize) {
        self.reached |= cells;
        let [even, odd] = &mut self.front;
        *(if parity == 0 { odd } else { even }) |= cells;
        for plane in &mut self.mark {
            if number == 0 {
                break;
            }
            if number & 1 == 1 {
                *plane |= cells;
            }
            number >>= 1;
        }
    }
}

/// The state of a wave over a map of `TW`×`TH` tiles.
pub(crate) struct Wave<const TW: usize, const TH: usize> {
    tiles: Tiles<WaveTile, TW, TH>,
    stamps: Tiles<Stamp, TW, TH>,
    /// The number of this wave: tiles of earlier ones count as empty.
    round: u16,
    /// The tiles with frontier cells that are spoken for.
    spoken: TileSet<TH>,
    /// Tiles with a front, by the layer's parity.
    active: [TileSet<TH>; 2],
    layer: u32,
}

impl<const TW: usize, const TH: usize> Wave<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            tiles: Tiles::all(WaveTile::EMPTY),
            stamps: Tiles::all(Stamp::NONE),
            round: 0,
            spoken: TileSet::new(),
            active: [TileSet::new(); 2],
            layer: 0,
        }
    }

    /// Forgets all waves, but not who is spoken for. Work: the rows with a front.
    pub(crate) fn clear(&mut self) {
        self.round = self.round.checked_add(1).unwrap_or(1);
        // One stamp in turn is wiped, so none gets so old that its number comes again.
        let turn = usize::from(self.round).checked_rem(TW * TH);
        if let Some(turn) = turn
            && let Some(stamp) = self.stamps.values_mut().nth(turn)
        {
            *stamp = Stamp::NONE;
        }
        for active in &mut self.active {
            active.clear();
        }
        self.layer = 0;
    }

    /// Nobody has spoken for any frontier cell.
    pub(crate) fn forget_taken(&mut self) {
        self.spoken.clear();
    }

    /// Steps that the wave has made: the distance of the cells of its front.
    pub(crate) const fn layer(&self) -> u32 {
        self.layer
    }

    const fn parity(&self) -> usize {
        (self.layer & 1) as usize
    }

    fn active_now(&mut self) -> &mut TileSet<TH> {
        let [even, odd] = &mut self.active;
        if self.layer & 1 == 0 { even } else { odd }
    }

    fn active_next(&mut self) -> &mut TileSet<TH> {
        let [even, odd] = &mut self.active;
        if self.layer & 1 == 0 { odd } else { even }
    }

    /// The tile, if this wave has been there.
    fn tile(&self, at: TileIndex) -> Option<&WaveTile> {
        let is_current = self.stamps.get(at)?.round == self.round;
        if is_current { self.tiles.get(at) } else { None }
    }

    #[inline(always)] // in the innermost loop
    fn tile_mut(&mut self, at: TileIndex) -> Option<(&mut WaveTile, &mut Stamp)> {
        let tile = self.tiles.get_mut(at)?;
        let stamp = self.stamps.get_mut(at)?;
        if stamp.round != self.round {
            *stamp = Stamp {
                round: self.round,
                given_up: 0,
            };
            *tile = WaveTile {
                taken: tile.taken,
                ..WaveTile::EMPTY
            };
        }
        Some((tile, stamp))
    }

    /// Starts a wave with this label in a cell that none has reached. Only in layer 0.
    pub(crate) fn seed(&mut self, cell: Cell, label: u8) {
        if let Some((at, bit)) = TileIndex::of(cell)
            && let Some((tile, _)) = self.tile_mut(at)
            && tile.reached & bit == 0
        {
            tile.advance(bit, label, 1);
            self.active[0].insert(at);
        }
    }

    /// The cells of a tile that a wave has reached.
    pub(crate) fn reached(&self, at: TileIndex) -> u64 {
        self.tile(at).map_or(0, |tile| tile.reached)
    }

    /// Whether a wave has reached the cell.
    pub(crate) fn is_reached(&self, cell: Cell) -> bool {
        TileIndex::of(cell)
            .and_then(|(at, bit)| Some(self.tile(at)?.reached & bit != 0))
            .unwrap_or(false)
    }

    /// In a route: the direction back to where it started.
    pub(crate) fn direction_at(&self, cell: Cell) -> Option<Direction> {
        let (at, bit) = TileIndex::of(cell)?;
        let tile = self.tile(at)?;
        (tile.reached & bit != 0).then(|| Direction::from_index(tile.mark_of(bit)))
    }

    /// The next tile of this layer and its front, which is taken out; at the end
    /// of a layer, of the next one. `None` when the waves have ended.
    pub(crate) fn next_front(&mut self) -> Option<(TileIndex, u64)> {
        if self.active_now().is_empty() {
            self.layer += 1;
        }
        let at = self.active_now().pop_first()?;
        let parity = self.parity();
        let tile = self.tiles.get_mut(at)?;
        let [even, odd] = &mut tile.front;
        let front = if parity == 0 { even } else { odd };
        Some((at, core::mem::take(front)))
    }

    /// Splits the front of a tile by label: the label of its first cell, all cells
    /// that carry it, and the rest. What was given up meanwhile is left out.
    pub(crate) fn first_label(&self, at: TileIndex, front: u64) -> (u8, u64, u64) {
        self.tiles.get(at).map_or((0, 0, 0), |tile| {
            let front = front & tile.reached;
            let label = tile.mark_of(front & front.wrapping_neg());
            let cells = front & tile.labelled(label);
            (label, cells, front & !cells)
        })
    }

    /// The frontier cells of a tile that are spoken for.
    pub(crate) fn taken(&self, at: TileIndex) -> u64 {
        match self.tiles.get(at) {
            Some(tile) if self.spoken.contains(at) => tile.taken,
            _ => 0,
        }
    }

    /// Speaks for frontier cells.
    pub(crate) fn take(&mut self, at: TileIndex, cells: u64) {
        let taken = self.taken(at) | cells;
        if taken != 0
            && let Some((tile, _)) = self.tile_mut(at)
        {
            tile.taken = taken;
            self.spoken.insert(at);
        }
    }

    /// Sweep: one step of the wave `label` from `cells` of a tile, into `free`
    /// cells that no wave has reached, or one of a robot in `served` (a bit a label).
    /// Returns the number of tiles beside that it moves into.
    pub(crate) fn spread(
        &mut self,
        at: TileIndex,
        cells: u64,
        label: u8,
        served: u16,
        free: impl Fn(TileIndex) -> u64,
    ) -> u32 {
        let within = shifted(cells, Direction::East)
            | shifted(cells, Direction::South)
            | shifted(cells, Direction::West)
            | shifted(cells, Direction::North);
        self.claim(at, within & free(at), label, served);
        let mut beside = 0;
        for direction in Direction::ALL {
            let moved = carried(cells, direction);
            if moved != 0 {
                beside += 1;
                let next = at.beside(direction);
                self.claim(next, moved & free(next), label, served);
            }
        }
        beside
    }

    /// Route: one step of the wave from `cells` of a tile into `free` cells that
    /// it has not reached; each gets the direction back. Returns as [`spread`](Self::spread).
    pub(crate) fn spread_route(
        &mut self,
        at: TileIndex,
        cells: u64,
        free: impl Fn(TileIndex) -> u64,
    ) -> u32 {
        let here = free(at);
        let mut beside = 0;
        for direction in Direction::ALL {
            let back = direction.opposite() as u8;
            self.claim(at, shifted(cells, direction) & here, back, 0);
            let moved = carried(cells, direction);
            if moved != 0 {
                beside += 1;
                let next = at.beside(direction);
                self.claim(next, moved & free(next), back, 0);
            }
        }
        beside
    }

    fn claim(&mut self, at: TileIndex, cells: u64, label: u8, served: u16) {
        if cells == 0 {
            return;
        }
        let parity = self.parity();
        let Some((tile, stamp)) = self.tile_mut(at) else {
            return;
        };
        let mut open = cells & !tile.reached;
        if open != cells && served & !stamp.given_up != 0 {
            tile.give_up(served & !stamp.given_up);
            stamp.given_up |= served;
            open = cells & !tile.reached;
        }
        if open != 0 {
            tile.advance(open, label, parity);
            self.active_next().insert(at);
        }
    }

    /// Starts a route at a cell. Only after [`clear`](Self::clear).
    pub(crate) fn seed_route(&mut self, cell: Cell) {
        self.seed(cell, 0);
    }
}
