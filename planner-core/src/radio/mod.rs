//! What robots tell each other, in frames of at most [`MAX_LEN`] bytes.
//!
//! A frame stands alone: it may be lost, repeated, late, reordered, cut short,
//! corrupted or forged. Its tiles join into the map, so any order and any
//! repetition of the same frames gives the same map; what it says of the sender is
//! a hint with a sequence number. `docs/wire-format.md` has the byte tables.

mod cells;
mod check;
mod envelope;
mod error;
mod hearsay;
#[cfg(feature = "survey")]
mod heights;
mod key;
mod link;
mod outbox;
mod roster;
mod sender;
#[cfg(feature = "survey")]
mod voxels;

pub use cells::{Frame, MAX_TILES, TileRecord};
pub use check::GridId;
pub use envelope::MAX_LEN;
pub use error::{Field, FrameError};
pub use hearsay::Hearsay;
#[cfg(feature = "survey")]
pub use heights::{HeightRecord, SurfaceFrame};
pub use key::Key;
pub use link::{Heard, Link};
pub(crate) use roster::Roster;
pub use roster::{MAX_PEERS, PEER_MEMORY, Peer};
pub use sender::LinkConfig;
pub(crate) use sender::Sender;
#[cfg(feature = "survey")]
pub(crate) use voxels::MAX_PATCHES;
#[cfg(feature = "survey")]
pub use voxels::VoxelFrame;

#[cfg(test)]
mod tests;
