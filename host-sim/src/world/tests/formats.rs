//! What is written can be read, and images become the cells that are promised.

use image::{GrayImage, Luma, Rgba, RgbaImage};
use std::fs;
use tempfile::TempDir;

use super::*;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Same cells; names, starts and notes may differ.
fn same_cells(a: &World, b: &World) -> bool {
    a.extent() == b.extent() && a.free_cells().eq(b.free_cells())
}

proptest! {
    #[test]
    fn every_format_round_trips(world in any_world(), side in 1u32..4) {
        let folder = folder();
        for file in ["a.png", "a.pgm", "a.map", "a.txt"] {
            let path = folder.path().join(file);
            world.write(&path, side).unwrap();
            let read = World::read(&path, &pixels(side)).unwrap();
            prop_assert!(same_cells(&world, &read), "{file}\n{world:?}\n{read:?}");
            prop_assert_eq!(read.name(), "a");
        }
    }

    #[test]
    fn readers_survive_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let folder = folder();
        for file in ["a.png", "a.pgm", "a.yaml", "a.map", "a.txt"] {
            let path = folder.path().join(file);
            fs::write(&path, &bytes).unwrap();
            // Either way is right, as long as it does not panic.
            let _ = World::read(&path, &ReadOptions::default());
        }
    }
}

#[test]
fn a_pgm_is_a_pgm() {
    let folder = folder();
    let path = folder.path().join("a.pgm");
    world(&[".#"]).write(&path, 1).unwrap();
    let bytes = fs::read(path).unwrap();
    assert!(bytes.starts_with(b"P5"), "not a binary PGM: {bytes:?}");
}

#[test]
fn starts_come_in_the_order_of_their_digits() {
    let rows = ["#0.2", "1. #", "...3"];
    let world = world(&rows);
    assert_eq!(
        world.starts(),
        [cell(0, 1), cell(3, 0), cell(3, 2), cell(1, 0)]
    );
    assert_eq!(world.to_text(), "#4.2\n1..#\n...3\n");
}

#[test]
fn a_txt_may_hold_a_movingai_map() {
    let folder = folder();
    let path = folder.path().join("a.txt");
    fs::write(
        &path,
        "type octile\r\nheight 2\r\nwidth 4\r\nmap\r\n.GS@\r\nOTW.\r\n",
    )
    .unwrap();
    let read = World::read(&path, &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), "...#\n###.\n");
}

#[test]
fn movingai_headers_come_in_any_order() {
    let folder = folder();
    let path = folder.path().join("a.map");
    for map in [
        "\u{feff}type octile\nheight 1\nwidth 2\nmap\n.@\n",
        "Width 2\nTYPE octile\n\nheight 1\nmap\n.@\n\n \r\n\n",
        "height 1\r\nwidth 2\r\ntype octile\r\nmap\r\n.@",
    ] {
        fs::write(&path, map).unwrap();
        let read = World::read(&path, &ReadOptions::default()).unwrap();
        assert_eq!(read.to_text(), ".#\n", "{map:?}");
        fs::rename(&path, folder.path().join("a.txt")).unwrap();
        let read = World::read(folder.path().join("a.txt"), &ReadOptions::default());
        assert_eq!(read.unwrap().to_text(), ".#\n", "{map:?}");
    }
}

#[test]
fn text_maps_from_any_editor() {
    let folder = folder();
    let path = folder.path().join("A.TXT");
    for map in ["\u{feff}1#\n. \n", "1#\r\n. \r\n\r\n", "1#\n. "] {
        fs::write(&path, map).unwrap();
        let read = World::read(&path, &ReadOptions::default()).unwrap();
        assert_eq!(read.to_text(), "1#\n..\n", "{map:?}");
        assert_eq!(read.notes(), [""; 0]);
    }
}

#[test]
fn formats_with_cells_of_their_own_ignore_pixels_and_say_so() {
    let folder = folder();
    let path = folder.path().join("a.txt");
    fs::write(&path, "..\n..\n").unwrap();
    let read = World::read(&path, &pixels(2)).unwrap();
    assert_eq!(read.extent(), Extent::new(2, 2));
    assert!(read.notes()[0].contains("--pixels-per-cell is for images"));
}

#[test]
fn thin_walls_stay_and_edges_that_are_half_missing_close() {
    let folder = folder();
    let path = folder.path().join("a.png");
    // A wall of one pixel in column 7; 12 columns: the third block has 2 of 5.
    GrayImage::from_fn(12, 8, |x, _| Luma([if x == 7 { 0 } else { 255 }]))
        .save(&path)
        .unwrap();
    let read = World::read(&path, &pixels(5)).unwrap();
    assert_eq!(read.to_text(), ".##\n.##\n");
}

#[test]
fn dark_is_below_the_threshold_and_nothing_is_unknown() {
    let folder = folder();
    let path = folder.path().join("a.png");
    let shades = [
        [127, 127, 127, 255],
        [128, 128, 128, 255],
        [0, 0, 0, 0],
        [0, 0, 0, 128],
    ];
    RgbaImage::from_fn(4, 1, |x, _| Rgba(shades[x as usize]))
        .save(&path)
        .unwrap();
    let read = World::read(&path, &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), "#.##\n");
    assert_eq!(
        read.notes(),
        [
            "1 of 4 pixels are unknown (transparent): taken as obstacles; paint white what is \
          free, or name the YAML file of the map"
        ]
    );
    let darker = ReadOptions {
        dark_below: 100,
        ..ReadOptions::default()
    };
    let read = World::read(&path, &darker).unwrap();
    assert_eq!(read.to_text(), "..##\n");
    assert!(read.notes()[0].starts_with("2 of 4"), "{:?}", read.notes());
}

