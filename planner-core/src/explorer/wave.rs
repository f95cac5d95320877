//! Waves over the tiles of the whole map, layer by layer, in slices: no queue of
//! cells, 64 bytes a tile.
//!
//! A wave is either the *sweep*, in which several robots' waves run at once and
//! each cell carries the label of the robot that reached it, or a *route*, in
//! which each cell carries the direction back to where the wave started.

use crate::cell::{Cell, Direction};
use crate::map::{TileIndex, TileSet, carried, shifted};

/// Waves that can run at once: the robot's own and one for each other.
pub(crate) const LABELS: usize = 16;

/// The layers of one tile.
#[derive(Clone, Copy)]
struct WaveTile {
    /// Cells that a wave has reached.
    reached: u64,
    /// Cells reached in the last layer and in this one, by the layer's parity.
    front: [u64; 2],
    /// Frontier cells that are spoken for.
    taken: u64,
    /// Sweep: the label's four bits. Route: the direction's two bits.
    mark: [u64; 4],
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
        self.mark
            .iter()
            .enumerate()
            .fold(u64::MAX, |cells, (place, &plane)| {
                cells
                    & if label >> place & 1 == 1 {
                        plane
                    } else {
                        !plane
                    }
            })
    }

    /// The number that the marks of a cell spell.
    fn mark_of(&self, bit: u64) -> u8 {
        self.mark
            .iter()
            .rev()
            .fold(0, |number, &plane| number << 1 | u8::from(plane & bit != 0))
    }

    fn set_mark(&mut self, cells: u64, number: u8) {
        for (place, plane) in self.mark.iter_mut().enumerate() {
            if number >> place & 1 == 1 {
                *plane |= cells;
            } else {
                *plane &= !cells;
            }
        }
    }
}

/// What a wave has left where it has not been.
const EMPTY: &WaveTile = &WaveTile::EMPTY;

/// The state of a wave over a map of `TW`×`TH` tiles.
pub(crate) struct Wave<const TW: usize, const TH: usize> {
    tiles: [[WaveTile; TW]; TH],
    /// The tiles that hold something of this wave; all others count as empty.
    touched: TileSet<TH>,
    /// The tiles with frontier cells that are spoken for.
    spoken: TileSet<TH>,
    /// Tiles with a front, by the layer's parity.
    active: [TileSet<TH>; 2],
    layer: u32,
}

