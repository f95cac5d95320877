use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Cell;
use crate::radio::check::CHECK;
use crate::radio::envelope::CRC;

const GRID: GridId = GridId(0xcafe);
const EXTENT: Extent = Extent::new(512, 511);

fn quiet() -> Frame {
    Frame {
        grid: GRID,
        sender: RobotId(7),
        sequence: 0x0102,
        status: Status {
            position: Cell::new(300, 17),
            goal: None,
            activity: Activity::Stopped,
        },
        tiles: heapless::Vec::new(),
    }
}

fn full() -> Frame {
    let mixed = TileRecord {
        at: TileIndex::new(2, 1),
        tile: Tile::seen(1, 4 | 1 << 63).with(2, Level::Visited),
    };
    let free = TileRecord {
        at: TileIndex::new(0, 3),
        tile: Tile::seen(u64::MAX, 0),
    };
    Frame {
        status: Status {
            position: Cell::new(20, 9),
            goal: Some(Cell::new(511, 510)),
            activity: Activity::Exploring,
        },
        tiles: heapless::Vec::from_slice(&[mixed, free]).unwrap(),
        ..quiet()
    }
}

#[rustfmt::skip]
const QUIET: [u8; 16] = [
    // version, kind, grid, sender, sequence, state
    0x02, 0x01, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x02,
    // position, goal
    0x2c, 0x11, 0x01, 0x00, 0x00, 0x00,
    // CRC
    0x4c, 0x2d,
];

#[rustfmt::skip]
const FULL: [u8; 52] = [
    0x02, 0x01, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x04,
    0x14, 0x90, 0x00, 0xff, 0xe1, 0x1f,
    // free, visited, obstacle, unknown … obstacle
    0x02, 0x01, 0x39, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xc0,
    // free throughout
    0x00, 0x03, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55,
    0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55,
    0x3b, 0xc4,
];

fn decoded(bytes: &[u8]) -> Result<Frame, FrameError> {
    Frame::decode(bytes, None, GRID, EXTENT)
}

