//! What a robot has from others, and what speaks against them.

use super::cells::TileRecord;
use super::error::FrameError;
use crate::map::Map;
use crate::robot::RobotId;
use crate::sight::Sighting;
use crate::tile::TileIndex;

/// Counters of what was heard, since the robot was set up. They saturate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hearsay {
    /// Cells of the map that others told before the robot saw them itself: in frames, or
    /// as whole maps.
    pub cells: u32,
    /// Cells told otherwise than the robot saw them in its last look, within the tile
    /// that it looked from, and cells told as obstacles on which somebody has stood.
    /// Where sensors are right and all robots have the same origin and axes: none.
    pub contradictions: u16,
    /// Who told most of them, if somebody told more than half.
    pub contradicted_by: Option<RobotId>,
    /// Frames of another robot with this robot's id.
    pub same_id: u16,
    /// Frames refused for their check bytes: damaged, or not signed with the key.
    pub refused: u16,
}

impl Hearsay {
    pub(crate) const fn new() -> Self {
        Self {
            cells: 0,
            contradictions: 0,
            contradicted_by: None,
            same_id: 0,
            refused: 0,
        }
    }

    /// The map has learnt `cells` from others.
    pub(crate) fn told(&mut self, cells: u32) {
        self.cells = self.cells.saturating_add(cells);
    }

    /// A frame was refused.
    pub(crate) fn refuse(&mut self, error: FrameError) {
        match error {
            FrameError::SameId(_) => self.same_id = self.same_id.saturating_add(1),
            FrameError::Check => self.refused = self.refused.saturating_add(1),
            _ => {}
        }
    }
}

/// Holds what others tell against what the robot saw itself. 24 bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Witness {
    /// The tile that the robot looked from, and what it saw of it.
    at: TileIndex,
    /// How many more contradictions came from whom [`Hearsay::contradicted_by`] names
    /// than from all others.
    lead: u16,
    free: u64,
    blocked: u64,
}

impl Witness {
    pub(crate) const fn new() -> Self {
        Self {
            at: TileIndex { x: 0, y: 0 },
            lead: 0,
            free: 0,
            blocked: 0,
        }
    }

    /// The robot has looked from this tile, in which `robots` are no walls. Work: eight rows.
    pub(crate) fn look(&mut self, sighting: &Sighting, at: TileIndex, robots: u64) {
        let (free, blocked) = sighting.tile(at);
        (self.at, self.free, self.blocked) = (at, free, blocked & !robots);
    }

    /// Counts what `sender` tells otherwise. Call it before the record is joined.
    pub(crate) fn hear<const TW: usize, const TH: usize>(
        &mut self,
        hearsay: &mut Hearsay,
        sender: RobotId,
        record: &TileRecord,
        map: &Map<TW, TH>,
    ) {
        let TileRecord { at, tile } = *record;
        let mut wrong = tile.obstacle() & map.tile(at).visited();
        if at == self.at {
            wrong |= tile.obstacle() & self.free | tile.free() & self.blocked;
        }
        let wrong = wrong.count_ones() as u16;
        if wrong == 0 {
            return;
        }
        hearsay.contradictions = hearsay.contradictions.saturating_add(wrong);
        // The majority vote of Boyer and Moore: one name and one number are enough.
        if hearsay.contradicted_by == Some(sender) {
            self.lead = self.lead.saturating_add(wrong);
        } else if wrong > self.lead {
            hearsay.contradicted_by = Some(sender);
            self.lead = wrong - self.lead;
        } else {
            self.lead -= wrong;
        }
    }
}