impl<const TW: usize, const TH: usize> Wave<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            tiles: [[WaveTile::EMPTY; TW]; TH],
            touched: TileSet::new(),
            spoken: TileSet::new(),
            active: [TileSet::new(); 2],
            layer: 0,
        }
    }

    /// Forgets all waves, but not who is spoken for. Work: three words a row of tiles.
    pub(crate) fn clear(&mut self) {
        self.touched.clear();
        self.active = [TileSet::new(); 2];
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

    /// The tile of this wave, empty where it has not been.
    fn tile(&self, at: TileIndex) -> &WaveTile {
        if self.touched.contains(at) {
            self.stored(at)
        } else {
            EMPTY
        }
    }

    fn stored(&self, at: TileIndex) -> &WaveTile {
        self.tiles
            .get(usize::from(at.y))
            .and_then(|row| row.get(usize::from(at.x)))
            .unwrap_or(EMPTY)
    }

    fn tile_mut(&mut self, at: TileIndex) -> Option<&mut WaveTile> {
        let tile = self
            .tiles
            .get_mut(usize::from(at.y))?
            .get_mut(usize::from(at.x))?;
        if !self.touched.contains(at) {
            *tile = WaveTile {
                taken: tile.taken,
                ..WaveTile::EMPTY
            };
            self.touched.insert(at);
        }
        Some(tile)
    }

    /// Starts a wave with this label in a cell that none has reached. Only in layer 0.
    pub(crate) fn seed(&mut self, cell: Cell, label: u8) {
        if let Some((at, bit)) = TileIndex::of(cell)
            && let Some(tile) = self.tile_mut(at)
            && tile.reached & bit == 0
        {
            tile.reached |= bit;
            tile.front[0] |= bit;
            tile.set_mark(bit, label);
            self.active[0].insert(at);
        }
    }

    /// The cells of a tile that a wave has reached.
    pub(crate) fn reached(&self, at: TileIndex) -> u64 {
        self.tile(at).reached
    }

    /// Whether a wave has reached the cell.
    pub(crate) fn is_reached(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.tile(at).reached & bit != 0)
    }

    /// In a route: the direction back to where it started.
    pub(crate) fn direction_at(&self, cell: Cell) -> Option<Direction> {
        let (at, bit) = TileIndex::of(cell)?;
        let tile = self.tile(at);
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
        let tile = self.tile_mut(at)?;
        Some((at, core::mem::take(tile.front.get_mut(parity)?)))
    }

    /// Splits the front of a tile by label: the label of its first cell, and all
    /// cells that carry it.
    pub(crate) fn first_label(&self, at: TileIndex, front: u64) -> (u8, u64) {
        let tile = self.tile(at);
        let label = tile.mark_of(front & front.wrapping_neg());
        (label, front & tile.labelled(label))
    }

    /// The frontier cells of a tile that are spoken for.
    pub(crate) fn taken(&self, at: TileIndex) -> u64 {
        if self.spoken.contains(at) {
            self.stored(at).taken
        } else {
            0
        }
    }

    /// Speaks for frontier cells.
    pub(crate) fn take(&mut self, at: TileIndex, cells: u64) {
        let taken = self.taken(at) | cells;
        if taken != 0
            && let Some(tile) = self.tile_mut(at)
        {
            tile.taken = taken;
            self.spoken.insert(at);
        }
    }

    /// Adds `cells` to the next layer.
    fn advance(&mut self, at: TileIndex, cells: u64, mark: u8) {
        let parity = self.parity();
        if let Some(tile) = self.tile_mut(at) {
            tile.reached |= cells;
            tile.set_mark(cells, mark);
            // A cell that changes hands is not in this layer any more.
            for (place, front) in tile.front.iter_mut().enumerate() {
                if place == parity {
                    *front &= !cells;
                } else {
                    *front |= cells;
                }
            }
        }
        let [even, odd] = &mut self.active;
        if self.layer & 1 == 0 { odd } else { even }.insert(at);
    }

    /// Sweep: one step of the wave `label` from `cells` of a tile, into `free`
    /// cells that no wave has reached, or one of a robot in `served` (a bit a label).
    pub(crate) fn spread(
        &mut self,
        at: TileIndex,
        cells: u64,
        label: u8,
        served: u16,
        free: impl Fn(TileIndex) -> u64,
    ) {
        let within = Direction::ALL
            .into_iter()
            .fold(0, |moved, direction| moved | shifted(cells, direction));
        self.claim(at, within, label, served, &free);
        for direction in Direction::ALL {
            let moved = carried(cells, direction);
            if moved != 0
                && let Some(next) = at.neighbour(direction)
            {
                self.claim(next, moved, label, served, &free);
            }
        }
    }

    fn claim(
        &mut self,
        at: TileIndex,
        cells: u64,
        label: u8,
        served: u16,
        free: &impl Fn(TileIndex) -> u64,
    ) {
        let cells = cells & free(at);
        if cells == 0 {
            return;
        }
        let tile = self.tile(at);
        let mut open = cells & !tile.reached;
        let contested = cells & tile.reached;
        if contested != 0 && served != 0 {
            for other in 0..LABELS as u8 {
                if served >> other & 1 == 1 {
                    open |= contested & tile.labelled(other);
                }
            }
        }
        if open != 0 {
            self.advance(at, open, label);
        }
    }

    /// Route: one step of the wave from `cells` of a tile into `free` cells that
    /// it has not reached; each gets the direction back.
    pub(crate) fn spread_route(
        &mut self,
        at: TileIndex,
        cells: u64,
        free: impl Fn(TileIndex) -> u64,
    ) {
        for direction in Direction::ALL {
            let back = direction.opposite() as u8;
            let within = shifted(cells, direction) & free(at) & !self.tile(at).reached;
            if within != 0 {
                self.advance(at, within, back);
            }
            let moved = carried(cells, direction);
            if moved != 0
                && let Some(next) = at.neighbour(direction)
            {
                let entered = moved & free(next) & !self.tile(next).reached;
                if entered != 0 {
                    self.advance(next, entered, back);
                }
            }
        }
    }

    /// Starts a route at a cell. Only after [`clear`](Self::clear).
    pub(crate) fn seed_route(&mut self, cell: Cell) {
        self.seed(cell, 0);
    }
}
