//! How robots hear of each other.

mod ideal;

pub use ideal::Ideal;

use crate::fleet::Robot;

/// What carries maps and positions between robots.
pub trait Medium<const TW: usize, const TH: usize> {
    /// One exchange among the living robots.
    fn exchange(&mut self, robots: &mut [Robot<TW, TH>]);
}

#[cfg(test)]
mod tests;
