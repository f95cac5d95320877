//! The planners that the project's own are measured against. They search the
//! whole known map whenever they decide and keep it on the heap, which no
//! microcontroller would; otherwise they are robots like any other: they see
//! sightings and know of others only what they hear.

mod bmilrv;
mod closest;
mod greedy;
mod groups;
mod minpos;
mod peer;
pub mod surveys;
mod utility;
pub mod voxels;
mod waves;

pub use bmilrv::{Bmilrv, Marks};
pub use closest::Closest;
pub use greedy::Greedy;
pub use minpos::{MinPos, PaperMinPos, StrongMinPos};
pub use peer::{Peer, Rule, Term};
pub use utility::Utility;
pub use waves::{Spot, Waves};