/// The frame in a buffer that is dirty, and must stay so behind the frame.
fn encoded(frame: &Frame, key: Option<&Key>) -> Vec<u8> {
    let mut buffer = [0xa5; MAX_LEN];
    let length = frame.encode(key, &mut buffer);
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

/// Some tile as a frame carries it: layers that agree with each other.
fn record(extent: Extent) -> impl Strategy<Value = TileRecord> {
    let columns = extent.width.div_ceil(8) as u8;
    let rows = extent.height.div_ceil(8) as u8;
    (0..columns, 0..rows, any::<[u64; 3]>(), 0..3usize).prop_map(move |(x, y, planes, form)| {
        let at = TileIndex::new(x, y);
        let tile = Tile::from_planes(planes).only(at.inside(extent));
        TileRecord {
            at,
            tile: parts(tile)[form],
        }
    })
}

fn cell(extent: Extent) -> impl Strategy<Value = Cell> {
    (0..extent.width as i16, 0..extent.height as i16).prop_map(|(x, y)| Cell::new(x, y))
}

/// Any frame that a robot can send about a grid.
fn frame(extent: Extent) -> impl Strategy<Value = Frame> {
    let activity = prop_oneof![
        Just(Activity::Exploring),
        Just(Activity::SecondChance),
        Just(Activity::Stopped),
    ];
    (
        any::<(u16, u8, u16)>(),
        cell(extent),
        proptest::option::of(cell(extent)),
        activity,
        proptest::collection::vec(record(extent), 0..=MAX_TILES),
    )
        .prop_map(
            |((grid, sender, sequence), position, goal, activity, tiles)| Frame {
                grid: GridId(grid),
                sender: RobotId(sender),
                sequence,
                status: Status {
                    position,
                    goal,
                    activity,
                },
                tiles: tiles.into_iter().collect(),
            },
        )
}

fn any_frame() -> impl Strategy<Value = (Extent, Frame)> {
    (1u16..=512, 1u16..=512)
        .prop_map(|(width, height)| Extent::new(width, height))
        .prop_flat_map(|extent| (Just(extent), frame(extent)))
}

#[test]
fn the_bytes_are_as_documented_in_both_directions() {
    assert_eq!(encoded(&quiet(), None), QUIET);
    assert_eq!(encoded(&full(), None), FULL);
    assert_eq!(decoded(&QUIET), Ok(quiet()));
    assert_eq!(decoded(&FULL), Ok(full()));
}

#[test]
fn each_field_is_looked_at() {
    let field = |field| Err(FrameError::Field(field));
    assert_eq!(decoded(&altered(0, 1)), Err(FrameError::Version(1)));
    assert_eq!(decoded(&altered(1, 3)), Err(FrameError::Kind(3)));
    let other = GridId(0xcaff);
    assert_eq!(
        decoded(&altered(2, 0xff)),
        Err(FrameError::OtherGrid(other))
    );
    assert_eq!(decoded(&altered(7, 7)), field(Field::State));
    assert_eq!(decoded(&altered(7, 8)), field(Field::State));
    assert_eq!(decoded(&altered(9, 0x02)), field(Field::Position));
    assert_eq!(decoded(&altered(13, 0x20)), field(Field::Goal));
    // A goal where there is none.
    assert_eq!(decoded(&altered(7, 0)), field(Field::Goal));
    // A tile outside of the grid, and one of which row 7 is.
    assert_eq!(decoded(&altered(14, 192)), field(Field::Tile));
    assert_eq!(decoded(&altered(15, 63)), field(Field::Tile));
    let mut bytes = FULL;
    bytes[20] ^= 1;
    assert_eq!(decoded(&bytes), Err(FrameError::Check));
    for error in [
        FrameError::Length(3),
        FrameError::Version(9),
        FrameError::Kind(9),
        FrameError::Check,
        FrameError::OtherGrid(other),
        FrameError::Own,
        FrameError::Field(Field::Tile),
    ] {
        assert!(std::format!("{error}").contains("frame"));
    }
}

/// Each of the three forms of a record, and what none of them says.
#[test]
fn rare_levels_have_forms_of_their_own() {
    let levels = Level::ALL.into_iter().zip(0..);
    let tile = levels.fold(Tile::UNKNOWN, |tile, (level, bit)| {
        tile.with(1 << bit, level)
    });
    let written = |form: usize| {
        let tiles = [TileRecord {
            at: TileIndex::new(2, 1),
            tile: parts(tile)[form],
        }];
        let frame = Frame {
            tiles: heapless::Vec::from_slice(&tiles).unwrap(),
            ..quiet()
        };
        encoded(&frame, None)[14..18].to_vec()
    };
    // Cells 0 to 3 in the first byte, 4 to 7 in the second, the first in the lowest bits.
    assert_eq!(written(0), [0x02, 1, 0b10_01_00_00, 0b10_11_10_11]);
    assert_eq!(written(1), [0x42, 1, 0b00_00_01_00, 0b10_11_10_00]);
    assert_eq!(written(2), [0x82, 1, 0, 0b01_00_00_00]);
    let whole = parts(tile).into_iter().fold(Tile::UNKNOWN, Tile::joined);
    assert_eq!(whole, tile);

    let field = Err(FrameError::Field(Field::Tile));
    // No fourth form; a form other than the first says something; the last has one code.
    assert_eq!(decoded(&altered(14, 0xc2)), field);
    let with = |form: u8, codes: [u8; 2]| {
        let mut bytes = altered(14, form << 6 | 2);
        bytes[16..32].fill(0);
        bytes[16..18].copy_from_slice(&codes);
        let body = bytes.len() - CRC;
        let check = CHECK.checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&check.to_le_bytes());
        decoded(&bytes)
    };
    assert!(with(0, [0, 0]).is_ok());
    for (form, codes) in [(1, [0, 0]), (2, [0, 0]), (2, [2, 0]), (2, [1, 3])] {
        assert_eq!(with(form, codes), field);
    }
    assert!(with(1, [1, 0]).is_ok() && with(2, [1, 0]).is_ok());
}

