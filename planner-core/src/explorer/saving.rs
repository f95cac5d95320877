//! The explorer's state as bytes and back: after a brown-out, or for the next sortie.
//!
//! Kept is what took walking to learn: the map, places that were shut, how much was heard,
//! where the robot and its home are, whose role it has, and the number of its next frame.
//! Dropped is what looks and searches bring again: plan, hints, votes, what is set aside.
//!
//! All numbers are little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 0–3 | `EXP`, version |
//! | 4–7 | width and height of the grid in cells |
//! | 8–11 | the grid's [id](crate::radio::GridId), the robot's id, its role |
//! | 12–19 | where the robot is, and its home: x, y |
//! | 20–23 | number of the next frame, places that were shut |
//! | 24–31 | cells heard, cells that were shut |
//! | 32–63 | the shut places: x, y |
//! | 64– | tile by tile, row by row, the bits of the levels: three words |
//! | last 4 | CRC-32 of all before |

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

use super::Explorer;
use crate::cell::{Cell, Extent};
use crate::map::{MOST_PLACES, Shut, Tile};
use crate::planner::{Persist, RestoreError};
use crate::robot::RobotId;
use crate::role::Role;
use crate::tile::every_tile;

const MAGIC: [u8; 3] = *b"EXP";
const VERSION: u8 = 1;
/// Words of 8 bytes before the tiles.
const HEADER: usize = 8;
const _: () = assert!(MOST_PLACES == 2 * (HEADER - 4));
/// Words of a tile.
const WORDS: usize = 3;
/// Bytes of the check sum.
const CHECKED: usize = 4;

/// Without a table: a save is seldom, and small.
static CHECK: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Bytes of a save of a grid.
const fn length(extent: Extent) -> usize {
    let (columns, rows) = extent.tiles();
    8 * (HEADER + WORDS * columns as usize * rows as usize) + CHECKED
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    fn header(&self) -> [u64; HEADER] {
        let map = &self.around.map;
        let Extent { width, height } = map.extent();
        let places = map.shut().places();
        let [a, b, c] = MAGIC;
        let magic = u32::from_le_bytes([a, b, c, VERSION]);
        let mut header = [
            u64::from(magic) | pair(width, height) << 32,
            u64::from(self.link.grid().0)
                | u64::from(self.id.0) << 16
                | u64::from(self.role.rank.0) << 24
                | of_cell(self.around.position) << 32,
            of_cell(self.role.home) | pair(self.link.sequence(), places.len() as u16) << 32,
            u64::from(self.link.hearsay().cells) | u64::from(map.shut().cells()) << 32,
            0,
            0,
            0,
            0,
        ];
        for (word, places) in header.iter_mut().skip(4).zip(places.chunks(2)) {
            for (place, shift) in places.iter().zip([0, 32]) {
                *word |= of_cell(*place) << shift;
            }
        }
        header
    }
}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for Explorer<TW, TH> {
    fn saved_bytes(&self) -> usize {
        length(self.around.map.extent())
    }

    fn save(&self, first: usize, page: &mut [u8]) -> usize {
        let map = &self.around.map;
        let (columns, rows) = map.tile_extent();
        let tiles = every_tile(columns.into(), rows.into());
        let words = tiles.flat_map(|at| map.tile_inside(at).planes());
        let mut digest = CHECK.digest();
        let (mut at, mut written) = (0usize, 0);
        let mut put = |bytes: &[u8]| {
            for byte in bytes {
                if let Some(place) = at.checked_sub(first).and_then(|at| page.get_mut(at)) {
                    *place = *byte;
                    written += 1;
                }
                at += 1;
            }
        };
        for word in self.header().into_iter().chain(words) {
            let bytes = word.to_le_bytes();
            digest.update(&bytes);
            put(&bytes);
        }
        put(&digest.finalize().to_le_bytes());
        written
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), RestoreError> {
        let saved = Saved::read(bytes)?;
        let map = &self.around.map;
        if saved.extent != map.extent() || saved.grid != self.link.grid().0 {
            return Err(RestoreError::Grid(saved.extent));
        }
        if saved.id != self.id {
            return Err(RestoreError::Robot(saved.id));
        }
        if !saved.extent.contains(saved.home) {
            return Err(RestoreError::Damaged);
        }
        let (cells, kept_out) = (map.kept_out_cells(), self.role.kept_out);
        self.reset(self.config, self.id, saved.extent, saved.position)
            .map_err(|_| RestoreError::Damaged)?;
        self.around.map.load(saved.tiles(), saved.shut());
        self.around.map.keep_out(cells);
        self.role = Role::new(saved.rank, saved.home);
        self.role.kept_out = kept_out;
        self.link.restore(saved.sequence, saved.heard);
        self.budget.doubt();
        Ok(())
    }
}

