//! The map format of the MovingAI benchmarks.
//!
//! <https://movingai.com/benchmarks/formats.html>. `.` and `G` are free, as is
//! the swamp `S`; `@`, `O`, trees `T` and water `W` are obstacles.

use super::World;
use super::error::Problem;
use super::text;
use crate::excerpt::excerpt;

const TYPE: &str = "`type octile`";
const HEIGHT: &str = "`height` and the number of rows";
const WIDTH: &str = "`width` and the number of cells in a row";

/// Whether a text begins as a map of this format does.
pub(super) fn begins(map: &str) -> bool {
    let first = map.split_whitespace().next().unwrap_or_default();
    ["type", "height", "width"]
        .iter()
        .any(|key| first.eq_ignore_ascii_case(key))
}

/// What the lines above `map` say.
#[derive(Default)]
struct Header {
    is_octile: bool,
    height: Option<usize>,
    width: Option<usize>,
}

impl Header {
    /// Takes in a line; true if it was the last.
    ///
    /// # Errors
    /// What was expected.
    fn take(&mut self, line: &str) -> Result<bool, &'static str> {
        let missing = match self {
            Self {
                is_octile: false, ..
            } => Some(TYPE),
            Self { height: None, .. } => Some(HEIGHT),
            Self { width: None, .. } => Some(WIDTH),
            _ => None,
        };
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or_default().to_ascii_lowercase();
        let (value, rest) = (words.next(), words.next());
        let number = |expected| {
            let value = value.filter(|_| rest.is_none());
            value.and_then(|value| value.parse().ok()).ok_or(expected)
        };
        match key.as_str() {
            "type" if (value, rest) == (Some("octile"), None) => self.is_octile = true,
            "type" => return Err(TYPE),
            "height" if self.height.is_none() => self.height = Some(number(HEIGHT)?),
            "width" if self.width.is_none() => self.width = Some(number(WIDTH)?),
            "map" if value.is_none() && missing.is_none() => return Ok(true),
            _ => return Err(missing.unwrap_or("`map`")),
        }
        Ok(false)
    }
}

/// Parses a MovingAI map. The lines of its header come in any order, `map` last; blank
/// lines among them and at the end do not count.
pub(super) fn parse(name: &str, map: &str) -> Result<World, Problem> {
    let lines: Vec<&str> = map.lines().collect();
    let mut header = Header::default();
    let mut read = 0;
    loop {
        let line = lines.get(read).copied();
        read += 1;
        if line.is_some_and(|line| line.trim().is_empty()) {
            continue;
        }
        let line = line.unwrap_or_default();
        let is_last = header.take(line).map_err(|expected| Problem::Header {
            line: read,
            expected,
            found: excerpt(line),
        })?;
        if is_last {
            break;
        }
    }
    let (height, width) = (header.height.unwrap_or(0), header.width.unwrap_or(0));
    let first_row = read + 1;
    let mut rows = &lines[read..];
    while let [most @ .., last] = rows
        && rows.len() > height
        && last.trim().is_empty()
    {
        rows = most;
    }
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
            line: first_row,
            expected: width,
            found: row.chars().count(),
        });
    }
    let grid = text::parse_rows(
        rows,
        first_row,
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
