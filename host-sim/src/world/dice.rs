//! Seeded chance that gives the same numbers on every platform.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A seeded source of choices.
///
/// The stream of ChaCha8 is fixed for ever, while the sampling of ranges in
/// `rand` may change between versions; committed maps and golden traces hang
/// on these numbers, hence the few lines of our own.
pub(super) struct Dice(ChaCha8Rng);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A number in `0..n`; `n` must not be 0. The bias is below n/2³².
    pub(super) fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(n)) >> 32) as u32
    }

    /// A number from `lowest` to `highest`, both included.
    pub(super) fn between(&mut self, lowest: u16, highest: u16) -> u16 {
        lowest + self.below(u32::from(highest - lowest) + 1) as u16
    }

    /// True in `percent` of 100 cases.
    pub(super) fn chance(&mut self, percent: u16) -> bool {
        self.below(100) < u32::from(percent)
    }

    /// One of `items`, or nothing if there is none.
    pub(super) fn pick<T: Copy>(&mut self, items: &[T]) -> Option<T> {
        match items.len() {
            0 => None,
            len => Some(items[self.below(len as u32) as usize]),
        }
    }

    /// Puts `items` into a random order.
    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last as u32 + 1) as usize);
        }
    }
}
