//! Point clouds and meshes as PLY files, as text or in either order of bytes. A file with
//! faces is a mesh.

use std::io::ErrorKind;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult,
};

use super::SceneError;
use super::error::MOST_POINTS;
use super::shape::{Point, Shape};
use crate::excerpt::excerpt;

const FORMAT: &str = "PLY";
const HEADER: &str = "the header";

/// Whether a file begins like one.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    [&b"ply\n"[..], b"ply\r"]
        .iter()
        .any(|it| bytes.starts_with(it))
}

/// What stands in a file: triangles if it has faces, else points.
///
/// # Errors
/// What is wrong, and where. A header is believed as far as there are bytes behind it.
pub(super) fn from_ply(bytes: &[u8]) -> Result<Shape, SceneError> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader);
    let header = header.map_err(|error| wrong(HEADER, &error))?;
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (name, element) in &header.elements {
        check(element, reader.get_ref().len())?;
        match name.as_str() {
            "vertex" => points = elements::<Vertex>(&mut reader, element, &header)?,
            "face" => faces = elements::<Face>(&mut reader, element, &header)?,
            _ => _ = elements::<Skipped>(&mut reader, element, &header)?,
        }
    }
    let points: Vec<Point> = points.into_iter().map(|vertex| vertex.0).collect();
    match faces.is_empty() {
        true => Ok(Shape::Cloud {
            points,
            viewpoint: None,
        }),
        false => triangles(&points, &faces).map(Shape::Mesh),
    }
}

/// Whether so many elements can stand in so many bytes, before memory is taken for them.
fn check(element: &ElementDef, bytes: usize) -> Result<(), SceneError> {
    let ElementDef { name, count, .. } = element;
    if *count > MOST_POINTS {
        return Err(SceneError::TooMany {
            found: *count as u64,
            things: "elements of a kind",
        });
    }
    let refuse = |what: String| Err(SceneError::broken(FORMAT, HEADER, what));
    match element.properties.is_empty() {
        _ if *count > bytes => refuse(format!(
            "{count} elements {}, behind which are {bytes} bytes",
            excerpt(name)
        )),
        true if *count > 0 => refuse(format!("elements {} without a property", excerpt(name))),
        _ => Ok(()),
    }
}

fn elements<E: PropertyAccess>(
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<Vec<E>, SceneError> {
    let read = Parser::<E>::new().read_payload_for_element(reader, element, header);
    read.map_err(|error| {
        let place = match (header.encoding, error.line()) {
            (Encoding::Ascii, Some(line)) => format!("line {line}"),
            _ => format!("an element {}", excerpt(&element.name)),
        };
        wrong(&place, &error)
    })
}

/// A polygon is as many triangles about its first corner.
fn triangles(points: &[Point], faces: &[Face]) -> Result<Vec<[Point; 3]>, SceneError> {
    let mut triangles = Vec::new();
    for (Face(corners), number) in faces.iter().zip(0u32..) {
        let corner = |index: &u32| {
            let point = points.get(*index as usize);
            let what = format!("no vertex {index}, there are {}", points.len());
            point
                .copied()
                .ok_or_else(|| SceneError::broken(FORMAT, format!("face {number}"), what))
        };
        let [first, rest @ ..] = &corners[..] else {
            continue;
        };
        for pair in rest.windows(2) {
            triangles.push([corner(first)?, corner(&pair[0])?, corner(&pair[1])?]);
        }
        if triangles.len() > MOST_POINTS {
            return Err(SceneError::TooMany {
                found: triangles.len() as u64,
                things: "triangles",
            });
        }
    }
    Ok(triangles)
}

fn wrong(place: &str, error: &ParseError) -> SceneError {
    let is_header = place == HEADER;
    let place = match error.line() {
        Some(line) if is_header => format!("line {line}"),
        _ => place.to_owned(),
    };
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => "ends in the middle; it was cut off".into(),
        // The innermost reason stands last, in words for elements alone.
        _ => {
            let words = error.to_string();
            match words.rsplit_once("Error: ") {
                Some((_, reason)) if !is_header => excerpt(reason.trim()),
                _ => "expected a line of the header of a PLY file".into(),
            }
        }
    };
    SceneError::broken(FORMAT, place, what)
}

/// An element that is passed over.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

struct Vertex(Point);

impl PropertyAccess for Vertex {
    /// What has no place is skipped as a point that was not measured is.
    fn new() -> Self {
        Self([f64::NAN; 3])
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        let number = match value {
            Property::Double(number) => Some(number),
            _ => value.to_f32_lossy().map(f64::from),
        };
        let Some(number) = number else {
            return PropertyAccessResult::UnsupportedType;
        };
        self.0[axis] = number;
        PropertyAccessResult::Set
    }
}

