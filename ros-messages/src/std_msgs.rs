//! `builtin_interfaces` and `std_msgs`.

use crate::field::messages;

pub use time::{Duration, Time};

/// In a module of its own, for it has the name of Rust's.
pub mod text {
    use crate::field::messages;

    messages! { "std_msgs";
        /// Text.
        String {
            /// It.
            data: std::string::String,
        }
    }
}

mod time {
    use crate::field::messages;

    messages! { "builtin_interfaces";
        /// A point in time, since 1970 or since the simulation began.
        Time {
            /// Whole seconds.
            sec: i32,
            /// And nanoseconds, below 10⁹.
            nanosec: u32,
        }

        /// A span of time.
        Duration {
            /// Whole seconds.
            sec: i32,
            /// And nanoseconds, below 10⁹.
            nanosec: u32,
        }
    }

    impl Copy for Time {}

    impl Time {
        /// In nanoseconds; a time before the beginning is the beginning.
        pub fn nanoseconds(self) -> u64 {
            u64::try_from(self.sec).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanosec)
        }

        /// From nanoseconds, as far as the seconds reach.
        pub fn from_nanoseconds(nanoseconds: u64) -> Self {
            Self {
                sec: i32::try_from(nanoseconds / 1_000_000_000).unwrap_or(i32::MAX),
                nanosec: (nanoseconds % 1_000_000_000) as u32,
            }
        }
    }
}

messages! { "std_msgs";
    /// When and in which frame.
    Header {
        /// When the data was taken.
        stamp: Time,
        /// The frame of the coordinates.
        frame_id: String,
    }

    /// Yes or no.
    Bool {
        /// It.
        data: bool,
    }

    /// A colour, each part from 0 to 1.
    ColorRGBA {
        /// Red.
        r: f32,
        /// Green.
        g: f32,
        /// Blue.
        b: f32,
        /// Opacity.
        a: f32,
    }

    /// One dimension of an array.
    MultiArrayDimension {
        /// What it is.
        label: String,
        /// Elements along it.
        size: u32,
        /// Elements from one to the next.
        stride: u32,
    }

    /// The shape of an array.
    MultiArrayLayout {
        /// From the outermost on.
        dim: Vec<MultiArrayDimension>,
        /// Elements to skip.
        data_offset: u32,
    }

    /// Bytes.
    UInt8MultiArray {
        /// Empty for plain bytes.
        layout: MultiArrayLayout,
        /// They.
        data: Vec<u8>,
    }
}
