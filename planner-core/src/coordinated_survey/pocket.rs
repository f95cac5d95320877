//! Pockets: small holes in known surface.

use super::CoordinatedSurvey;
use crate::cell::Cell;
use crate::math;
use crate::point::Point;
use crate::surface::{Bits, Tile};

/// Frontiers farther away than this share of the range are left for later.
const REACH: f32 = 1.28;

/// A frontier with less than this share unknown around it is a pocket's.
const OPENNESS: f32 = 0.18;

/// Radius of the disc around a frontier that is looked at, as a share of the range.
const NEIGHBOURHOOD: f32 = 1.25;

/// Samples of a disc.
const SAMPLES: u8 = 16;

/// Angle between two samples: the golden angle, so that they fill the disc evenly
/// like the seeds of a sunflower.
// [Vogel1979]
const GOLDEN_ANGLE: f32 = 2.399_96;

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
            for bit in Bits(self.knowledge.surface().frontier_cells(tile)) {
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
                work += u32::from(SAMPLES);
                if self.openness(at, NEIGHBOURHOOD * range) < OPENNESS {
                    best = Some((distance, cell));
                }
            }
        }
        self.knowledge.look_at(work);
        best.map(|(_, cell)| cell)
    }

    /// Share of the disc of `radius` around `centre` that is unknown, of the part
    /// inside the map.
    ///
    /// Cost: 16 columns.
    pub(super) fn openness(&self, centre: Point, radius: f32) -> f32 {
        let surface = self.knowledge.surface();
        let (mut inside, mut unknown) = (0.0f32, 0.0);
        for sample in 0..SAMPLES {
            let number = f32::from(sample);
            let reach = radius * math::sqrt((number + 0.5) / f32::from(SAMPLES));
            let (sin, cos) = math::sin_cos(GOLDEN_ANGLE * number);
            let cell = centre.offset(reach * cos, reach * sin, 0.0).cell();
            if surface.extent().contains(cell) {
                inside += 1.0;
                unknown += f32::from(u8::from(surface.is_unknown(cell)));
            }
        }
        unknown / inside.max(1.0)
    }
}

/// The tiles that hold a cell within `radius` of `centre`, and a few more.
fn tiles_within(centre: Point, radius: f32) -> impl Iterator<Item = Tile> {
    let corner = |by: f32| {
        let cell = centre.offset(by, by, 0.0).cell();
        Tile::of(Cell::new(cell.x.max(0), cell.y.max(0))).unwrap_or(Tile { x: 255, y: 255 })
    };
    let (first, last) = (corner(-radius), corner(radius));
    (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| Tile { x, y }))
}
