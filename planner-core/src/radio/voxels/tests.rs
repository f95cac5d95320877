use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::radio::check::CHECK;
use crate::radio::envelope::CRC;

const GRID: GridId = GridId(0xcafe);
const EXTENT: Extent = Extent::new(100, 61);
const LEVELS: u8 = 18;

fn quiet() -> VoxelFrame {
    VoxelFrame {
        grid: GRID,
        sender: RobotId(7),
        sequence: 0x0102,
        status: Status {
            position: Voxel::new(3, 60, 17),
            goal: None,
            activity: Activity::Stopped,
        },
        patches: heapless::Vec::new(),
    }
}

fn full() -> VoxelFrame {
    let patch = |x, y, z, known, occupied| VoxelPatch {
        tile: TileIndex { x, y },
        z,
        known,
        occupied,
    };
    VoxelFrame {
        status: Status {
            position: Voxel::new(3, 60, 17),
            goal: Some(Voxel::new(99, 17, 4)),
            activity: Activity::Exploring,
        },
        patches: heapless::Vec::from_slice(&[
            patch(2, 1, 5, !0, 0),
            patch(12, 6, 0, 0x0f0f, 0x0102),
            patch(0, 3, 17, 1 << 63, 0),
        ])
        .unwrap(),
        ..quiet()
    }
}

#[rustfmt::skip]
const QUIET: [u8; 18] = [
    // version, kind, grid, sender, sequence, state
    0x02, 0x03, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x01,
    // position, goal
    0x03, 0xc0, 0x03, 17, 0x00, 0x00, 0x00, 0,
    // CRC
    0x22, 0x87,
];

#[rustfmt::skip]
const FULL: [u8; 51] = [
    0x02, 0x03, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x02,
    0x03, 0xc0, 0x03, 17, 0x63, 0x10, 0x01, 4,
    // tile 2, 1 of level 5: known as a whole, without obstacles
    0x42, 0x01, 5,
    // tile 12, 6 of level 0: what is known, what is occupied
    0x8c, 0x06, 0, 0x0f, 0x0f, 0, 0, 0, 0, 0, 0, 0x02, 0x01, 0, 0, 0, 0, 0, 0,
    // tile 0, 3 of level 17: one free voxel
    0x00, 0x03, 17, 0, 0, 0, 0, 0, 0, 0, 0x80,
    0x53, 0xdd,
];

/// A voxel free again, one occupied and one free: kind 4.
fn withdrawn() -> VoxelFrame {
    let mut frame = quiet();
    let _ = frame.patches.push(VoxelPatch {
        tile: TileIndex { x: 0, y: 3 },
        z: 17,
        known: 0b110,
        occupied: 0b011,
    });
    frame
}

#[rustfmt::skip]
const WITHDRAWN: [u8; 37] = [
    0x02, 0x04, 0xfe, 0xca, 0x07, 0x02, 0x01, 0x01,
    0x03, 0xc0, 0x03, 17, 0x00, 0x00, 0x00, 0,
    // tile 0, 3 of level 17: what is known, what is occupied or free again
    0x80, 0x03, 17, 0x06, 0, 0, 0, 0, 0, 0, 0, 0x03, 0, 0, 0, 0, 0, 0, 0,
    0x17, 0x33,
];

fn decoded(bytes: &[u8]) -> Result<VoxelFrame, FrameError> {
    VoxelFrame::decode(bytes, None, GRID, EXTENT, LEVELS)
}

/// The frame in a buffer that is dirty, and must stay so behind the frame.
fn encoded(frame: &VoxelFrame) -> Vec<u8> {
    let mut buffer = [0xa5; MAX_LEN];
    let length = frame.encode(None, &mut buffer);
    assert!(buffer[length..].iter().all(|&byte| byte == 0xa5));
    buffer[..length].to_vec()
}

/// Makes the check bytes match again.
fn checked(mut bytes: Vec<u8>) -> Vec<u8> {
    let body = bytes.len() - CRC;
    let check = CHECK.checksum(&bytes[..body]);
    bytes[body..].copy_from_slice(&check.to_le_bytes());
    bytes
}

/// The full frame with another byte.
fn altered(at: usize, byte: u8) -> Vec<u8> {
    let mut bytes = FULL.to_vec();
    bytes[at] = byte;
    checked(bytes)
}

#[test]
fn the_bytes_of_three_frames() {
    assert_eq!(encoded(&withdrawn()), WITHDRAWN);
    assert_eq!(decoded(&WITHDRAWN), Ok(withdrawn()));
    assert_eq!(encoded(&quiet()), QUIET);
    assert_eq!(encoded(&full()), FULL);
    assert_eq!(decoded(&QUIET), Ok(quiet()));
    assert_eq!(decoded(&FULL), Ok(full()));
}

