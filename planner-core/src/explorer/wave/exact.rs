//! A wave that is alone, and whose ways are the shortest whatever the queue holds.
//!
//! It needs no label, so each cell keeps its distance modulo 3 there: what a layer has lost is
//! found by that before the next one begins. Its one goal is the robot.

use super::{Notes, Pause, SOME, Step, Wave, cell};
use crate::cell::Extent;

/// Distances of an exact wave are kept modulo this: cells beside each other differ.
const RING: u8 = 3;

impl<const TW: usize, const TH: usize> Wave<TW, TH> {
    /// As [`begin`](Self::begin), for one exact wave, of label 0.
    pub(crate) fn begin_exact(&mut self, extent: Extent) {
        self.begin(extent, false);
        self.is_exact = true;
    }

    /// As [`run_through`](Self::run_through) for an exact wave, up to the end of a layer.
    #[inline(never)]
    pub(super) fn run_exact(&mut self, cells: u32) -> (Pause, u32) {
        let mut places = Self::places(&mut self.places, self.end);
        let bytes = self.cells.as_flattened_mut().as_flattened_mut();
        let end = (self.end as usize).min(bytes.len());
        let mut notes = Notes {
            has_lost: false,
            has_met: false,
        };
        let mut wave = Step::<true> {
            bytes: bytes.get_mut(..end).unwrap_or_default(),
            places: &mut places,
            queue: &mut self.queue,
            notes: &mut notes,
            mark: cell::REACHED | (self.layer % u32::from(RING)) as u8,
            given_up: 0,
        };
        let mut left = cells;
        let pause = loop {
            if !self.is_under_way {
                if left == 0 {
                    break Pause::Enough;
                }
                if wave.queue.first == self.layer_end {
                    break Pause::Layer;
                }
                let Some(first) = wave.queue.pop(wave.places) else {
                    break Pause::Layer;
                };
                left -= 1;
                self.from = first as u32;
            }
            let pause = wave.enter_all(self.from as usize, self.stride as usize);
            self.is_under_way = pause.is_some();
            if let Some(pause) = pause {
                break pause;
            }
        };
        self.has_lost |= notes.has_lost;
        (pause, left)
    }

    /// The next layer of an exact wave begins; what was lost belongs to it. False if there
    /// is nothing in it.
    pub(super) fn begin_layer(&mut self) -> bool {
        let has_lost = core::mem::take(&mut self.has_lost);
        if has_lost {
            self.searched = 0;
        }
        self.layer += 1;
        self.layer_end = self.queue.end;
        has_lost || self.queue.first != self.queue.end
    }

    /// As [`find_lost`](Self::find_lost) for an exact wave: the next cell of this layer,
    /// all of which stood in the queue or were lost, has its neighbours looked at, once
    /// more at worst.
    #[cold]
    pub(super) fn find_lost_of_layer(&mut self) {
        let layer = ((self.layer + 2) % u32::from(RING)) as u8;
        for number in (self.searched..self.end).take(SOME) {
            self.searched = number + 1;
            let byte = self.byte(number as usize);
            if byte & (cell::REACHED | cell::LABEL) == cell::REACHED | layer {
                self.from = number;
                self.is_under_way = true;
                break;
            }
        }
    }
}
