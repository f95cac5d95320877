//! What happens when nothing is left to fly to: what is closed is tried again, or the
//! robot stops and says why.

use super::VoxelSurvey;
use super::gain::voxels;
use crate::robot::{Action, Stop, Wait};
use crate::tile::{TileIndex, every_tile};
use crate::volume::{Content, Voxel};

/// How often closed voxels are tried again before they are taken to stay closed.
const ROUNDS: u8 = 3;

/// Steps of rest before the first of these; each time twice as many.
const REST: u8 = 8;

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// No step leads to `at` until a round begins.
    pub(super) fn close(&mut self, at: Voxel) {
        self.closed.set(at);
        self.is_closed = true;
        self.refused = at;
    }

    /// Nothing counts as closed any more.
    pub(super) fn open_all(&mut self) {
        self.closed.reset();
        self.is_closed = false;
    }

    pub(super) fn stop(&mut self, reason: Stop<Voxel>) -> Action<Voxel, Voxel> {
        self.way.clear();
        if !self.stopped {
            log!(
                info,
                "robot {}: stops at {}: {}",
                self.sender.id.0,
                self.position,
                reason
            );
        }
        self.stopped = true;
        self.reason = (reason, self.volume.age());
        Action::Stop(reason)
    }

    /// Nothing is left to fly to: what is closed is tried again, or the robot stops.
    pub(super) fn end_round(&mut self) -> Action<Voxel, Voxel> {
        if self.is_closed {
            let known = self.volume.known_voxels();
            if known != self.round_known {
                self.round_known = known;
                self.round = 0;
            }
            if self.round >= ROUNDS {
                return self.end(Stop::Blocked {
                    frontiers: self.volume.frontiers(),
                    at: self.refused,
                });
            }
            self.rest = REST << self.round;
            self.round = self.round.saturating_add(1);
            self.open_all();
            return self.wait(Wait::Closed);
        }
        let missed = if self.has_missed {
            self.missed_place()
        } else {
            None
        };
        let frontiers = self.volume.frontiers();
        self.end(match missed {
            Some(at) => self.unseen(at),
            // What could be seen from poses about it nobody knows.
            None if self.is_adrift => Stop::Blocked {
                frontiers,
                at: self.position,
            },
            None if frontiers == 0 => Stop::Complete,
            None if self.sender.hearsay.cells > 0 => Stop::Enclosed { frontiers },
            None => Stop::OutOfReach { frontiers },
        })
    }

    pub(super) fn unseen(&self, at: Voxel) -> Stop<Voxel> {
        Stop::Unseen {
            frontiers: self.volume.frontiers(),
            at,
        }
    }

    /// The first voxel that a look should have shown, and that is still unknown beside a free
    /// one: others are behind what has turned out to be occupied.
    ///
    /// Cost: 15 words for each tile of a level.
    fn missed_place(&self) -> Option<Voxel> {
        self.first_of(|tile, z| {
            let missed = self.missed.word(tile, z);
            match missed {
                0 => 0,
                _ => missed & self.volume.unknown_beside_free(tile, z),
            }
        })
    }

    /// An unknown voxel: beside the robot, or else the first beside a free one.
    ///
    /// Cost: 14 words for each tile of a level.
    pub(super) fn unknown_place(&self) -> Option<Voxel> {
        let is_unknown = |voxel: &Voxel| self.volume.content(*voxel) == Content::Unknown;
        let beside = self.position.beside();
        beside
            .into_iter()
            .find(is_unknown)
            .or_else(|| self.first_of(|tile, z| self.volume.unknown_beside_free(tile, z)))
    }

    fn first_of(&self, word: impl Fn(TileIndex, u8) -> u64) -> Option<Voxel> {
        let mut tiles =
            (0..self.volume.levels()).flat_map(|z| every_tile(TW, TH).map(move |tile| (tile, z)));
        tiles.find_map(|(tile, z)| voxels(tile, z, word(tile, z)).next())
    }
}
