//! Sharing out frontiers: each robot prefers the frontiers that few rivals are
//! nearer to, that open onto much unknown, and that nobody announced.

use super::CoordinatedSurvey;
use crate::cell::Cell;
use crate::list;
use crate::math;
use crate::point::Point;
use crate::tile::{TileIndex, bits};

/// Tiles whose frontiers are looked at one by one.
pub(super) const SHORTLIST: usize = 4;

/// Nearest tiles with frontiers that are considered for the shortlist in each step.
const NEAREST: usize = 16;

/// Further tiles with frontiers that are considered in each step, in turn.
const IN_TURN: u8 = 8;

/// Cost of each rival that is nearer, against a distance of one range.
// [Bautin2012 MinPos]
const RANK: f32 = 10.0;

/// Worth of a neighbourhood that is all unknown.
const OPENNESS: f32 = 3.0;

/// Radius of that neighbourhood, as a share of the range.
const NEIGHBOURHOOD: f32 = 0.6;

/// Cost of a place that a rival announced, falling off over [`SPREAD`] ranges.
const ANNOUNCED: f32 = 2.0;
const SPREAD: f32 = 1.5;

impl<const TW: usize, const TH: usize> CoordinatedSurvey<TW, TH> {
    /// The frontier with the lowest score among those of four tiles: the best of the
    /// last time's four, the nearest ones, and a few in turn.
    ///
    /// Cost: 28 tiles, then the frontiers of four; each against all robots heard of.
    #[inline(never)] // what it keeps on the stack goes with it
    pub(super) fn own_frontier(&mut self) -> Option<Cell> {
        let range = self.config.limits.range;
        let surface = self.knowledge.surface();
        let (nearest, mut work) =
            surface.nearest_frontier_tiles::<NEAREST>(self.knowledge.position());
        let mut turn = self.turn;
        let in_turn = (0..IN_TURN).map_while(|_| {
            turn = surface.next_frontier_tile(turn)?;
            Some(turn)
        });
        let kept = core::mem::take(&mut self.shortlist);
        let mut shortlist: [Option<(f32, TileIndex)>; SHORTLIST] = [None; SHORTLIST];
        for tile in kept.iter().chain(&nearest).copied().chain(in_turn) {
            work += 2;
            let is_listed = shortlist
                .iter()
                .flatten()
                .any(|&(_, listed)| listed == tile);
            if is_listed || surface.frontiers_in(tile) == 0 {
                continue;
            }
            let centre = Point::over(tile.cell(0), 0.0).offset(3.5, 3.5, 0.0);
            let unknown = surface.unknown(tile).count_ones() as f32 / 64.0;
            let mut candidate = Some((self.score(centre, unknown), tile));
            for place in &mut shortlist {
                if place.is_none_or(|(score, _)| candidate.is_some_and(|(new, _)| new < score)) {
                    core::mem::swap(place, &mut candidate);
                }
            }
        }
        self.turn = turn;
        self.shortlist = list::collect(shortlist.iter().flatten().map(|&(_, tile)| tile));
        let mut best: Option<(f32, Cell)> = None;
        for (_, tile) in shortlist.into_iter().flatten() {
            for bit in bits(self.knowledge.surface().frontier_cells(tile)) {
                work += 16;
                let cell = tile.cell(bit);
                let at = Point::over(cell, 0.0);
                let score = self.score(at, self.openness(at, NEIGHBOURHOOD * range));
                if best.is_none_or(|(least, _)| score < least) {
                    best = Some((score, cell));
                }
            }
        }
        self.knowledge.count_work(work);
        best.map(|(_, cell)| cell)
    }

    fn score(&self, at: Point, openness: f32) -> f32 {
        let range = self.config.limits.range;
        let distance = self.knowledge.position().plan_distance(at);
        let (mut rank, mut announced) = (0.0f32, 0.0);
        for peer in self.knowledge.rivals() {
            if peer.status.position.plan_distance(at) < distance {
                rank += 1.0;
            }
            if let Some(goal) = peer.status.goal {
                let away = Point::over(goal, 0.0).plan_distance(at) / (SPREAD * range);
                announced += math::exp(-0.5 * away * away);
            }
        }
        distance / range + RANK * rank - OPENNESS * openness + ANNOUNCED * announced
    }
}
