//! `nav_msgs`.

use crate::field::messages;
use crate::geometry::{Pose, PoseStamped, PoseWithCovariance, TwistWithCovariance};
use crate::std_msgs::{Header, Time};

messages! { "nav_msgs";
    /// Where a robot is and how fast.
    Odometry {
        /// When, and the frame of the pose.
        header: Header,
        /// The frame of the robot.
        child_frame_id: String,
        /// Where.
        pose: PoseWithCovariance,
        /// How fast, in the robot's frame.
        twist: TwistWithCovariance,
    }

    /// The size and place of a map.
    MapMetaData {
        /// When it was loaded.
        map_load_time: Time,
        /// The side of a cell in metres.
        resolution: f32,
        /// Cells along x.
        width: u32,
        /// Cells along y.
        height: u32,
        /// Where the corner of cell (0, 0) lies, the one of least x and y.
        origin: Pose,
    }

    /// A map.
    OccupancyGrid {
        /// When and in which frame.
        header: Header,
        /// Size and place.
        info: MapMetaData,
        /// Row by row from the least y: 0 free to 100 blocked, -1 unknown.
        data: Vec<i8>,
    }

    /// A way.
    Path {
        /// When and in which frame.
        header: Header,
        /// From the next pose on.
        poses: Vec<PoseStamped>,
    }
}
