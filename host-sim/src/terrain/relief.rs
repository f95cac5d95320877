//! Heights in metres as a terrain.

use planner_core::Extent;
use planner_core::surface::Height;

use super::file::{HIGHEST, TerrainError};
use super::{Scale, Terrain};

/// The terrain of heights in metres, row by row from the north, each as many as `extent`
/// has columns of `cell` metres: the lowest is height 0.
///
/// # Errors
/// The highest is too high over the lowest.
pub(super) fn from_metres(
    extent: Extent,
    metres: &[f64],
    cell: f64,
) -> Result<Terrain, TerrainError> {
    let low = metres.iter().copied().fold(f64::INFINITY, f64::min);
    let high = metres.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let relief = (high - low) / cell;
    if relief > f64::from(HIGHEST) {
        return Err(TerrainError::Relief { relief });
    }
    let width = usize::from(extent.width);
    let terrain = Terrain::from_fn(extent, |at| {
        let metres = metres[at.y as usize * width + at.x as usize];
        Height::from_cells(((metres - low) / cell) as f32)
    });
    Ok(terrain.scaled(Some(Scale::picture(cell))))
}
