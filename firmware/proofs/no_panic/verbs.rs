//! Every call that a robot makes, with arguments that the compiler knows nothing of.

use core::hint::black_box;

use planner_core::sight::{Beam, Pose, RangeScan};
use planner_core::{Cell, Extent, Map};
use static_cell::ConstStaticCell;

static MAPS: ConstStaticCell<[Map<4, 4>; 2]> = ConstStaticCell::new([Map::vacant(), Map::vacant()]);

/// Calls them all.
pub(crate) fn call_all() {
    let Some([map, other]) = MAPS.try_take() else {
        return;
    };
    for map in [&mut *map, &mut *other] {
        let _ = black_box(map.reset(black_box(Extent::new(9, 9))));
        scan(map);
        map.visit(cell());
    }
    black_box(map.join(other));
    let changed = other.take_changed();
    black_box(map.join_tiles(other, &changed));
    black_box((map.is_frontier(cell()), map.is_free(cell())));
}

fn scan(map: &mut Map<4, 4>) {
    let beams = black_box([Beam {
        bearing: 0.0,
        range: 1.0,
    }]);
    let scan = RangeScan {
        pose: black_box(Pose {
            x: 0.5,
            y: 0.5,
            heading: 0.0,
        }),
        max_range: black_box(4.0),
        beams: &beams,
    };
    if let Ok(sighting) = scan.sighting() {
        black_box(map.observe(&sighting));
    }
}

fn cell() -> Cell {
    black_box(Cell::new(1, 1))
}
