use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::radio::check::CHECK;
use crate::radio::envelope::CRC;

const GRID: GridId = GridId(0xcafe);
const EXTENT: Extent = Extent::new(100, 61);

/// A place in 1/128 of a cell.
fn point(coordinates: [u16; 3]) -> Point {
    let [x, y, z] = coordinates.map(|v| f32::from(v) / 128.0);
    Point::new(x, y, z)
}

fn quiet() -> SurfaceFrame {
    SurfaceFrame {
        grid: GRID,
        sender: RobotId(7),
        sequence: 0x0102,
        status: Status {
            position: point([0x0180, 0x1e40, 0x0540]),
            goal: None,
            activity: Activity::Stopped,
        },
        records: heapless::Vec::new(),
    }
}

fn full() -> SurfaceFrame {
    let record = |tile, south, fresh, cells: u32, first: u8| HeightRecord {
        tile,
        south,
        fresh,
        cells,
        heights: (first..)
            .take(cells.count_ones() as usize)
            .map(Height)
            .collect(),
    };
    SurfaceFrame {
        status: Status {
            goal: Some(Cell::new(99, 60)),
            activity: Activity::Exploring,
            ..quiet().status
        },
        records: heapless::Vec::from_slice(&[
            record(TileIndex { x: 2, y: 1 }, false, true, 0x8000_0003, 16),
            record(TileIndex { x: 12, y: 6 }, true, false, 0x0000_000f, 250),
        ])
        .unwrap(),
        ..quiet()
    }
}

#[rustfmt::skip]
const QUIET: [u8; 19] = [
    // version, kind, grid, sender, sequence, state
    0x02, 0x02, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x01,
    // position, goal
    0x80, 0x01, 0x40, 0x1e, 0x40, 0x05, 0x00, 0x00, 0x00,
    // CRC
    0x17, 0xbc,
];

#[rustfmt::skip]
const FULL: [u8; 38] = [
    0x02, 0x02, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x02,
    0x80, 0x01, 0x40, 0x1e, 0x40, 0x05, 0x63, 0xc0, 0x03,
    // fresh, tile 2, 1; columns 0, 1 and 31 of its northern half
    0x42, 0x01, 0x03, 0x00, 0x00, 0x80, 16, 17, 18,
    // tile 12, 6; columns 32 to 35, in its southern half
    0x8c, 0x06, 0x0f, 0x00, 0x00, 0x00, 250, 251, 252, 253,
    0x10, 0xa5,
];

fn decoded(bytes: &[u8]) -> Result<SurfaceFrame, FrameError> {
    SurfaceFrame::decode(bytes, None, GRID, EXTENT)
}

/// The frame in a buffer that is dirty, and must stay so behind the frame.
fn encoded(frame: &SurfaceFrame) -> Vec<u8> {
    let mut buffer = [0xa5; MAX_LEN];
    let length = frame.encode(None, &mut buffer);
    assert!(buffer[length..].iter().all(|&byte| byte == 0xa5));
    buffer[..length].to_vec()
}

/// Puts a byte in and makes the check bytes match again.
fn altered(at: usize, byte: u8) -> Vec<u8> {
    let mut bytes = FULL.to_vec();
    bytes[at] = byte;
    let check = CHECK.checksum(&bytes[..FULL.len() - CRC]);
    bytes[FULL.len() - CRC..].copy_from_slice(&check.to_le_bytes());
    bytes
}

#[test]
fn the_bytes_of_two_frames() {
    assert_eq!(encoded(&quiet()), QUIET);
    assert_eq!(encoded(&full()), FULL);
    assert_eq!(decoded(&QUIET), Ok(quiet()));
    assert_eq!(decoded(&FULL), Ok(full()));
}

