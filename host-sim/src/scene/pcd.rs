//! Point clouds as PCD files of the Point Cloud Library, in all three of its encodings.

use pcd_rs::{DataKind, DynReader, Field, FieldDef, PcdMeta, ValueKind};

use super::SceneError;
use super::error::{MOST_BYTES, MOST_POINTS};
use super::shape::Shape;
use crate::excerpt::excerpt;

const FORMAT: &str = "PCD";

/// Whether a file begins like one: with its version or its fields, after comments.
pub(super) fn is_pcd(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|&byte| byte == b'\n').take(100);
    let first = lines.find(|line| !line.starts_with(b"#") && !line.trim_ascii().is_empty());
    bytes.starts_with(b"# .PCD")
        || first.is_some_and(|line| line.starts_with(b"VERSION ") || line.starts_with(b"FIELDS "))
}

/// The points of a file, and where it says that they were seen from.
///
/// # Errors
/// What is wrong, and where. A header is believed as far as there are bytes behind it.
pub(super) fn from_pcd(bytes: &[u8]) -> Result<Shape, SceneError> {
    let mut data = bytes;
    let meta = PcdMeta::from_reader(&mut data);
    let meta = meta.map_err(|error| wrong("the header", &error))?;
    let header = &bytes[..bytes.len() - data.len()];
    check(&meta, data)?;
    let fields = meta.field_defs.iter().filter(|field| !field.is_padding());
    let fields: Vec<_> = fields.collect();
    let place = |name: &str| {
        let is_single =
            |it: &FieldDef| it.count == 1 && matches!(it.kind, ValueKind::F32 | ValueKind::F64);
        let place = (fields.iter()).position(|it| it.name == name && is_single(it));
        place.ok_or_else(|| {
            let what = format!("no field {name} of one float (TYPE F, COUNT 1)");
            SceneError::broken(FORMAT, "the header", what)
        })
    };
    let axes = [place("x")?, place("y")?, place("z")?];
    let first_line = 1 + header.iter().filter(|&&byte| byte == b'\n').count();
    let reader = DynReader::from_bytes(bytes).map_err(|error| wrong("the data", &error))?;
    let mut points = Vec::new();
    for (record, number) in reader.zip(0..) {
        let place = || match meta.data {
            DataKind::Ascii => format!("line {}", first_line + number),
            _ => format!("point {number}"),
        };
        let record = record.map_err(|error| wrong(&place(), &error))?;
        let mut point = [0.0; 3];
        for (axis, at) in point.iter_mut().zip(axes) {
            *axis = record.0.get(at).and_then(number_of).ok_or_else(|| {
                SceneError::broken(FORMAT, place(), "x, y and z are no single floats (TYPE F)")
            })?;
        }
        points.push(point);
    }
    let says_from_where = header
        .split(|&byte| byte == b'\n')
        .any(|line| line.starts_with(b"VIEWPOINT"));
    let viewpoint = [meta.viewpoint.tx, meta.viewpoint.ty, meta.viewpoint.tz];
    Ok(Shape::Cloud {
        points,
        viewpoint: says_from_where.then_some(viewpoint),
    })
}

/// Whether there are as many bytes as the header says, before memory is taken for them.
fn check(meta: &PcdMeta, data: &[u8]) -> Result<(), SceneError> {
    let refuse = |what: String| Err(SceneError::broken(FORMAT, "the header", what));
    let (points, bytes) = (meta.num_points, data.len() as u64);
    if points > MOST_POINTS as u64 {
        return Err(SceneError::TooMany {
            found: points,
            things: "points",
        });
    }
    let of_point = meta.field_defs.iter().try_fold(0u64, |sum, field| {
        let bytes = field.count.checked_mul(field.kind.byte_size() as u64)?;
        sum.checked_add(bytes)
    });
    let of_point = of_point.filter(|&bytes| bytes <= MOST_BYTES);
    let Some(of_point) = of_point else {
        return refuse("a point has more bytes than a file may have".into());
    };
    let wanted = points * of_point;
    match meta.data {
        // A number and a space each, at least.
        DataKind::Ascii if points > bytes => refuse(format!("{points} points, {bytes} bytes")),
        DataKind::Binary if wanted > bytes => refuse(format!(
            "{points} points of {of_point} bytes, of which {bytes} bytes are there"
        )),
        DataKind::BinaryCompressed => {
            let Some((sizes, packed)) = data.split_first_chunk::<8>() else {
                return refuse("no sizes of the compressed data behind it".into());
            };
            let [a, b, c, d, sizes @ ..] = *sizes;
            let there = u64::from(u32::from_le_bytes([a, b, c, d]));
            let unpacked = u64::from(u32::from_le_bytes(sizes));
            if unpacked != wanted || unpacked > MOST_BYTES {
                return refuse(format!(
                    "{points} points of {of_point} bytes, but {unpacked} bytes when unpacked; \
                     expected the same, and at most {} MiB",
                    MOST_BYTES >> 20
                ));
            }
            match there > packed.len() as u64 {
                true => refuse(format!(
                    "{there} compressed bytes, of which {} are there",
                    packed.len()
                )),
                false => Ok(()),
            }
        }
        _ => Ok(()),
    }
}

