//! `tf2_msgs`.

use crate::field::messages;
use crate::geometry::TransformStamped;

messages! { "tf2_msgs";
    /// Transforms between frames.
    TFMessage {
        /// In any order.
        transforms: Vec<TransformStamped>,
    }
}
