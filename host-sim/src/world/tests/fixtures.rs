//! The committed maps: those that are generated are what the generators give
//! today, and the others are as their readers expect them.

use std::path::PathBuf;

use crate::world::{Family, LARGEST, generate, paper};

use super::*;

fn path(file: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/maps")).join(file)
}

fn read(file: &str) -> World {
    World::read(path(file), &ReadOptions::default()).unwrap()
}

/// Every generated fixture with its file.
fn generated() -> [(&'static str, World); 5] {
    [
        ("labyrinth1.txt", paper::labyrinth1(1)),
        ("labyrinth2.txt", paper::labyrinth2(1)),
        ("circle.txt", paper::circle()),
        ("blocks.txt", paper::blocks()),
        ("cave.map", generate(Family::Cave, 48, 32, 3).unwrap()),
    ]
}

#[test]
fn generated_maps_are_what_the_generators_give() {
    // After a change of the generators: `GOLDEN=refresh cargo test -p host-sim --lib`.
    let refresh = std::env::var_os("GOLDEN").is_some();
    for (file, world) in generated() {
        if refresh {
            world.write(path(file), 1).unwrap();
        }
        let read = read(file);
        assert_eq!(read.extent(), world.extent());
        assert!(read.free_cells().eq(world.free_cells()), "{file} differs");
        if file.ends_with(".txt") {
            assert_eq!(read.starts(), world.starts(), "{file} starts elsewhere");
            assert_eq!(read.starts().len(), 10);
        }
    }
}

#[test]
fn all_of_the_office_can_be_reached() {
    let office = read("office.png");
    assert_eq!(office.extent(), Extent::new(96, 64));
    assert_eq!(office.largest_component().unreachable(), 0);
}

#[test]
fn the_house_is_in_one_piece_pixel_by_pixel_and_in_cells() {
    let house = World::read(path("house.yaml"), &metres(0.25)).unwrap();
    assert_eq!(house.extent(), Extent::new(48, 36));
    assert_eq!(house.metres_per_cell(), Some(0.25));
    // What was seen through the window cannot be reached.
    for (house, seen_outside) in [(house, 5), (read("house.yaml"), 190)] {
        assert_eq!(house.largest_component().unreachable(), seen_outside);
    }
}

#[test]
fn the_counterexamples_are_small_and_have_one_robot() {
    for (letter, free) in [("a", 9), ("b", 15), ("d", 9)] {
        let world = read(&format!("counterexample_{letter}.txt"));
        assert_eq!(world.starts().len(), 1);
        assert_eq!(world.free_cells().count(), free, "{world:?}");
        assert_eq!(world.largest_component().unreachable(), 0);
    }
}

#[test]
fn every_map_fits_the_largest_compiled_size() {
    for entry in path("").read_dir().unwrap() {
        let path = entry.unwrap().path();
        let extent = World::read(&path, &ReadOptions::default())
            .unwrap()
            .extent();
        assert!(extent.width <= LARGEST.width && extent.height <= LARGEST.height);
    }
}
