//! Plain text maps: `#` obstacle, `.` or space free, digits for starts.

use planner_core::{Cell, Extent};

use super::World;
use super::error::Problem;
use super::grid::{self, Grid};

/// Digits in the order of the robots that start there; `0` is the tenth.
const DIGITS: &str = "1234567890";

/// Parses a text map. All rows must be equally long; empty lines at the end
/// do not count.
pub(super) fn parse(name: &str, text: &str) -> Result<World, Problem> {
    let rows: Vec<&str> = text.trim_end_matches(['\r', '\n']).lines().collect();
    let mut starts = [None; 10];
    let grid = parse_rows(&rows, 1, |line, column, character, cell| {
        match character {
            '#' => return Ok(true),
            '.' | ' ' => {}
            _ => {
                let start = DIGITS.find(character).ok_or(Problem::UnknownCharacter {
                    line,
                    column,
                    found: character,
                    expected: match character {
                        '\t' => "spaces in place of tabs, one for each free cell",
                        _ => "`#` (obstacle), `.` or space (free), or a digit (start)",
                    },
                })?;
                if starts[start].replace(cell).is_some() {
                    return Err(Problem::RepeatedStart {
                        line,
                        column,
                        digit: character,
                    });
                }
            }
        }
        Ok(false)
    })?;
    let mut world = World::from_grid(name, grid)?;
    world.starts = starts.into_iter().flatten().collect();
    Ok(world)
}

/// Parses rows of one character per cell. `blocked` is told the line (the
/// first row stands in `first_line`), the column, the character and its cell.
pub(super) fn parse_rows(
    rows: &[&str],
    first_line: usize,
    mut blocked: impl FnMut(usize, usize, char, Cell) -> Result<bool, Problem>,
) -> Result<Grid, Problem> {
    let width = rows.first().map_or(0, |row| row.chars().count());
    let extent = grid::checked_extent(width, rows.len(), || {
        "draw the map as a PNG image and use --pixels-per-cell".into()
    })?;
    let mut grid = Grid::filled(extent, false);
    for (y, row) in rows.iter().enumerate() {
        let line = first_line + y;
        let found = row.chars().count();
        if found != width {
            return Err(Problem::Ragged {
                line,
                expected: width,
                found,
            });
        }
        for (x, character) in row.chars().enumerate() {
            let cell = Cell::new(x as i16, y as i16);
            grid.set_blocked(cell, blocked(line, x + 1, character, cell)?);
        }
    }
    Ok(grid)
}

impl World {
    /// The world as a text map, with its first ten starts as digits (of starts
    /// in one cell only the first shows).
    pub fn to_text(&self) -> String {
        let starts = self.starts().iter().zip(DIGITS.chars());
        rows(self.extent(), |cell| {
            if !self.is_free(cell) {
                return '#';
            }
            let start = starts.clone().find(|&(&start, _)| start == cell);
            start.map_or('.', |(_, digit)| digit)
        })
    }
}

/// One line a row, each ended by a line break.
pub(super) fn rows(extent: Extent, character: impl Fn(Cell) -> char) -> String {
    let mut text = String::new();
    for cell in grid::cells(extent) {
        text.push(character(cell));
        if cell.x as u16 + 1 == extent.width {
            text.push('\n');
        }
    }
    text
}
