//! What can go wrong between processes, said so that the reader can mend it.

use std::io;
use std::net::SocketAddr;

use thiserror::Error;

use super::line::LineError;

/// A world that cannot be served, or a robot that cannot take part.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum LiveError {
    #[error(
        "cannot serve a world on {address}: {problem}; if another world is served there, give \
         another address with --listen (port 0 takes a free one)"
    )]
    Serve {
        address: SocketAddr,
        problem: io::Error,
    },
    #[error(
        "cannot hear frames on {address}: {problem}; if another robot does, give another \
         address with --listen"
    )]
    Frames {
        address: SocketAddr,
        problem: io::Error,
    },
    #[error(
        "no world answers at {address}: {problem}; start one with `host-sim world MAP --listen \
         {address}`, or say with --world where it is"
    )]
    NoWorld {
        address: SocketAddr,
        problem: io::Error,
    },
    #[error(
        "the world at {address} {problem}; see what `host-sim world` printed there, and start \
         it and its robots again"
    )]
    World {
        address: SocketAddr,
        problem: LineError,
    },
    #[error("the world at {address} does not take this robot: {reason}")]
    Refused { address: SocketAddr, reason: String },
    #[error(
        "the world at {address} has a place for the robot that no planner takes: {reason}; is \
         it a `host-sim world` of this version?"
    )]
    Place { address: SocketAddr, reason: String },
}
