//! Meshes as STL files, as text or binary.

use super::SceneError;
use super::shape::{Point, Shape};

const FORMAT: &str = "STL";

/// Bytes before the triangles of a binary file, the last four of them their number.
const HEADER: usize = 84;
/// Bytes of a triangle: its normal, its corners and two more.
const TRIANGLE: usize = 50;

/// Whether it is such a file: by its beginning, its length or its ending.
pub(super) fn is_stl(bytes: &[u8], ending: &str) -> bool {
    bytes.starts_with(b"solid") || is_binary(bytes) || ending.eq_ignore_ascii_case("stl")
}

/// Whether it is as long as the number of triangles in it says. Some begin with `solid`,
/// too.
fn is_binary(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|count| count.checked_mul(TRIANGLE) == Some(bytes.len() - HEADER))
}

fn count(bytes: &[u8]) -> Option<usize> {
    let (header, _) = bytes.split_first_chunk::<HEADER>()?;
    let count = header.last_chunk::<4>()?;
    Some(u32::from_le_bytes(*count) as usize)
}

/// The triangles of a file, of all its solids.
///
/// # Errors
/// What is wrong, and where.
pub(super) fn from_stl(bytes: &[u8]) -> Result<Shape, SceneError> {
    let is_text = bytes.starts_with(b"solid") && !is_binary(bytes);
    match is_text {
        true => from_text(bytes),
        false => from_binary(bytes),
    }
    .map(Shape::Mesh)
}

fn from_binary(bytes: &[u8]) -> Result<Vec<[Point; 3]>, SceneError> {
    if !is_binary(bytes) {
        let bytes_of = |count: usize| HEADER as u64 + TRIANGLE as u64 * count as u64;
        let what = match count(bytes) {
            None => format!(
                "{} bytes; expected {HEADER} before the triangles",
                bytes.len()
            ),
            Some(count) => format!(
                "{count} triangles are {} bytes, and {} are there",
                bytes_of(count),
                bytes.len()
            ),
        };
        return Err(SceneError::broken(FORMAT, "the header", what));
    }
    let corner = |bytes: &[u8]| {
        let mut numbers = bytes.chunks_exact(4).map(|number| {
            let number = number.try_into().unwrap_or_default();
            f64::from(f32::from_le_bytes(number))
        });
        [0; 3].map(|_| numbers.next().unwrap_or(f64::NAN))
    };
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE);
    // The normal is not needed.
    let triangles = triangles.map(|it| [&it[12..24], &it[24..36], &it[36..48]].map(corner));
    Ok(triangles.collect())
}

fn from_text(bytes: &[u8]) -> Result<Vec<[Point; 3]>, SceneError> {
    let wrong =
        |line: usize, what: &str| Err(SceneError::broken(FORMAT, format!("line {line}"), what));
    let text = match str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let before = &bytes[..error.valid_up_to()];
            let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
            return wrong(line, "no text");
        }
    };
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    let mut last = 0;
    for (line, number) in text.lines().zip(1..) {
        last = number;
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
                let &[x, y, z] = &numbers[..] else {
                    return wrong(number, "expected `vertex` and three numbers");
                };
                corners.push([x, y, z]);
            }
            Some("endfacet") => {
                let &[a, b, c] = &corners[..] else {
                    return wrong(number, "expected three vertices before the end of a facet");
                };
                triangles.push([a, b, c]);
                corners.clear();
            }
            None | Some("solid" | "facet" | "outer" | "endloop" | "endsolid") => {}
            Some(_) => return wrong(number, "expected a line of a solid, a facet or a loop"),
        }
    }
    match corners.is_empty() {
        true => Ok(triangles),
        false => wrong(last, "ends within a facet; it was cut off"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::damage::assert_refused;

    const TEXT: &str = "solid one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
                        vertex 1 0 0\n   vertex 0 2.5e0 0\n  endloop\n endfacet\nendsolid one\n\
                        solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1\nvertex 1 0 1\n\
                        vertex 0 1 -1\nendloop\nendfacet\nendsolid\n";

    const TRIANGLES: [[Point; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.5, 0.0]],
        [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, -1.0]],
    ];

    fn binary() -> Vec<u8> {
        let mut bytes = b"solid though it is binary".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(2u32.to_le_bytes());
        for triangle in TRIANGLES {
            bytes.extend([0; 12]);
            let numbers = triangle.as_flattened().iter();
            bytes.extend(numbers.flat_map(|number| (*number as f32).to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_say_the_same_and_all_solids_count() {
        for bytes in [TEXT.as_bytes(), &binary()] {
            assert!(is_stl(bytes, ""));
            let Ok(Shape::Mesh(triangles)) = from_stl(bytes) else {
                panic!("{:?}", from_stl(bytes).err());
            };
            assert_eq!(triangles, TRIANGLES);
        }
    }

    #[test]
    fn a_damaged_file_is_refused_with_its_line_or_its_length() {
        let error = |bytes: &[u8]| from_stl(bytes).err().unwrap().to_string();
        assert_refused(
            TEXT,
            error,
            &[
                ("vertex 1 0 0", "vertex 1 0", "line 5 "),
                ("vertex 1 0 0", "vertex 1 O 0", "line 5 "),
                ("vertex 1 0 0", "", "line 8 "),
                ("outer loop", "inner loop", "line 3 "),
                ("endloop\nendfacet\nendsolid\n", "", "line 15 "),
            ],
        );
        let mut bytes = TEXT.as_bytes().to_vec();
        bytes[40] = 0xff;
        assert!(error(&bytes).contains("line 3 "));
        let mut bytes = binary();
        bytes[0] = b'S';
        bytes.pop();
        assert!(is_stl(&bytes, "STL") && !is_stl(&bytes, "dat"));
        assert!(error(&bytes).contains("2 triangles are 184 bytes, and 183 are there"));
        assert!(error(&bytes[..20]).contains("20 bytes"));
        bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(error(&bytes).contains("4294967295 triangles"));
    }
}
