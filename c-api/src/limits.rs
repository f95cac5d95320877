//! Cells to keep out of, a grid that moves, and the state as bytes and back.

use planner_core::{Cell, Errands as _, Persist as _};

use crate::answer;
use crate::place::{Cells, Planner, PlannerCellSet, cells, input, inputs, output, page, robot};
use crate::types::{PlannerCell, PlannerResult};

/// Adds the rectangle between two opposite corners, both of them in it, as far as it lies on
/// the grid. Work: a few instructions a cell.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_add_rectangle(
    set: *mut PlannerCellSet,
    corner: PlannerCell,
    opposite: PlannerCell,
) -> PlannerResult {
    answer(|| {
        let corners = [corner, opposite].map(|at| Cell::new(at.x, at.y));
        cells(set)?.insert_rectangle(corners[0], corners[1]);
        Ok(())
    })
}

/// From now on the robot enters none of these cells, nor touches one with its body, and need
/// not see them; null: it may enter all. "Complete" is then meant without them, and others
/// are told nothing of them. A robot that had stopped goes on. The set stays yours, in RAM or
/// flash: it must stay where it is, and as it is, until the next such call or
/// `planner_create`. `PLANNER_RESULT_KEPT_OUT`: the robot or its home lies in them, and
/// nothing has changed.
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_keep_out(
    planner: *mut Planner,
    set: *const PlannerCellSet,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let set = match set.is_null() {
            true => None,
            false => Some(input(set.cast::<Cells>())?),
        };
        let result = robot.planner.keep_out(set);
        result.map_err(|_| PlannerResult::KeptOut)
    })
}

/// Moves the grid by so many tiles of 8 cells to the east and to the south, for a place that
/// is larger than it: a stop for `PLANNER_STOP_AT_EDGE` asks for it. Every cell is called by
/// a number 8 less for each, also in what you tell from now on. The robot goes on, and what
/// comes in is unknown. What falls off is lost: read it before, by `planner_row`. A fleet
/// moves by agreement, every robot by the same tiles: until all have, they do not hear each
/// other. `PLANNER_RESULT_OFF_GRID`: the robot or its home would fall off (see
/// `planner_settle`); `PLANNER_RESULT_KEPT_OUT`: call `planner_keep_out` without cells before,
/// and with those of the new grid afterwards; `PLANNER_RESULT_TOO_OFTEN`: 16 times since the
/// last stop. Then nothing has changed. Work: every tile, with its neighbours.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_recentre(planner: *mut Planner, columns: i8, rows: i8) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        robot.planner.recentre(columns, rows, |_, _| {})?;
        Ok(())
    })
}

/// From now on the robot's home is where it stands.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_settle(planner: *mut Planner) -> PlannerResult {
    answer(|| {
        robot(planner)?.planner.settle();
        Ok(())
    })
}

/// Writes how many bytes a save takes: 1,604 for 64×64 cells.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_saved_bytes(planner: *mut Planner, bytes: *mut usize) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        output(bytes)?.write(robot.planner.saved_bytes());
        Ok(())
    })
}

/// Writes the bytes of a save from number `first` on into `bytes`, as many as there is `room`
/// for or left, and how many into `written`; 0: the save is whole. So it goes to flash a page
/// at a time. Make no other call between the pages, or the save is refused later as damaged.
/// Kept are the map, where the robot and its home are, and the number of its next frame; not
/// plans, nor what it heard of the others. Work: the whole save, about 100 instructions a
/// byte.
///
/// Stack: 640 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_save(
    planner: *mut Planner,
    first: usize,
    bytes: *mut u8,
    room: usize,
    written: *mut usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        let (page, written) = (page(bytes, room)?, output(written)?);
        written.write(robot.planner.save(first, page));
        Ok(())
    })
}

