//! What differs between the chips that the images are built for; build.rs says
//! which it is, by the target.

/// Ticks of the processor's clock in a second, in QEMU's model of the board.
pub const CLOCK_HZ: u32 = if cfg!(board = "stm32f405") {
    168_000_000
} else if cfg!(board = "mps2-an385") {
    25_000_000
} else {
    16_000_000
};

/// Columns of tiles of the maps that fit the chip.
pub const COLUMNS: usize = if cfg!(board = "microbit") { 4 } else { 16 };

/// Rows of tiles of the maps that fit the chip.
pub const ROWS: usize = COLUMNS;
