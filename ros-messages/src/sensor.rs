//! `sensor_msgs`.

use crate::field::messages;
use crate::std_msgs::Header;

messages! { "sensor_msgs";
    /// A scan in a plane.
    LaserScan {
        /// When the first beam was taken, in the frame of the sensor.
        header: Header,
        /// Angle of the first beam, in radians to the left of ahead.
        angle_min: f32,
        /// Of the last.
        angle_max: f32,
        /// From one beam to the next.
        angle_increment: f32,
        /// Seconds from one beam to the next.
        time_increment: f32,
        /// Seconds from one scan to the next.
        scan_time: f32,
        /// The least range that means anything, in metres.
        range_min: f32,
        /// The largest.
        range_max: f32,
        /// In metres; infinite: nothing within reach; otherwise outside of the limits: no
        /// measurement.
        ranges: Vec<f32>,
        /// Of the echo, where the device tells.
        intensities: Vec<f32>,
    }

    /// A picture as a file.
    CompressedImage {
        /// When and in which frame.
        header: Header,
        /// Such as `png`.
        format: String,
        /// The file.
        data: Vec<u8>,
    }
}
