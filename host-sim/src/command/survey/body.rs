//! How wide robots are.

use clap::Args;
use host_sim::scenario::{heights, voxels};
use host_sim::scene::Scene;
use host_sim::terrain::Terrain;

/// Room in voxels unless said otherwise.
const USUAL: u8 = 1;

/// The options that say how wide robots are.
#[derive(Args, Clone, Copy)]
pub(super) struct BodyArgs {
    /// Among voxels, robots reach N voxels beyond the one of their middle, 0 to 3, and keep that
    /// much free of everything; with 0 they fly wherever a voxel is free. Default: 1. Over heights
    /// their radius is N columns, and the least altitude is kept over all ground under them.
    /// Default: 0.
    #[arg(long, value_name = "N", conflicts_with = "radius", value_parser = clap::value_parser!(u8).range(..=3))]
    clearance: Option<u8>,
    /// Radius of the robots in metres, with errors of pose and control, where voxels or columns
    /// have metres: the least --clearance in which such a ball touches nothing.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = super::metres)]
    radius: Option<f64>,
}

impl BodyArgs {
    /// The clearance in a scene.
    ///
    /// # Errors
    /// A radius where voxels have no metres, or one that does not fit.
    pub(super) fn among_voxels(self, scene: &Scene) -> Result<u8, String> {
        let side = scene.frame().map(|frame| frame.voxel_size);
        let clearance = self.of_radius("voxel", side, &voxels::ROOM, voxels::clearance_for)?;
        Ok(clearance.or(self.clearance).unwrap_or(USUAL))
    }

    /// The clearance over a terrain.
    ///
    /// # Errors
    /// As [`among_voxels`](Self::among_voxels).
    pub(super) fn over_heights(self, terrain: &Terrain) -> Result<u8, String> {
        let side = terrain.scale().map(|scale| scale.cell);
        let clearance = self.of_radius("column", side, &heights::ROOM, heights::clearance_for)?;
        Ok(clearance.or(self.clearance).unwrap_or_default())
    }

    /// The clearance for the radius, if one is given, where a `cell` has a side of so many metres.
    fn of_radius(
        self,
        cell: &str,
        side: Option<f64>,
        room: &[f64],
        clearance_for: impl Fn(f64) -> Option<u8>,
    ) -> Result<Option<u8>, String> {
        let Some(radius) = self.radius else {
            return Ok(None);
        };
        let Some(side) = side else {
            return Err(format!(
                "--radius {radius}: nothing says how wide a {cell} is; add --metres-per-cell M, or \
                 say --clearance N in {cell}s"
            ));
        };
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(format!("--radius {radius}: expected metres, 0 or more"));
        }
        clearance_for(radius / side).map(Some).ok_or_else(|| {
            let most = room[room.len() - 1];
            format!(
                "--radius {radius}: with {cell}s of {side} m at most {:.2} m fits; take {cell}s of \
                 {:.2} m or more",
                (100.0 * most * side).floor() / 100.0,
                (100.0 * radius / most).ceil() / 100.0,
            )
        })
    }
}
