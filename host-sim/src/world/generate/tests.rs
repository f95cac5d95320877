//! What is promised of each family.

use planner_core::Cell;
use proptest::prelude::*;

use super::*;

/// For each free cell the number of its free neighbours.
fn degrees(world: &World) -> impl Iterator<Item = usize> + '_ {
    world
        .free_cells()
        .map(|cell| world.grid.free_neighbours(cell).count())
}

fn any_extent() -> impl Strategy<Value = (u16, u16)> {
    (SMALLEST..40, SMALLEST..40)
}

proptest! {
    #[test]
    fn every_world_is_one_piece_of_the_size_that_was_asked_for(
        (width, height) in any_extent(), seed: u64,
    ) {
        for family in Family::ALL {
            let world = generate(family, width, height, seed).unwrap();
            prop_assert_eq!(world.extent(), Extent::new(width, height));
            prop_assert_eq!(world.largest_component().unreachable(), 0);
            prop_assert_eq!(&world, &generate(family, width, height, seed).unwrap());
        }
    }

    #[test]
    fn a_perfect_maze_is_a_tree((width, height) in any_extent(), seed: u64) {
        let maze = generate(Family::PerfectMaze, width, height, seed).unwrap();
        let edges = degrees(&maze).sum::<usize>() / 2;
        prop_assert_eq!(edges, maze.free_cells().count() - 1);
        // Every junction of the lattice is part of it.
        let junctions = usize::from((width - 1) / 2) * usize::from((height - 1) / 2);
        prop_assert_eq!(edges, 2 * (junctions - 1));
    }

    #[test]
    fn a_braided_maze_has_no_dead_end((width, height) in any_extent(), seed: u64) {
        let maze = generate(Family::BraidedMaze, width, height, seed).unwrap();
        prop_assert!(degrees(&maze).all(|degree| degree >= 2), "{:?}", maze);
    }

    #[test]
    fn a_wide_maze_is_made_of_squares(seed: u64, corridor in 2u16..=5) {
        let extent = Extent::new(40, 31);
        let recipe = Recipe { corridor: Some(corridor), ..Recipe::new(Family::WideMaze, extent, seed) };
        let maze = recipe.generate().unwrap();
        let side = corridor as i16;
        let in_square = |cell: Cell| {
            let mut corners = (cell.y - side + 1..=cell.y)
                .flat_map(|y| (cell.x - side + 1..=cell.x).map(move |x| (x, y)));
            corners.any(|(left, top)| {
                (top..top + side)
                    .all(|y| (left..left + side).all(|x| maze.is_free(Cell::new(x, y))))
            })
        };
        prop_assert!(maze.free_cells().all(in_square), "{:?}", maze);
    }

    #[test]
    fn a_cave_is_large((width, height) in any_extent(), seed: u64) {
        let cave = generate(Family::Cave, width, height, seed).unwrap();
        prop_assert!(5 * cave.free_cells().count() >= 2 * cave.extent().cells() as usize);
    }

    #[test]
    fn isolated_blocks_leave_the_border_and_their_corners_free(
        (width, height) in any_extent(), seed: u64,
    ) {
        let world = generate(Family::IsolatedBlocks, width, height, seed).unwrap();
        let (right, bottom) = (width as i16 - 1, height as i16 - 1);
        let border = |c: Cell| c.x == 0 || c.y == 0 || c.x == right || c.y == bottom;
        for cell in grid::cells(world.extent()).filter(|&cell| border(cell)) {
            prop_assert!(world.is_free(cell));
        }
        // Two blocks that met at a corner would show as a 2×2 chequer.
        for Cell { x, y } in grid::cells(Extent::new(width - 1, height - 1)) {
            let free = |dx, dy| world.is_free(Cell::new(x + dx, y + dy));
            let diagonal = free(0, 0) == free(1, 1) && free(1, 0) == free(0, 1);
            prop_assert!(!diagonal || free(0, 0) == free(1, 0), "{:?}", world);
        }
    }

    #[test]
    fn density_is_the_share_of_obstacles(seed: u64, density in 0u16..=20) {
        for family in [Family::RandomObstacles, Family::IsolatedBlocks] {
            let recipe = Recipe {
                density: Some(density),
                ..Recipe::new(family, Extent::new(100, 100), seed)
            };
            let blocked = 10_000 - recipe.generate().unwrap().free_cells().count() as i32;
            prop_assert!((blocked - 100 * i32::from(density)).abs() < 250, "{} {}", family, blocked);
        }
    }
}

#[test]
fn rooms_have_walls_and_doors() {
    for seed in 0..20 {
        let world = generate(Family::Rooms, 40, 30, seed).unwrap();
        let doors = world.free_cells().filter(|&cell| {
            let free = |x, y| world.is_free(Cell::new(cell.x + x, cell.y + y));
            let (across, along) = (free(-1, 0) && free(1, 0), free(0, -1) && free(0, 1));
            (across && !free(0, -1) && !free(0, 1)) || (along && !free(-1, 0) && !free(1, 0))
        });
        assert!(doors.count() >= 10, "{world:?}");
    }
}

#[test]
fn an_open_world_is_nearly_empty() {
    for seed in 0..20 {
        let world = generate(Family::Open, 50, 40, seed).unwrap();
        assert_eq!(world.free_cells().count(), 50 * 40 - 20);
    }
}

/// Committed maps and golden traces hang on the exact cells.
#[test]
fn worlds_never_change() {
    let maze = generate(Family::PerfectMaze, 11, 7, 1).unwrap();
    let rows = [
        "###########",
        "#...#.....#",
        "#.###.###.#",
        "#...#.#.#.#",
        "#.#.###.#.#",
        "#.#.......#",
        "###########\n",
    ];
    assert_eq!(maze.to_text(), rows.join("\n"));
}

#[test]
fn families_are_named_as_on_the_command_line() {
    assert_eq!(Family::PerfectMaze.to_string(), "perfect-maze");
    assert_eq!(
        Family::from_str("isolated-blocks", false),
        Ok(Family::IsolatedBlocks)
    );
    assert_eq!(Family::value_variants(), Family::ALL);
}