/// The numbers of its vertices.
struct Face(Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !["vertex_index", "vertex_indices"].contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        let Some(corners) = value.to_u32_list() else {
            return PropertyAccessResult::UnsupportedType;
        };
        self.0 = corners;
        PropertyAccessResult::Set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::damage::assert_refused;

    /// A square of two kinds of faces, and something that is passed over.
    fn text(format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\ncomment a square\nelement vertex 4\nproperty float x\n\
             property double y\nproperty uchar red\nproperty short z\nelement edge 1\n\
             property int vertex1\nelement face 2\nproperty list uchar int vertex_indices\n\
             end_header\n"
        )
    }

    const POINTS: [Point; 4] = [
        [0.0, 0.0, 2.0],
        [1.5, 0.0, 2.0],
        [1.5, 1.0, 2.0],
        [0.0, 1.0, 2.0],
    ];

    fn ascii() -> String {
        let rows = POINTS.map(|[x, y, z]| format!("{x} {y} 200 {z}\n"));
        let (head, rows) = (text("ascii"), rows.concat());
        format!("{head}{rows}3\n4 0 1 2 3\n3 0 1 3\n")
    }

    fn binary(is_little: bool) -> Vec<u8> {
        let format = match is_little {
            true => "binary_little_endian",
            false => "binary_big_endian",
        };
        let mut bytes = text(format).into_bytes();
        let mut push = |number: &[u8]| match is_little {
            true => bytes.extend(number),
            false => bytes.extend(number.iter().rev()),
        };
        for [x, y, z] in POINTS {
            push(&(x as f32).to_le_bytes());
            push(&y.to_le_bytes());
            push(&[200]);
            push(&(z as i16).to_le_bytes());
        }
        push(&3i32.to_le_bytes());
        for face in [&[0i32, 1, 2, 3][..], &[0, 1, 3]] {
            push(&[face.len() as u8]);
            face.iter().for_each(|corner| push(&corner.to_le_bytes()));
        }
        bytes
    }

    #[test]
    fn all_three_encodings_say_the_same() {
        let [a, b, c, d] = POINTS;
        for bytes in [ascii().into_bytes(), binary(true), binary(false)] {
            assert!(is_ply(&bytes));
            let Ok(Shape::Mesh(triangles)) = from_ply(&bytes) else {
                panic!("{:?}", from_ply(&bytes).err());
            };
            assert_eq!(triangles, [[a, b, c], [a, c, d], [a, b, d]]);
        }
    }

    #[test]
    fn without_faces_it_is_a_cloud() {
        let text = "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\n\
                    property float y\r\nproperty float z\r\nend_header\r\n1 -2 3e-1\r\n";
        let Ok(Shape::Cloud { points, viewpoint }) = from_ply(text.as_bytes()) else {
            panic!("no cloud");
        };
        assert_eq!((points[0][0], points[0][1], viewpoint), (1.0, -2.0, None));
        assert!((points[0][2] - 0.3).abs() < 1e-6);
    }

    #[test]
    fn a_header_is_believed_only_so_far() {
        let error = |bytes: &[u8]| from_ply(bytes).err().unwrap().to_string();
        assert_refused(
            &ascii(),
            error,
            &[
                ("vertex 4", "vertex 99999999999", "at most 16777216"),
                ("vertex 4", "vertex 16000000", "behind which are"),
                ("vertex 4", "vertex 5", "line 18 "),
                ("face 2", "face 3", "cut off"),
                (
                    "4 0 1 2 3",
                    "4 0 1 2 4",
                    "face 0 of the PLY file: no vertex 4",
                ),
                ("4 0 1 2 3", "4 0 1 2 -1", "line 19 "),
                ("4 0 1 2 3", "5 0 1 2 3", "line 19 "),
                ("1.5 0 200 2", "1.5 0 200 two", "line 15 "),
                (
                    "property int vertex1\n",
                    "",
                    "elements edge without a property",
                ),
                ("property short z", "property shirt z", "line 8 "),
                ("ascii", "morse", "line 2 "),
                ("end_header\n", "", "line 13 "),
            ],
        );
        let whole = binary(true);
        let cut = error(&whole[..whole.len() - 1]);
        assert!(
            cut.contains("an element face") && cut.contains("cut off"),
            "{cut}"
        );
        let mut long = whole.clone();
        let at = long.len() - 13;
        long[at] = 255;
        assert!(error(&long).contains("cut off"));
    }
}
