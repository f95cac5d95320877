//! What was mapped as a PLY point cloud.

use std::io::{self, Write};

use crate::record::voxels::VoxelTrace;
use crate::scene::Frame;

/// Writes the middles of all occupied voxels that were seen, in metres of the scene's
/// file, as an ASCII PLY file.
///
/// # Errors
/// Those of `to`.
pub fn ply(trace: &VoxelTrace, mut to: impl Write) -> io::Result<()> {
    let frame = trace.scene.frame().unwrap_or(Frame::PLAIN);
    let occupied = trace.found.iter().filter(|found| found.2);
    writeln!(
        to,
        "ply\nformat ascii 1.0\ncomment voxels of {} m\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header",
        frame.voxel_size,
        occupied.clone().count()
    )?;
    for (_, voxel, _) in occupied {
        let [x, y, z] = frame.middle(*voxel);
        writeln!(to, "{x:.4} {y:.4} {z:.4}")?;
    }
    Ok(())
}
