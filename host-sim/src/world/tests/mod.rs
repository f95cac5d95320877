//! Laws of worlds, whatever they come from.

mod errors;
mod fixtures;
mod formats;
mod pictures;
mod places;

use planner_core::{Cell, Extent};
use proptest::prelude::*;

use super::{ReadOptions, Scale, World};

/// Small worlds with at least one free cell and no structure at all.
fn any_world() -> impl Strategy<Value = World> {
    (1u16..12, 1u16..12)
        .prop_flat_map(|(width, height)| {
            let cells = usize::from(width * height);
            let blocked = prop::collection::vec(prop::bool::weighted(0.4), cells);
            (Just(Extent::new(width, height)), blocked, 0..cells)
        })
        .prop_map(|(extent, mut blocked, free)| {
            blocked[free] = false;
            let mut blocked = blocked.into_iter();
            World::from_fn("any", extent, |_| blocked.next() == Some(true)).unwrap()
        })
}

/// A world with its starts from the rows of a text map.
fn world(rows: &[&str]) -> World {
    super::text::parse("drawn", &rows.join("\n")).unwrap()
}

fn pixels(pixels: u32) -> ReadOptions {
    ReadOptions {
        scale: Scale::Pixels(pixels),
        ..ReadOptions::default()
    }
}

fn metres(metres: f64) -> ReadOptions {
    ReadOptions {
        scale: Scale::Metres(metres),
        ..ReadOptions::default()
    }
}

fn cell(x: i16, y: i16) -> Cell {
    Cell::new(x, y)
}