#[test]
fn what_is_wrong_is_named() {
    let field = |field| Err(FrameError::Field(field));
    assert_eq!(decoded(&altered(0, 1)), Err(FrameError::Version(1)));
    assert_eq!(decoded(&altered(1, 2)), Err(FrameError::Kind(2)));
    let other = GridId(0xca00);
    assert_eq!(decoded(&altered(2, 0)), Err(FrameError::OtherGrid(other)));
    assert_eq!(decoded(&altered(7, 6)), field(Field::State));
    assert_eq!(decoded(&altered(8, 100)), field(Field::Position));
    assert_eq!(decoded(&altered(11, 18)), field(Field::Position));
    assert_eq!(decoded(&altered(12, 100)), field(Field::Goal));
    assert_eq!(decoded(&altered(15, 18)), field(Field::Goal));
    let goal_that_is_not_there = altered(7, 0);
    assert_eq!(decoded(&goal_that_is_not_there), field(Field::Goal));
    let mut only_a_height = QUIET.to_vec();
    only_a_height[15] = 1;
    assert_eq!(decoded(&checked(only_a_height)), field(Field::Goal));
    let beyond_the_edge = altered(16, 0x4d);
    assert_eq!(decoded(&beyond_the_edge), field(Field::Tile));
    assert!(decoded(&altered(16, 0x4b)).is_ok());
    let whole_over_the_edge = altered(16, 0x4c);
    assert_eq!(decoded(&whole_over_the_edge), field(Field::Tile));
    let unused_bit = altered(17, 0x81);
    assert_eq!(decoded(&unused_bit), field(Field::Tile));
    let level_beyond = altered(18, 18);
    assert_eq!(decoded(&level_beyond), field(Field::Tile));
    let mut none_withdrawn = WITHDRAWN;
    none_withdrawn[19] = 7;
    assert_eq!(
        decoded(&checked(none_withdrawn.to_vec())),
        field(Field::Tile)
    );
    let occupied_unknown = altered(30, 0x12);
    assert_eq!(decoded(&occupied_unknown), field(Field::Tile));
    let nothing_known = altered(48, 0);
    assert_eq!(decoded(&nothing_known), field(Field::Tile));
    let mut corrupted = FULL;
    corrupted[20] ^= 1;
    assert_eq!(decoded(&corrupted), Err(FrameError::Check));
    for length in 0..FULL.len() {
        assert!(decoded(&FULL[..length]).is_err(), "cut to {length} bytes");
    }
    assert_eq!(decoded(&FULL[..12]), Err(FrameError::Length(12)));
}

/// A mask that says nothing, or that its absence would say, is no encoding.
#[test]
fn each_piece_has_one_encoding() {
    let with = |patch: &[u8]| {
        let mut bytes = QUIET[..QUIET.len() - CRC].to_vec();
        bytes.extend(patch);
        bytes.extend([0; CRC]);
        decoded(&checked(bytes))
    };
    let wrong = Err(FrameError::Field(Field::Tile));
    assert_eq!(with(&[[2, 1, 5].as_slice(), &[0xff; 8]].concat()), wrong);
    assert_eq!(with(&[[0xc2, 1, 5].as_slice(), &[0; 8]].concat()), wrong);
    assert_eq!(with(&[2, 1, 5]), wrong);
    assert!(with(&[0x42, 1, 5]).is_ok());
}

#[test]
fn boxes_of_other_heights_are_other_grids() {
    let grid = |levels| GridId::of_box(EXTENT, levels, (0, 0), 100);
    assert_ne!(grid(17), grid(18));
    assert_ne!(grid(18), GridId::of(EXTENT, (0, 0), 100));
}

/// Any frame that a robot can send.
fn frame() -> impl Strategy<Value = VoxelFrame> {
    let voxel =
        || (0i16..100, 0i16..61, 0..i16::from(LEVELS)).prop_map(|(x, y, z)| Voxel::new(x, y, z));
    let mask = || prop_oneof![Just(0), Just(!0), any::<u64>()];
    let patch = (0u8..13, 0u8..8, 0..LEVELS, mask(), mask());
    (
        any::<u8>(),
        any::<u16>(),
        voxel(),
        proptest::option::of(voxel()),
        any::<[bool; 2]>(),
        prop::collection::vec(patch, 0..12),
    )
        .prop_map(|(sender, sequence, position, goal, flags, patches)| {
            let [stopped, withdraws] = flags;
            let mut frame = VoxelFrame {
                grid: GRID,
                sender: RobotId(sender),
                sequence,
                status: Status {
                    position,
                    goal,
                    activity: Activity::stopped_if(stopped),
                },
                patches: heapless::Vec::new(),
            };
            for (x, y, z, known, occupied) in patches {
                let tile = TileIndex { x, y };
                let inside = tile.inside(EXTENT);
                let patch = VoxelPatch {
                    tile,
                    z,
                    known: known & inside,
                    occupied: occupied & inside & if withdraws { !0 } else { known },
                };
                if !patch.is_empty() {
                    frame.add(patch);
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
        is_checked in any::<bool>(),
    ) {
        if in_form && bytes.len() >= QUIET.len() {
            let kind = bytes[1];
            bytes[..4].copy_from_slice(&QUIET[..4]);
            bytes[1] = 3 + (kind & 1);
            bytes[7] &= 1;
            bytes[8..16].copy_from_slice(&QUIET[8..16]);
        }
        if is_checked && bytes.len() > CRC {
            bytes = checked(bytes);
        }
        if let Ok(frame) = decoded(&bytes) {
            prop_assert_eq!(encoded(&frame), bytes);
        }
    }
}

#[cfg(feature = "keyed")]
mod keyed {
    use super::*;

    /// The longest frame too fits when it is signed; nobody takes what others signed.
    #[test]
    fn signed_frames_are_for_those_who_hold_the_key() {
        let mut frame = full();
        frame.patches.pop();
        for z in 0..2 {
            let tile = TileIndex { x: 1, y: 1 };
            frame
                .patches
                .push(VoxelPatch {
                    tile,
                    z,
                    known: 1,
                    occupied: 0,
                })
                .unwrap();
        }
        frame.patches.remove(1);
        let (key, other) = (Key([1; 16]), Key([2; 16]));
        let mut buffer = [0xa5; MAX_LEN];
        let length = frame.encode(Some(&key), &mut buffer);
        let bytes = &buffer[..length];
        let read = |key| VoxelFrame::decode(bytes, key, GRID, EXTENT, LEVELS);
        assert_eq!(read(Some(&key)), Ok(frame));
        assert_eq!(read(Some(&other)), Err(FrameError::Check));
        assert!(read(None).is_err());
    }
}
