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

/// Memory of the caller in which one planner lives.
pub(crate) trait Memory: Sized {
    type Planner;
    /// One that is not set up. All of it is zero: the compiler clears the memory in place,
    /// and needs neither a copy on the stack nor one in flash.
    const VACANT: Self::Planner;
    /// The first word once it is created, for each kind of planner another.
    const CREATED: u32;
}

impl Memory for Planner {
    type Planner = Explorer<TILES, TILES>;
    const VACANT: Self::Planner = Explorer::vacant();
    const CREATED: u32 = 0x9e37_79b1;
}

/// What lies in such a memory once it is created.
#[repr(C)]
pub(crate) struct Robot<P> {
    /// [`Memory::CREATED`]; anything else: no planner was created here.
    created: u32,
    /// Its number in the fleet.
    pub(crate) id: u8,
    /// Whether the configuration lets it send nothing.
    pub(crate) is_mute: bool,
    pub(crate) planner: P,
}

/// The planner fits in its memory; both are as they are for the C compiler.
const fn has_room<M: Memory>() {
    assert!(
        size_of::<Robot<M::Planner>>() <= size_of::<M>(),
        "the planner does not fit in its memory: raise its number of words"
    );
    assert!(align_of::<Robot<M::Planner>>() <= align_of::<M>());
}

/// Whether a header that tells these bytes is that of this library.
pub(crate) fn fits<M>(bytes: usize) -> Result<(), PlannerResult> {
    match bytes == size_of::<M>() {
        true => Ok(()),
        false => Err(PlannerResult::Memory),
    }
}

/// A planner that is not set up, in place; `id` is the robot's, and what it may send a tick.
pub(crate) fn create<'a, M: Memory>(
    memory: *mut M,
    id: u8,
    bytes_per_tick: u16,
) -> Result<&'a mut M::Planner, PlannerResult> {
    const { has_room::<M>() }
    check(memory)?;
    let place = memory.cast::<Robot<M::Planner>>();
    // SAFETY: inside of the memory, which `check` has looked at and which is
    // large enough by the assertions above.
    let (created, its_id, is_mute, planner) = unsafe {
        (
            &raw mut (*place).created,
            &raw mut (*place).id,
            &raw mut (*place).is_mute,
            &raw mut (*place).planner,
        )
    };
    output(planner)?.write(const { M::VACANT });
    output(its_id)?.write(id);
    output(is_mute)?.write(bytes_per_tick == 0);
    output(created)?.write(M::CREATED);
    Ok(&mut robot(memory)?.planner)
}

/// The planner in this memory.
pub(crate) fn robot<'a, M: Memory>(
    memory: *mut M,
) -> Result<&'a mut Robot<M::Planner>, PlannerResult> {
    const { has_room::<M>() }
    check(memory)?;
    // SAFETY: not null, aligned, and by the header's contract as large as a
    // planner's memory. Any bits are a valid u32.
    let created = unsafe { memory.cast::<u32>().read() };
    if created != M::CREATED {
        return Err(PlannerResult::NotCreated);
    }
    // SAFETY: only `create` writes that word, before a whole Robot; it fits by the
    // assertions above. The header forbids other uses of the memory meanwhile.
    Ok(unsafe { &mut *memory.cast::<Robot<M::Planner>>() })
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
