//! Waves over the cells of the whole map, a byte a cell, in slices.
//!
//! Several waves run at once, each with a label, a step a layer: what they reach next
//! stands in a queue, first in, first out. Each cell that a wave reaches carries its label
//! and the direction back to where the wave began.
//!
//! The queue holds three cells a tile. What does not fit is found again when the queue is
//! empty, by looking at all cells: the waves then reach the same cells, but not by the
//! shortest ways.
//!
//! An *exact* wave is alone, and its ways are the shortest whatever the queue holds ([`exact`]).

mod cell;
mod exact;

use super::body::TILE_WORK;
use super::others::MAX_OTHERS;
use super::queue::{PER_TILE, Places, Queue};
use super::surroundings::Surroundings;
use crate::cell::{Cell, Direction, Extent};
use crate::tile::{TILE, TileIndex, bits};

/// Waves that can run at once: the robot's own and one for each other.
pub(crate) const LABELS: usize = 16;
const _: () = assert!(
    LABELS <= u16::BITS as usize && LABELS <= 1 << 4,
    "a set of labels is a u16, and a cell's label has four bits"
);
const _: () = assert!(
    MAX_OTHERS < LABELS,
    "each robot that is remembered, and the robot itself, needs a label"
);

/// Work of taking a cell out of the queue and looking at its neighbours, in instructions.
const VISIT_WORK: u32 = 155;
/// Work of reading a tile of the map.
const LOAD_WORK: u32 = 2200;
/// Work of forgetting [`CHUNK`] cells.
const CHUNK_WORK: u32 = 660;
/// Work of looking at [`SOME`] cells for those that the queue lost.
const SOME_WORK: u32 = 1000;

/// What a step of a wave costs at most: a cell with four neighbours in tiles that were not
/// read yet; or a chunk.
pub(crate) const STEP_WORK: u32 = VISIT_WORK + 4 * LOAD_WORK;

/// Cells that are forgotten at a time.
const CHUNK: usize = 256;
/// Cells that are looked at for lost ones at a time.
const SOME: usize = 32;

fn load_work<const TW: usize, const TH: usize>(around: &Surroundings<TW, TH>) -> u32 {
    match around.clearance {
        0 => LOAD_WORK,
        _ => LOAD_WORK + TILE_WORK,
    }
}

/// Eight cells of a row as bytes, from bits: each byte is 0 or 1.
fn spread(row: u64) -> u64 {
    let nibble = |bits: u64| u64::from(((bits as u32 & 0xf) * 0x0020_4081) & 0x0101_0101);
    nibble(row) | nibble(row >> 4) << 32
}

/// Whose waves run.
#[derive(Clone, Copy)]
pub(crate) struct Labels {
    pub(crate) own: u8,
    /// Those whose cells belong to nobody any more, a bit a label.
    pub(crate) given_up: u16,
}

impl Labels {
    const fn has_given_up(self, label: u8) -> bool {
        self.given_up >> (label & cell::LABEL) & 1 == 1
    }
}

/// What has come of running.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// Nothing yet.
    Nothing,
    /// The wave `label` has reached a goal that nobody has spoken for.
    Goal { label: u8, cell: Cell },
    /// No wave reaches any more.
    End,
}

/// Why the innermost loop ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pause {
    /// So many cells were asked for.
    Enough,
    /// The queue is empty.
    Empty,
    /// A layer of an exact wave ends.
    Layer,
    /// A goal was reached.
    Goal(usize),
    /// The map was not read there, or a wave that gave up had reached the cell.
    Unread(usize),
}

/// What happened on the way.
struct Notes {
    /// The queue had no room for a cell.
    has_lost: bool,
    /// The robot's own wave met another.
    has_met: bool,
}

/// A wave's steps from one cell: the robot's own wave or another's.
struct Step<'a, 'b, const OWN: bool> {
    bytes: &'a mut [u8],
    places: &'a mut Places<'b>,
    queue: &'a mut Queue,
    notes: &'a mut Notes,
    /// What the cells get.
    mark: u8,
    /// The labels that gave up.
    given_up: u16,
}

