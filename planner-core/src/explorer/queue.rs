//! A queue of cells, first in, first out, over places that a wave keeps.

/// Places of the queue for each tile.
pub(crate) const PER_TILE: usize = 3;

/// The places of a queue of cells: the number of one in each, or in two where numbers
/// have more than 16 bits.
pub(crate) struct Places<'a> {
    pub(crate) halves: &'a mut [u16],
    pub(crate) is_large: bool,
}

impl Places<'_> {
    #[inline(always)] // in the innermost loop
    fn count(&self) -> u32 {
        (self.halves.len() >> u8::from(self.is_large)) as u32
    }

    #[inline(always)] // in the innermost loop
    fn set(&mut self, place: u32, number: usize) {
        let place = (place as usize) << u8::from(self.is_large);
        if let Some(half) = self.halves.get_mut(place) {
            *half = number as u16;
        }
        if self.is_large
            && let Some(half) = self.halves.get_mut(place + 1)
        {
            *half = (number >> 16) as u16;
        }
    }

    #[inline(always)] // in the innermost loop
    fn get(&self, place: u32) -> Option<usize> {
        let place = (place as usize) << u8::from(self.is_large);
        let low = usize::from(*self.halves.get(place)?);
        if !self.is_large {
            return Some(low);
        }
        Some(usize::from(*self.halves.get(place + 1)?) << 16 | low)
    }
}

/// Which places are in use: first in, first out. One place stays empty.
#[derive(Clone, Copy)]
pub(crate) struct Queue {
    pub(crate) first: u32,
    /// The place behind the last one.
    pub(crate) end: u32,
}

impl Queue {
    pub(crate) const EMPTY: Self = Self { first: 0, end: 0 };

    #[inline(always)] // in the innermost loop
    fn after(place: u32, places: &Places<'_>) -> u32 {
        if place + 1 < places.count() {
            place + 1
        } else {
            0
        }
    }

    /// Adds a cell; false if there is no room.
    #[inline(always)] // in the innermost loop
    pub(crate) fn push(&mut self, places: &mut Places<'_>, number: usize) -> bool {
        let end = Self::after(self.end, places);
        if end == self.first {
            return false;
        }
        places.set(self.end, number);
        self.end = end;
        true
    }

    /// Takes the first cell out.
    #[inline(always)] // in the innermost loop
    pub(crate) fn pop(&mut self, places: &Places<'_>) -> Option<usize> {
        if self.first == self.end {
            return None;
        }
        let number = places.get(self.first);
        self.first = Self::after(self.first, places);
        number
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_is_first_in_first_out_and_says_when_it_is_full(
            steps in proptest::collection::vec(proptest::option::of(0usize..1 << 18), 0..60),
            is_large: bool,
        ) {
            let mut halves = vec![0; 12];
            let mut places = Places { halves: &mut halves, is_large };
            let room = if is_large { 5 } else { 11 };
            let (mut queue, mut oracle) = (Queue::EMPTY, VecDeque::new());
            for step in steps {
                match step {
                    Some(number) => {
                        let number = if is_large { number } else { number & 0xffff };
                        let has_room = oracle.len() < room;
                        prop_assert_eq!(queue.push(&mut places, number), has_room);
                        if has_room {
                            oracle.push_back(number);
                        }
                    }
                    None => prop_assert_eq!(queue.pop(&places), oracle.pop_front()),
                }
            }
        }
    }
}
