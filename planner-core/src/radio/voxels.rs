//! The frame of a map of voxels: kind 3 of the wire format, and kind 4 if some are free again.

use heapless::Vec;

use super::check::GridId;
use super::envelope::{
    HEADER, Header, MAX_LEN, Sealed, TAG, Writer, optional_cell, packed, unpacked,
};
use super::error::{Field, FrameError};
use super::key::Key;
use crate::cell::Extent;
use crate::robot::{Activity, RobotId, Status};
use crate::tile::MOST_TILES;
use crate::tile::TileIndex;
use crate::volume::{Voxel, VoxelPatch};

/// The kind of frame that carries tiles of levels of voxels.
const VOXELS: u8 = 3;
/// The same in which some are occupied without known: free again.
const WITHDRAWN: u8 = 4;
/// Bytes between the header and the records.
const STATUS: usize = 9;
/// Bytes of a record before its masks.
const RECORD: usize = 3;
/// Bytes of a mask: a bit a voxel.
const MASK: usize = 8;
const _: () = assert!(
    MOST_TILES <= 1 << 6,
    "a column of tiles is written with 6 bits"
);
/// Bytes for records: the same with and without a key.
const ROOM: usize = MAX_LEN - HEADER - STATUS - TAG;

/// Most records in one frame: of a tile without obstacles that is known as a whole
/// no mask is sent.
pub(crate) const MAX_PATCHES: usize = ROOM / RECORD;

/// One frame: who is where, going where, and some tiles of levels of its map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VoxelFrame {
    /// The box that voxels and tiles refer to: [`GridId::of_box`].
    pub grid: GridId,
    /// Who sends.
    pub sender: RobotId,
    /// Counts the sender's frames, and wraps around.
    pub sequence: u16,
    /// What the sender says of itself.
    pub status: Status<Voxel>,
    /// Pieces of its map, each with a known voxel at least; together at most 35 bytes.
    pub patches: Vec<VoxelPatch, MAX_PATCHES>,
}

/// The length of `patch` on the wire in bytes, 3 to 19.
fn length(patch: &VoxelPatch) -> usize {
    let masks = usize::from(patch.known != !0) + usize::from(patch.occupied != 0);
    RECORD + MASK * masks
}

impl VoxelFrame {
    /// Whether it has a piece of that tile of that level.
    pub(crate) fn has(&self, tile: TileIndex, z: u8) -> bool {
        self.patches
            .iter()
            .any(|patch| (patch.tile, patch.z) == (tile, z))
    }

    /// Adds `patch`, or says that there is no room for it.
    pub(crate) fn add(&mut self, patch: VoxelPatch) -> bool {
        let taken: usize = self.patches.iter().map(length).sum();
        taken + length(&patch) <= ROOM && self.patches.push(patch).is_ok()
    }

    /// Writes the frame and returns its length, at most [`MAX_LEN`]. Bytes behind are
    /// not touched.
    ///
    /// Position, goal and patches must lie in the box, and the patches fit into 35 bytes
    /// together: those that do not are left out.
    pub fn encode(&self, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        let header = Header {
            grid: self.grid,
            sender: self.sender,
            sequence: self.sequence,
        };
        let Status { position, goal, .. } = self.status;
        let patches = fitting(&self.patches);
        let mut writer = Writer::new(kind_of(patches), header, buffer);
        writer.put(&[u8::from(self.status.has_stopped()) | u8::from(goal.is_some()) << 1]);
        for voxel in [position, goal.unwrap_or(Voxel::new(0, 0, 0))] {
            writer.put(&packed(voxel.cell()));
            writer.put(&[voxel.z as u8]);
        }
        for patch in patches {
            let VoxelPatch {
                tile,
                z,
                known,
                occupied,
            } = *patch;
            let flags = u8::from(known == !0) << 6 | u8::from(occupied != 0) << 7;
            writer.put(&[tile.x & 63 | flags, tile.y & 63, z]);
            if known != !0 {
                writer.put(&known.to_le_bytes());
            }
            if occupied != 0 {
                writer.put(&occupied.to_le_bytes());
            }
        }
        writer.finish(key)
    }