/// A folder with a map_server map of 4×2 pixels: black, unknown, white, white.
fn ros_map(changes: &[(&str, &str)]) -> TempDir {
    let folder = folder();
    let image = GrayImage::from_fn(4, 2, |x, _| Luma([[0, 205, 254, 255][x as usize]]));
    image.save(folder.path().join("a.pgm")).unwrap();
    let mut yaml = "image: a.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        .to_string();
    for (from, to) in changes {
        assert!(yaml.contains(from));
        yaml = yaml.replace(from, to);
    }
    fs::write(folder.path().join("a.yaml"), yaml).unwrap();
    folder
}

#[test]
fn map_server_unknown_is_an_obstacle() {
    let folder = ros_map(&[]);
    let read = World::read(folder.path().join("a.yaml"), &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), "##..\n##..\n");
    assert_eq!(read.metres_per_cell(), Some(0.1));
    assert_eq!(
        read.notes(),
        [
            "2 of 8 pixels are unknown (neither occupied nor free by the keys of the file): \
          taken as obstacles, which no robot enters"
        ]
    );
}

#[test]
fn map_server_thresholds_and_negate_count() {
    let wider = ros_map(&[("0.196", "0.2")]);
    let read = World::read(wider.path().join("a.yaml"), &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), "#...\n#...\n");
    let negated = ros_map(&[("negate: 0", "negate: true\nmode: trinary")]);
    let read = World::read(negated.path().join("a.yaml"), &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), ".###\n.###\n");
}

#[test]
fn cell_size_becomes_whole_pixels() {
    let folder = ros_map(&[]);
    let path = folder.path().join("a.yaml");
    let exact = World::read(&path, &metres(0.2)).unwrap();
    assert_eq!(
        (exact.to_text().as_str(), exact.metres_per_cell()),
        ("#.\n", Some(0.2))
    );
    assert!(!exact.notes()[0].contains("--cell-size"));
    let rounded = World::read(&path, &metres(0.17)).unwrap();
    assert_eq!(rounded.metres_per_cell(), Some(0.2));
    let note = "--cell-size 0.17 is 1.70 pixels of 0.1 m; cells of 2 pixels, 0.2000 m, are used";
    assert_eq!(rounded.notes()[0], note);
}

#[test]
fn map_server_keys_in_quotation_marks_and_capitals() {
    let folder = folder();
    world(&[".#"])
        .write(folder.path().join("A.PGM"), 1)
        .unwrap();
    let yaml = "\u{feff}Image: 'A.PGM'\nRESOLUTION: \"0.1\"\norigin: ['0', -1.5, \"2e1\"]\n\
                Negate: 'no'\nOccupied_Thresh: '0.65'\nfree_thresh: \"0.196\"\n\
                mode: Trinary\nauthor: {name: somebody, age: [1, 2]}\n";
    fs::write(folder.path().join("A.YAML"), yaml).unwrap();
    let read = World::read(folder.path().join("A.YAML"), &ReadOptions::default()).unwrap();
    assert_eq!(read.to_text(), ".#\n");
    assert_eq!(read.metres_per_cell(), Some(0.1));
    assert_eq!(read.notes(), [""; 0]);
}

#[test]
fn an_origin_that_is_no_pose_is_told() {
    for nan in ["-nan", "nan", ".nan", "-.inf", "'-nan(ind)'"] {
        let folder = ros_map(&[("[0, 0, 0]", &format!("[0, 0, {nan}]"))]);
        let read = World::read(folder.path().join("a.yaml"), &ReadOptions::default());
        match nan.contains("ind") {
            true => assert!(read.unwrap_err().to_string().contains("key `origin`")),
            false => {
                let notes = read.unwrap().notes().to_vec();
                assert!(notes[0].starts_with("key `origin` is [0, 0, "), "{notes:?}");
            }
        }
    }
}

#[test]
fn an_image_beside_a_moved_map_is_read_and_told() {
    for image in [
        "/data/maps/a.pgm",
        "maps/a.pgm",
        "C:\\maps\\a.pgm",
        "..\\a.pgm",
    ] {
        let folder = ros_map(&[("image: a.pgm", &format!("image: {image}"))]);
        let read = World::read(folder.path().join("a.yaml"), &ReadOptions::default()).unwrap();
        assert_eq!(read.to_text(), "##..\n##..\n");
        let note = &read.notes()[0];
        assert!(note.contains(&format!("names {image}")), "{note}");
        assert!(note.contains("a.pgm lies beside the YAML file"), "{note}");
    }
    let gone = ros_map(&[("image: a.pgm", "image: /data/maps/b.pgm")]);
    let error = World::read(gone.path().join("a.yaml"), &ReadOptions::default());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("/data/maps/b.pgm"), "{error}");
    assert!(error.contains("no such file"), "{error}");
}
