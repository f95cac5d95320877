//! Pockets: small holes in known surface.

use super::CoordinatedSurvey;
use crate::cell::Cell;
use crate::point::Point;
use crate::tile::{TileIndex, bits};

/// Frontiers farther away than this share of the range are left for later.
const REACH: f32 = 1.28;

/// A frontier with less than this share unknown around it is a pocket's.
const OPENNESS: f32 = 0.18;

/// Radius of the disc around a frontier that is looked at, as a share of the range.
const NEIGHBOURHOOD: f32 = 1.25;

/// How far beyond a frontier a robot flies, as a share of the way to the middle of the
/// unknown within range: what lies there comes into sight sooner.
const BEYOND: f32 = 0.7;

/// Samples of the unit disc: number n at radius √((n + ½)/16) and n times the golden
/// angle of 2.39996, so that they fill the disc evenly like the seeds of a sunflower.
// [Vogel1979]
const SAMPLES: [(f32, f32); 16] = [
    (0.176_776_7, 0.0),
    (-0.225_771_5, 0.206_826_5),
    (0.034_555_5, -0.393_771_4),
    (0.284_574_8, 0.371_17),
    (-0.522_224_4, -0.092_367_2),
    (0.494_690_3, -0.314_692_7),
    (-0.165_454, 0.615_528_2),
    (-0.315_575_2, -0.607_587_3),
    (0.684_648_6, 0.250_012_5),
    (-0.712_247_5, 0.294_029_7),
    (0.343_330_8, -0.733_739_7),
    (0.253_759, 0.808_923),
    (-0.764_763_1, -0.443_156_2),
    (0.897_125_7, -0.197_270_1),
    (-0.547_471_7, 0.778_797),
    (-0.126_534_1, -0.976_083_6),
];

impl<const TW: usize, const TH: usize> CoordinatedSurvey<TW, TH> {
    /// The nearest frontier that belongs to a pocket and that no rival is nearer to.
    ///
    /// Cost: the frontiers within 1.28 R, each with 16 samples at most.
    pub(super) fn nearest_pocket(&mut self) -> Option<Cell> {
        let here = self.knowledge.position();
        let range = self.config.limits.range;
        let mut best: Option<(f32, Cell)> = None;
        let mut work = 0;
        for tile in tiles_within(here, REACH * range) {
            work += 1;
            if self.knowledge.surface().frontiers_in(tile) == 0 {
                continue;
            }
            for bit in bits(self.knowledge.surface().frontier_cells(tile)) {
                work += 1;
                let cell = tile.cell(bit);
                let at = Point::over(cell, 0.0);
                let distance = here.plan_distance(at);
                let most = best.map_or(REACH * range, |(least, _)| least);
                if distance > most {
                    continue;
                }
                let rival_is_nearer = self
                    .knowledge
                    .rivals()
                    .any(|peer| peer.status.position.plan_distance(at) < distance);
                if rival_is_nearer {
                    continue;
                }
                work += SAMPLES.len() as u32;
                if self.openness(at, NEIGHBOURHOOD * range) < OPENNESS {
                    best = Some((distance, cell));
                }
            }
        }
        self.knowledge.count_work(work);
        best.map(|(_, cell)| cell)
    }

    /// The place beyond `frontier`, towards the unknown around it, at which all that it
    /// hides is seen.
    ///
    /// Cost: 16 columns.
    #[inline(never)] // what it keeps on the stack goes with it
    pub(super) fn beyond(&mut self, frontier: Point) -> Point {
        let range = self.config.limits.range;
        let (mut unknown, mut dx, mut dy) = (0.0f32, 0.0, 0.0);
        for (x, y) in SAMPLES {
            let cell = frontier.offset(range * x, range * y, 0.0).cell();
            if self.knowledge.surface().is_unknown(cell) {
                unknown += 1.0;
                dx += range * x;
                dy += range * y;
            }
        }
        self.knowledge.count_work(SAMPLES.len() as u32);
        let share = BEYOND / unknown.max(1.0);
        frontier.offset(share * dx, share * dy, 0.0)
    }

    /// Share of the disc of `radius` around `centre` that is unknown, of the part
    /// inside the map.
    ///
    /// Cost: 16 columns.
    pub(super) fn openness(&self, centre: Point, radius: f32) -> f32 {
        let surface = self.knowledge.surface();
        let (mut inside, mut unknown) = (0.0f32, 0.0);
        for (x, y) in SAMPLES {
            let cell = centre.offset(radius * x, radius * y, 0.0).cell();
            if surface.extent().contains(cell) {
                inside += 1.0;
                unknown += f32::from(u8::from(surface.is_unknown(cell)));
            }
        }
        unknown / inside.max(1.0)
    }
}

/// The tiles that hold a cell within `radius` of `centre`, and a few more.
fn tiles_within(centre: Point, radius: f32) -> impl Iterator<Item = TileIndex> {
    let corner = |by: f32| {
        let cell = centre.offset(by, by, 0.0).cell();
        TileIndex::of(Cell::new(cell.x.max(0), cell.y.max(0)))
            .map_or(TileIndex { x: 255, y: 255 }, |(tile, _)| tile)
    };
    let (first, last) = (corner(-radius), corner(radius));
    (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| TileIndex { x, y }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_the_seeds_of_a_sunflower() {
        for (number, (x, y)) in (0u8..).zip(SAMPLES) {
            let number = f32::from(number);
            let (radius, angle) = (libm::sqrtf((number + 0.5) / 16.0), 2.399_96 * number);
            assert!((radius * libm::cosf(angle) - x).abs() < 1e-5, "{number}");
            assert!((radius * libm::sinf(angle) - y).abs() < 1e-5, "{number}");
        }
    }
}