    /// Reads a frame about `grid`, a box of `extent` columns and `levels` levels. Every
    /// field is looked at before anything is returned.
    ///
    /// # Errors
    /// Anything that [`encode`](Self::encode) would not have written, and frames
    /// about other grids.
    pub fn decode(
        bytes: &[u8],
        key: Option<&Key>,
        grid: GridId,
        extent: Extent,
        levels: u8,
    ) -> Result<Self, FrameError> {
        let sealed = Sealed::new(bytes, key)?;
        let (status, mut rest) = sealed.payload::<STATUS>(ROOM)?;
        let &[state, p0, p1, p2, height, g0, g1, g2, goal_height] = status;
        let kind = match sealed.kind() {
            WITHDRAWN => WITHDRAWN,
            _ => VOXELS,
        };
        let header = sealed.open(kind, grid)?;
        if state & !3 != 0 {
            return Err(FrameError::Field(Field::State));
        }
        let position = unpacked([p0, p1, p2]);
        if !extent.contains(position) || height >= levels {
            return Err(FrameError::Field(Field::Position));
        }
        let goal = optional_cell([g0, g1, g2], state & 2 != 0, extent)?;
        if goal_height >= levels || goal.is_none() && goal_height != 0 {
            return Err(FrameError::Field(Field::Goal));
        }
        let mut patches = Vec::new();
        while !rest.is_empty() {
            let (patch, behind) = decode_patch(rest, extent, levels)?;
            // There is room: the length was checked, and every record has its bytes.
            let _ = patches.push(patch);
            rest = behind;
        }
        if kind_of(&patches) != kind {
            return Err(FrameError::Field(Field::Tile));
        }
        Ok(Self {
            grid: header.grid,
            sender: header.sender,
            sequence: header.sequence,
            status: Status {
                position: Voxel::new(position.x, position.y, height.into()),
                goal: goal.map(|goal| Voxel::new(goal.x, goal.y, goal_height.into())),
                activity: Activity::stopped_if(state & 1 != 0),
            },
            patches,
        })
    }
}

/// The first of `patches`, as many as there is room for.
fn fitting(patches: &[VoxelPatch]) -> &[VoxelPatch] {
    let mut room = ROOM;
    let fits = |patch: &&VoxelPatch| match room.checked_sub(length(patch)) {
        Some(left) => {
            room = left;
            true
        }
        None => false,
    };
    let count = patches.iter().take_while(fits).count();
    patches.get(..count).unwrap_or(&[])
}

/// The kind of a frame with these pieces.
fn kind_of(patches: &[VoxelPatch]) -> u8 {
    match patches.iter().any(|patch| patch.withdrawn() != 0) {
        true => WITHDRAWN,
        false => VOXELS,
    }
}

fn decode_patch(
    bytes: &[u8],
    extent: Extent,
    levels: u8,
) -> Result<(VoxelPatch, &[u8]), FrameError> {
    let wrong = FrameError::Field(Field::Tile);
    let (&[x, y, z], mut rest) = bytes.split_first_chunk::<RECORD>().ok_or(wrong)?;
    let mut mask = || {
        let (mask, behind) = rest.split_first_chunk::<MASK>().ok_or(wrong)?;
        rest = behind;
        Ok(u64::from_le_bytes(*mask))
    };
    let (is_whole, has_obstacles) = (x & 64 != 0, x & 128 != 0);
    let known = if is_whole { !0 } else { mask()? };
    let occupied = if has_obstacles { mask()? } else { 0 };
    let tile = TileIndex { x: x & 63, y };
    let is_odd = known | occupied == 0
        || (known | occupied) & !tile.inside(extent) != 0
        || !is_whole && known == !0
        || has_obstacles && occupied == 0;
    if y > 63 || z >= levels || is_odd {
        return Err(wrong);
    }
    let patch = VoxelPatch {
        tile,
        z,
        known,
        occupied,
    };
    Ok((patch, rest))
}

#[cfg(test)]
mod tests;
