//! What is known of a cell: a byte, with these bits.

/// A frontier cell that is spoken for.
pub(super) const TAKEN: u8 = 1 << 6;
/// A wave has reached the cell. Then it has the label in bits 0 to 3 and the direction
/// back in bits 4 and 5; otherwise the bits below.
pub(super) const REACHED: u8 = 1 << 7;
pub(super) const BACK: u32 = 4;
pub(super) const LABEL: u8 = 0xf;

/// The map was read. Without this bit and [`REACHED`], nothing is known.
pub(super) const READ: u8 = 1 << 4;
/// Waves of others may enter; one bit higher: the robot's own may.
pub(super) const FREE: u8 = 1;
/// A goal of others; one bit higher: one of the robot's own.
pub(super) const GOAL: u8 = 1 << 2;
