//! Metres of a terrain: how wide its columns are, and where they lie.

use planner_core::Point;
use serde::{Deserialize, Serialize};

use crate::options::{OptionError, none_given};

/// Where columns lie in metres: x east, y north, z up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// Side of a column.
    pub cell: f64,
    /// The corner of the first column, at height 0 of the terrain.
    pub corner: [f64; 3],
    /// Whether rows follow each other to the north; those of pictures lead south.
    pub northward: bool,
}

impl Scale {
    /// Of a picture whose columns are `cell` metres wide: its north-west corner is the
    /// origin.
    pub fn picture(cell: f64) -> Self {
        Self {
            cell,
            corner: [0.0; 3],
            northward: false,
        }
    }

    /// A place in cells, in metres.
    pub fn metres(&self, at: Point) -> [f64; 3] {
        let [x, y, z] = [at.x, at.y, at.z].map(|it| f64::from(it) * self.cell);
        let y = if self.northward { y } else { -y };
        [self.corner[0] + x, self.corner[1] + y, self.corner[2] + z]
    }
}

/// What is said of the metres of a terrain, beside what its file says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TerrainOptions {
    /// Side of a column in metres.
    pub metres_per_cell: Option<f64>,
    /// Metres between two neighbouring numbers of a picture or of a GeoTIFF.
    pub metres_per_level: Option<f64>,
}

impl TerrainOptions {
    /// # Errors
    /// An option that is no length, or out of its range.
    pub fn check(&self) -> Result<(), OptionError> {
        let of = |option, found: Option<f64>| match found {
            Some(found) if !(1e-3..=1e5).contains(&found) => Err(OptionError::Setting {
                option,
                found,
                expected: "0.001 to 100000 metres",
            }),
            _ => Ok(()),
        };
        of("--metres-per-cell", self.metres_per_cell)?;
        of("--metres-per-level", self.metres_per_level)
    }

    /// # Errors
    /// Something is said to something that says it itself.
    pub(super) fn check_none(&self, what: &'static str) -> Result<(), OptionError> {
        let given = [
            ("--metres-per-cell", self.metres_per_cell.is_some()),
            ("--metres-per-level", self.metres_per_level.is_some()),
        ];
        none_given(given, what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_pictures_lead_south() {
        let at = Point::new(3.0, 2.0, 1.5);
        assert_eq!(Scale::picture(2.0).metres(at), [6.0, -4.0, 3.0]);
        let tree = Scale {
            cell: 0.5,
            corner: [10.0, 20.0, -1.0],
            northward: true,
        };
        assert_eq!(tree.metres(at), [11.5, 21.0, -0.25]);
    }
}