#[test]
fn no_beginning_of_a_frame_is_one_and_nothing_may_follow() {
    for frame in [&QUIET[..], &FULL] {
        for length in 0..frame.len() {
            assert!(decoded(&frame[..length]).is_err(), "{length} bytes");
        }
        let mut longer = frame.to_vec();
        for _ in 0..2 * RECORD {
            longer.push(0);
            assert!(decoded(&longer).is_err(), "{} bytes", longer.len());
        }
    }
    assert_eq!(decoded(&[]), Err(FrameError::Length(0)));
    assert_eq!(decoded(&[1; 70]), Err(FrameError::Length(70)));
}

#[test]
fn a_wrong_bit_is_always_noticed() {
    for bit in 0..8 * FULL.len() {
        let mut bytes = FULL;
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(decoded(&bytes).is_err(), "bit {bit}");
    }
}

proptest! {
    #[test]
    fn decoding_undoes_encoding((extent, frame) in any_frame()) {
        let bytes = encoded(&frame, None);
        prop_assert_eq!(bytes.len(), HEADER + STATUS + RECORD * frame.tiles.len() + CRC);
        prop_assert!(bytes.len() <= MAX_LEN);
        prop_assert_eq!(Frame::decode(&bytes, None, frame.grid, extent), Ok(frame));
    }

    /// CRC-16/X-25 notices up to three wrong bits in a frame, and any burst of 16.
    #[test]
    fn few_wrong_bits_are_always_noticed(
        (extent, frame) in any_frame(),
        bits in proptest::collection::btree_set(0..8 * MAX_LEN, 1..=3),
    ) {
        let mut bytes = encoded(&frame, None);
        let count = 8 * bytes.len();
        let bits: std::collections::BTreeSet<_> = bits.into_iter().map(|bit| bit % count).collect();
        for bit in bits {
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        prop_assert!(Frame::decode(&bytes, None, frame.grid, extent).is_err());
    }

    /// Whatever decodes is what encoding would have written.
    #[test]
    fn a_frame_is_written_in_one_way_only(at in 0..FULL.len() - CRC, byte in any::<u8>()) {
        let bytes = altered(at, byte);
        if let Ok(frame) = decoded(&bytes) {
            prop_assert_eq!(encoded(&frame, None), bytes);
        }
    }

    #[test]
    fn any_bytes_are_a_frame_or_an_error(bytes in proptest::collection::vec(any::<u8>(), 0..80)) {
        let _ = decoded(&bytes);
    }
}

#[cfg(feature = "keyed")]
mod keyed {
    use super::*;

    const KEY: Key = Key([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);

    #[test]
    fn the_tag_takes_the_place_of_the_check() {
        let bytes = encoded(&quiet(), Some(&KEY));
        assert_eq!(bytes[..14], QUIET[..14]);
        // SipHash-2-4 of the 14 bytes, its first 32 bits.
        assert_eq!(bytes[14..], [108, 157, 77, 173]);
        assert_eq!(Frame::decode(&bytes, Some(&KEY), GRID, EXTENT), Ok(quiet()));
    }

    #[test]
    fn without_the_key_nothing_passes() {
        let signed = encoded(&full(), Some(&KEY));
        assert_eq!(signed.len(), 54);
        let other = Key([7; 16]);
        let check = Err(FrameError::Check);
        assert_eq!(Frame::decode(&signed, Some(&other), GRID, EXTENT), check);
        assert!(Frame::decode(&signed, None, GRID, EXTENT).is_err());
        assert!(Frame::decode(&FULL, Some(&KEY), GRID, EXTENT).is_err());
        assert_eq!(std::format!("{KEY:?}"), "Key(…)");
    }

    proptest! {
        #[test]
        fn decoding_undoes_encoding((extent, frame) in any_frame(), secret in any::<[u8; 16]>()) {
            let key = Key(secret);
            let bytes = encoded(&frame, Some(&key));
            prop_assert!(bytes.len() <= MAX_LEN);
            prop_assert_eq!(Frame::decode(&bytes, Some(&key), frame.grid, extent), Ok(frame));
        }

        #[test]
        fn a_wrong_bit_is_noticed(bit in 0..8 * 54usize) {
            let mut bytes = encoded(&full(), Some(&KEY));
            bytes[bit / 8] ^= 1 << (bit % 8);
            prop_assert!(Frame::decode(&bytes, Some(&KEY), GRID, EXTENT).is_err());
        }
    }
}
