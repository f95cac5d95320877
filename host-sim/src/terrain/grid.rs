//! Elevation models as ESRI ASCII grids: a header of `ncols`, `nrows`, a corner, `cellsize`
//! and perhaps `NODATA_value`, then the heights in metres, row by row from the north.

use super::Terrain;
use super::file::{TerrainError, fitting};
use super::relief::from_metres;

/// First word of such a file, in any case.
const FIRST: &str = "ncols";

/// Words of the header, beside the two of a corner.
const CORNERS: [&str; 4] = ["xllcorner", "xllcenter", "yllcorner", "yllcenter"];

/// Whether a file begins like a grid.
pub(super) fn is_grid(bytes: &[u8]) -> bool {
    let first = bytes.trim_ascii_start().get(..FIRST.len());
    first.is_some_and(|first| first.eq_ignore_ascii_case(FIRST.as_bytes()))
}

fn wrong(line: usize, expected: impl Into<String>) -> TerrainError {
    TerrainError::Grid {
        line,
        expected: expected.into(),
    }
}

/// The terrain of a grid: its cells are columns, and its lowest height is 0.
pub(super) fn from_grid(bytes: &[u8]) -> Result<Terrain, TerrainError> {
    let text = str::from_utf8(bytes).map_err(|_| wrong(1, "text"))?;
    let lines = text.lines().zip(1..);
    let mut words = lines
        .flat_map(|(line, number)| line.split_whitespace().map(move |word| (word, number)))
        .peekable();
    let (mut width, mut height, mut side, mut nothing) = (None, None, None, None);
    let is_name = |word: &str| word.starts_with(|first: char| first.is_ascii_alphabetic());
    while let Some((word, line)) = words.next_if(|(word, _)| is_name(word)) {
        let name = word.to_ascii_lowercase();
        let value = words.next().map_or("", |(value, _)| value);
        let number = || {
            let number = value.parse::<f64>().ok().filter(|it| it.is_finite());
            number.ok_or_else(|| wrong(line, format!("a number after {name}")))
        };
        match &name[..] {
            "ncols" => width = value.parse().ok(),
            "nrows" => height = value.parse().ok(),
            "cellsize" => side = Some(number()?).filter(|side| *side > 0.0),
            "nodata_value" => nothing = Some(number()?),
            _ if CORNERS.contains(&&name[..]) => _ = number()?,
            _ => {
                return Err(wrong(
                    line,
                    "ncols, nrows, a corner, cellsize or NODATA_value",
                ));
            }
        }
    }
    let first = words.peek().map_or(1, |(_, line)| *line);
    let sides = width.zip(height);
    let sides = sides.ok_or_else(|| wrong(first, "ncols and nrows, whole numbers, before it"))?;
    let side = side.ok_or_else(|| wrong(first, "a cellsize above 0 before it"))?;
    let extent = fitting(sides)?;
    let mut metres = Vec::with_capacity(extent.cells() as usize);
    let mut last = first;
    for (word, line) in words {
        last = line;
        let value = word.parse::<f64>().ok().filter(|it| it.is_finite());
        let value = value.ok_or_else(|| wrong(line, "heights in metres"))?;
        if nothing == Some(value) {
            let (x, y) = (metres.len() as u32 % sides.0, metres.len() as u32 / sides.0);
            let expected = format!(
                "a height in column {x}, row {y} instead of NODATA: fill the gaps, for example \
                 with `gdal_fillnodata`, or cut a part out"
            );
            return Err(wrong(line, expected));
        }
        metres.push(value);
    }
    if metres.len() != extent.cells() as usize {
        let (cells, found) = (extent.cells(), metres.len());
        return Err(wrong(last, format!("{cells} heights in all, not {found}")));
    }
    from_metres(extent, &metres, side)
}

#[cfg(test)]
mod tests {
    use planner_core::{Cell, Extent};

    use super::*;

    const HEADER: &str = "ncols 3\nNROWS 2\nxllcorner 500.5\nyllcorner -7\ncellsize 2\n";

    fn read(text: &str) -> Result<Terrain, String> {
        Terrain::from_bytes(text.as_bytes(), "asc").map_err(|error| error.to_string())
    }

    #[test]
    fn heights_are_metres_over_the_lowest() {
        let text = format!("{HEADER}NODATA_value -9999\n100 101 102.5\n104\n100 120 ");
        let terrain = read(&text).unwrap();
        assert_eq!(terrain.extent(), Extent::new(3, 2));
        let quarters: Vec<_> = terrain
            .cells()
            .map(|cell: Cell| terrain.height(cell).unwrap().0)
            .collect();
        // Of cells of two metres.
        assert_eq!(quarters, [0, 2, 5, 8, 0, 40]);
    }

    #[test]
    fn a_damaged_grid_is_refused_with_its_line() {
        for (text, words) in [
            (
                format!("{HEADER}1 2 3\n4 5"),
                ["line 7", "6 heights in all, not 5"],
            ),
            (
                format!("{HEADER}1 2 3\n4 5 6 7"),
                ["line 7", "6 heights in all, not 7"],
            ),
            (
                format!("{HEADER}1 2 3\n4 x 6"),
                ["line 7", "heights in metres"],
            ),
            (
                format!("{HEADER}1 2 3\n4 nan 6"),
                ["line 7", "heights in metres"],
            ),
            (
                format!("{HEADER}nodata_value -1\n1 2 3\n4 -1.0 6"),
                ["line 8", "column 1, row 1"],
            ),
            (format!("{HEADER}1 2 3\n4 5 600"), ["299.5 cells", "63"]),
            (HEADER.replace("NROWS 2", "NROWS -2"), ["line 1", "nrows"]),
            (
                HEADER.replace("cellsize 2", "cellsize 0\n1"),
                ["line 6", "cellsize"],
            ),
            (HEADER.replace("cellsize", "dx"), ["line 5", "cellsize or"]),
            (
                HEADER.replace("500.5", "inf"),
                ["line 3", "after xllcorner"],
            ),
            (
                HEADER.replace("ncols 3", "ncols 513"),
                ["513×2", "1 to 512"],
            ),
        ] {
            let error = read(&text).unwrap_err();
            for word in words {
                assert!(error.contains(word), "{word:?} is not in {error}");
            }
        }
    }
}
