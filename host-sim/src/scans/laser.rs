//! What a laser on the robots of a run would have measured: a log whose truth is known.

use std::f64::consts::TAU;
use std::io;

use planner_core::Cell;

use super::line::line;
use super::{Log, Look, Reading};
use crate::dice::Dice;
use crate::record::grid::Trace;
use crate::robot::Deed;
use crate::world::World;

/// A laser that turns around, and its errors: standard deviations of normal noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laser {
    /// Side of a cell in metres, where the map does not say it.
    pub cell_size: f64,
    /// How far the log's cells lie off the map's, in cells along both axes: what a robot
    /// maps does not begin at a wall.
    pub shift: f64,
    /// Beams a look, in equal steps all around.
    pub beams: u16,
    /// Largest range in metres, which is read where nothing is hit.
    pub range: f64,
    /// Error of a range in metres.
    pub range_error: f64,
    /// Error of either coordinate of a pose in metres.
    pub place_error: f64,
    /// Error of a heading in radians.
    pub heading_error: f64,
    /// Same seed, same errors.
    pub seed: u64,
}

impl Default for Laser {
    /// 360 beams of 8 m that err by 1 cm, from poses that err by 3 cm and 1°; cells of
    /// 0.25 m, those of the log a third of a cell off.
    fn default() -> Self {
        Self {
            cell_size: 0.25,
            shift: 0.35,
            beams: 360,
            range: 8.0,
            range_error: 0.01,
            place_error: 0.03,
            heading_error: TAU / 360.0,
            seed: 1,
        }
    }
}

impl Laser {
    /// A look in every cell that a robot entered, one robot after the other. The log's
    /// origin is the map's lower left corner, but for the shift.
    pub fn log(&self, trace: &Trace) -> Log {
        let world = &trace.scenario.world;
        let mut dice = Dice::new(self.seed);
        let mut looks = Vec::new();
        for (robot, &start) in trace.scenario.starts.iter().enumerate() {
            looks.push(self.look(world, start, 0.0, &mut dice));
            for record in &trace.records {
                if usize::from(record.robot) == robot
                    && let Deed::Moved(to) = record.deed
                {
                    // East, south, west, north; angles of a log grow the other way round.
                    let heading = -TAU / 4.0 * f64::from(to as u8);
                    looks.push(self.look(world, record.after(), heading, &mut dice));
                }
            }
        }
        Log {
            name: world.name().into(),
            looks,
            nothing_from: self.range as f32,
        }
    }

    /// What it measures from the middle of a cell.
    pub(crate) fn look(&self, world: &World, at: Cell, heading: f64, dice: &mut Dice) -> Look {
        let size = world.metres_per_cell().unwrap_or(self.cell_size);
        let from = (f64::from(at.x) + 0.5, f64::from(at.y) + 0.5);
        let readings = (0..self.beams).map(|beam| {
            let bearing = TAU * f64::from(beam) / f64::from(self.beams);
            let reach = self.range / size;
            let hit = first_hit(world, from, -heading - bearing, reach);
            let range = hit.map(|length| length * size + self.range_error * normal(dice));
            Reading {
                bearing: bearing as f32,
                range: range.map_or(self.range, |range| range.clamp(0.0, self.range)) as f32,
            }
        });
        let readings = readings.collect();
        let height = f64::from(world.extent().height);
        Look {
            x: (from.0 + self.shift) * size + self.place_error * normal(dice),
            y: (height - from.1 + self.shift) * size + self.place_error * normal(dice),
            heading: heading + self.heading_error * normal(dice),
            readings,
        }
    }
}

impl Log {
    /// Writes the log, a look a line: millimetres and tenths of a milliradian.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write(&self, mut to: impl io::Write) -> io::Result<()> {
        for look in &self.looks {
            write!(to, "{:.3} {:.3} {:.4}", look.x, look.y, look.heading)?;
            for Reading { bearing, range } in &look.readings {
                write!(to, " {bearing:.4} {range:.3}")?;
            }
            writeln!(to)?;
        }
        Ok(())
    }
}

/// How far from a place the first cell is that is not free, if it is nearer than `reach`.
fn first_hit(world: &World, from: (f64, f64), angle: f64, reach: f64) -> Option<f64> {
    let mut entered = 0.0;
    for (cell, left) in line(from, angle) {
        if entered >= reach {
            return None;
        }
        if !world.is_free(cell) {
            return Some(entered);
        }
        entered = left;
    }
    None
}

