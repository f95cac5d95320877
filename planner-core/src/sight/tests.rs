use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;

const EXTENT: Extent = Extent::new(24, 24);

fn walls() -> impl Strategy<Value = Vec<bool>> {
    (0.0..0.5f64).prop_flat_map(|share| {
        proptest::collection::vec(proptest::bool::weighted(share), EXTENT.cells() as usize)
    })
}

fn blocked_in(walls: &[bool]) -> impl Fn(Cell) -> bool + '_ {
    |cell| !EXTENT.contains(cell) || walls[cell.y as usize * 24 + cell.x as usize]
}

fn cell() -> impl Strategy<Value = Cell> {
    (0i16..24, 0i16..24).prop_map(|(x, y)| Cell::new(x, y))
}

/// Line of sight in exact rational geometry: the open segment between the centres
/// meets the interior of no blocked cell, and no corner whose two cells beside
/// the segment are both blocked.
fn exact_line_of_sight(from: Cell, to: Cell, is_blocked: &impl Fn(Cell) -> bool) -> bool {
    let (dx, dy) = (i32::from(to.x - from.x), i32::from(to.y - from.y));
    let (west, east) = (from.x.min(to.x), from.x.max(to.x));
    let (north, south) = (from.y.min(to.y), from.y.max(to.y));
    let side = |corner_x: i32, corner_y: i32| dx * corner_y - dy * corner_x;
    for y in north..=south {
        for x in west..=east {
            // Corners relative to the centre of `from`, doubled.
            let (cx, cy) = (2 * i32::from(x - from.x), 2 * i32::from(y - from.y));
            let sides = [(-1, -1), (1, -1), (-1, 1), (1, 1)].map(|(a, b)| side(cx + a, cy + b));
            let crosses = sides.iter().any(|&s| s > 0) && sides.iter().any(|&s| s < 0);
            let cell = Cell::new(x, y);
            if crosses && cell != from && cell != to && is_blocked(cell) {
                return false;
            }
            // The south-eastern and the south-western corner of this cell.
            for (a, diagonal) in [(1i16, dx * dy > 0), (-1, dx * dy < 0)] {
                let inside = x + a >= west && x + a <= east && y < south;
                if diagonal && inside && side(cx + i32::from(a), cy + 1) == 0 {
                    let beside = (Cell::new(x + a, y), Cell::new(x, y + 1));
                    if is_blocked(beside.0) && is_blocked(beside.1) {
                        return false;
                    }
                }
            }
        }
    }
    true
}

proptest! {
    #[test]
    fn sight_is_symmetric(walls in walls(), a in cell(), b in cell()) {
        let blocked = blocked_in(&walls);
        prop_assert_eq!(line_of_sight(a, b, &blocked), line_of_sight(b, a, &blocked));
    }

    #[test]
    fn sight_is_what_geometry_says(walls in walls(), a in cell(), b in cell()) {
        let blocked = blocked_in(&walls);
        prop_assert_eq!(line_of_sight(a, b, &blocked), exact_line_of_sight(a, b, &blocked));
    }

    #[test]
    fn a_look_holds_exactly_the_disc_in_sight(walls in walls(), centre in cell(), radius in 1u8..=15) {
        let blocked = blocked_in(&walls);
        let sighting = look(centre, radius, &blocked);
        for y in -20..44 {
            for x in -20..44 {
                let cell = Cell::new(x, y);
                let seen = cell.distance_squared(centre) <= u32::from(radius) * u32::from(radius)
                    && line_of_sight(centre, cell, &blocked);
                let free = !blocked(cell) || cell == centre;
                prop_assert_eq!(sighting.is_free(cell), seen && free);
                prop_assert_eq!(sighting.is_blocked(cell), seen && !free);
            }
        }
        prop_assert_eq!(sighting.free_cells().filter(|&c| !sighting.is_free(c)).count(), 0);
    }

    /// A dense scan of a grid world tells no lie, and sees the free cells that
    /// lie well within reach of the eye.
    #[test]
    fn a_scan_agrees_with_geometry(
        walls in walls(), centre in cell(),
        inside in (0.05f32..0.95, 0.05f32..0.95), heading in -7.0f32..7.0, max_range in 1.0f32..14.0,
    ) {
        let blocked = blocked_in(&walls);
        let pose = Pose { x: f32::from(centre.x) + inside.0, y: f32::from(centre.y) + inside.1, heading };
        let beams: Vec<Beam> = (0..720).map(|i| {
            let bearing = i as f32 * core::f32::consts::TAU / 720.0;
            Beam { bearing, range: cast(pose, heading + bearing, max_range, centre, &blocked) }
        }).collect();
        let sighting = RangeScan { pose, max_range, beams: &beams }.sighting().unwrap();
        for cell in sighting.free_cells().filter(|&cell| cell != centre) {
            prop_assert!(!blocked(cell), "{} free", cell);
        }
        for cell in sighting.blocked_cells() {
            prop_assert!(blocked(cell), "{} blocked", cell);
        }
        for direction in crate::cell::Direction::ALL {
            let next = centre.step(direction);
            if max_range > 2.0 {
                prop_assert_eq!(sighting.is_free(next), !blocked(next), "{}", next);
                prop_assert_eq!(sighting.is_blocked(next), blocked(next), "{}", next);
            }
        }
    }

    #[test]
    fn no_scan_panics(
        x in any::<f32>(), y in any::<f32>(), heading in any::<f32>(), max_range in any::<f32>(),
        beams in proptest::collection::vec((any::<f32>(), any::<f32>()), 0..20),
    ) {
        let beams: Vec<Beam> = beams.into_iter().map(|(bearing, range)| Beam { bearing, range }).collect();
        let _ = RangeScan { pose: Pose { x, y, heading }, max_range, beams: &beams }.sighting();
        let pose = Pose { x: 3.5, y: 3.5, heading: 0.0 };
        let sighting = RangeScan { pose, max_range: 9.0, beams: &beams }.sighting().unwrap();
        prop_assert!(sighting.is_free(Cell::new(3, 3)));
    }
}

