//! Terrains and scenes, as the air sees them, how robots in the air speak, and what can be
//! forged about them.

use planner_core::radio::{GridId, HeightRecord, LinkConfig, MAX_LEN, SurfaceFrame, VoxelFrame};
use planner_core::surface::{self, Height};
use planner_core::volume::{self, Voxel, VoxelPatch};
use planner_core::{Cell, Extent, Point, Status};

use super::grid::{any_bits, any_cell};
use super::{Claim, Radio, Space, Station};
use crate::dice::Dice;
use crate::scene::Scene;
use crate::terrain::Terrain;

/// Columns of a forged record.
const COLUMNS: usize = 8;

impl Space for Terrain {
    type Place = Point;
    type Read = ();

    fn is_near(&self, from: Point, to: Point, cells: u16) -> bool {
        from.distance(to) <= f32::from(cells)
    }

    fn is_in_sight(&self, from: Point, to: Point) -> bool {
        surface::in_sight(from, to, |cell| self.height(cell))
    }
}

impl Space for Scene {
    type Place = Voxel;
    type Read = ();

    fn is_near(&self, from: Voxel, to: Voxel, cells: u16) -> bool {
        from.distance_squared(to) <= u32::from(cells).pow(2)
    }

    fn is_in_sight(&self, from: Voxel, to: Voxel) -> bool {
        volume::in_sight(from, to, |voxel| !self.is_solid(voxel))
    }
}

/// Robots in the air speak before anybody decides, and again after their flight.
impl<W: Space> Radio<W> {
    /// What everybody has to say before anybody decides, within so many bytes a robot;
    /// one frame of them is left for after the flight.
    pub(crate) fn share<S: Station<Place = W::Place, Read = W::Read>>(
        &mut self,
        tick: u32,
        robots: &mut [S],
        byte_budget: u16,
    ) {
        self.deliver(tick, robots);
        let frames = usize::from(byte_budget) / MAX_LEN;
        for speaker in 0..robots.len() {
            self.speak(tick, robots, speaker, frames.saturating_sub(1).max(1));
        }
        self.forge(tick, robots);
    }

    /// A robot sends what its budget allows, at most so many frames; what is due is heard.
    pub(crate) fn speak<S: Station<Place = W::Place, Read = W::Read>>(
        &mut self,
        tick: u32,
        robots: &mut [S],
        speaker: usize,
        most: usize,
    ) {
        self.transmit(tick, robots, speaker, most);
        self.deliver(tick, robots);
    }

    /// The robots that hear in `tick` what robot `from` says without a frame.
    pub(crate) fn listeners<S: Station<Place = W::Place, Read = W::Read>>(
        &mut self,
        tick: u32,
        robots: &[S],
        from: usize,
    ) -> Vec<usize> {
        let end = |robot: &S| (robot.id(), robot.place());
        let hears = |&to: &usize| {
            to != from
                && robots[to].is_awake()
                && self.is_open(tick)
                && self.air.carries(tick, end(&robots[from]), end(&robots[to]))
        };
        (0..robots.len()).filter(hears).collect()
    }
}

/// Anywhere under the ceiling.
pub(crate) fn any_point(extent: Extent, ceiling: f32, dice: &mut Dice) -> Point {
    let cell = any_cell(extent, dice);
    Point::over(cell, dice.unit() as f32 * ceiling)
}

/// Anywhere in a box.
pub(crate) fn any_voxel(extent: Extent, levels: u8, dice: &mut Dice) -> Voxel {
    let Cell { x, y } = any_cell(extent, dice);
    Voxel::new(x, y, dice.below(levels.into()) as i16)
}

/// A frame about a surface of this size.
pub(crate) fn surface_frame(
    extent: Extent,
    claim: Claim<Point>,
    pieces: u32,
    dice: &mut Dice,
) -> SurfaceFrame {
    let link = LinkConfig::new();
    SurfaceFrame {
        grid: GridId::of(extent, link.origin_mm, link.cell_mm),
        sender: claim.sender,
        sequence: claim.sequence,
        status: Status {
            position: claim.position,
            goal: claim.goal.map(Point::cell),
            activity: claim.activity,
        },
        records: (0..pieces)
            .filter_map(|_| any_record(extent, dice))
            .collect(),
    }
}

fn any_record(extent: Extent, dice: &mut Dice) -> Option<HeightRecord> {
    let (tile, bits) = any_bits(extent, dice);
    let south = dice.below(2) == 1;
    let half = if south { bits >> 32 } else { bits } as u32;
    let columns = (0..u32::BITS).filter(|bit| half >> bit & 1 == 1);
    let cells = columns
        .take(COLUMNS)
        .fold(0u32, |cells, bit| cells | 1 << bit);
    let height = |_| Height(dice.below(256) as u8);
    let heights = (0..cells.count_ones()).map(height).collect();
    (cells != 0).then_some(HeightRecord {
        tile,
        south,
        fresh: true,
        cells,
        heights,
    })
}

/// A frame about a box of this size.
pub(crate) fn voxel_frame(
    extent: Extent,
    levels: u8,
    claim: Claim<Voxel>,
    pieces: u32,
    dice: &mut Dice,
) -> VoxelFrame {
    let link = LinkConfig::new();
    let any_patch = |_| {
        let (tile, known) = any_bits(extent, dice);
        let z = dice.below(levels.into()) as u8;
        let occupied = known & dice.bits();
        (known != 0).then_some(VoxelPatch {
            tile,
            z,
            known,
            occupied,
        })
    };
    VoxelFrame {
        grid: GridId::of_box(extent, levels, link.origin_mm, link.cell_mm),
        sender: claim.sender,
        sequence: claim.sequence,
        status: Status {
            position: claim.position,
            goal: claim.goal,
            activity: claim.activity,
        },
        patches: (0..pieces).filter_map(any_patch).collect(),
    }
}
