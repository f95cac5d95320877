//! Seeded chance that gives the same numbers on every platform.

use planner_core::Cell;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A seeded source of choices, for worlds and for whatever goes wrong in a run.
///
/// The stream of ChaCha8 is fixed for ever, while the sampling of ranges in
/// `rand` may change between versions; committed maps and golden traces hang
/// on these numbers, hence the few lines of our own.
pub(crate) struct Dice(ChaCha8Rng);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A number in `0..n`; `n` must not be 0. The bias is below n/2³².
    pub(crate) fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(n)) >> 32) as u32
    }

    /// A number from `lowest` to `highest`, both included.
    pub(crate) fn between(&mut self, lowest: u16, highest: u16) -> u16 {
        lowest + self.below(u32::from(highest - lowest) + 1) as u16
    }

    /// A number in `0..n`; `n` must not be 0. The towns are drawn by it; everything else
    /// by [`below`](Self::below).
    pub(crate) fn residue(&mut self, n: u32) -> u32 {
        self.0.next_u32() % n
    }

    /// A number from 0 to 1, both included.
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    /// 64 bits, each of them set in half of the cases.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Fills `bytes`.
    pub(crate) fn fill(&mut self, bytes: &mut [u8]) {
        self.0.fill_bytes(bytes);
    }

    /// True with this probability, 0 to 1. Draws nothing for 0.
    pub(crate) fn happens(&mut self, probability: f64) -> bool {
        if probability <= 0.0 {
            return false;
        }
        let below = (probability.min(1.0) * 2f64.powi(32)) as u64;
        below > 0 && u64::from(self.0.next_u32()) < below
    }

    /// True in `percent` of 100 cases.
    pub(crate) fn chance(&mut self, percent: u16) -> bool {
        self.below(100) < u32::from(percent)
    }

    /// One of `items`, or nothing if there is none.
    pub(crate) fn pick<T: Copy>(&mut self, items: &[T]) -> Option<T> {
        match items.len() {
            0 => None,
            len => Some(items[self.below(len as u32) as usize]),
        }
    }

    /// Puts `items` into a random order.
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last as u32 + 1) as usize);
        }
    }
}

/// Chance as a function: whoever asks again for the same things gets the same answer, in
/// any order. The mixing is that of SplitMix64 [Steele2014].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Lot(u64);

impl Lot {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The lot of this in particular.
    pub(crate) const fn of(self, what: u64) -> Self {
        let mixed = (self.0 ^ what).wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        Self(mixed ^ (mixed >> 31))
    }

    /// The lot of a cell.
    pub(crate) const fn at(self, cell: Cell) -> Self {
        self.of((cell.x as u16 as u64) << 16 | cell.y as u16 as u64)
    }

    /// True with this probability, 0 to 1.
    pub(crate) fn happens(self, probability: f64) -> bool {
        let below = (probability.clamp(0.0, 1.0) * 2f64.powi(32)) as u64;
        (self.0 >> 32) < below
    }

    /// A number from 0 to below 1.
    pub(crate) fn unit(self) -> f64 {
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }

    /// A number in `0..n`; `n` must not be 0.
    pub(crate) const fn below(self, n: u32) -> u32 {
        (((self.0 >> 32) * n as u64) >> 32) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lots_of_neighbouring_things_are_as_if_drawn() {
        let cells = (0..100).flat_map(|y| (0..100).map(move |x| Cell::new(x, y)));
        for seed in 0..5 {
            for p in [0.0, 0.01, 0.5, 1.0] {
                let lots = cells.clone().map(|cell| Lot::new(seed).of(7).at(cell));
                let share = lots.filter(|lot| lot.happens(p)).count() as f64 / 1e4;
                let deviation = (p * (1.0 - p) / 1e4).sqrt();
                assert!((share - p).abs() <= 4.0 * deviation, "{p}: {share}");
            }
            let mut counts = [0; 8];
            for of in 0..8000 {
                counts[Lot::new(seed).of(of).below(8) as usize] += 1;
            }
            assert!(
                counts.iter().all(|count| (880..1120).contains(count)),
                "{counts:?}"
            );
        }
    }
}
