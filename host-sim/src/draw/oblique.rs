//! The view from the south-east and above: columns as blocks, ways in the air.

use image::{Rgb, RgbImage};
use planner_core::volume::Voxel;
use planner_core::{Cell, Extent, Point};

use super::compass::{Drawn, Rows, Sides, ways_among_voxels, ways_over_heights};
use super::paint::{DARK, disc, line, put, shade, way_color};
use crate::record::heights::Trace;
use crate::record::voxels::VoxelTrace;

/// Width of a picture in pixels, about.
const WIDTH: f32 = 900.0;

/// An isometric view with north away to the right.
#[derive(Clone, Copy)]
struct View {
    /// Pixels of a cell along the picture's x axis, and up.
    scale: f32,
    /// Where the north-west corner of the ground is.
    origin: (f32, f32),
}

impl View {
    /// Where a point falls.
    fn project(self, at: Point) -> (f32, f32) {
        (
            self.origin.0 + (at.x - at.y) * self.scale,
            self.origin.1 + (at.x + at.y) * self.scale * 0.5 - at.z * self.scale,
        )
    }

    /// What a cell's sides take.
    fn sides(self) -> Sides {
        let scale = self.scale;
        Sides {
            east: (scale, scale * 0.5),
            north: (scale, -scale * 0.5),
            up: Some((0.0, -scale)),
        }
    }
}

/// What had been mapped after `step` steps, with the ways flown; what is unknown is
/// left dark.
pub fn oblique_view(trace: &Trace, step: u32) -> RgbImage {
    heights(trace, step).image
}

pub(super) fn heights(trace: &Trace, step: u32) -> Drawn {
    let rows = Rows::of_heights(trace);
    let blocks = trace.mapped(step).map(|column| Block {
        cell: rows.cell(column.cell),
        bottom: 0.0,
        top: column.height.cells(),
    });
    let highest = trace.terrain.highest().cells();
    let place = Place {
        extent: trace.extent,
        lowest: 0.0,
        highest,
        ceiling: highest + 8.0,
    };
    oblique(&place, blocks.collect(), &ways_over_heights(trace, step))
}

/// What the robots took for occupied in a scene of voxels after `tick` steps, with the ways flown;
/// without what is higher than the level `cut`, if there is one.
pub fn oblique_voxels(trace: &VoxelTrace, tick: u32, cut: Option<i16>) -> RgbImage {
    voxels(trace, tick, cut).image
}

pub(super) fn voxels(trace: &VoxelTrace, tick: u32, cut: Option<i16>) -> Drawn {
    let (scene, rows) = (&trace.scene, Rows::of_voxels(trace.scene.extent()));
    let levels = i16::from(scene.levels());
    let shown = cut.map_or(levels, |cut| levels.min(cut.saturating_add(1)));
    let occupied = trace.map(tick).into_iter().filter(|found| found.1);
    let shown_blocks = occupied.filter(|(voxel, _)| voxel.z < shown);
    let blocks = shown_blocks.map(|(voxel, _)| Block {
        cell: rows.cell(voxel.cell()),
        bottom: f32::from(voxel.z),
        top: f32::from(voxel.z) + 1.0,
    });
    let solid = trace.found.iter().filter(|found| found.2);
    let flown = trace.ways.iter().flatten().map(|at| at.z + 1);
    let place = Place {
        extent: scene.extent(),
        lowest: f32::from(solid.map(|found| found.1.z).min().unwrap_or(0)),
        highest: f32::from(shown),
        ceiling: f32::from(flown.max().unwrap_or(0).max(shown)),
    };
    oblique(&place, blocks.collect(), &ways_among_voxels(trace, tick))
}

/// The level at which a view from aside is cut unless somebody chose one: none if the first start is
/// under the sky, or else where rooms are, which a ceiling would hide.
pub fn usual_cut(trace: &VoxelTrace) -> Option<i16> {
    rooms(trace).filter(|_| trace.starts_covered())
}

/// The level that shows rooms best: where the robots' map has most free voxels with something over
/// them, or the middle one of those that have nine tenths of that; `None` if nothing is over any.
pub(super) fn rooms(trace: &VoxelTrace) -> Option<i16> {
    let width = usize::from(trace.scene.extent().width);
    let index = |at: &Voxel| at.y as usize * width + at.x as usize;
    let map = trace.map(u32::MAX);
    let mut tops = vec![-1; trace.scene.extent().cells() as usize];
    for (voxel, _) in map.iter().filter(|found| found.1) {
        let top = &mut tops[index(voxel)];
        *top = voxel.z.max(*top);
    }
    let mut covered = vec![0_u64; trace.scene.levels().into()];
    for (voxel, _) in map
        .iter()
        .filter(|(at, full)| !full && at.z < tops[index(at)])
    {
        covered[voxel.z as usize] += 1;
    }
    let most = *covered.iter().max().filter(|&&most| most > 0)?;
    let levels = covered.iter().zip(0..);
    let good: Vec<i16> = levels
        .filter(|(free, _)| 10 * **free >= 9 * most)
        .map(|(_, level)| level)
        .collect();
    good.get(good.len() / 2).copied()
}

