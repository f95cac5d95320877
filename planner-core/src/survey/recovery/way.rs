//! The shortest way over known columns, for a body clear ones, found in slices.

use crate::cell::{Cell, Direction};
use crate::surface::Surface;
use crate::survey::Knowledge;
use crate::tile::{TileIndex, Tiles, neighbours};

/// Tiles that the wave spreads into in a step.
const SLICE: u32 = 1024;

/// What [`Way::next`] knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The neighbouring column that is one nearer to the goal.
    Column(Cell),
    /// Not yet.
    Searching,
    /// There is no way.
    None,
}

/// Where a body may fly.
#[derive(Clone, Copy)]
struct Room {
    clearance: u8,
    /// Where the robot is, if its body has no room there: from there it flies over known columns.
    astray: Option<Cell>,
}

impl Room {
    fn of<const TW: usize, const TH: usize>(knowledge: &Knowledge<TW, TH>) -> Self {
        let (here, clearance) = (knowledge.position().cell(), knowledge.limits().clearance);
        Self {
            clearance,
            astray: knowledge.astray.then_some(here),
        }
    }

    /// The columns of a tile that a robot which is astray is near.
    fn about(self, tile: TileIndex) -> u64 {
        let near = |here| tile.near(here, self.clearance);
        self.astray.map_or(0, near)
    }
}

/// A wave from a goal over known columns, until it reaches the robot's. A column's
/// distance is kept modulo 3: the next one towards the goal has one less.
#[derive(Clone, Debug)]
pub(super) struct Way<const TW: usize, const TH: usize> {
    layers: [Tiles<u64, TW, TH>; 3],
    /// Number modulo 3 of the layer that is made.
    layer: usize,
    /// Where the look at all tiles for it stands.
    cursor: TileIndex,
    /// Whether anything was reached in it.
    grows: bool,
    is_done: bool,
    /// Whether closed columns kept it from spreading.
    is_cut: bool,
}

impl<const TW: usize, const TH: usize> Way<TW, TH> {
    /// A way to nowhere; all zero.
    pub(super) const fn vacant() -> Self {
        Self {
            layers: [Tiles::all(0); 3],
            layer: 0,
            cursor: TileIndex { x: 0, y: 0 },
            grows: false,
            is_done: false,
            is_cut: false,
        }
    }

    /// Begins anew, from `goal`.
    pub(super) fn begin(&mut self, goal: Option<Cell>) {
        // Each by itself: a new `Self` would be made on the stack first.
        for layer in &mut self.layers {
            layer.fill(0);
        }
        self.layer = 1;
        self.cursor = TileIndex { x: 0, y: 0 };
        self.grows = false;
        self.is_done = false;
        self.is_cut = false;
        let [first, ..] = &mut self.layers;
        if let Some(cell) = goal {
            first.insert(cell);
        }
    }

    /// Whether closed columns have kept the wave from something.
    pub(super) const fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The columns that the wave has reached, tile by tile.
    pub(super) fn reached(&self) -> impl Iterator<Item = u64> + '_ {
        let [a, b, c] = &self.layers;
        let words = a.values().zip(b.values());
        words.zip(c.values()).map(|((a, b), c)| a | b | c)
    }

    /// The column to fly to from the robot's; the wave does not enter `closed` columns.
    ///
    /// Cost: 1024 tiles.
    pub(super) fn next(
        &mut self,
        knowledge: &mut Knowledge<TW, TH>,
        closed: &Tiles<u64, TW, TH>,
    ) -> Next {
        let here = knowledge.position().cell();
        let room = Room::of(knowledge);
        for _ in 0..SLICE {
            if self.distance(here).is_some() {
                break;
            }
            if self.is_done {
                return Next::None;
            }
            self.spread_into_tile(knowledge.surface(), closed, room);
            knowledge.count_work(1);
        }
        let Some(distance) = self.distance(here) else {
            return Next::Searching;
        };
        let nearer = Direction::ALL
            .map(|direction| here.step(direction))
            .into_iter()
            .find(|&cell| self.distance(cell) == Some((distance + 2) % 3));
        nearer.map_or(Next::None, Next::Column)
    }

    /// Distance of `cell` from the goal modulo 3, if it is reached.
    fn distance(&self, cell: Cell) -> Option<usize> {
        self.layers.iter().position(|layer| layer.contains(cell))
    }

    /// Lets the wave into the next tile.
    fn spread_into_tile(
        &mut self,
        surface: &Surface<TW, TH>,
        closed: &Tiles<u64, TW, TH>,
        room: Room,
    ) {
        let tile = self.cursor;
        let before = (self.layer + 2) % 3;
        let reached = self
            .layers
            .iter()
            .fold(0, |reached, layer| reached | layer.word(tile));
        let from = |tile| self.layers.get(before).map_or(0, |layer| layer.word(tile));
        let new = neighbours(tile, from) & surface.known(tile) & !reached;
        let new = match room.clearance > 0 && new != 0 {
            true => new & (surface.clear(tile, room.clearance) | room.about(tile)),
            false => new,
        };
        let shut = new & closed.word(tile);
        self.is_cut |= shut != 0;
        let new = new & !shut;
        if let Some(layer) = self.layers.get_mut(self.layer) {
            layer.add(tile, new);
        }
        self.grows |= new != 0;
        self.cursor = surface.tile_after(tile);
        if self.cursor == (TileIndex { x: 0, y: 0 }) {
            self.is_done = !self.grows;
            self.grows = false;
            self.layer = (self.layer + 1) % 3;
        }
    }
}
