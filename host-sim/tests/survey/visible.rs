//! Against brute force.

use std::collections::HashSet;

use host_sim::scenario::heights::Scenario;
use host_sim::terrain::{Terrain, look};
use planner_core::surface::body_columns;
use planner_core::{Cell, Direction, Point};

/// Everything that can be seen from just inside the edges of the places that bodies can fly to,
/// where more of the ground under them would have to be known, from low to high in steps,
/// again and again until nothing is new; with what is seen already.
pub(crate) fn visible(
    terrain: &Terrain,
    scenario: &Scenario,
    start: Point,
    mut seen: HashSet<Cell>,
) -> HashSet<Cell> {
    let limits = scenario.limits;
    let columns = |eye| {
        look(terrain, eye, limits.range)
            .into_iter()
            .map(|it| it.cell)
    };
    seen.extend(columns(start));
    loop {
        let before = seen.len();
        let has_room = |cell| terrain.under(cell, limits.clearance).is_some();
        let is_clear = |seen: &HashSet<Cell>, cell| {
            body_columns(limits.clearance, cell).all(|it| seen.contains(&it))
        };
        let mut reached = vec![start.cell()];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            next += 1;
            for beside in Direction::ALL.map(|direction| cell.step(direction)) {
                if is_clear(&seen, beside) && !reached.contains(&beside) {
                    reached.push(beside);
                }
            }
        }
        reached.retain(|&cell| is_clear(&seen, cell));
        for cell in reached {
            for direction in Direction::ALL {
                let beyond = cell.step(direction);
                if !has_room(beyond) || is_clear(&seen, beyond) {
                    continue;
                }
                let (dx, dy) = direction.delta();
                let ground = terrain.under(cell, limits.clearance).unwrap().cells();
                let mut z = ground + limits.min_altitude + 0.1;
                while z <= limits.ceiling {
                    let eye = Point::over(cell, z).offset(
                        0.45 * f32::from(dx),
                        0.45 * f32::from(dy),
                        0.0,
                    );
                    seen.extend(columns(eye));
                    z += limits.step;
                }
            }
        }
        if seen.len() == before {
            return seen;
        }
    }
}
