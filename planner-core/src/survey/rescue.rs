//! The way out for a robot that has gained nothing for a long time: it flies low to
//! the edge of one frontier after the other, and stops when all of them are done.
//!
//! The rules of the planners are heuristics; this one is what makes a survey
//! complete. It looks over the edge between a frontier and the unknown column beside
//! it from just above the least altitude, from where even a deep drop shows.

use super::{Action, Knowledge, Stop};
use crate::cell::{Cell, Direction};
use crate::point::Point;
use crate::surface::Tile;

/// Steps without gain after which the rescue begins.
pub const PATIENCE: u16 = 50;

/// Height over the least altitude at which it flies.
const MARGIN: f32 = 0.1;

/// Which frontiers have been looked over since the map last grew.
#[derive(Clone, Debug)]
pub(crate) struct Rescue<const TW: usize, const TH: usize> {
    tried: [[u64; TW]; TH],
    known_columns: u32,
    target: Option<Cell>,
    /// Steps left for the target.
    patience: u16,
    pub(crate) work: u32,
}

impl<const TW: usize, const TH: usize> Rescue<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            tried: [[0; TW]; TH],
            known_columns: 0,
            target: None,
            patience: 0,
            work: 0,
        }
    }

    /// The frontier that it flies to.
    pub(crate) const fn target(&self) -> Option<Cell> {
        self.target
    }

    /// One step of the rescue.
    ///
    /// Cost: a [`Knowledge::closest_frontier`] when a target is done, and at most 29
    /// flights looked at.
    pub(crate) fn tick(&mut self, knowledge: &Knowledge<TW, TH>) -> Action {
        let surface = knowledge.surface();
        self.work = 0;
        if self.known_columns != surface.known_columns() {
            self.known_columns = surface.known_columns();
            self.tried = [[0; TW]; TH];
        }
        let here = knowledge.position();
        if !self
            .target
            .is_some_and(|target| surface.is_frontier(target))
        {
            let (target, work) = knowledge.closest_frontier(here, |cell| !self.was_tried(cell));
            self.work = work;
            self.target = target;
            self.patience = target.map_or(0, |cell| {
                let steps = here.plan_distance(Point::over(cell, 0.0)) / knowledge.limits().step;
                ((4.0 * steps) as u16).saturating_add(20)
            });
        }
        let Some(target) = self.target else {
            return Action::Stop(Stop::Unseen {
                frontiers: surface.frontiers(),
            });
        };
        self.work = self.work.saturating_add(29);
        self.patience = self.patience.saturating_sub(1);
        let cruise = knowledge.limits().min_altitude + MARGIN;
        match knowledge.step_towards(edge_of(knowledge, target), cruise) {
            Some(to) if self.patience > 0 => Action::Fly(to),
            _ => {
                self.mark_tried(target);
                self.target = None;
                Action::Hover
            }
        }
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
        if let Some(word) = Tile::of(cell).and_then(|tile| {
            self.tried
                .get_mut(usize::from(tile.y))?
                .get_mut(usize::from(tile.x))
        }) {
            *word |= 1 << Tile::bit(cell);
        }
    }
}

/// The place over `frontier`, just inside its border with an unknown column.
fn edge_of<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    frontier: Cell,
) -> Point {
    let (dx, dy) = Direction::ALL
        .into_iter()
        .find(|&direction| knowledge.surface().is_unknown(frontier.step(direction)))
        .map_or((0, 0), Direction::delta);
    Point::over(frontier, 0.0).offset(0.45 * f32::from(dx), 0.45 * f32::from(dy), 0.0)
}
