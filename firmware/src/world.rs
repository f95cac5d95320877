//! The built-in world, read in place from its text.

use planner_core::{Cell, Extent};

/// A map as text: `#` is an obstacle, the digit `1` the robot's start, all else free.
pub struct World {
    rows: &'static [u8],
    extent: Extent,
    start: Cell,
}

impl World {
    /// Reads a map whose rows are equally long and each end with a line feed.
    ///
    /// # Panics
    /// The rows differ in length, or there is no start. Evaluated in a `const`,
    /// that is an error at compile time.
    pub const fn parse(text: &'static str) -> Self {
        let rows = text.as_bytes();
        let mut width = 0;
        while width < rows.len() && rows[width] != b'\n' {
            width += 1;
        }
        let mut start = None;
        let mut at = 0;
        while at < rows.len() {
            let (x, y) = (at % (width + 1), at / (width + 1));
            assert!(
                (rows[at] == b'\n') == (x == width),
                "the rows of the map differ in length"
            );
            if rows[at] == b'1' {
                start = Some(Cell::new(x as i16, y as i16));
            }
            at += 1;
        }
        assert!(
            rows.len().is_multiple_of(width + 1),
            "the last row of the map does not end with a line feed"
        );
        let Some(start) = start else {
            panic!("the map has no start: mark it with the digit 1");
        };
        let extent = Extent::new(width as u16, (rows.len() / (width + 1)) as u16);
        Self {
            rows,
            extent,
            start,
        }
    }

    /// The size in cells.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Where the robot starts.
    pub const fn start(&self) -> Cell {
        self.start
    }

    /// Whether the cell is an obstacle, or lies outside.
    pub fn is_blocked(&self, cell: Cell) -> bool {
        let at = usize::from(cell.y as u16) * (usize::from(self.extent.width) + 1)
            + usize::from(cell.x as u16);
        !self.extent.contains(cell) || self.rows.get(at) == Some(&b'#')
    }
}
