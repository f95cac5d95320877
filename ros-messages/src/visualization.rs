//! `visualization_msgs`, as of ROS 2 Humble and later.

use crate::field::messages;
use crate::geometry::{Point, Pose, Vector3};
use crate::sensor::CompressedImage;
use crate::std_msgs::{ColorRGBA, Duration, Header};

messages! { "visualization_msgs";
    /// A place on a texture.
    UVCoordinate {
        /// From the left, 0 to 1.
        u: f32,
        /// From below, 0 to 1.
        v: f32,
    }

    /// A mesh as a file.
    MeshFile {
        /// Its name.
        filename: String,
        /// The file.
        data: Vec<u8>,
    }

    /// Something to draw.
    Marker {
        /// When and in which frame.
        header: Header,
        /// With the number, what a later marker replaces.
        ns: String,
        /// See `ns`.
        id: i32,
        /// [`CUBE_LIST`](Self::CUBE_LIST) and the like.
        r#type: i32,
        /// [`ADD`](Self::ADD) or [`DELETE_ALL`](Self::DELETE_ALL).
        action: i32,
        /// Where the points' origin lies.
        pose: Pose,
        /// Sides in metres.
        scale: Vector3,
        /// Of all points.
        color: ColorRGBA,
        /// How long it stays; 0 for ever.
        lifetime: Duration,
        /// Whether it moves with its frame.
        frame_locked: bool,
        /// The places of a list.
        points: Vec<Point>,
        /// Of each point, or none.
        colors: Vec<ColorRGBA>,
        /// Not used here.
        texture_resource: String,
        /// Not used here.
        texture: CompressedImage,
        /// Not used here.
        uv_coordinates: Vec<UVCoordinate>,
        /// Of a marker that is a text.
        text: String,
        /// Not used here.
        mesh_resource: String,
        /// Not used here.
        mesh_file: MeshFile,
        /// Not used here.
        mesh_use_embedded_materials: bool,
    }

    /// Markers that belong together.
    MarkerArray {
        /// They.
        markers: Vec<Marker>,
    }
}

impl Marker {
    /// A list of boxes.
    pub const CUBE_LIST: i32 = 6;
    /// Draws it.
    pub const ADD: i32 = 0;
    /// Removes all of its namespace.
    pub const DELETE_ALL: i32 = 3;
}
