//! What a field of a message is called in ROS, and the definition of a whole message.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// The type of a field.
pub trait Field {
    /// What a `.msg` file calls it.
    fn name() -> String;

    /// Adds the definitions that it stands on, each once: name and text.
    fn define(definitions: &mut Vec<(String, String)>) {
        let _ = definitions;
    }
}

/// A message that a topic can carry.
pub trait Message: Field + Serialize {
    /// The package, such as `geometry_msgs`.
    const PACKAGE: &'static str;
    /// The name in the package, such as `Twist`.
    const NAME: &'static str;

    /// The definition with those that it stands on, as recordings carry it (`ros2msg`).
    fn definition() -> String {
        let mut definitions = Vec::new();
        Self::define(&mut definitions);
        let mut parts = definitions.into_iter();
        let mut text = parts.next().map(|(_, text)| text).unwrap_or_default();
        for (name, part) in parts {
            text += &format!("{}\nMSG: {name}\n{part}", "=".repeat(80));
        }
        text
    }

    /// The bytes on the wire: little-endian CDR behind its header of four bytes.
    ///
    /// # Errors
    /// Serde's, for a list of more than 2³² elements.
    fn to_bytes(&self) -> Result<Vec<u8>, cdr_encoding::Error>
    where
        Self: Sized,
    {
        let mut bytes = vec![0, 1, 0, 0];
        bytes.extend(cdr_encoding::to_vec::<_, byteorder::LittleEndian>(self)?);
        Ok(bytes)
    }

    /// A message out of its bytes, of either byte order.
    ///
    /// # Errors
    /// Bytes that end too early, or text that is none.
    fn from_bytes(bytes: &[u8]) -> Result<Self, cdr_encoding::Error>
    where
        Self: DeserializeOwned,
    {
        match bytes {
            [_, order, _, _, body @ ..] if order & 1 == 0 => {
                cdr_encoding::from_bytes::<_, byteorder::BigEndian>(body)
            }
            [_, _, _, _, body @ ..] => cdr_encoding::from_bytes::<_, byteorder::LittleEndian>(body),
            _ => cdr_encoding::from_bytes::<_, byteorder::LittleEndian>(&[]),
        }
        .map(|(message, _)| message)
    }
}

macro_rules! plain {
    ($($rust:ty = $ros:literal),*) => {
        $(impl Field for $rust {
            fn name() -> String {
                $ros.to_owned()
            }
        })*
    };
}

plain!(
    bool = "bool",
    u8 = "uint8",
    i8 = "int8",
    u32 = "uint32",
    i32 = "int32"
);
plain!(f32 = "float32", f64 = "float64", String = "string");

impl<T: Field> Field for Vec<T> {
    fn name() -> String {
        T::name() + "[]"
    }

    fn define(definitions: &mut Vec<(String, String)>) {
        T::define(definitions);
    }
}

/// Of a square matrix ROS knows its elements, row by row.
impl<const N: usize> Field for [[f64; N]; N] {
    fn name() -> String {
        format!("float64[{}]", N * N)
    }
}

/// Declares messages of one package.
macro_rules! messages {
    ($package:literal; $(
        $(#[$doc:meta])*
        $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* }
    )*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl $crate::Field for $name {
            fn name() -> ::std::string::String {
                concat!($package, "/", stringify!($name)).to_owned()
            }

            fn define(definitions: &mut Vec<(::std::string::String, ::std::string::String)>) {
                let name = <Self as $crate::Field>::name();
                if definitions.iter().any(|(known, _)| *known == name) {
                    return;
                }
                let mut text = ::std::string::String::new();
                $(
                    text += &<$type as $crate::Field>::name();
                    text += " ";
                    text += stringify!($field).trim_start_matches("r#");
                    text += "\n";
                )*
                definitions.push((name, text));
                $(<$type as $crate::Field>::define(definitions);)*
            }
        }

        impl $crate::Message for $name {
            const PACKAGE: &'static str = $package;
            const NAME: &'static str = stringify!($name);
        }
    )*};
}

pub(crate) use messages;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{PoseStamped, Twist, Vector3};
    use crate::nav::{MapMetaData, OccupancyGrid};
    use crate::sensor::LaserScan;
    use crate::std_msgs::{Header, Time};
    use crate::visualization::Marker;

    #[test]
    fn the_definition_of_a_message_is_that_of_ros() {
        assert_eq!(
            Twist::definition(),
            format!(
                "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n{}\n\
                 MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
                "=".repeat(80)
            )
        );
    }

    #[test]
    fn parts_that_are_used_twice_are_defined_once() {
        let definition = Marker::definition();
        assert_eq!(definition.matches("MSG: geometry_msgs/Point\n").count(), 1);
        assert!(definition.contains("\nint32 type\n"), "{definition}");
        assert!(PoseStamped::definition().starts_with("std_msgs/Header header\n"));
    }

    #[test]
    fn a_twist_is_six_doubles() {
        let twist = Twist {
            linear: Vector3 {
                x: 0.5,
                ..Vector3::default()
            },
            angular: Vector3 {
                z: -1.0,
                ..Vector3::default()
            },
        };
        let mut expected = vec![0, 1, 0, 0];
        for value in [0.5_f64, 0.0, 0.0, 0.0, 0.0, -1.0] {
            expected.extend(value.to_le_bytes());
        }
        assert_eq!(twist.to_bytes().unwrap(), expected);
    }

    #[test]
    fn a_scan_has_its_strings_counted_and_its_numbers_aligned() {
        let scan = LaserScan {
            header: Header {
                stamp: Time { sec: 1, nanosec: 2 },
                frame_id: "ab".to_owned(),
            },
            range_max: 4.0,
            ranges: vec![1.0, f32::INFINITY],
            ..LaserScan::default()
        };
        #[rustfmt::skip]
        let expected = [
            0, 1, 0, 0,
            1, 0, 0, 0, 2, 0, 0, 0,
            3, 0, 0, 0, b'a', b'b', 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
            0, 0, 128, 64,
            2, 0, 0, 0, 0, 0, 128, 63, 0, 0, 128, 127,
            0, 0, 0, 0,
        ];
        assert_eq!(scan.to_bytes().unwrap(), expected);
        assert_eq!(LaserScan::from_bytes(&expected).unwrap(), scan);
        for end in 0..expected.len() {
            assert!(LaserScan::from_bytes(&expected[..end]).is_err(), "{end}");
        }
    }

    #[test]
    fn the_header_tells_the_order_of_bytes() {
        let big = [0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 3];
        let time = Time {
            sec: 0x0102,
            nanosec: 3,
        };
        assert_eq!(Time::from_bytes(&big).unwrap(), time);
    }

    #[test]
    fn a_map_of_two_cells() {
        let grid = OccupancyGrid {
            info: MapMetaData {
                resolution: 0.25,
                width: 2,
                height: 1,
                ..MapMetaData::default()
            },
            data: vec![100, -1],
            ..OccupancyGrid::default()
        };
        let bytes = grid.to_bytes().unwrap();
        // The stamp, an empty name, the time of loading, resolution, width, height; the
        // origin's seven doubles at a multiple of 8; the count and the cells.
        assert_eq!(bytes[4 + 12..4 + 13], [0], "the name ends");
        assert_eq!(bytes[4 + 24..4 + 28], 0.25_f32.to_le_bytes());
        assert_eq!(bytes[4 + 96..], [2, 0, 0, 0, 100, 255]);
    }
}
