//! The way out for a robot that has gained nothing for a long time: it flies to the
//! edge of one frontier after the other, looks over it from low to high, and stops
//! when all of them are done.
//!
//! The rules of the planners are heuristics; this one is what makes a survey
//! complete. Just above the least altitude and just before the unknown column even a
//! deep drop shows; from there the robot climbs to the ceiling, and a tower's top
//! shows.

mod way;

use super::{Action, Knowledge, Stop};
use crate::cell::{Cell, Direction};
use crate::point::Point;
use crate::surface::{Bits, Columns, Tile};
use way::{Way, word_of};

/// Steps without gain after which the rescue begins.
pub const PATIENCE: u16 = 50;

/// Height over the least altitude at which it flies.
const MARGIN: f32 = 0.1;

/// Tiles looked at in a step for a frontier to fly to.
const SLICE: usize = 64;

/// Which frontiers have been looked over since the map last grew, and the one that is.
#[derive(Clone, Debug)]
pub(crate) struct Rescue<const TW: usize, const TH: usize> {
    tried: [[u64; TW]; TH],
    known_columns: u32,
    target: Option<Cell>,
    /// The search for the next target: the tile that comes next, how many are left,
    /// and the nearest frontier found so far.
    cursor: Tile,
    left: usize,
    nearest: Option<(f32, Cell)>,
    way: Way<TW, TH>,
    /// Which of the target's four edges is looked over.
    edge: u8,
    /// Whether the robot is there and climbs.
    climbing: bool,
    /// Steps left to get there.
    patience: u16,
}

impl<const TW: usize, const TH: usize> Rescue<TW, TH> {
    /// All zero, until [`reset`](Self::reset).
    pub(crate) const fn vacant() -> Self {
        Self {
            tried: [[0; TW]; TH],
            known_columns: 0,
            target: None,
            cursor: Tile { x: 0, y: 0 },
            left: 0,
            nearest: None,
            way: Way::vacant(),
            edge: 0,
            climbing: false,
            patience: 0,
        }
    }

    /// Starts anew, in place.
    pub(crate) fn reset(&mut self) {
        self.tried = [[0; TW]; TH];
        self.known_columns = 0;
        self.target = None;
        self.cursor = Tile { x: 0, y: 0 };
        self.begin_search();
        self.way.begin(None);
        self.edge = 0;
        self.climbing = false;
        self.patience = 0;
    }

    /// One step of the rescue.
    ///
    /// Cost: 64 tiles while a target is searched for, 1024 while the way to it is, and
    /// at most 30 flights looked at.
    pub(crate) fn tick(&mut self, knowledge: &mut Knowledge<TW, TH>) -> Action {
        let known_columns = knowledge.surface().known_columns();
        if self.known_columns != known_columns {
            self.known_columns = known_columns;
            self.tried = [[0; TW]; TH];
            self.begin_search();
        }
        let is_frontier = |target| knowledge.surface().is_frontier(target);
        if !self.target.is_some_and(is_frontier) {
            self.target = None;
            self.search(knowledge);
            if self.left > 0 {
                return Action::Hover;
            }
            self.target = self.nearest.map(|(_, cell)| cell);
            self.begin_search();
            self.begin(knowledge, 0);
            self.way.begin(self.target);
        }
        knowledge.set_target(self.target);
        let Some(target) = self.target else {
            return knowledge.stop(Stop::Unseen {
                frontiers: knowledge.surface().frontiers(),
            });
        };
        let Some((edge, place)) = edge_of(knowledge, target, self.edge) else {
            self.mark_tried(target);
            self.target = None;
            return Action::Hover;
        };
        self.edge = edge;
        if !self.climbing {
            let cruise = knowledge.limits().min_altitude + MARGIN;
            knowledge.look_at(29);
            let next = if is_known_between(knowledge, place) {
                place
            } else {
                match self.way.next(knowledge) {
                    way::Next::Column(cell) => Point::over(cell, 0.0),
                    way::Next::Searching => return Action::Hover,
                    way::Next::None => place,
                }
            };
            self.patience = self.patience.saturating_sub(1);
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

    fn begin_search(&mut self) {
        self.left = TW * TH;
        self.nearest = None;
    }

    /// Looks at the next few tiles for the nearest frontier that was not tried.
    fn search(&mut self, knowledge: &mut Knowledge<TW, TH>) {
        let here = knowledge.position();
        for _ in 0..SLICE.min(self.left) {
            let tile = self.cursor;
            self.cursor = knowledge.surface().tile_after(tile);
            self.left -= 1;
            knowledge.look_at(1);
            if knowledge.surface().frontiers_in(tile) == 0 {
                continue;
            }
            let tried = word_of(&mut self.tried, tile.cell(0)).map_or(0, |word| *word);
            let open = knowledge.surface().frontier_cells(tile) & !tried;
            knowledge.look_at(open.count_ones());
            for bit in Bits(open) {
                let cell = tile.cell(bit);
                let distance = here.plan_distance(Point::over(cell, 0.0));
                if self.nearest.is_none_or(|(least, _)| distance < least) {
                    self.nearest = Some((distance, cell));
                }
            }
        }
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

    fn mark_tried(&mut self, cell: Cell) {
        if let Some(word) = word_of(&mut self.tried, cell) {
            *word |= 1 << Tile::bit(cell);
        }
    }
}

/// Whether all ground on the straight way to `place` is known.
///
/// Cost: the columns crossed.
fn is_known_between<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    place: Point,
) -> bool {
    Columns::new(knowledge.position(), place)
        .all(|crossing| knowledge.surface().height(crossing.cell).is_some())
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