/// A number that is normally distributed, nearly: by sums alone, so that it is the same on
/// every machine.
fn normal(dice: &mut Dice) -> f64 {
    (0..12).map(|_| dice.unit()).sum::<f64>() - 6.0
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use planner_core::Extent;
    use planner_core::explorer::SensorModel;

    use super::*;
    use crate::planners::PlannerKind;
    use crate::run::{self, Options};
    use crate::scans::{Belief, Options as Replay};
    use crate::scenario::grid::Scenario;

    fn trace() -> Trace {
        // Two rooms with a door between them, and a wall into the first.
        let is_wall = |Cell { x, y }| x % 11 == 0 || y % 11 == 0 || x == 5 && y < 6;
        let is_door = |cell| cell == Cell::new(11, 4);
        let world = World::from_fn("rooms", Extent::new(23, 12), |cell| {
            is_wall(cell) && !is_door(cell)
        });
        let scenario = Scenario::new(
            Arc::new(world.unwrap()),
            vec![Cell::new(1, 1), Cell::new(2, 1)],
            PlannerKind::Explorer,
        );
        let options = Options {
            trace: true,
            ..Options::default()
        };
        run::run(&scenario, options).unwrap().1.unwrap()
    }

    const CELLS: Replay = Replay {
        cell_size: 0.25,
        range: 15,
        sensor: SensorModel::truthful(),
    };

    #[test]
    fn a_log_without_errors_shows_the_world() {
        let trace = trace();
        let exact = Laser {
            shift: 0.0,
            range_error: 0.0,
            place_error: 0.0,
            heading_error: 0.0,
            ..Laser::default()
        };
        let log = exact.log(&trace);
        let (replayed, score) = log.replay(CELLS).unwrap();
        assert_eq!(score.closed_percent, 0.0);
        assert_eq!((score.opened_percent, score.driven_closed), (0.0, 0));
        let world = &trace.scenario.world;
        let (x, y) = replayed.ways()[0][0];
        let (west, north) = (x as i16 - 1, y as i16 - 1);
        let mut unseen = 0;
        for cell in crate::world::cells(world.extent()) {
            let believed = replayed.belief(Cell::new(west + cell.x, north + cell.y));
            // A cell that beams cross near its edge alone is not seen.
            match believed {
                Belief::Unknown => unseen += u32::from(world.is_free(cell)),
                Belief::Free => assert!(world.is_free(cell), "{cell} is a wall"),
                Belief::Doubtful | Belief::Wall => {
                    assert!(!world.is_free(cell), "{cell} is free");
                }
            }
        }
        assert!(unseen <= 10, "{unseen}");
        // As a file it is the same to the millimetre.
        let mut bytes = Vec::new();
        log.write(&mut bytes).unwrap();
        let read = Log::from_lines(&bytes[..]).unwrap();
        assert_eq!(read.looks.len(), log.looks.len());
        let (again, exactly) = (&read.looks[3], &log.looks[3]);
        assert!((again.x - exactly.x).abs() <= 5e-4 && (again.y - exactly.y).abs() <= 5e-4);
        assert_eq!(again.readings.len(), 360);
        let score = read.replay(CELLS).unwrap().1;
        assert_eq!((score.opened_percent, score.driven_closed), (0.0, 0));
    }

    #[test]
    fn the_same_seed_errs_alike() {
        let trace = trace();
        let laser = Laser::default();
        assert_eq!(laser.log(&trace), laser.log(&trace));
        assert_ne!(laser.log(&trace), Laser { seed: 2, ..laser }.log(&trace));
        let exact = Laser {
            place_error: 0.0,
            ..laser
        };
        let off = |a: &Look, b: &Look| (a.x - b.x).abs();
        let (noisy, exact) = (laser.log(&trace), exact.log(&trace));
        let errors = noisy.looks.iter().zip(&exact.looks);
        let errors: Vec<f64> = errors.map(|(noisy, exact)| off(noisy, exact)).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        // Of a normal error of 3 cm, 0.8 of that; from some dozens of looks.
        assert!((0.012..0.036).contains(&mean), "{mean}");
    }
}
