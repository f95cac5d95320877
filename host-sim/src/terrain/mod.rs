//! Worlds of one height per column.

mod file;
mod foreign;
mod geotiff;
mod grid;
mod look;
mod relief;
mod scale;
mod source;

use planner_core::surface::{Height, body_columns};
use planner_core::{Cell, Extent};

use crate::dice::Dice;

pub(crate) use file::LARGEST;
pub use file::TerrainError;
pub use look::look;
pub use scale::{Scale, TerrainOptions};
pub use source::TerrainSource;

/// A height field; heights in cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    name: String,
    extent: Extent,
    scale: Option<Scale>,
    heights: Vec<Height>,
}

impl Terrain {
    /// A terrain of `extent` with the height that `height` gives for each column.
    pub fn from_fn(extent: Extent, height: impl FnMut(Cell) -> Height) -> Self {
        let heights = cells(extent).map(height).collect();
        Self {
            name: "terrain".into(),
            extent,
            scale: None,
            heights,
        }
    }

    /// The same with columns in metres.
    pub fn scaled(self, scale: Option<Scale>) -> Self {
        Self { scale, ..self }
    }

    /// The same by another name.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Eight Gaussian hills of equal width σ = 0.1·`side` and peaks of 4 to 14 cells
    /// at places drawn by `seed` [Renzaglia2019 §5].
    pub fn gaussian(seed: u64, side: u16) -> Self {
        let mut dice = Dice::new(seed);
        let mut unit = || dice.unit();
        let hills: [(f64, f64, f64); 8] = std::array::from_fn(|_| {
            (
                unit() * f64::from(side),
                unit() * f64::from(side),
                4.0 + 10.0 * unit(),
            )
        });
        let sigma = 0.1 * f64::from(side);
        Self::from_fn(Extent::new(side, side), |cell| {
            let height: f64 = hills
                .iter()
                .map(|(x, y, peak)| {
                    let (dx, dy) = (f64::from(cell.x) + 0.5 - x, f64::from(cell.y) + 0.5 - y);
                    peak * (-(dx * dx + dy * dy) / (2.0 * sigma * sigma)).exp()
                })
                .sum();
            Height::from_cells(height as f32)
        })
        .named(format!("gaussian-{seed}"))
    }

    /// A town: streets every 20 cells, on each block a building of 5 to 16 cells or a
    /// yard, and vehicles along the streets.
    pub fn urban(seed: u64, side: u16) -> Self {
        /// Width of a block with its street, and of the street.
        const BLOCK: i16 = 20;
        const STREET: i16 = 8;
        let mut dice = Dice::new(seed);
        let blocks = side as usize / BLOCK as usize + 1;
        let buildings: Vec<u8> = (0..blocks * blocks)
            .map(|_| {
                if dice.residue(5) == 0 {
                    0
                } else {
                    20 + dice.residue(45) as u8
                }
            })
            .collect();
        // North-west corner and size of each vehicle, parked along a kerb.
        let vehicles: Vec<(i16, i16, i16, i16)> = (0..blocks * blocks)
            .map(|block| {
                let along = STREET + dice.residue(8) as i16;
                let (x, y) = (
                    (block % blocks) as i16 * BLOCK,
                    (block / blocks) as i16 * BLOCK,
                );
                if dice.residue(2) == 0 {
                    (x + 5, y + along, 2, 4)
                } else {
                    (x + along, y + 5, 4, 2)
                }
            })
            .collect();
        Self::from_fn(Extent::new(side, side), |cell| {
            let parked = vehicles.iter().any(|&(x, y, width, length)| {
                (x..x + width).contains(&cell.x) && (y..y + length).contains(&cell.y)
            });
            let block =
                cell.y as usize / BLOCK as usize * blocks + cell.x as usize / BLOCK as usize;
            let on_street = cell.x % BLOCK < STREET || cell.y % BLOCK < STREET;
            match (on_street, parked) {
                (true, true) => Height(6),
                (true, false) => Height(0),
                (false, _) => Height(buildings[block]),
            }
        })
        .named(format!("urban-{seed}"))
    }

    /// Its metres, if anything says them.
    pub fn scale(&self) -> Option<Scale> {
        self.scale
    }

    /// Size in columns.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// Height of the ground at `cell`; `None` outside.
    pub fn height(&self, cell: Cell) -> Option<Height> {
        self.extent.contains(cell).then(|| {
            self.heights[cell.y as usize * usize::from(self.extent.width) + cell.x as usize]
        })
    }

    /// Height of the highest ground under a body of this clearance with its middle over `cell`;
    /// `None` where the body is not all over the terrain.
    pub fn under(&self, cell: Cell, clearance: u8) -> Option<Height> {
        let mut columns = body_columns(clearance, cell);
        columns.try_fold(Height(0), |most, cell| Some(most.max(self.height(cell)?)))
    }

    /// Height of the highest ground.
    pub fn highest(&self) -> Height {
        self.heights.iter().copied().max().unwrap_or_default()
    }

    /// All columns, row by row.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + use<> {
        cells(self.extent)
    }
}

fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    let (width, height) = (extent.width as i16, extent.height as i16);
    (0..height).flat_map(move |y| (0..width).map(move |x| Cell::new(x, y)))
}
