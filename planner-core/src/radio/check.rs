//! The check sum of frames, and of what names a grid.

use crc::{CRC_16_IBM_SDLC, Crc, Table};

use crate::cell::Extent;

/// With a table of 512 bytes: every frame in earshot is checked, byte by byte.
pub(super) static CHECK: Crc<u16, Table<1>> = Crc::<u16, Table<1>>::new(&CRC_16_IBM_SDLC);

/// Names a grid: robots whose maps differ in origin, resolution or size do not
/// understand each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridId(pub u16);

impl GridId {
    /// A short hash (CRC-16/X-25) of the grid: its size in cells, where cell
    /// `(0, 0)` lies in the common frame, and the side of a cell, in millimetres.
    pub fn of(extent: Extent, origin_mm: (i32, i32), cell_mm: u16) -> Self {
        let mut digest = CHECK.digest();
        digest.update(&extent.width.to_le_bytes());
        digest.update(&extent.height.to_le_bytes());
        digest.update(&origin_mm.0.to_le_bytes());
        digest.update(&origin_mm.1.to_le_bytes());
        digest.update(&cell_mm.to_le_bytes());
        Self(digest.finalize())
    }

    /// The same of a box with `levels` levels over the grid.
    pub fn of_box(extent: Extent, levels: u8, origin_mm: (i32, i32), cell_mm: u16) -> Self {
        let [a, b] = Self::of(extent, origin_mm, cell_mm).0.to_le_bytes();
        Self(CHECK.checksum(&[a, b, levels]))
    }
}
