//! The first steps of a way, two bits each.

use crate::cell::Direction;

/// Steps that a path holds.
pub(crate) const CAPACITY: usize = 256;
const _: () = assert!(
    CAPACITY == u8::MAX as usize + 1,
    "the ring of steps wraps around where its u8 does"
);

/// The next steps of a way, at most 256: the rest of a longer one is looked for
/// when these are used up. 68 bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Path {
    #[cfg_attr(feature = "serde", serde(with = "serde_bytes"))]
    steps: [u8; CAPACITY / 4],
    /// Where the first step lies in the ring.
    first: u8,
    length: u16,
}

impl Path {
    pub(crate) const fn new() -> Self {
        Self {
            steps: [0; CAPACITY / 4],
            first: 0,
            length: 0,
        }
    }

    pub(crate) const fn len(&self) -> u32 {
        self.length as u32
    }

    /// Keeps so many of the first steps at most.
    pub(crate) fn truncate(&mut self, length: u16) {
        self.length = self.length.min(length);
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.length == 0
    }

    fn set(&mut self, place: u8, step: Direction) {
        let shift = (place & 3) * 2;
        if let Some(byte) = self.steps.get_mut(usize::from(place >> 2)) {
            *byte = *byte & !(3 << shift) | (step as u8) << shift;
        }
    }

    /// Puts a step before the first; a full path loses its last step.
    pub(crate) fn push_front(&mut self, step: Direction) {
        self.first = self.first.wrapping_sub(1);
        self.set(self.first, step);
        if usize::from(self.length) < CAPACITY {
            self.length += 1;
        }
    }

    /// Puts a step after the last; a full path stays as it is and says so.
    pub(crate) fn push_back(&mut self, step: Direction) -> bool {
        let room = usize::from(self.length) < CAPACITY;
        if room {
            self.set(self.first.wrapping_add(self.length as u8), step);
            self.length += 1;
        }
        room
    }

    pub(crate) fn first(&self) -> Option<Direction> {
        self.get(0)
    }

    /// The step with this number, from 0 on.
    pub(crate) fn get(&self, number: u16) -> Option<Direction> {
        let place = self.first.wrapping_add(number as u8);
        let byte = self.steps.get(usize::from(place >> 2))?;
        (self.length > number).then(|| Direction::from_index(byte >> ((place & 3) * 2)))
    }

    /// Exchanges the step with this number and the next one, if there are both.
    pub(crate) fn swap(&mut self, number: u16) {
        if let (Some(step), Some(next)) = (self.get(number), self.get(number + 1)) {
            let place = self.first.wrapping_add(number as u8);
            self.set(place, next);
            self.set(place.wrapping_add(1), step);
        }
    }

    /// All of its steps.
    pub(crate) fn steps(self) -> impl Iterator<Item = Direction> {
        let mut path = self;
        core::iter::from_fn(move || path.pop_front())
    }

    pub(crate) fn pop_front(&mut self) -> Option<Direction> {
        let step = self.first()?;
        self.first = self.first.wrapping_add(1);
        self.length -= 1;
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_path_is_a_queue_that_forgets_its_end(
            operations in proptest::collection::vec((0u8..5, 0u8..4, 200u16..300), 0..900),
        ) {
            let mut path = Path::new();
            let mut oracle = VecDeque::new();
            for (operation, step, limit) in operations {
                let step = Direction::from_index(step);
                match operation {
                    0 => {
                        path.push_front(step);
                        oracle.push_front(step);
                        oracle.truncate(CAPACITY);
                    }
                    1 => {
                        let room = oracle.len() < CAPACITY;
                        prop_assert_eq!(path.push_back(step), room);
                        if room {
                            oracle.push_back(step);
                        }
                    }
                    4 => {
                        let number = usize::from(limit) % (oracle.len() + 1);
                        let step = oracle.get(number).copied();
                        prop_assert_eq!(path.get(number as u16), step);
                        path.swap(number as u16);
                        if number + 1 < oracle.len() {
                            oracle.swap(number, number + 1);
                        }
                    }
                    2 => {
                        path.truncate(limit);
                        oracle.truncate(limit.into());
                    }
                    _ => prop_assert_eq!(path.pop_front(), oracle.pop_front()),
                }
                prop_assert_eq!(path.len() as usize, oracle.len());
            }
            let rest: Vec<_> = core::iter::from_fn(|| path.pop_front()).collect();
            prop_assert_eq!(rest, Vec::from(oracle));
        }
    }
}
