//! Elevation models as GeoTIFF: one band of numbers, the side of a cell in metres in
//! `ModelPixelScale`, gaps as `GDAL_NODATA`.

use std::io::Cursor;

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::file::{TerrainError, fitting};
use super::relief::from_metres;
use super::{Terrain, TerrainOptions};
use crate::options::OptionError;

/// Most bytes of the pixels of a file: 512×512 doubles, and tiles beyond its edges.
const MOST_BYTES: usize = 16 << 20;

/// How far the sides of a cell may differ, as a share.
const SLACK: f64 = 1e-3;

/// Keys of the `GeoKeyDirectory`: the kind of model, and the value of it that counts in
/// degrees.
const MODEL: u16 = 1024;
const DEGREES: u16 = 2;

/// Whether a file begins like a TIFF, in either order of bytes, BigTIFF included.
pub(super) fn is_tiff(bytes: &[u8]) -> bool {
    let beginnings = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    beginnings.iter().any(|it| bytes.starts_with(*it))
}

fn wrong(what: impl Into<String>) -> TerrainError {
    TerrainError::Tiff(what.into())
}

impl From<tiff::TiffError> for TerrainError {
    fn from(error: tiff::TiffError) -> Self {
        let words = crate::excerpt::excerpt(&error.to_string());
        wrong(format!("{words}; copy it again or export it again"))
    }
}

/// The terrain of a file: its cells are columns, and its lowest height is 0.
pub(super) fn from_tiff(bytes: &[u8], options: &TerrainOptions) -> Result<Terrain, TerrainError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_BYTES;
    limits.intermediate_buffer_size = MOST_BYTES;
    let mut file = Decoder::new(Cursor::new(bytes))?.with_limits(limits);
    let extent = fitting(file.dimensions()?)?;
    match file.colortype()? {
        ColorType::Gray(_) => {}
        _ => {
            return Err(wrong(
                "it has several bands; expected one of heights: `gdal_translate -b 1 IN OUT.tif`",
            ));
        }
    }
    let cell = cell(&mut file, options)?;
    let nothing = match file.find_tag(Tag::GdalNodata)? {
        None => None,
        Some(value) => {
            let text = value.into_string()?;
            let text = text.trim_matches(|it: char| it == '\0' || it.is_whitespace());
            let number = text.parse::<f64>().ok();
            Some(number.ok_or_else(|| wrong("its GDAL_NODATA is no number"))?)
        }
    };
    let unit = options.metres_per_level.unwrap_or(1.0);
    let metres = numbers(file.read_image()?)?;
    let (cells, width) = (extent.cells() as usize, usize::from(extent.width));
    if metres.len() != cells {
        return Err(wrong(format!("{} heights for {cells} cells", metres.len())));
    }
    for (number, at) in metres.iter().zip(0..) {
        // As text a number of four bytes has other digits than as one of eight.
        let is_gap = |gap: f64| *number == gap || *number as f32 == gap as f32;
        if !number.is_finite() || nothing.is_some_and(is_gap) {
            let (x, y) = (at % width, at / width);
            return Err(wrong(format!(
                "a gap (NODATA) in column {x}, row {y}; expected heights everywhere: fill the \
                 gaps, for example with `gdal_fillnodata`, or cut a part out"
            )));
        }
    }
    let metres: Vec<f64> = metres.iter().map(|number| number * unit).collect();
    from_metres(extent, &metres, cell)
}

/// Side of a cell in metres: the file's, or else what was said.
fn cell(file: &mut Decoder<Cursor<&[u8]>>, options: &TerrainOptions) -> Result<f64, TerrainError> {
    if let Some(keys) = file.find_tag(Tag::GeoKeyDirectoryTag)? {
        // Behind a head of four, four numbers a key: its name, where it stands, how many
        // values it has, its value.
        let keys = keys.into_u16_vec()?;
        let mut keys = keys.chunks_exact(4).skip(1);
        if keys.any(|key| key[0] == MODEL && key[1] == 0 && key[3] == DEGREES) {
            return Err(wrong(
                "its cells are degrees wide; expected metres: `gdalwarp -t_srs EPSG:CODE IN \
                 OUT.tif` with the code of a projection, such as 326 and the number of a UTM zone",
            ));
        }
    }
    let scale = match file.find_tag(Tag::ModelPixelScaleTag)? {
        None => None,
        Some(scale) => Some(scale.into_f64_vec()?),
    };
    match (scale.as_deref(), options.metres_per_cell) {
        (None, Some(cell)) => Ok(cell),
        (None, None) => Err(TerrainError::NoCell),
        (Some(_), Some(_)) => Err(OptionError::DoesNotApply {
            option: "--metres-per-cell",
            what: "the file, which says how wide its cells are",
        }
        .into()),
        (Some(&[x, y, ..]), None) if x > 0.0 && x.is_finite() => {
            match (y.abs() - x).abs() <= SLACK * x {
                true => Ok(x),
                false => Err(wrong(format!(
                    "its cells are {x} m wide and {} m long; expected squares: `gdalwarp -tr {x} \
                     {x} IN OUT.tif`",
                    y.abs()
                ))),
            }
        }
        (Some(_), None) => Err(wrong("its ModelPixelScale is no width above 0")),
    }
}