/// The distance at which a ray enters the first blocked cell, in steps of a
/// thousandth of a cell refined to the border: an oracle without grid traversal.
fn cast(
    pose: Pose,
    angle: f32,
    max_range: f32,
    own: Cell,
    is_blocked: &impl Fn(Cell) -> bool,
) -> f32 {
    let (dx, dy) = (f64::from(angle).cos(), f64::from(angle).sin());
    let at = |t: f64| {
        let x = (f64::from(pose.x) + t * dx).floor() as i16;
        let y = (f64::from(pose.y) + t * dy).floor() as i16;
        Cell::new(x, y)
    };
    let stops = |t: f64| at(t) != own && is_blocked(at(t));
    let mut t = 0.0;
    while t < f64::from(max_range) {
        t += 0.001;
        if stops(t) {
            let (mut low, mut high) = (t - 0.001, t);
            for _ in 0..30 {
                let middle = (low + high) / 2.0;
                if stops(middle) {
                    high = middle
                } else {
                    low = middle
                }
            }
            return high as f32;
        }
    }
    f32::INFINITY
}

#[test]
fn a_multi_ranger_sees_four_lines() {
    let quarter = core::f32::consts::FRAC_PI_2;
    let beams = [
        (0.0, 2.5),
        (quarter, f32::INFINITY),
        (2.0 * quarter, 0.5),
        (-quarter, f32::NAN),
    ]
    .map(|(bearing, range)| Beam { bearing, range });
    let pose = Pose {
        x: 10.5,
        y: 10.5,
        heading: 0.0,
    };
    let sighting = RangeScan {
        pose,
        max_range: 4.0,
        beams: &beams,
    }
    .sighting()
    .unwrap();
    let mut free: Vec<_> = sighting.free_cells().map(|c| (c.x, c.y)).collect();
    free.sort();
    assert_eq!(
        free,
        [
            (10, 10),
            (10, 11),
            (10, 12),
            (10, 13),
            (10, 14),
            (11, 10),
            (12, 10)
        ]
    );
    let blocked: Vec<_> = sighting.blocked_cells().map(|c| (c.x, c.y)).collect();
    assert_eq!(blocked, [(9, 10), (13, 10)]);
}

#[test]
fn a_scan_that_says_nothing_is_refused() {
    let pose = Pose {
        x: 1.0,
        y: 1.0,
        heading: 0.0,
    };
    let scan = |pose, max_range| {
        RangeScan {
            pose,
            max_range,
            beams: &[],
        }
        .sighting()
    };
    assert_eq!(scan(pose, 0.0), Err(ScanError::MaxRange));
    assert_eq!(scan(pose, f32::NAN), Err(ScanError::MaxRange));
    assert_eq!(
        scan(
            Pose {
                x: f32::INFINITY,
                ..pose
            },
            3.0
        ),
        Err(ScanError::Pose)
    );
    assert_eq!(scan(Pose { y: 1e9, ..pose }, 3.0), Err(ScanError::Pose));
}
