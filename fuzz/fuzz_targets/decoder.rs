//! Any bytes, also with matching check bytes, are an error or a frame that is
//! written in the same way again and keeps to its grid.
#![no_main]

use crc::{CRC_16_IBM_SDLC, Crc};
use libfuzzer_sys::fuzz_target;
use planner_core::Extent;
use planner_core::map::TILE;
use planner_core::radio::{Frame, GridId, MAX_LEN};

fuzz_target!(|input: &[u8]| {
    let &[width, height, mend, ref bytes @ ..] = input else {
        return;
    };
    let mut bytes = bytes.to_vec();
    let extent = Extent::new(1 + 2 * u16::from(width), 1 + 2 * u16::from(height));
    let grid = GridId(0xcafe);
    if mend & 1 == 1 && bytes.len() > 6 {
        bytes[..4].copy_from_slice(&[1, 1, 0xfe, 0xca]);
        let body = bytes.len() - 2;
        let check = Crc::<u16>::new(&CRC_16_IBM_SDLC).checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&check.to_le_bytes());
    }
    let Ok(frame) = Frame::decode(&bytes, None, grid, extent) else {
        return;
    };
    assert!(extent.contains(frame.status.position));
    assert!(frame.status.goal.is_none_or(|goal| extent.contains(goal)));
    for record in &frame.tiles {
        for bit in 0..(TILE * TILE) as u32 {
            let inside = extent.contains(record.at.cell(bit));
            assert!(inside || record.tile.known >> bit & 1 == 0);
        }
        assert_eq!(record.tile.obstacle & !record.tile.known, 0);
        assert_eq!(record.tile.visited & !record.tile.free(), 0);
    }
    let mut buffer = [0xa5; MAX_LEN];
    let length = frame.encode(None, &mut buffer);
    assert_eq!(buffer[..length], bytes);
});