/// A save that is whole.
struct Saved<'a> {
    extent: Extent,
    grid: u16,
    id: RobotId,
    rank: RobotId,
    position: Cell,
    home: Cell,
    sequence: u16,
    heard: u32,
    shut_cells: u32,
    shut_places: usize,
    /// All before the check sum.
    words: &'a [[u8; 8]],
}

impl<'a> Saved<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, RestoreError> {
        let damaged = RestoreError::Damaged;
        let &[a, b, c, version] = bytes.first_chunk().ok_or(RestoreError::NoSave)?;
        if [a, b, c] != MAGIC {
            return Err(RestoreError::NoSave);
        }
        if version != VERSION {
            return Err(RestoreError::Version(version));
        }
        let (words, _) = bytes.as_chunks();
        let word = |index: usize| words.get(index).copied().map(u64::from_le_bytes);
        let size = (word(0).ok_or(damaged)? >> 32) as u32;
        let extent = Extent::new(size as u16, (size >> 16) as u16);
        let whole = bytes.get(..length(extent)).ok_or(damaged)?;
        let (body, check) = whole.split_last_chunk().ok_or(damaged)?;
        if CHECK.checksum(body) != u32::from_le_bytes(*check) {
            return Err(damaged);
        }
        let half = |index: usize, shift: u32| word(index).map_or(0, |word| (word >> shift) as u32);
        let (names, frames, words) = (half(1, 0), half(2, 32), body.as_chunks().0);
        Ok(Self {
            extent,
            grid: names as u16,
            id: RobotId((names >> 16) as u8),
            rank: RobotId((names >> 24) as u8),
            position: cell_of(half(1, 32)),
            home: cell_of(half(2, 0)),
            sequence: frames as u16,
            heard: half(3, 0),
            shut_cells: half(3, 32),
            shut_places: (frames >> 16) as usize,
            words,
        })
    }

    fn shut(&self) -> Shut {
        let words = self.words.iter().skip(4).take(HEADER - 4);
        let words = words.map(|bytes| u64::from_le_bytes(*bytes));
        let places = words.flat_map(|word| [word as u32, (word >> 32) as u32]);
        Shut::of(self.shut_cells, places.take(self.shut_places).map(cell_of))
    }

    fn tiles(&self) -> impl Iterator<Item = Tile> {
        let words = self.words.get(HEADER..).unwrap_or(&[]);
        let (tiles, _) = words.as_chunks::<WORDS>();
        tiles
            .iter()
            .map(|planes| Tile::from_planes(planes.map(u64::from_le_bytes)))
    }
}

fn pair(low: u16, high: u16) -> u64 {
    u64::from(low) | u64::from(high) << 16
}

fn of_cell(cell: Cell) -> u64 {
    pair(cell.x as u16, cell.y as u16)
}

const fn cell_of(pair: u32) -> Cell {
    Cell::new(pair as i16, (pair >> 16) as i16)
}

#[cfg(test)]
mod tests;