fn number_of(field: &Field) -> Option<f64> {
    let single = || field.to_value::<f32>().map(f64::from);
    single().or_else(|| field.to_value::<f64>())
}

fn wrong(place: &str, error: &pcd_rs::Error) -> SceneError {
    let words = error.to_string();
    let first = words.lines().next().unwrap_or_default();
    SceneError::broken(FORMAT, place, excerpt(first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::damage::assert_refused;

    const POINTS: [[f32; 3]; 3] = [[0.5, -1.25, 2.0], [f32::NAN; 3], [3.0, 4.0, 5.0]];

    /// With a field and padding before the coordinates.
    fn header(data: &str, points: usize) -> Vec<u8> {
        format!(
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS i _ x y z\n\
             SIZE 2 1 4 4 4\nTYPE U U F F F\nCOUNT 1 3 1 1 1\nWIDTH {points}\nHEIGHT 1\n\
             VIEWPOINT 1 2 3 1 0 0 0\nPOINTS {points}\nDATA {data}\n"
        )
        .into_bytes()
    }

    fn ascii() -> Vec<u8> {
        let rows = POINTS.map(|[x, y, z]| format!("7 0 0 0 {x} {y} {z}\n"));
        [header("ascii", 3), rows.concat().into_bytes()].concat()
    }

    fn binary() -> Vec<u8> {
        let row = |point: [f32; 3]| {
            let numbers = point.map(f32::to_le_bytes).concat();
            [&[7, 0, 9, 9, 9][..], &numbers].concat()
        };
        [header("binary", 3), POINTS.map(row).concat()].concat()
    }

    /// Field by field, as it is compressed: here into literal runs alone.
    fn compressed() -> Vec<u8> {
        let mut columns = [7, 0].repeat(3);
        columns.extend([9; 9]);
        for axis in 0..3 {
            columns.extend(POINTS.map(|point| point[axis].to_le_bytes()).concat());
        }
        let runs = columns.chunks(32);
        let packed = runs.flat_map(|run| [&[run.len() as u8 - 1], run].concat());
        let packed: Vec<u8> = packed.collect();
        let sizes = [packed.len(), columns.len()].map(|size| (size as u32).to_le_bytes());
        [header("binary_compressed", 3), sizes.concat(), packed].concat()
    }

    #[test]
    fn all_three_encodings_say_the_same() {
        for bytes in [ascii(), binary(), compressed()] {
            assert!(is_pcd(&bytes));
            let Ok(Shape::Cloud { points, viewpoint }) = from_pcd(&bytes) else {
                panic!("{}", from_pcd(&bytes).err().unwrap());
            };
            assert_eq!(viewpoint, Some([1.0, 2.0, 3.0]));
            assert_eq!((points[0], points[2]), ([0.5, -1.25, 2.0], [3.0, 4.0, 5.0]));
            assert!(points[1][0].is_nan() && points.len() == 3);
        }
        let text = String::from_utf8(ascii()).unwrap();
        let silent = text.replace("VIEWPOINT 1 2 3 1 0 0 0\n", "");
        let read = from_pcd(silent.as_bytes());
        assert!(matches!(
            read,
            Ok(Shape::Cloud {
                viewpoint: None,
                ..
            })
        ));
    }

    #[test]
    fn a_header_is_believed_only_so_far() {
        let error = |bytes: &[u8]| from_pcd(bytes).err().unwrap().to_string();
        let ascii = String::from_utf8(ascii()).unwrap();
        assert_refused(
            &ascii,
            error,
            &[
                ("POINTS 3", "POINTS 4000000000", "at most 16777216"),
                ("POINTS 3", "POINTS 16000000", "16000000 points, "),
                ("POINTS 3", "POINTS 4", "line 15 "),
                ("7 0 0 0 3 4 5", "7 0 0 0 3 4", "line 14 "),
                ("7 0 0 0 3 4 5", "7 0 0 0 3 4 z", "line 14 "),
                (
                    "COUNT 1 3",
                    "COUNT 1 18446744073709551615",
                    "more bytes than",
                ),
                ("TYPE U U F", "TYPE U U I", "TYPE F"),
                ("_ x y z", "_ x y w", "no field z"),
                ("POINTS 3\n", "", "POINTS"),
                ("ascii", "morse", "DATA"),
            ],
        );
        let binary = binary();
        assert!(error(&binary[..binary.len() - 1]).contains("3 points of 17 bytes"));
        let whole = compressed();
        let sizes = header("binary_compressed", 3).len();
        assert!(error(&whole[..whole.len() - 1]).contains("compressed bytes"));
        assert!(error(&whole[..sizes + 3]).contains("no sizes"));
        for (at, words) in [(sizes, "compressed bytes"), (sizes + 4, "when unpacked")] {
            let mut wrong = whole.clone();
            wrong[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
            assert!(error(&wrong).contains(words), "{words}: {}", error(&wrong));
        }
        let mut wrong = whole;
        wrong[sizes + 8] = 255;
        assert!(error(&wrong).contains("the data"), "{}", error(&wrong));
    }
}
