//! The map format of the MovingAI benchmarks.
//!
//! <https://movingai.com/benchmarks/formats.html>. `.` and `G` are free, as is
//! the swamp `S`; `@`, `O`, trees `T` and water `W` are obstacles.

use super::World;
use super::error::Problem;
use super::text;

const ROWS_FROM_LINE: usize = 5;

/// Parses a MovingAI map.
pub(super) fn parse(name: &str, map: &str) -> Result<World, Problem> {
    let lines: Vec<&str> = map.trim_end_matches(['\r', '\n']).lines().collect();
    let header = |line: usize, expected| Problem::Header {
        line,
        expected,
        found: lines.get(line - 1).unwrap_or(&"").to_string(),
    };
    let words = |line: usize| -> Vec<&str> {
        lines
            .get(line - 1)
            .unwrap_or(&"")
            .split_whitespace()
            .collect()
    };
    let number = |line, key, expected| match words(line)[..] {
        [word, number] if word == key => number.parse().map_err(|_| header(line, expected)),
        _ => Err(header(line, expected)),
    };
    if words(1) != ["type", "octile"] {
        return Err(header(1, "`type octile`"));
    }
    let height: usize = number(2, "height", "`height` and the number of rows")?;
    let width: usize = number(3, "width", "`width` and the number of cells in a row")?;
    if words(4) != ["map"] {
        return Err(header(4, "`map`"));
    }
    let rows = &lines[ROWS_FROM_LINE - 1..];
    if rows.len() != height {
        return Err(Problem::Rows {
            expected: height,
            found: rows.len(),
        });
    }
    if let Some(row) = rows.first()
        && row.chars().count() != width
    {
        return Err(Problem::Ragged {
            line: ROWS_FROM_LINE,
            expected: width,
            found: row.chars().count(),
        });
    }
    let grid = text::parse_rows(
        rows,
        ROWS_FROM_LINE,
        |line, column, character, _| match character {
            '.' | 'G' | 'S' => Ok(false),
            '@' | 'O' | 'T' | 'W' => Ok(true),
            found => Err(Problem::UnknownCharacter {
                line,
                column,
                found,
                expected: "`.` `G` `S` (free) or `@` `O` `T` `W` (obstacle)",
            }),
        },
    )?;
    World::from_grid(name, grid)
}

impl World {
    /// The world as a MovingAI map. The format knows no starts.
    pub fn to_movingai(&self) -> String {
        let extent = self.extent();
        let rows = text::rows(extent, |cell| if self.is_free(cell) { '.' } else { '@' });
        format!(
            "type octile\nheight {}\nwidth {}\nmap\n{rows}",
            extent.height, extent.width
        )
    }
}
