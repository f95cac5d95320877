//! What robots tell each other, in frames of at most [`MAX_LEN`] bytes.
//!
//! A frame stands alone: it may be lost, repeated, late, reordered, cut short,
//! corrupted or forged. Its tiles join into the map, so any order and any
//! repetition of the same frames gives the same map; what it says of the sender is
//! a hint with a sequence number. `docs/wire-format.md` has the byte tables.

mod envelope;
mod frame;
mod hearsay;
mod link;
mod outbox;
mod sent;
mod surface_frame;
mod voxel_frame;

pub use frame::{Field, Frame, FrameError, MAX_LEN, MAX_TILES, TileRecord};
pub use hearsay::Hearsay;
pub use link::{GridId, Heard, Key, Link, LinkConfig};
pub(crate) use sent::Sent;
pub use surface_frame::{HeightRecord, SurfaceFrame};
pub(crate) use voxel_frame::MAX_PATCHES;
pub use voxel_frame::VoxelFrame;

#[cfg(test)]
mod tests;