#[test]
fn what_is_wrong_is_named() {
    let field = |field| Err(FrameError::Field(field));
    assert_eq!(decoded(&altered(0, 1)), Err(FrameError::Version(1)));
    assert_eq!(decoded(&altered(1, 1)), Err(FrameError::Kind(1)));
    assert_eq!(
        decoded(&altered(2, 0)),
        Err(FrameError::OtherGrid(GridId(0xca00)))
    );
    assert_eq!(decoded(&altered(7, 6)), field(Field::State));
    assert_eq!(decoded(&altered(11, 0x1f)), field(Field::Position));
    assert_eq!(decoded(&altered(14, 100)), field(Field::Goal));
    assert_eq!(
        decoded(&altered(7, 0)),
        field(Field::Goal),
        "a goal that is not there"
    );
    assert_eq!(
        decoded(&altered(17, 0x4d)),
        field(Field::Tile),
        "beyond the edge"
    );
    assert_eq!(
        decoded(&altered(18, 0x81)),
        field(Field::Tile),
        "an unused bit"
    );
    assert_eq!(
        decoded(&altered(19, 0x07)),
        field(Field::Tile),
        "a height too few"
    );
    let mut corrupted = FULL;
    corrupted[20] ^= 1;
    assert_eq!(decoded(&corrupted), Err(FrameError::Check));
    assert_eq!(decoded(&FULL[..12]), Err(FrameError::Length(12)));
}

/// Any frame that a robot can send.
fn frame() -> impl Strategy<Value = SurfaceFrame> {
    let record = (
        0u8..13,
        0u8..8,
        any::<bool>(),
        any::<bool>(),
        any::<u64>(),
        any::<[u8; 32]>(),
    );
    let goal = proptest::option::of((0i16..100, 0i16..61));
    let records = prop::collection::vec(record, 0..5);
    let position = (0u16..100 * 128, 0u16..61 * 128, any::<u16>());
    (
        any::<u8>(),
        any::<u16>(),
        position,
        goal,
        any::<bool>(),
        records,
    )
        .prop_map(|(sender, sequence, (x, y, z), goal, stopped, records)| {
            let mut frame = SurfaceFrame {
                grid: GRID,
                sender: RobotId(sender),
                sequence,
                status: Status {
                    position: point([x, y, z]),
                    goal: goal.map(|(x, y)| Cell::new(x, y)),
                    activity: Activity::stopped_if(stopped),
                },
                records: heapless::Vec::new(),
            };
            let mut taken = 0;
            for (x, y, south, fresh, cells, seed) in records {
                let tile = TileIndex { x, y };
                let patch = Patch {
                    tile,
                    cells: tile.inside(EXTENT),
                    heights: core::array::from_fn(|i| Height(seed[i % 32].wrapping_add(i as u8))),
                    fresh,
                };
                if let Some(record) = HeightRecord::of(&patch, south, cells, taken) {
                    taken += record.length();
                    frame.records.push(record).unwrap();
                }
            }
            frame
        })
}

proptest! {
    #[test]
    fn what_is_written_is_read(frame in frame()) {
        let bytes = encoded(&frame);
        prop_assert!(bytes.len() <= MAX_LEN);
        prop_assert_eq!(decoded(&bytes), Ok(frame));
    }

    /// Anything that is taken is in form: it would be written as it was read.
    #[test]
    fn hostile_bytes_are_refused_or_in_form(
        mut bytes in prop::collection::vec(any::<u8>(), 0..64),
        in_form in any::<bool>(),
        checked in any::<bool>(),
    ) {
        if in_form && bytes.len() >= 19 {
            bytes[..4].copy_from_slice(&QUIET[..4]);
            bytes[7] &= 3;
            for i in [9, 11] {
                bytes[i] %= 0x1f;
            }
        }
        if checked && bytes.len() > CRC {
            let body = bytes.len() - CRC;
            let check = CHECK.checksum(&bytes[..body]);
            bytes[body..].copy_from_slice(&check.to_le_bytes());
        }
        if let Ok(frame) = decoded(&bytes) {
            prop_assert_eq!(encoded(&frame), bytes);
        }
    }
}
