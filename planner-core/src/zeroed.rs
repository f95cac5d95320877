//! An `Option` whose `None` is zero.

/// As [`Option`], but laid out so that [`Nothing`](Self::Nothing) is all zero.
/// The compiler gives `None` of an option of an enum the first number that the
/// enum leaves free, and a single byte that is not zero moves a whole `static`
/// planner from `.bss` to `.data`, and so into flash.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Maybe<T> {
    Nothing = 0,
    Just(T) = 1,
}

impl<T: Copy> Maybe<T> {
    pub(crate) const fn get(self) -> Option<T> {
        match self {
            Self::Nothing => None,
            Self::Just(value) => Some(value),
        }
    }
}
