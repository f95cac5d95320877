//! The way out for a robot that has gained nothing for a long time: it flies to the
//! edge of one frontier after the other, looks over it from low to high, and stops
//! when all of them are done.
//!
//! The rules of the planners are heuristics; this one is what makes a survey
//! complete. Just above the least altitude and just before the unknown column even a
//! deep drop shows; from there the robot climbs to the ceiling, and a tower's top
//! shows.

use super::{Action, Knowledge, Stop};
use crate::cell::{Cell, Direction};
use crate::point::Point;
use crate::surface::{Columns, Tile, neighbours_of};

/// Steps without gain after which the rescue begins.
pub const PATIENCE: u16 = 50;

/// Height over the least altitude at which it flies.
const MARGIN: f32 = 0.1;

/// Which frontiers have been looked over since the map last grew, and the one that is.
#[derive(Clone, Debug)]
pub(crate) struct Rescue<const TW: usize, const TH: usize> {
    tried: [[u64; TW]; TH],
    known_columns: u32,
    target: Option<Cell>,
    /// Which of the target's four edges is looked over.
    edge: u8,
    /// Whether the robot is there and climbs.
    climbing: bool,
    /// Steps left to get there.
    patience: u16,
    pub(crate) work: u32,
}

impl<const TW: usize, const TH: usize> Rescue<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            tried: [[0; TW]; TH],
            known_columns: 0,
            target: None,
            edge: 0,
            climbing: false,
            patience: 0,
            work: 0,
        }
    }

    /// Starts anew, in place.
    pub(crate) fn reset(&mut self) {
        self.tried = [[0; TW]; TH];
        self.known_columns = 0;
        self.target = None;
        self.edge = 0;
        self.climbing = false;
        self.patience = 0;
        self.work = 0;
    }

    /// The frontier that it flies to.
    pub(crate) const fn target(&self) -> Option<Cell> {
        self.target
    }

    /// One step of the rescue.
    ///
    /// Cost: a [`Knowledge::closest_frontier`] when a target is done, and at most 30
    /// flights looked at.
    pub(crate) fn tick(&mut self, knowledge: &Knowledge<TW, TH>) -> Action {
        let surface = knowledge.surface();
        self.work = 30;
        if self.known_columns != surface.known_columns() {
            self.known_columns = surface.known_columns();
            self.tried = [[0; TW]; TH];
        }
        if !self
            .target
            .is_some_and(|target| surface.is_frontier(target))
        {
            let here = knowledge.position();
            let (target, work) = knowledge.closest_frontier(here, |cell| !self.was_tried(cell));
            self.work = self.work.saturating_add(work);
            self.target = target;
            self.begin(knowledge, 0);
        }
        let Some(target) = self.target else {
            return Action::Stop(Stop::Unseen {
                frontiers: surface.frontiers(),
            });
        };
        let Some((edge, place)) = edge_of(knowledge, target, self.edge) else {
            self.mark_tried(target);
            self.target = None;
            return Action::Hover;
        };
        self.edge = edge;
        if !self.climbing {
            self.patience = self.patience.saturating_sub(1);
            let cruise = knowledge.limits().min_altitude + MARGIN;
            let next = self.next_place(knowledge, target, place);
            match knowledge.step_towards(next, cruise) {
                Some(to) if self.patience > 0 => return Action::Fly(to),
                _ => self.climbing = true,
            }
        }
        let up = knowledge.climb();
        if up.z > knowledge.position().z && knowledge.may_fly(up) {
            return Action::Fly(up);
        }
        self.begin(knowledge, edge.saturating_add(1));
        Action::Hover
    }

    /// Where to fly next on the way to `place` over `target`: there if all ground on
    /// the straight way is known, or else to the next column on the shortest way over
    /// known columns.
    ///
    /// Cost: the columns on the straight way, or all tiles once for each column of the
    /// shortest way.
    #[inline(never)] // what it keeps on the stack goes with it
    fn next_place(&mut self, knowledge: &Knowledge<TW, TH>, target: Cell, place: Point) -> Point {
        let surface = knowledge.surface();
        let here = knowledge.position();
        if Columns::new(here, place).all(|crossing| surface.height(crossing.cell).is_some()) {
            return place;
        }
        // A wave from the target until it wets a column beside the robot.
        let mut wave = [[0u64; TW]; TH];
        if let Some(word) = word_of(&mut wave, target) {
            *word |= 1 << Tile::bit(target);
        }
        for _ in 0..surface.known_columns() {
            let beside = Direction::ALL.map(|direction| here.cell().step(direction));
            let wet = beside.into_iter().find(|&cell| {
                word_of(&mut wave, cell).is_some_and(|word| *word >> Tile::bit(cell) & 1 == 1)
            });
            if let Some(cell) = wet {
                return Point::over(cell, 0.0);
            }
            self.work = self.work.saturating_add((TW * TH) as u32);
            let before = wave;
            let at = |x: Option<u8>, y: Option<u8>| {
                let row = before.get(usize::from(y?))?;
                row.get(usize::from(x?)).copied()
            };
            for tile in surface.tiles() {
                let around = [
                    at(Some(tile.x), tile.y.checked_sub(1)),
                    at(tile.x.checked_add(1), Some(tile.y)),
                    at(Some(tile.x), tile.y.checked_add(1)),
                    at(tile.x.checked_sub(1), Some(tile.y)),
                ]
                .map(|word| word.unwrap_or(0));
                if let Some(word) = word_of(&mut wave, tile.cell(0)) {
                    *word |= neighbours_of(*word, around) & surface.known(tile);
                }
            }
            if wave == before {
                break;
            }
        }
        place
    }

    /// Sets out for the target's edge number `edge`.
    fn begin(&mut self, knowledge: &Knowledge<TW, TH>, edge: u8) {
        self.edge = edge;
        self.climbing = false;
        self.patience = self.target.map_or(0, |cell| {
            let way = knowledge.position().plan_distance(Point::over(cell, 0.0));
            ((8.0 * way / knowledge.limits().step) as u16).saturating_add(30)
        });
    }

    fn was_tried(&self, cell: Cell) -> bool {
        Tile::of(cell).is_some_and(|tile| {
            self.tried
                .get(usize::from(tile.y))
                .and_then(|row| row.get(usize::from(tile.x)))
                .is_some_and(|word| word >> Tile::bit(cell) & 1 == 1)
        })
    }

    fn mark_tried(&mut self, cell: Cell) {
        if let Some(word) = word_of(&mut self.tried, cell) {
            *word |= 1 << Tile::bit(cell);
        }
    }
}

/// The word of a layer that has the bit of `cell`.
fn word_of<const TW: usize, const TH: usize>(
    layer: &mut [[u64; TW]; TH],
    cell: Cell,
) -> Option<&mut u64> {
    let tile = Tile::of(cell)?;
    layer
        .get_mut(usize::from(tile.y))?
        .get_mut(usize::from(tile.x))
}

/// The first edge of `frontier`, from number `first` on, that borders an unknown
/// column, and the place just inside it.
fn edge_of<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    frontier: Cell,
    first: u8,
) -> Option<(u8, Point)> {
    (0u8..)
        .zip(Direction::ALL)
        .skip(usize::from(first))
        .find(|&(_, direction)| knowledge.surface().is_unknown(frontier.step(direction)))
        .map(|(number, direction)| {
            let (dx, dy) = direction.delta();
            let centre = Point::over(frontier, 0.0);
            (
                number,
                centre.offset(0.45 * f32::from(dx), 0.45 * f32::from(dy), 0.0),
            )
        })
}
