//! How wide robots are among voxels.

use clap::Args;
use host_sim::scenario::voxels::{ROOM, clearance_for};
use host_sim::scene::Scene;

/// Room in voxels unless said otherwise.
const USUAL: u8 = 1;

/// The options that say how wide robots are.
#[derive(Args, Clone, Copy)]
pub(super) struct BodyArgs {
    /// Among voxels, robots reach N voxels beyond the one of their middle, 0 to 3, and keep that
    /// much free of everything; with 0 they fly wherever a voxel is free. Default: 1.
    #[arg(long, value_name = "N", conflicts_with = "radius", value_parser = clap::value_parser!(u8).range(..=3))]
    clearance: Option<u8>,
    /// Radius of the robots in metres, with errors of pose and control, where voxels have
    /// metres: the least --clearance in which such a ball touches nothing.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = super::metres)]
    radius: Option<f64>,
}

impl BodyArgs {
    /// The option that is given, if one is.
    pub(super) fn given(self) -> Option<&'static str> {
        let clearance = self.clearance.map(|_| "clearance");
        clearance.or(self.radius.map(|_| "radius"))
    }

    /// The clearance in a scene.
    ///
    /// # Errors
    /// A radius where voxels have no metres, or one that does not fit.
    pub(super) fn clearance(self, scene: &Scene) -> Result<u8, String> {
        let Some(radius) = self.radius else {
            return Ok(self.clearance.unwrap_or(USUAL));
        };
        let Some(frame) = scene.frame() else {
            return Err(format!(
                "--radius {radius}: nothing says how wide a voxel is; add --metres-per-cell M, or \
                 say --clearance N in voxels"
            ));
        };
        let side = frame.voxel_size;
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(format!("--radius {radius}: expected metres, 0 or more"));
        }
        clearance_for(radius / side).ok_or_else(|| {
            let most = ROOM[ROOM.len() - 1];
            format!(
                "--radius {radius}: with voxels of {side} m at most {:.2} m fits; take voxels of \
                 {:.2} m or more",
                (100.0 * most * side).floor() / 100.0,
                (100.0 * radius / most).ceil() / 100.0,
            )
        })
    }
}