impl<const OWN: bool> Step<'_, '_, OWN> {
    /// What tells that the wave may enter, and that it reaches a goal.
    const FREE: u8 = cell::FREE << OWN as u8;
    const GOAL: u8 = cell::GOAL << OWN as u8;

    /// Enters the neighbours of a cell, until something comes of it. What was entered
    /// before is not entered again.
    #[inline(always)] // in the innermost loop, once for each kind of wave
    fn enter_all(&mut self, from: usize, stride: usize) -> Option<Pause> {
        // Past the last column and the first there is nothing.
        if from % TILE != TILE - 1 || !(from + 1).is_multiple_of(stride) {
            let pause = self.enter(from + 1, 0);
            if pause.is_some() {
                return pause;
            }
        }
        let pause = self.enter(from + stride, 1);
        if pause.is_some() {
            return pause;
        }
        if !from.is_multiple_of(TILE) || !from.is_multiple_of(stride) {
            let pause = self.enter(from.wrapping_sub(1), 2);
            if pause.is_some() {
                return pause;
            }
        }
        self.enter(from.wrapping_sub(stride), 3)
    }

    /// Enters a cell in direction number `direction`, if it can.
    #[inline(always)] // in the innermost loop
    fn enter(&mut self, number: usize, direction: u8) -> Option<Pause> {
        let place = self.bytes.get_mut(number)?;
        let byte = *place;
        if byte & cell::REACHED != 0 {
            if self.given_up >> (byte & cell::LABEL) & 1 == 1 {
                return Some(Pause::Unread(number));
            }
            self.notes.has_met |= OWN && byte & cell::LABEL != self.mark & cell::LABEL;
            return None;
        }
        if byte & Self::FREE == 0 {
            let is_read = byte & cell::READ != 0;
            return (!is_read).then_some(Pause::Unread(number));
        }
        *place = byte & cell::TAKEN | (direction ^ 2) << cell::BACK | self.mark;
        if !self.queue.push(self.places, number) {
            self.notes.has_lost = true;
        }
        let is_goal = byte & (cell::TAKEN | Self::GOAL) == Self::GOAL;
        is_goal.then_some(Pause::Goal(number))
    }
}

/// The state of waves over a map of `TW`×`TH` tiles: 70 bytes a tile.
///
/// Cells are numbered row by row over the tiles that the extent needs, and the queue has
/// room by the number of these: what the waves do is the same whatever `TW` and `TH` are.
pub(crate) struct Wave<const TW: usize, const TH: usize> {
    cells: [[[u8; TILE * TILE]; TW]; TH],
    places: [[[u16; PER_TILE]; TW]; TH],
    queue: Queue,
    /// Cells of a row.
    stride: u32,
    /// Cells of all rows.
    end: u32,
    /// Cells forgotten so far, up to `end`, and what is kept of each.
    cleared: u32,
    kept: u8,
    /// The cell whose neighbours are being looked at, and whether any may be left.
    from: u32,
    is_under_way: bool,
    /// Whether the queue had no room for a cell since all were last looked at.
    has_lost: bool,
    /// Whether the robot's own wave has met another.
    has_met: bool,
    /// Cells looked at for those that were lost, up to `end`.
    searched: u32,
    /// Steps that the waves have made at most, and the place behind the last of this layer.
    layer: u32,
    layer_end: u32,
    /// Frontier cells that are spoken for.
    taken: u32,
    /// Whether the wave is alone and its ways are the shortest.
    is_exact: bool,
}

