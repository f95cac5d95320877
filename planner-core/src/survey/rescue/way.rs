//! The shortest way over known columns, found in slices.

use crate::cell::{Cell, Direction};
use crate::surface::{Surface, Tile, neighbours_of};
use crate::survey::Knowledge;

/// Tiles that the wave washes in a step.
const SLICE: u32 = 1024;

/// What [`Way::next`] knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The neighbouring column that is one nearer to the target.
    Column(Cell),
    /// Not yet.
    Searching,
    /// There is no way.
    None,
}

/// A wave from a target over known columns, until it wets the robot's. A column's
/// distance is kept modulo 3: the next one towards the target has one less.
#[derive(Clone, Debug)]
pub(super) struct Way<const TW: usize, const TH: usize> {
    layers: [[[u64; TW]; TH]; 3],
    /// Number modulo 3 of the layer that is made.
    layer: usize,
    /// Where the look at all tiles for it stands.
    cursor: Tile,
    /// Whether anything has become wet in it.
    grows: bool,
    is_done: bool,
    /// Whether closed columns kept it from spreading.
    is_cut: bool,
}

impl<const TW: usize, const TH: usize> Way<TW, TH> {
    /// A way to nowhere; all zero.
    pub(super) const fn vacant() -> Self {
        Self {
            layers: [[[0; TW]; TH]; 3],
            layer: 0,
            cursor: Tile { x: 0, y: 0 },
            grows: false,
            is_done: false,
            is_cut: false,
        }
    }

    /// Begins anew, from `target`.
    pub(super) fn begin(&mut self, target: Option<Cell>) {
        // Each by itself: a new `Self` would be made on the stack first.
        self.layers = [[[0; TW]; TH]; 3];
        self.layer = 1;
        self.cursor = Tile { x: 0, y: 0 };
        self.grows = false;
        self.is_done = false;
        self.is_cut = false;
        let [first, ..] = &mut self.layers;
        if let Some(cell) = target
            && let Some(word) = word_of(first, cell)
        {
            *word |= 1 << Tile::bit(cell);
        }
    }

    /// Whether closed columns have kept the wave from something.
    pub(super) const fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The columns that the wave has wet, tile by tile.
    pub(super) fn wet(&self) -> impl Iterator<Item = u64> + '_ {
        let [a, b, c] = &self.layers;
        let words = a.iter().flatten().zip(b.iter().flatten());
        words.zip(c.iter().flatten()).map(|((a, b), c)| a | b | c)
    }

    /// The column to fly to from the robot's; the wave does not enter `closed` columns.
    ///
    /// Cost: 1024 tiles.
    pub(super) fn next(
        &mut self,
        knowledge: &mut Knowledge<TW, TH>,
        closed: &[[u64; TW]; TH],
    ) -> Next {
        let here = knowledge.position().cell();
        for _ in 0..SLICE {
            if self.distance(here).is_some() {
                break;
            }
            if self.is_done {
                return Next::None;
            }
            self.wash(knowledge.surface(), closed);
            knowledge.look_at(1);
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

    /// Distance of `cell` from the target modulo 3, if it is wet.
    fn distance(&self, cell: Cell) -> Option<usize> {
        let tile = Tile::of(cell)?;
        self.layers
            .iter()
            .position(|layer| word(layer, tile) >> Tile::bit(cell) & 1 == 1)
    }

    /// Lets the wave into the next tile.
    fn wash(&mut self, surface: &Surface<TW, TH>, closed: &[[u64; TW]; TH]) {
        let tile = self.cursor;
        let before = (self.layer + 2) % 3;
        let wet = self
            .layers
            .iter()
            .fold(0, |wet, layer| wet | word(layer, tile));
        let from = |x: Option<u8>, y: Option<u8>| match (x, y, self.layers.get(before)) {
            (Some(x), Some(y), Some(layer)) => word(layer, Tile { x, y }),
            _ => 0,
        };
        let around = [
            from(Some(tile.x), tile.y.checked_sub(1)),
            from(tile.x.checked_add(1), Some(tile.y)),
            from(Some(tile.x), tile.y.checked_add(1)),
            from(tile.x.checked_sub(1), Some(tile.y)),
        ];
        let here = from(Some(tile.x), Some(tile.y));
        let new = neighbours_of(here, around) & surface.known(tile) & !wet;
        let shut = new & word(closed, tile);
        self.is_cut |= shut != 0;
        let new = new & !shut;
        if let Some(layer) = self.layers.get_mut(self.layer)
            && let Some(word) = word_of(layer, tile.cell(0))
        {
            *word |= new;
        }
        self.grows |= new != 0;
        self.cursor = surface.tile_after(tile);
        if self.cursor == (Tile { x: 0, y: 0 }) {
            self.is_done = !self.grows;
            self.grows = false;
            self.layer = (self.layer + 1) % 3;
        }
    }
}

fn word<const TW: usize, const TH: usize>(layer: &[[u64; TW]; TH], tile: Tile) -> u64 {
    layer
        .get(usize::from(tile.y))
        .and_then(|row| row.get(usize::from(tile.x)))
        .copied()
        .unwrap_or(0)
}

/// The word of a layer that has the bit of `cell`.
pub(super) fn word_of<const TW: usize, const TH: usize>(
    layer: &mut [[u64; TW]; TH],
    cell: Cell,
) -> Option<&mut u64> {
    let tile = Tile::of(cell)?;
    layer
        .get_mut(usize::from(tile.y))?
        .get_mut(usize::from(tile.x))
}