/// The box that is drawn, in cells.
struct Place {
    extent: Extent,
    /// Between what heights blocks have shades.
    lowest: f32,
    highest: f32,
    /// How high there is anything to be drawn.
    ceiling: f32,
}

/// Something solid over one column of cells.
struct Block {
    cell: Cell,
    bottom: f32,
    top: f32,
}

/// Blocks and ways, rows leading south.
fn oblique(place: &Place, mut blocks: Vec<Block>, ways: &[Vec<Point>]) -> Drawn {
    let (width, height) = (
        f32::from(place.extent.width),
        f32::from(place.extent.height),
    );
    let margin = 20.0;
    let top = place.ceiling;
    let scale = (WIDTH / (width + height)).clamp(2.0, 12.0).floor();
    let view = View {
        scale,
        origin: (height * scale + margin, top * scale + margin),
    };
    let mut picture = RgbImage::from_pixel(
        ((width + height) * scale + 2.0 * margin) as u32,
        ((width + height) * scale * 0.5 + top * scale + 2.0 * margin) as u32,
        DARK,
    );
    // Far blocks first, so that near ones cover them.
    blocks.sort_by(|a, b| {
        let depth = |block: &Block| block.cell.x + block.cell.y;
        depth(a).cmp(&depth(b)).then(a.bottom.total_cmp(&b.bottom))
    });
    for solid in &blocks {
        let (above, most) = (solid.top - place.lowest, place.highest - place.lowest);
        block(&mut picture, solid, shade(above, most), view);
    }
    for (robot, way) in ways.iter().enumerate() {
        let colour = way_color(robot);
        for leg in way.windows(2) {
            let (from, to) = (view.project(leg[0]), view.project(leg[1]));
            line(&mut picture, from, to, &[(0.0, 0.0), (0.0, 1.0)], colour);
        }
        if let (Some(first), Some(last)) = (way.first(), way.last()) {
            disc(&mut picture, view.project(*first), 3.0..=4.0, colour);
            disc(&mut picture, view.project(*last), 0.0..=4.0, colour);
        }
    }
    Drawn {
        image: picture,
        sides: view.sides(),
    }
}

/// One block: its top, and its two sides that face the viewer.
fn block(picture: &mut RgbImage, block: &Block, colour: Rgb<u8>, view: View) {
    let scale = view.scale;
    let darker = |share: f32| Rgb(colour.0.map(|value| (f32::from(value) * share) as u8));
    let (x, y) = view.project(Point::over(block.cell, block.top));
    let wide = scale as i32;
    let deep = ((block.top - block.bottom) * scale) as i32;
    for dx in -wide..=wide {
        let half = (scale * 0.5 * (1.0 - dx.abs() as f32 / scale)).ceil() as i32;
        for dy in -half..=half {
            put(picture, x + dx as f32, y + dy as f32, colour);
        }
        let side = if dx < 0 { darker(0.7) } else { darker(0.5) };
        for dy in half + 1..=half + deep {
            put(picture, x + dx as f32, y + dy as f32, side);
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::run::voxels::Simulation;
    use crate::scenario::voxels::Scenario;
    use crate::scene::Scene;

    /// What a robot maps that starts at `start` in a yard with a house, which has a door to the
    /// south: its walls reach from 4 to 10, its roof is at level 6.
    pub(in crate::draw) fn house(start: Voxel) -> VoxelTrace {
        let is_house = |at: Voxel| {
            let inside = |side: i16| (4..=10).contains(&side);
            let wall = |side: i16| [4, 10].contains(&side);
            let door = at.y == 4 && (6..=8).contains(&at.x) && at.z < 4;
            let shell = at.z == 6 || (wall(at.x) || wall(at.y)) && !door;
            inside(at.x) && inside(at.y) && at.z <= 6 && shell
        };
        let scene = Scene::from_fn("house", Extent::new(15, 16), 9, |at| {
            at.z == 0 || is_house(at)
        });
        let mut scenario = Scenario::new(1, 0);
        scenario.start = Some(start);
        let mut run = Simulation::new(&scene, &scenario).unwrap();
        while run.step() {}
        run.finish()
    }

    #[test]
    fn a_ceiling_over_the_start_is_cut_off_and_a_roof_is_not() {
        let (indoors, outdoors) = (Voxel::new(7, 7, 2), Voxel::new(2, 2, 2));
        let trace = house(indoors);
        assert!(trace.complete());
        assert_eq!((rooms(&trace), usual_cut(&trace)), (Some(2), Some(2)));
        let trace = house(outdoors);
        assert_eq!((rooms(&trace), usual_cut(&trace)), (Some(2), None));
        let roof = |picture: &RgbImage| {
            let roof = shade(7.0, 9.0);
            picture.pixels().filter(|it| **it == roof).count()
        };
        assert!(roof(&oblique_voxels(&trace, u32::MAX, None)) > 100);
        assert_eq!(roof(&oblique_voxels(&trace, u32::MAX, Some(3))), 0);
    }
}