impl<const TW: usize, const TH: usize> Wave<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            cells: [[[0; TILE * TILE]; TW]; TH],
            places: [[[0; PER_TILE]; TW]; TH],
            queue: Queue::EMPTY,
            stride: 0,
            end: 0,
            cleared: 0,
            kept: 0,
            from: 0,
            is_under_way: false,
            has_lost: false,
            has_met: false,
            searched: 0,
            layer: 0,
            layer_end: 0,
            taken: 0,
            is_exact: false,
        }
    }

    fn bytes(&self) -> &[u8] {
        let bytes = self.cells.as_flattened().as_flattened();
        bytes.get(..self.end as usize).unwrap_or(bytes)
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        let bytes = self.cells.as_flattened_mut().as_flattened_mut();
        let end = (self.end as usize).min(bytes.len());
        bytes.get_mut(..end).unwrap_or_default()
    }

    fn byte(&self, number: usize) -> u8 {
        self.bytes().get(number).copied().unwrap_or(0)
    }

    /// The places of the queue that the extent needs.
    fn places(places: &mut [[[u16; PER_TILE]; TW]; TH], end: u32) -> Places<'_> {
        let halves = places.as_flattened_mut().as_flattened_mut();
        let room = (end as usize / (TILE * TILE) * PER_TILE).min(halves.len());
        Places {
            halves: halves.get_mut(..room).unwrap_or_default(),
            // The first is known when it is compiled, and false on chips.
            is_large: TW * TH * TILE * TILE > 1 << 16 && end > 1 << 16,
        }
    }

    fn push(&mut self, number: usize) -> bool {
        self.queue
            .push(&mut Self::places(&mut self.places, self.end), number)
    }

    fn number(&self, cell: Cell) -> Option<usize> {
        let stride = self.stride as usize;
        let x = usize::try_from(cell.x).ok().filter(|x| *x < stride)?;
        Some(usize::try_from(cell.y).ok()? * stride + x)
    }

    const fn cell(&self, number: usize) -> Cell {
        let number = number as u32;
        let stride = if self.stride == 0 { 1 } else { self.stride };
        Cell::new((number % stride) as i16, (number / stride) as i16)
    }

    /// Forgets all waves and, unless it is kept, who is spoken for; but it is
    /// [`clear`](Self::clear) that does it.
    pub(crate) fn begin(&mut self, extent: Extent, keeps_taken: bool) {
        let length = |cells: u16, most: usize| {
            let tiles = usize::from(cells).div_ceil(TILE);
            (tiles.clamp(1, most) * TILE) as u32
        };
        self.stride = length(extent.width, TW);
        self.end = self.stride * length(extent.height, TH);
        self.cleared = 0;
        self.kept = if keeps_taken { cell::TAKEN } else { 0 };
        if !keeps_taken {
            self.taken = 0;
        }
        self.queue = Queue::EMPTY;
        self.is_under_way = false;
        self.has_lost = false;
        self.has_met = false;
        self.searched = self.end;
        self.layer = 0;
        self.layer_end = 0;
        self.is_exact = false;
    }

    /// Forgets a chunk of the cells; says whether all are forgotten. Only then waves can
    /// be seeded.
    pub(crate) fn clear(&mut self, work: &mut u32) -> bool {
        if self.cleared >= self.end {
            return true;
        }
        *work += CHUNK_WORK;
        let (first, kept) = (self.cleared as usize, u32::from_ne_bytes([self.kept; 4]));
        let (words, _) = self.bytes_mut().as_chunks_mut();
        for word in words.iter_mut().skip(first / 4).take(CHUNK / 4) {
            *word = (u32::from_ne_bytes(*word) & kept).to_ne_bytes();
        }
        self.cleared += CHUNK as u32;
        false
    }

    /// Starts the wave `label` in a cell. The goal that this cell is, if any.
    pub(crate) fn seed(
        &mut self,
        cell: Cell,
        label: u8,
        labels: Labels,
        around: &Surroundings<TW, TH>,
        work: &mut u32,
    ) -> Event {
        *work += VISIT_WORK;
        let Some(number) = self.number(cell) else {
            return Event::Nothing;
        };
        if self.byte(number) & !cell::TAKEN == 0 {
            *work += load_work(around);
            self.read(number, labels, around);
        }
        let byte = self.byte(number);
        let goal = cell::GOAL << u8::from(label == labels.own);
        if let Some(place) = self.bytes_mut().get_mut(number) {
            *place = byte & cell::TAKEN | cell::REACHED | label;
        }
        self.has_lost |= !self.push(number);
        if byte & (cell::REACHED | cell::TAKEN | goal) == goal {
            Event::Goal { label, cell }
        } else {
            Event::Nothing
        }
    }

    /// Lets the waves run on until something comes of it, or the work is not less than
    /// `until`.
    pub(crate) fn run(
        &mut self,
        labels: Labels,
        around: &Surroundings<TW, TH>,
        until: u32,
        work: &mut u32,
    ) -> Event {
        while *work < until {
            let cells = (until - *work).div_ceil(VISIT_WORK);
            let (pause, left) = match self.is_exact {
                true => self.run_exact(cells),
                false => self.run_through(labels, cells),
            };
            *work += (cells - left) * VISIT_WORK;
            match pause {
                Pause::Enough => {}
                Pause::Goal(number) => {
                    return Event::Goal {
                        label: self.byte(number) & cell::LABEL,
                        cell: self.cell(number),
                    };
                }
                Pause::Unread(number) => {
                    *work += load_work(around);
                    self.read(number, labels, around);
                }
                Pause::Empty => {
                    *work += SOME_WORK;
                    if !self.find_lost(labels) {
                        return Event::End;
                    }
                }
                Pause::Layer if self.searched < self.end => {
                    *work += SOME_WORK;
                    self.find_lost_of_layer();
                }
                Pause::Layer => {
                    *work += VISIT_WORK;
                    if !self.begin_layer() {
                        return Event::End;
                    }
                }
            }
        }
        Event::Nothing
    }

    /// Takes so many cells out of the queue, or less; why, and how many were left.
    #[inline(never)]
    fn run_through(&mut self, labels: Labels, cells: u32) -> (Pause, u32) {
        let mut places = Self::places(&mut self.places, self.end);
        let bytes = self.cells.as_flattened_mut().as_flattened_mut();
        let end = (self.end as usize).min(bytes.len());
        let bytes = bytes.get_mut(..end).unwrap_or_default();
        let stride = self.stride as usize;
        let (mut queue, mut layer_end) = (self.queue, self.layer_end);
        let (mut from, mut is_under_way) = (self.from as usize, self.is_under_way);
        let mut notes = Notes {
            has_lost: false,
            has_met: false,
        };
        let mut left = cells;
        let pause = loop {
            if !is_under_way {
                if left == 0 {
                    break Pause::Enough;
                }
                if queue.first == layer_end {
                    self.layer += 1;
                    layer_end = queue.end;
                }
                let Some(first) = queue.pop(&places) else {
                    break Pause::Empty;
                };
                left -= 1;
                from = first;
            }
            // A wave that gave up may have left it here.
            let byte = bytes.get(from).copied().unwrap_or(0);
            let label = byte & cell::LABEL;
            if byte & cell::REACHED == 0 || labels.has_given_up(label) {
                is_under_way = false;
                continue;
            }
            macro_rules! step {
                ($own:literal) => {
                    Step::<$own> {
                        bytes: &mut *bytes,
                        places: &mut places,
                        queue: &mut queue,
                        notes: &mut notes,
                        mark: cell::REACHED | label,
                        given_up: labels.given_up,
                    }
                    .enter_all(from, stride)
                };
            }
            let pause = if label == labels.own {
                step!(true)
            } else {
                step!(false)
            };
            is_under_way = pause.is_some();
            if let Some(pause) = pause {
                break pause;
            }
        };
        self.queue = queue;
        self.layer_end = layer_end;
        self.from = from as u32;
        self.is_under_way = is_under_way;
        self.has_lost |= notes.has_lost;
        self.has_met |= notes.has_met;
        (pause, left)
    }

    /// Reads the tile of a cell from the map, but for what waves have reached that did not
    /// give up.
    #[inline(never)] // once a tile, and again where a wave gave up
    fn read(&mut self, number: usize, labels: Labels, around: &Surroundings<TW, TH>) {
        let Cell { x, y } = self.cell(number);
        let (column, row) = ((x >> 3) as u8, (y >> 3) as u8);
        let at = TileIndex::new(column, row);
        let [free, open, frontier, goals] = around.layers(at);
        let goals = match TileIndex::of(around.position) {
            Some((tile, bit)) if self.is_exact => bit & u64::from(tile == at).wrapping_neg(),
            _ => goals,
        };
        let stride = self.stride as usize;
        let first = usize::from(row) * TILE * stride + usize::from(column) * TILE;
        const READ: u64 = u64::from_ne_bytes([cell::READ; TILE]);
        const TAKEN: u64 = u64::from_ne_bytes([cell::TAKEN; TILE]);
        let (words, _) = self.bytes_mut().as_chunks_mut::<TILE>();
        let rows = words
            .iter_mut()
            .skip(first / TILE)
            .step_by((stride / TILE).max(1));
        for (bytes, y) in rows.take(TILE).zip(0u32..) {
            let row = |layer: u64| spread(layer >> (8 * y));
            let read = READ
                | (row(free) * u64::from(cell::FREE))
                | (row(open) * u64::from(cell::FREE << 1))
                | (row(frontier) * u64::from(cell::GOAL))
                | (row(goals) * u64::from(cell::GOAL << 1));
            let taken = u64::from_le_bytes(*bytes) & TAKEN;
            let read = (taken | read).to_le_bytes();
            for (byte, read) in bytes.iter_mut().zip(read) {
                if *byte & cell::REACHED == 0 || labels.has_given_up(*byte) {
                    *byte = read;
                }
            }
        }
    }

    /// The queue is empty: puts cells into it whose neighbours may not have been looked at,
    /// if any was lost. False if none was.
    #[cold]
    fn find_lost(&mut self, labels: Labels) -> bool {
        if self.searched >= self.end {
            if !self.has_lost {
                return false;
            }
            self.has_lost = false;
            self.searched = 0;
        }
        let first = self.searched as usize;
        for number in first..first + SOME {
            let byte = self.byte(number);
            let is_reached = byte & cell::REACHED != 0 && !labels.has_given_up(byte);
            if is_reached && !self.push(number) {
                break;
            }
            self.searched += 1;
        }
        true
    }

    /// Steps that the waves have made at most: the distance of what they reach next.
    pub(crate) const fn layer(&self) -> u32 {
        self.layer
    }

    /// Whether the robot's own wave has met another: its ways may go round.
    pub(crate) const fn has_met(&self) -> bool {
        self.has_met
    }

    /// The cells of a tile that a wave has reached. Work: 64 bytes.
    pub(crate) fn reached(&self, at: TileIndex) -> u64 {
        bits(u64::MAX)
            .filter(|bit| {
                let number = self.number(at.cell(*bit));
                let number = number.filter(|number| *number < self.cleared as usize);
                let byte = number.and_then(|number| self.bytes().get(number));
                byte.is_some_and(|byte| byte & cell::REACHED != 0)
            })
            .fold(0, |cells, bit| cells | 1 << bit)
    }

    /// The direction back to where the wave `label` began, if it has reached the cell; an
    /// exact wave has any label.
    pub(crate) fn direction_at(&self, cell: Cell, label: u8) -> Option<Direction> {
        let byte = self.bytes().get(self.number(cell)?)?;
        let is_its = byte & (cell::REACHED | cell::LABEL) == cell::REACHED | label
            || self.is_exact && byte & cell::REACHED != 0;
        is_its.then(|| Direction::from_index(byte >> cell::BACK))
    }

    /// Turns the direction at a cell that a wave has reached.
    pub(crate) fn turn(&mut self, cell: Cell, direction: Direction) {
        if let Some(number) = self.number(cell)
            && let Some(byte) = self.bytes_mut().get_mut(number)
        {
            *byte = *byte & !(3 << cell::BACK) | (direction as u8) << cell::BACK;
        }
    }

    /// Speaks for frontier cells of a tile.
    pub(crate) fn take(&mut self, at: TileIndex, cells: u64) {
        let mut new = 0;
        for bit in bits(cells) {
            if let Some(number) = self.number(at.cell(bit))
                && let Some(byte) = self.bytes_mut().get_mut(number)
            {
                new += u32::from(*byte & cell::TAKEN == 0);
                *byte |= cell::TAKEN;
            }
        }
        self.taken += new;
    }

    /// Frontier cells that are spoken for.
    pub(crate) const fn taken(&self) -> u32 {
        self.taken
    }
}
