//! `geometry_msgs`: metres and radians, x ahead, y to the left, z up.

use crate::field::messages;
use crate::std_msgs::Header;

messages! { "geometry_msgs";
    /// A vector.
    Vector3 {
        /// Ahead.
        x: f64,
        /// To the left.
        y: f64,
        /// Up.
        z: f64,
    }

    /// A place.
    Point {
        /// Ahead.
        x: f64,
        /// To the left.
        y: f64,
        /// Up.
        z: f64,
    }

    /// A turn.
    Quaternion {
        /// Of the axis.
        x: f64,
        /// Of the axis.
        y: f64,
        /// Of the axis.
        z: f64,
        /// The cosine of half the angle.
        w: f64,
    }

    /// Place and turn.
    Pose {
        /// Where.
        position: Point,
        /// Which way round.
        orientation: Quaternion,
    }

    /// A pose in a frame, at a time.
    PoseStamped {
        /// When and in which frame.
        header: Header,
        /// It.
        pose: Pose,
    }

    /// A pose and how well it is known.
    PoseWithCovariance {
        /// It.
        pose: Pose,
        /// Of x, y, z and the turns about them.
        covariance: [[f64; 6]; 6],
    }

    /// A velocity.
    Twist {
        /// In metres a second.
        linear: Vector3,
        /// In radians a second.
        angular: Vector3,
    }

    /// A velocity of a frame, at a time.
    TwistStamped {
        /// When and of which frame.
        header: Header,
        /// It.
        twist: Twist,
    }

    /// A velocity and how well it is known.
    TwistWithCovariance {
        /// It.
        twist: Twist,
        /// Of x, y, z and the turns about them.
        covariance: [[f64; 6]; 6],
    }

    /// From one frame to another.
    Transform {
        /// Where the other's origin lies.
        translation: Vector3,
        /// How it is turned.
        rotation: Quaternion,
    }

    /// From one frame to another, at a time.
    TransformStamped {
        /// When, and the frame that it starts from.
        header: Header,
        /// The frame that it leads to.
        child_frame_id: String,
        /// It.
        transform: Transform,
    }
}

impl Quaternion {
    /// A turn to the left by `yaw` radians.
    pub fn from_yaw(yaw: f64) -> Self {
        let (z, w) = (yaw / 2.0).sin_cos();
        Self {
            x: 0.0,
            y: 0.0,
            z,
            w,
        }
    }

    /// The turn to the left in radians, -π to π. What is no turn (all zero) is none.
    pub fn yaw(&self) -> f64 {
        let Self { x, y, z, w } = self;
        (2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_yaw_goes_into_a_quaternion_and_comes_back() {
        for yaw in [-3.1, -0.5, 0.0, 1.0, 3.1] {
            assert!((Quaternion::from_yaw(yaw).yaw() - yaw).abs() < 1e-12);
        }
        assert_eq!(Quaternion::default().yaw(), 0.0);
    }
}
