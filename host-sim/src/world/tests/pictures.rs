//! What pixels say, and that a header is looked at before them.

use std::fs;

use image::{GrayImage, Luma, LumaA, Rgba};

use super::*;

fn read(name: &str, bytes: &[u8]) -> Result<World, String> {
    let open = |_: &std::path::Path| Ok(bytes.to_vec());
    World::read_with(name, &ReadOptions::default(), open).map_err(|error| error.to_string())
}

/// The cells of a map_server map of these pixels under these keys, and its notes.
fn ros(image: &image::DynamicImage, keys: &str) -> (String, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    image.save(folder.path().join("a.png")).unwrap();
    let yaml = format!(
        "image: a.png\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n\
         free_thresh: 0.196\n{keys}"
    );
    fs::write(folder.path().join("a.yaml"), yaml).unwrap();
    let world = World::read(folder.path().join("a.yaml"), &ReadOptions::default()).unwrap();
    (world.to_text(), world.notes().to_vec())
}

fn grays(shades: &[u8]) -> image::DynamicImage {
    GrayImage::from_fn(shades.len() as u32, 1, |x, _| Luma([shades[x as usize]])).into()
}

fn with_alpha(pixels: &[[u8; 2]]) -> image::DynamicImage {
    image::GrayAlphaImage::from_fn(pixels.len() as u32, 1, |x, _| LumaA(pixels[x as usize])).into()
}

#[test]
fn the_gray_of_map_saver_is_unknown_without_its_yaml_file_too() {
    let mut map = b"P5\n# CREATOR: map_saver.cpp 0.050 m/pix\n6 1\n255\n".to_vec();
    map.extend([0, 204, 205, 206, 254, 255]);
    let read = read("map.pgm", &map).unwrap();
    assert_eq!(read.to_text(), "#.#...\n");
    assert_eq!(
        read.notes(),
        [
            "1 of 6 pixels are unknown (of the gray 205, map_saver's for unknown): taken as \
          obstacles; paint white what is free, or name the YAML file of the map"
        ]
    );
}

