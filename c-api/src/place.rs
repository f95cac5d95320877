//! From pointers to references: the only unsafe code, and why it is sound.

use planner_core::CellSet;
use planner_core::explorer::Explorer;

use crate::types::PlannerResult;

#[cfg(all(feature = "cells-32", feature = "cells-64"))]
compile_error!("choose one of the features cells-32 and cells-64");

/// Largest width and height of a grid, in cells. (The header has it, and the next, for
/// each size; `cbindgen.toml`.)
///
/// cbindgen:ignore
pub const PLANNER_MAX_CELLS: u16 = if cfg!(feature = "cells-32") {
    32
} else if cfg!(feature = "cells-64") {
    64
} else {
    128
};

/// Size of a planner in words of 8 bytes.
///
/// cbindgen:ignore
pub const PLANNER_WORDS: usize = words(PLANNER_MAX_CELLS);

/// Words for a map of so many cells: what an explorer may take by `fixtures/budget.txt`,
/// and one that tells that it is there and whether it talks.
pub(crate) const fn words(cells: u16) -> usize {
    match cells {
        32 => 529,
        64 => 1153,
        _ => 3630,
    }
}

/// Columns and rows of tiles of the map.
pub(crate) const TILES: usize = PLANNER_MAX_CELLS as usize / 8;

/// Memory for one planner. `planner_create` makes one in it. Do not copy it.
#[repr(C)]
pub struct Planner {
    words: [u64; PLANNER_WORDS],
}

/// Cells of a grid, a bit each. All zero there are none: make it with `= {0}`.
#[repr(C)]
pub struct PlannerCellSet {
    words: [u64; PLANNER_CELL_SET_WORDS],
}

impl PlannerCellSet {
    /// No cell.
    pub const NONE: Self = Self {
        words: [0; PLANNER_CELL_SET_WORDS],
    };
}

/// Size of a set of cells in words of 8 bytes.
///
/// cbindgen:ignore
pub const PLANNER_CELL_SET_WORDS: usize = TILES * TILES;

/// What lies in a [`PlannerCellSet`].
pub(crate) type Cells = CellSet<TILES, TILES>;

const _: () = assert!(size_of::<Cells>() == size_of::<PlannerCellSet>());
const _: () = assert!(align_of::<Cells>() == align_of::<PlannerCellSet>());

/// What lies in a [`Planner`] once it is created.
#[repr(C)]
pub(crate) struct Robot {
    /// [`CREATED`]; anything else: no planner was created here.
    created: u32,
    /// Whether the configuration lets it send nothing; anything but 0: it does.
    pub(crate) is_mute: u32,
    pub(crate) explorer: Explorer<TILES, TILES>,
}

const _: () = assert!(
    size_of::<Robot>() <= size_of::<Planner>(),
    "the explorer does not fit in a Planner: raise PLANNER_WORDS"
);
const _: () = assert!(align_of::<Robot>() <= align_of::<Planner>());

/// The first word of every planner.
const CREATED: u32 = 0x9e37_79b1;

impl Robot {
    /// Whether a header that tells these bytes is that of this library.
    pub(crate) const fn fits(bytes: usize) -> bool {
        bytes == size_of::<Planner>()
    }

    /// A planner without a map, in place.
    pub(crate) fn create<'a>(memory: *mut Planner) -> Result<&'a mut Self, PlannerResult> {
        check(memory)?;
        let place = memory.cast::<Self>();
        // SAFETY: inside of the memory, which `check` has looked at and which is
        // large enough by the assertions above.
        let (created, is_mute, explorer) = unsafe {
            (
                &raw mut (*place).created,
                &raw mut (*place).is_mute,
                &raw mut (*place).explorer,
            )
        };
        // A constant that is all zero: the compiler clears the memory in place, and
        // needs neither a copy on the stack nor one in flash.
        output(explorer)?.write(const { Explorer::vacant() });
        output(is_mute)?.write(0);
        output(created)?.write(CREATED);
        robot(memory)
    }
}

/// The planner in this memory.
pub(crate) fn robot<'a>(memory: *mut Planner) -> Result<&'a mut Robot, PlannerResult> {
    check(memory)?;
    // SAFETY: not null, aligned, and by the header's contract as large as a
    // Planner. Any bits are a valid u32.
    let created = unsafe { memory.cast::<u32>().read() };
    if created != CREATED {
        return Err(PlannerResult::NotCreated);
    }
    // SAFETY: only `create` writes that word, before a whole Robot; it fits by the
    // assertions above. The header forbids other uses of the memory meanwhile.
    Ok(unsafe { &mut *memory.cast::<Robot>() })
}

/// A value that the caller gives.
pub(crate) fn input<'a, T: Copy>(pointer: *const T) -> Result<&'a T, PlannerResult> {
    check(pointer)?;
    // SAFETY: not null, aligned, and by the header's contract a T, which the
    // caller does not change meanwhile. All bits of the types in `types.rs` that
    // are given are valid.
    Ok(unsafe { &*pointer })
}

/// Values that the caller gives. Where there are none, the pointer may be null.
pub(crate) fn inputs<'a, T: Copy>(
    pointer: *const T,
    count: usize,
) -> Result<&'a [T], PlannerResult> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer)?;
    if count
        .checked_mul(size_of::<T>())
        .is_none_or(|bytes| bytes > isize::MAX as usize)
    {
        return Err(PlannerResult::TooMany);
    }
    // SAFETY: as `input`, for `count` values in a row; their size does not
    // overflow.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

/// Cells of the caller, to be changed.
pub(crate) fn cells<'a>(pointer: *mut PlannerCellSet) -> Result<&'a mut Cells, PlannerResult> {
    check(pointer)?;
    // SAFETY: not null, aligned, of the same size by the assertions above, and by the
    // header's contract nobody else's meanwhile. All bits are a set of cells.
    Ok(unsafe { &mut *pointer.cast::<Cells>() })
}

/// Bytes that the caller gives room for.
pub(crate) fn page<'a>(pointer: *mut u8, room: usize) -> Result<&'a mut [u8], PlannerResult> {
    if room == 0 {
        return Ok(&mut []);
    }
    check(pointer)?;
    if room > isize::MAX as usize {
        return Err(PlannerResult::TooMany);
    }
    // SAFETY: not null, and by the header's contract so many bytes, of which the caller
    // uses none meanwhile. All bits are a byte.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, room) })
}

/// Where the caller wants a value; it need not hold one yet.
pub(crate) struct Output<T>(*mut T);

pub(crate) fn output<T>(pointer: *mut T) -> Result<Output<T>, PlannerResult> {
    check(pointer)?;
    Ok(Output(pointer))
}

impl<T> Output<T> {
    pub(crate) fn write(self, value: T) {
        // SAFETY: not null, aligned, and by the header's contract memory for a T.
        // No reference to it exists.
        unsafe { self.0.write(value) }
    }
}

fn check<T>(pointer: *const T) -> Result<(), PlannerResult> {
    if pointer.is_null() {
        Err(PlannerResult::Null)
    } else if !pointer.is_aligned() {
        Err(PlannerResult::Misaligned)
    } else {
        Ok(())
    }
}
