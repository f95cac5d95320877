//! The view from the south-east and above: columns as blocks, ways in the air.

use image::{Rgb, RgbImage};
use planner_core::volume::Voxel;
use planner_core::{Cell, Extent, Point};

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
}

/// What had been mapped after `step` steps, with the ways flown; what is unknown is
/// left dark.
pub fn oblique_view(trace: &Trace, step: u32) -> RgbImage {
    let blocks = trace.mapped(step).map(|column| Block {
        cell: column.cell,
        bottom: 0.0,
        top: column.height.cells(),
    });
    let ways: Vec<_> = (0..trace.robots)
        .map(|robot| trace.way(robot, step))
        .collect();
    let highest = trace.terrain.highest().cells();
    oblique(trace.extent, highest, blocks.collect(), &ways)
}

/// What the robots took for occupied in a scene of voxels after `tick` steps, with the ways flown.
pub fn oblique_voxels(trace: &VoxelTrace, tick: u32) -> RgbImage {
    let occupied = trace.map(tick).into_iter().filter(|found| found.1);
    let blocks = occupied.map(|(voxel, _)| Block {
        cell: voxel.cell(),
        bottom: f32::from(voxel.z),
        top: f32::from(voxel.z) + 1.0,
    });
    let point = |voxel: &Voxel| Point::over(voxel.cell(), f32::from(voxel.z) + 0.5);
    let ways = trace.ways.iter();
    let ways: Vec<Vec<Point>> = ways
        .map(|way| way.iter().take(tick as usize + 1).map(point).collect())
        .collect();
    let highest = f32::from(trace.scene.levels());
    oblique(trace.scene.extent(), highest, blocks.collect(), &ways)
}

/// Something solid over one column of cells.
struct Block {
    cell: Cell,
    bottom: f32,
    top: f32,
}

/// Blocks and ways in a box whose blocks reach up to `highest`.
fn oblique(extent: Extent, highest: f32, mut blocks: Vec<Block>, ways: &[Vec<Point>]) -> RgbImage {
    let (width, height) = (f32::from(extent.width), f32::from(extent.height));
    let margin = 20.0;
    let top = highest + 8.0;
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
        block(&mut picture, solid, highest, view);
    }
    for (robot, way) in ways.iter().enumerate() {
        let colour = way_color(robot);
        for leg in way.windows(2) {
            let (from, to) = (view.project(leg[0]), view.project(leg[1]));
            line(&mut picture, from, to, &[(0.0, 0.0), (0.0, 1.0)], colour);
        }
        if let Some(last) = way.last() {
            disc(&mut picture, view.project(*last), 0.0..=4.0, colour);
        }
    }
    picture
}

/// One block: its top, and its two sides that face the viewer.
fn block(picture: &mut RgbImage, block: &Block, highest: f32, view: View) {
    let scale = view.scale;
    let colour = shade(block.top, highest);
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