#[test]
fn a_map_of_which_nothing_is_known_says_so() {
    let error = read("map.pgm", b"P5\n2 1\n255\n\xcd\x00").unwrap_err();
    for words in ["no free cell", "1 of 2 pixels are unknown", "paint white"] {
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn modes_are_those_of_map_server() {
    // Occupied by 1, 0.651, 0.647, 0.2, 0.196.., 0.192, 0.
    let shades = grays(&[0, 89, 90, 204, 205, 206, 255]);
    let (cells, notes) = ros(&shades, "negate: 0");
    assert_eq!(cells, "#####..\n");
    assert!(
        notes[0].starts_with("3 of 7 pixels are unknown"),
        "{notes:?}"
    );

    let (cells, notes) = ros(&shades, "negate: 0\nmode: scale");
    assert_eq!(cells, "##.....\n");
    assert_eq!(
        notes,
        [
            "3 of 7 pixels are occupied in part (mode `scale`): taken as free, as a costmap \
          takes what is not occupied for certain"
        ]
    );

    let raw = grays(&[0, 1, 99, 100, 101, 255]);
    let (cells, notes) = ros(&raw, "negate: 0\nmode: raw");
    assert_eq!(cells, "...###\n");
    assert!(
        notes[0].starts_with("2 of 6 pixels are unknown"),
        "{notes:?}"
    );
    assert!(notes[1].starts_with("2 of 6 pixels are occupied in part (mode `raw`)"));

    let (cells, _) = ros(&grays(&[0, 49, 50, 255]), "negate: 1");
    assert_eq!(cells, "..##\n");
}

#[test]
fn transparent_pixels_are_those_of_map_server() {
    // Transparent black and white, half transparent white and black, opaque ones.
    let pixels = with_alpha(&[[0, 0], [255, 0], [255, 127], [0, 127], [255, 255], [0, 255]]);
    // In trinary mode transparency counts as a colour: white of alpha 127 is
    // occupied by 0.125.
    let (cells, notes) = ros(&pixels, "negate: 0");
    assert_eq!(cells, "##.#.#\n");
    assert!(
        notes[0].starts_with("2 of 6 pixels are unknown (transparent)"),
        "{notes:?}"
    );
    let (cells, notes) = ros(&pixels, "negate: 0\nmode: scale");
    assert_eq!(cells, "####.#\n");
    assert!(notes[0].starts_with("4 of 6"), "{notes:?}");
    let (cells, _) = ros(&pixels, "negate: 1");
    assert_eq!(cells, "###.##\n");
}

/// A palette of five bytes: one colour, and two thirds of another.
#[test]
fn a_palette_that_ends_within_a_colour_is_refused() {
    let palette = b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x04\x00\x00\x00\x01\x02\x03\x00\x00\x00\x84R\xe7^\x00\x00\x00\x05PLTE\x00\x00\x00\xff\xff\xdc@\xc6\xfe\x00\x00\x00\x0aIDATx\x9cc\x98\x00\x00\x00\x92\x00\x91\x12\x22\xfb{\x00\x00\x00\x00IEND\xaeB`\x82";
    let error = read("a.png", palette).unwrap_err().to_string();
    assert!(
        error.contains("its palette ends within a colour"),
        "{error}"
    );
}

#[test]
fn every_kind_of_png_and_pgm() {
    // Palette with a transparent entry; interlaced; one gray that is transparent.
    let palette = b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x04\x00\x00\x00\x01\x02\x03\x00\x00\x00\x84R\xe7^\x00\x00\x00\x09PLTE\x00\x00\x00\xff\xff\xff\xff\xff\xffsx\xa5c\x00\x00\x00\x03tRNS\xff\xff\x00\xd7\xca\x0dA\x00\x00\x00\x0aIDATx\xdac\x90\x04\x00\x00\x1b\x00\x1a\x83Z\xf7 \x00\x00\x00\x00IEND\xaeB`\x82";
    assert_eq!(read("a.png", palette).unwrap().to_text(), "#.#.\n");
    let interlaced = b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x04\x00\x00\x00\x02\x08\x00\x00\x00\x01-\xc4\x12)\x00\x00\x00\x0fIDATx\xdac``\xf8\xcf\xf0\x1f\x82\x00\x1d\xee\x05\xfbE\xbcq\xb4\x00\x00\x00\x00IEND\xaeB`\x82";
    assert_eq!(read("a.png", interlaced).unwrap().to_text(), "#...\n..#.\n");
    let keyed = b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x03\x00\x00\x00\x01\x08\x00\x00\x00\x00>\x8bKh\x00\x00\x00\x02tRNS\x00\xc8\xe3,\x87\xba\x00\x00\x00\x0cIDATx\xdac`\xf8\x7f\x02\x00\x02\xca\x01\xc8\x22J1\x05\x00\x00\x00\x00IEND\xaeB`\x82";
    assert_eq!(read("a.png", keyed).unwrap().to_text(), "#.#\n");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let deep = image::ImageBuffer::from_fn(3, 1, |x, _| Luma([[0u16, 0x8080, 0xffff][x as usize]]));
    image::DynamicImage::from(deep).save(&path).unwrap();
    assert_eq!(
        read("a.png", &fs::read(&path).unwrap()).unwrap().to_text(),
        "#..\n"
    );
    let coloured = [[255, 0, 0, 255], [255, 255, 0, 255], [0, 0, 0, 255]];
    image::RgbaImage::from_fn(3, 1, |x, _| Rgba(coloured[x as usize]))
        .save(&path)
        .unwrap();
    assert_eq!(
        read("a.png", &fs::read(&path).unwrap()).unwrap().to_text(),
        "#.#\n"
    );

    for (pgm, cells) in [
        (
            &b"P2\n# a remark\n3 1 # another\n100\n0 49\n51\n"[..],
            "##.\n",
        ),
        (b"P5 3 1 100\n\x00\x31\x33", "##.\n"),
        (b"P5\r\n2 1\r\n65535\n\x00\x00\xff\xff", "#.\n"),
        (b"P1\n3 1\n0 1 0\n", ".#.\n"),
        (b"P4\n3 1\n\x40", ".#.\n"),
        (b"P6\n2 1\n255\n\x00\x00\x00\xff\xff\xff", "#.\n"),
    ] {
        let world = read("a.pgm", pgm);
        let pgm = String::from_utf8_lossy(pgm);
        assert_eq!(
            world.map(|world| world.to_text()),
            Ok(cells.into()),
            "{pgm:?}"
        );
    }
}

/// A PNG image of so many pixels of one bit, cut off after its header.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(width.to_be_bytes());
    chunk.extend(height.to_be_bytes());
    chunk.extend([1, 0, 0, 0, 0]);
    let crc = !chunk.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| match crc & 1 {
            0 => crc >> 1,
            _ => (crc >> 1) ^ 0xedb8_8320,
        })
    });
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
    png.extend(chunk);
    png.extend(crc.to_be_bytes());
    png.extend(b"\0\0\x10\0IDAT");
    png
}

#[test]
fn the_header_says_whether_a_picture_fits() {
    // There is no pixel in these files: the message is about the header.
    let large = read("a.png", &png_header(20_000, 20_000)).unwrap_err();
    assert!(large.contains("20000×20000 cells"), "{large}");
    assert!(
        large.contains("use --pixels-per-cell 40 or more"),
        "{large}"
    );
    let vast = read("a.png", &png_header(2_000_000_000, 2_000_000_000)).unwrap_err();
    assert!(vast.contains("scale the picture down"), "{vast}");
    for (header, words) in [
        ("P5 20000 20000 255\n", "20000×20000 cells"),
        ("P2\n513 1\n255\n", "513×1 cells"),
        ("P5 4294967295 4294967295 255\n", "scale the picture down"),
        ("P5 99999999999999999999 1 255\n", "is not a complete image"),
        ("P5 0 0 255\n", "has no cell"),
        ("P5 0 7 255\n", "has no cell"),
        ("P5 -1 7 255\n", "is not a complete image"),
        ("P5 1 1 0\n", "is not a complete image"),
        (
            "P7\nWIDTH 1\nHEIGHT 1\nDEPTH 9\nMAXVAL 1\nENDHDR\n",
            "is not a complete image",
        ),
    ] {
        let error = read("a.pgm", header.as_bytes()).unwrap_err();
        assert!(error.contains(words), "{header:?}: {error}");
    }
}
