//! Rows of cells as bits, as wide as a look needs.

use core::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, Not, Shl};

/// A row of a look: a bit a column.
pub trait Row:
    Copy
    + PartialEq
    + Into<u64>
    + Not<Output = Self>
    + BitAnd<Output = Self>
    + BitAndAssign
    + BitOr<Output = Self>
    + BitOrAssign
    + Shl<u32, Output = Self>
    + sealed::Sealed
{
    /// No cell.
    const NONE: Self;
    /// The cell of column 0.
    const FIRST: Self;
    /// Every bit.
    const ALL: Self;
    /// Bits of a row.
    const BITS: u32;

    /// The row with bit `n` at `n - columns`; those below bit 0 come in at the top.
    fn turned(self, columns: u32) -> Self;

    /// The number of the lowest bit of a row that has any.
    fn first(self) -> u32;

    /// That of the highest.
    fn last(self) -> u32;

    /// The eight bits from bit number `from` on, which may be negative.
    fn byte_at(self, from: i32) -> u8;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u32 {}
    impl Sealed for u64 {}
}

macro_rules! row {
    ($row:ty, $last:literal) => {
        impl Row for $row {
            const NONE: Self = 0;
            const FIRST: Self = 1;
            const ALL: Self = <$row>::MAX;
            const BITS: u32 = <$row>::BITS;

            fn turned(self, columns: u32) -> Self {
                self.rotate_right(columns)
            }

            fn first(self) -> u32 {
                self.trailing_zeros()
            }

            fn last(self) -> u32 {
                ($last as u32).saturating_sub(self.leading_zeros())
            }

            fn byte_at(self, from: i32) -> u8 {
                match from {
                    0..=$last => (self >> from) as u8,
                    -7..=-1 => (self << -from) as u8,
                    _ => 0,
                }
            }
        }
    };
}

row!(u32, 31);
row!(u64, 63);
