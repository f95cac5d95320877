//! A robot that is wider than its cell: what its searches read, how it keeps apart from
//! others, and what is too narrow for it.

use super::Explorer;
use super::body::{Fit, bodies_touch, body_cells, fit, strip};
use super::surroundings::{Layer, Surroundings};
use super::window::{Rows, Window};
use crate::cell::{Cell, Direction};
use crate::map::{Learnt, Level, Tile};
use crate::tile::{TILE, TileIndex, bits, every_tile};

impl<const TW: usize, const TH: usize> Surroundings<TW, TH> {
    /// A layer of a window; with a clearance.
    #[inline(never)] // the strips leave the stack before a flood
    pub(super) fn body_window(&self, window: Window, layer: Layer) -> Rows {
        let mut rows = [0; TILE * 4];
        for (at, tiles) in window.rows_of_tiles() {
            let strip = strip(&self.map, self.clearance, at);
            for (layers, at) in strip.into_iter().zip(tiles) {
                let Some(at) = at else { continue };
                let [_, open, frontier, goals] = self.layers_of(at, layers);
                let cells = match layer {
                    Layer::Open => open,
                    Layer::Frontier => frontier,
                    Layer::Goals => goals,
                };
                window.put(&mut rows, at, cells);
            }
        }
        rows
    }

    /// The robot's body is there, so nothing else is: what is not known of its cells is
    /// free.
    pub(super) fn lie(&mut self) -> Learnt {
        let mut learnt = Learnt::default();
        for cell in body_cells(self.clearance, self.position) {
            if !self.map.is_known(cell)
                && let Some((at, bit)) = TileIndex::of(cell)
            {
                let free = Tile::UNKNOWN.with(bit, Level::Free);
                learnt += self.map.join_tile(at, free);
            }
        }
        learnt
    }

    /// Sets aside the cells from which the body would touch one that stays there.
    pub(crate) fn close_around(&mut self, other: Cell) {
        let reach = 2 * i16::from(self.clearance);
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let cell = Cell::new(other.x.saturating_add(dx), other.y.saturating_add(dy));
                if bodies_touch(self.clearance, cell, other) {
                    self.aside.add(cell);
                }
            }
        }
    }

    /// The state of a cell.
    pub(super) fn fit(&self, cell: Cell) -> Fit {
        fit(&self.map, self.clearance, cell)
    }

    /// A cell of the disc beside a cell that is not known.
    pub(super) fn unknown_near(&self, from: Cell, side: Direction) -> Cell {
        let beside = from.step(side);
        let mut cells = body_cells(self.clearance, beside);
        let found = cells.find(|cell| !self.map.is_known(*cell));
        found.unwrap_or(beside)
    }

    /// Whether a cell of the disc beside a cell is doubtful on the map.
    pub(super) fn is_doubtful_near(&self, from: Cell, side: Direction) -> bool {
        body_cells(self.clearance, from.step(side)).any(|cell| self.map.is_doubtful(cell))
    }
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// As [`Inspect::narrow_cells`](crate::Inspect::narrow_cells).
    pub(super) fn count_narrow_cells(&self) -> u32 {
        let around = &self.around;
        if around.clearance == 0 {
            return 0;
        }
        let is_narrow = |cell: &Cell| {
            let mut centres = body_cells(around.clearance, *cell);
            !centres.any(|centre| around.fit(centre) == Fit::Clear)
        };
        let free = every_tile(TW, TH)
            .flat_map(|at| bits(around.map.free(at)).map(move |bit| at.cell(bit)));
        free.filter(is_narrow).count() as u32
    }

    /// Whether the body of another robot is in the way of a step: the robot waits, and after
    /// as many waits as for held steps it takes the room around that body as refused.
    pub(super) fn keeps_apart(&mut self, step: Direction) -> bool {
        let clearance = self.around.clearance;
        if clearance == 0 {
            return false;
        }
        let here = self.around.position;
        let other = self
            .others
            .in_the_way(self.id, here, here.step(step), clearance);
        let Some(other) = other else {
            return false;
        };
        self.holds = self.holds.saturating_add(1);
        if self.holds >= self.config.holds {
            self.refuse(other, true);
            self.around.close_around(other);
        }
        true
    }
}

#[cfg(test)]
mod tests;