fn numbers(pixels: DecodingResult) -> Result<Vec<f64>, TerrainError> {
    fn of<T: Into<f64>>(numbers: Vec<T>) -> Vec<f64> {
        numbers.into_iter().map(Into::into).collect()
    }
    Ok(match pixels {
        DecodingResult::U8(numbers) => of(numbers),
        DecodingResult::U16(numbers) => of(numbers),
        DecodingResult::U32(numbers) => of(numbers),
        DecodingResult::I8(numbers) => of(numbers),
        DecodingResult::I16(numbers) => of(numbers),
        DecodingResult::I32(numbers) => of(numbers),
        DecodingResult::F32(numbers) => of(numbers),
        DecodingResult::F64(numbers) => of(numbers),
        _ => {
            return Err(wrong(
                "its numbers have 64 or 16 bits in a form that is not read; expected floats or \
                 integers: `gdal_translate -ot Float32 IN OUT.tif`",
            ));
        }
    })
}

#[cfg(test)]
mod tests {
    use planner_core::Cell;
    use tiff::encoder::{TiffEncoder, TiffValue, colortype};

    use super::*;

    /// A file of 3×2 numbers with some tags.
    fn file<C: colortype::ColorType>(numbers: &[C::Inner], scale: &[f64], gap: &str) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut image = encoder.new_image::<C>(3, 2).unwrap();
        let tags = image.encoder();
        if !scale.is_empty() {
            tags.write_tag(Tag::ModelPixelScaleTag, scale).unwrap();
        }
        if !gap.is_empty() {
            tags.write_tag(Tag::GdalNodata, gap).unwrap();
        }
        image.write_data(numbers).unwrap();
        bytes.into_inner()
    }

    fn read(bytes: &[u8], options: &TerrainOptions) -> Result<Terrain, String> {
        assert!(is_tiff(bytes));
        Terrain::from_bytes_with(bytes, "tif", options).map_err(|error| error.to_string())
    }

    fn quarters(terrain: &Terrain) -> Vec<u8> {
        let height = |cell: Cell| terrain.height(cell).unwrap().0;
        terrain.cells().map(height).collect()
    }

    #[test]
    fn heights_are_metres_over_the_lowest_whatever_the_numbers_are() {
        let none = TerrainOptions::default();
        let heights = [100i16, 101, 102, 104, 100, 120];
        let scale = [2.0, 2.0, 0.0];
        let floats = heights.map(f32::from);
        let integers = file::<colortype::GrayI16>(&heights, &scale, "-9999");
        let floats = file::<colortype::Gray32Float>(&floats, &scale, " -9999 ");
        for bytes in [integers, floats] {
            let terrain = read(&bytes, &none).unwrap();
            assert_eq!(quarters(&terrain), [0, 2, 4, 8, 0, 40]);
            assert_eq!(terrain.scale().unwrap().cell, 2.0);
        }
        let bare = file::<colortype::GrayI16>(&heights, &[], "");
        let said = TerrainOptions {
            metres_per_cell: Some(1.0),
            metres_per_level: Some(0.25),
        };
        assert_eq!(quarters(&read(&bare, &said).unwrap()), [0, 1, 2, 4, 0, 20]);
    }

    #[test]
    fn what_is_no_square_metre_grid_without_gaps_is_refused() {
        let none = TerrainOptions::default();
        let heights = [1.0f32, 2.0, 3.0, 4.0, -3.4e38, 6.0];
        let of = |scale: &[f64], gap| file::<colortype::Gray32Float>(&heights, scale, gap);
        let square = [1.0, 1.0, 0.0];
        let cell = TerrainOptions {
            metres_per_cell: Some(1.0),
            ..none
        };
        let whole = of(&square, "");
        for (bytes, options, words) in [
            (of(&square, "-3.4e38"), &none, "column 1, row 1"),
            (of(&square, "nothing"), &none, "GDAL_NODATA"),
            (of(&square, ""), &none, "over the lowest"),
            (of(&[1.0, 1.1, 0.0], ""), &none, "1 m wide and 1.1 m long"),
            (of(&[0.0, 0.0, 0.0], ""), &none, "ModelPixelScale"),
            (of(&[], ""), &none, "--metres-per-cell"),
            (of(&square, ""), &cell, "--metres-per-cell does not apply"),
            (whole[..whole.len() / 2].to_vec(), &none, "copy it again"),
        ] {
            let error = read(&bytes, options).unwrap_err();
            assert!(error.contains(words), "{words:?} is not in {error}");
        }
        let mut colour = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut colour).unwrap();
        let image = encoder.new_image::<colortype::RGB8>(1, 1).unwrap();
        image.write_data(&[1, 2, 3]).unwrap();
        assert!(
            read(&colour.into_inner(), &none)
                .unwrap_err()
                .contains("bands")
        );
    }

    #[test]
    fn degrees_are_no_metres() {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut image = encoder.new_image::<colortype::Gray8>(1, 1).unwrap();
        let keys = [1u16, 1, 0, 1, MODEL, 0, 1, DEGREES];
        let tags = image.encoder();
        tags.write_tag(Tag::GeoKeyDirectoryTag, &keys[..]).unwrap();
        image.write_data(&[7]).unwrap();
        let error = read(&bytes.into_inner(), &TerrainOptions::default()).unwrap_err();
        assert!(error.contains("degrees"), "{error}");
    }
}