/// Goes on from a save, after `planner_create` with the same grid and id; what lies behind
/// its last byte does not matter. The robot keeps out of what it did, if that is told before,
/// and has no limit of energy until it is told. A result other than `PLANNER_RESULT_OK` says
/// what is wrong with the save, and nothing has changed.
///
/// Stack: 1024 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_restore(
    planner: *mut Planner,
    bytes: *const u8,
    count: usize,
) -> PlannerResult {
    answer(|| {
        let robot = robot(planner)?;
        robot.planner.restore(inputs(bytes, count)?)?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use std::ptr::{null, null_mut};

    use planner_core::Planner as _;

    use super::*;
    use crate::tests::{CONFIG, created, memory};
    use crate::{PlannerConfig, planner_go_to};

    const OK: PlannerResult = PlannerResult::Ok;

    fn cell(x: i16, y: i16) -> PlannerCell {
        PlannerCell { x, y }
    }

    #[test]
    fn a_robot_keeps_out_of_rectangles_but_not_of_its_own_place() {
        static mut SET: PlannerCellSet = PlannerCellSet::NONE;
        let set = &raw mut SET;
        let mut memory = memory();
        let ready = created(&mut memory, CONFIG);
        assert_eq!(
            planner_add_rectangle(null_mut(), cell(0, 0), cell(1, 1)),
            PlannerResult::Null
        );
        assert_eq!(planner_add_rectangle(set, cell(3, 9), cell(7, 3)), OK);
        assert_eq!(planner_keep_out(ready, set), OK);
        let map = |at: PlannerCell| {
            let map = robot(ready).unwrap().planner.map();
            map.keeps_out(Cell::new(at.x, at.y))
        };
        assert!(map(cell(3, 3)) && map(cell(7, 9)) && !map(cell(8, 9)));
        assert_eq!(planner_keep_out(ready, null()), OK);
        assert!(!map(cell(3, 3)));
        assert_eq!(planner_add_rectangle(set, CONFIG.start, CONFIG.start), OK);
        assert_eq!(planner_keep_out(ready, set), PlannerResult::KeptOut);
        assert_eq!(planner_keep_out(null_mut(), set), PlannerResult::Null);
    }

    #[test]
    fn a_grid_moves_with_a_robot_that_settles() {
        let mut memory = memory();
        let ready = created(
            &mut memory,
            PlannerConfig {
                width: 24,
                ..CONFIG
            },
        );
        let place = || robot(ready).unwrap().planner.status().position;
        let (x, y) = (CONFIG.start.x, CONFIG.start.y);
        let columns = (x / 8 + 1) as i8;
        assert_eq!(planner_recentre(ready, columns, 0), PlannerResult::OffGrid);
        assert_eq!(place(), Cell::new(x, y));
        assert_eq!(planner_settle(ready), OK);
        for number in 0..16 {
            let columns = if number % 2 == 0 { -1 } else { 1 };
            assert_eq!(planner_recentre(ready, columns, 0), OK);
            assert_eq!(place(), Cell::new(x + 8 * (1 - number % 2), y));
        }
        assert_eq!(planner_recentre(ready, -1, 0), PlannerResult::TooOften);
        assert_eq!(planner_recentre(null_mut(), 0, 0), PlannerResult::Null);
        assert_eq!(planner_settle(null_mut()), PlannerResult::Null);
    }

    #[test]
    fn a_robot_goes_on_from_a_save_and_refuses_another() {
        let (mut memory, mut other) = (memory(), memory());
        let ready = created(&mut memory, CONFIG);
        let mut length = 0;
        assert_eq!(planner_saved_bytes(ready, &mut length), OK);
        let mut bytes = vec![0; length];
        let mut first = 0;
        loop {
            let page = &mut bytes[first..];
            let (room, mut written) = (page.len().min(50), 0);
            assert_eq!(
                planner_save(ready, first, page.as_mut_ptr(), room, &mut written),
                OK
            );
            match written {
                0 => break,
                _ => first += written,
            }
        }
        assert_eq!(first, length);
        let again = created(&mut other, CONFIG);
        let restore = |bytes: &[u8]| planner_restore(again, bytes.as_ptr(), bytes.len());
        assert_eq!(restore(&bytes), OK);
        assert_eq!(restore(&bytes[1..]), PlannerResult::NoSave);
        assert_eq!(restore(&bytes[..length - 1]), PlannerResult::SaveDamaged);
        assert_eq!(restore(&[]), PlannerResult::NoSave);
        assert_eq!(planner_go_to(again, CONFIG.start), OK);
        let id = CONFIG.id + 1;
        let again = created(&mut other, PlannerConfig { id, ..CONFIG });
        let result = planner_restore(again, bytes.as_ptr(), length);
        assert_eq!(result, PlannerResult::SaveOtherRobot);
        let cell_mm = CONFIG.cell_mm + 1;
        let again = created(&mut other, PlannerConfig { cell_mm, ..CONFIG });
        let result = planner_restore(again, bytes.as_ptr(), length);
        assert_eq!(result, PlannerResult::SaveOtherGrid);
        bytes[3] += 1;
        let result = planner_restore(again, bytes.as_ptr(), length);
        assert_eq!(result, PlannerResult::SaveVersion);
        assert_eq!(planner_restore(again, null(), 9), PlannerResult::Null);
        assert_eq!(
            planner_save(again, 0, null_mut(), 9, &mut 0),
            PlannerResult::Null
        );
    }
}
