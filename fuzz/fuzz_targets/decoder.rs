//! Any bytes, also with matching check bytes, are an error or a frame that is
//! written in the same way again and keeps to its grid. Frames of every kind.
#![no_main]

use crc::{CRC_16_IBM_SDLC, Crc};
use libfuzzer_sys::fuzz_target;
use planner_core::tile::TILE;
use planner_core::radio::{Frame, GridId, MAX_LEN, SurfaceFrame, VoxelFrame};
use planner_core::{Cell, Extent};

const GRID: GridId = GridId(0xcafe);
const LEVELS: u8 = 24;

fuzz_target!(|input: &[u8]| {
    let &[width, height, mend, ref bytes @ ..] = input else {
        return;
    };
    let mut bytes = bytes.to_vec();
    let extent = Extent::new(1 + 2 * u16::from(width), 1 + 2 * u16::from(height));
    let kind = 1 + (mend >> 1) % 3;
    if mend & 1 == 1 && bytes.len() > 6 {
        bytes[..4].copy_from_slice(&[1, kind, 0xfe, 0xca]);
        let body = bytes.len() - 2;
        let check = Crc::<u16>::new(&CRC_16_IBM_SDLC).checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&check.to_le_bytes());
    }
    let mut buffer = [0xa5; MAX_LEN];
    let length = match kind {
        1 => cells(&bytes, extent, &mut buffer),
        2 => heights(&bytes, extent, &mut buffer),
        _ => voxels(&bytes, extent, &mut buffer),
    };
    if let Some(length) = length {
        assert_eq!(buffer[..length], bytes);
    }
});

/// No cell of the tile at this place lies beyond the edge.
fn assert_inside(cells: u64, extent: Extent, cell: impl Fn(u32) -> Cell) {
    for bit in 0..(TILE * TILE) as u32 {
        assert!(cells >> bit & 1 == 0 || extent.contains(cell(bit)));
    }
}

fn cells(bytes: &[u8], extent: Extent, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
    let frame = Frame::decode(bytes, None, GRID, extent).ok()?;
    assert!(extent.contains(frame.status.position));
    assert!(frame.status.goal.is_none_or(|goal| extent.contains(goal)));
    for record in &frame.tiles {
        assert_inside(record.tile.known() | record.tile.doubtful(), extent, |bit| record.at.cell(bit));
        assert_eq!(record.tile.obstacle() & record.tile.free(), 0);
    }
    Some(frame.encode(None, buffer))
}

fn heights(bytes: &[u8], extent: Extent, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
    let frame = SurfaceFrame::decode(bytes, None, GRID, extent).ok()?;
    assert!(extent.contains(frame.status.position.cell()));
    assert!(frame.status.goal.is_none_or(|goal| extent.contains(goal)));
    for record in &frame.records {
        let cells = u64::from(record.cells) << if record.south { 32 } else { 0 };
        assert_inside(cells, extent, |bit| record.tile.cell(bit));
        assert_eq!(record.cells.count_ones() as usize, record.heights.len());
    }
    Some(frame.encode(None, buffer))
}

fn voxels(bytes: &[u8], extent: Extent, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
    let frame = VoxelFrame::decode(bytes, None, GRID, extent, LEVELS).ok()?;
    for voxel in [Some(frame.status.position), frame.status.goal]
        .into_iter()
        .flatten()
    {
        assert!(extent.contains(voxel.cell()) && (0..LEVELS.into()).contains(&voxel.z));
    }
    for patch in &frame.patches {
        assert!(patch.z < LEVELS);
        assert!(!patch.is_empty());
        assert_inside(patch.known | patch.occupied, extent, |bit| patch.tile.cell(bit));
    }
    Some(frame.encode(None, buffer))
}
