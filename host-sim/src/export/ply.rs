//! What was mapped as a PLY point cloud.

use std::io::{self, Write};

use crate::record::voxels::VoxelTrace;
use crate::scene::Frame;

/// Writes the middles of all voxels that the robots take for occupied, in metres of the scene's
/// file, as an ASCII PLY file.
///
/// # Errors
/// Those of `to`.
pub fn ply(trace: &VoxelTrace, mut to: impl Write) -> io::Result<()> {
    let frame = trace.scene.frame().unwrap_or(Frame::PLAIN);
    let mut map = trace.map(u32::MAX);
    map.retain(|&(_, occupied)| occupied);
    writeln!(
        to,
        "ply\nformat ascii 1.0\ncomment voxels of {} m\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header",
        frame.voxel_size,
        map.len()
    )?;
    for (voxel, _) in map {
        let [x, y, z] = frame.middle(voxel);
        writeln!(to, "{x:.4} {y:.4} {z:.4}")?;
    }
    Ok(())
}
