//! A log through the planner's map.

use planner_core::explorer::{Config, Explorer};
use planner_core::sight::{Beam, Bearing, Pose, RangeScan, RangeSensor, Sighting};
use planner_core::{Cell, Extent, Planner, RobotId};

use super::frame::{CellSizeError, Frame, Options};
use super::line::{cell, line};
use super::score::{Belief, Score};
use super::votes::{Verdict, Votes};
use super::{Log, Look};
use crate::world::index;

/// Two places farther apart than this, in metres, or than so many times the log's median
/// step, are no way that was driven: the log goes on with another robot, or its pose jumped.
const LONGEST_STEP: f64 = 2.0;
const LONGEST_STEPS: f64 = 4.0;

/// A planner of the largest size, [`LARGEST`](crate::world::LARGEST).
type Robot = Explorer<64, 64>;

/// A log replayed: what the map came to believe, beside the vote of all beams.
pub struct Replayed {
    extent: Extent,
    robot: Box<Robot>,
    votes: Votes,
    /// Whether the robot drove through a cell, row by row.
    driven: Vec<bool>,
    ways: Vec<Vec<(f64, f64)>>,
}

impl Log {
    /// Feeds every look to a planner as a robot would: its scan where it was taken, and
    /// the place alone in each cell that it drove through on the way there; a tick each.
    ///
    /// # Errors
    /// A cell size that is none, or with which the log does not fit the largest planner.
    pub fn replay(&self, options: Options) -> Result<(Replayed, Score), CellSizeError> {
        let frame = Frame::of(self, options)?;
        let mut replayed = Replayed::before(self, &frame);
        let longest = self.longest_step() / options.cell_size;
        for look in &self.looks {
            replayed.go_to(frame.place(look), longest);
            replayed.look(self, &frame, look);
        }
        let score = Score::of(self, &frame, &replayed);
        Ok((replayed, score))
    }

    /// The longest way between two looks that was driven, in metres.
    fn longest_step(&self) -> f64 {
        let steps = self.looks.windows(2).map(|two| {
            let [from, to] = two else { return 0.0 };
            (to.x - from.x).hypot(to.y - from.y)
        });
        let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        let median = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
        LONGEST_STEP.min(LONGEST_STEPS * median)
    }
}

impl Replayed {
    fn before(log: &Log, frame: &Frame) -> Self {
        let extent = frame.extent;
        let start = log
            .looks
            .first()
            .map_or((0.0, 0.0), |look| frame.place(look));
        let mut robot = Box::new(Robot::vacant());
        let config = Config {
            sensor: frame.options.sensor,
            ..Config::new()
        };
        let fits = robot.reset(config, RobotId(0), extent, cell(start));
        fits.unwrap_or_else(|error| unreachable!("the grid was made to fit: {error}"));
        Self {
            extent,
            robot,
            votes: Votes::new(extent),
            driven: vec![false; extent.cells() as usize],
            ways: vec![vec![start]],
        }
    }

    /// Drives to a place, or is set down there if it is farther than `longest` cells.
    fn go_to(&mut self, place: (f64, f64), longest: f64) {
        let from = self.ways.last().and_then(|way| way.last());
        let (x, y) = from.copied().unwrap_or(place);
        let (dx, dy) = (place.0 - x, place.1 - y);
        let length = dx.hypot(dy);
        if length > longest {
            self.ways.push(vec![place]);
        } else {
            let cells = line((x, y), dy.atan2(dx));
            for (at, _) in cells.take_while(|(_, left)| *left < length) {
                self.driven[index(self.extent, at)] = true;
                if at != cell((x, y)) {
                    self.robot.observe(&Sighting::new(at));
                    self.robot.tick();
                }
            }
            self.ways.last_mut().expect("a way was begun").push(place);
        }
        self.driven[index(self.extent, cell(place))] = true;
    }

    fn look(&mut self, log: &Log, frame: &Frame, look: &Look) {
        let (place, reach) = (frame.place(look), frame.reach(log));
        for (bearing, range) in frame.measured(log, look) {
            let angle = bearing - look.heading;
            self.votes
                .count(place, angle, range.min(reach), range < reach);
        }
        let beams = frame.measured(log, look).map(|(bearing, range)| Beam {
            bearing: Bearing::from_radians(bearing as f32),
            range: range as f32,
        });
        let scan = RangeScan {
            pose: Pose {
                x: place.0 as f32,
                y: place.1 as f32,
                heading: -look.heading as f32,
            },
            sensor: RangeSensor::new(reach as f32),
            beams,
        };
        let sighting = scan.sighting();
        let sighting = sighting.unwrap_or_else(|error| unreachable!("checked on reading: {error}"));
        self.robot.observe(&sighting);
        self.robot.tick();
    }

    /// Size of the grid.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// What the map says of a cell of the grid.
    pub fn belief(&self, at: Cell) -> Belief {
        let map = self.robot.map();
        match () {
            () if map.is_free(at) => Belief::Free,
            () if map.is_doubtful(at) => Belief::Doubtful,
            () if map.is_obstacle(at) => Belief::Wall,
            () => Belief::Unknown,
        }
    }

    /// What the beams say of a cell of the grid.
    pub fn verdict(&self, at: Cell) -> Verdict {
        self.votes.verdict(at)
    }

    /// Whether the robot drove through a cell of the grid.
    pub fn is_driven(&self, at: Cell) -> bool {
        self.driven[index(self.extent, at)]
    }

    /// The places of the looks in cells, a list for each piece of way that was driven.
    pub fn ways(&self) -> &[Vec<(f64, f64)>] {
        &self.ways
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_core::explorer::SensorModel;

    use crate::scans::Reading;

    /// A room of 5×5 m with a pillar, in metres from its lower left corner: what a beam hits.
    fn distance(x: f64, y: f64, angle: f64) -> f64 {
        let inside = |x: f64, y: f64| {
            let pillar = (2.0..2.5).contains(&x) && (2.0..2.5).contains(&y);
            (0.0..5.0).contains(&x) && (0.0..5.0).contains(&y) && !pillar
        };
        let (sin, cos) = angle.sin_cos();
        let mut length = 0.0;
        while inside(x + length * cos, y + length * sin) {
            length += 0.001;
        }
        length
    }

    fn look(x: f64, y: f64, heading: f64) -> Look {
        let readings = (0..180).map(|beam| {
            let bearing = f64::from(beam) * std::f64::consts::TAU / 180.0;
            Reading {
                bearing: bearing as f32,
                range: distance(x, y, heading + bearing) as f32,
            }
        });
        Look {
            x,
            y,
            heading,
            readings: readings.collect(),
        }
    }

    fn room() -> Log {
        let looks = (0..14).map(|i| look(0.6 + 0.27 * f64::from(i), 1.1, 0.3 * f64::from(i)));
        Log {
            name: "room".into(),
            looks: looks.collect(),
            nothing_from: 10.0,
        }
    }

    const OPTIONS: Options = Options {
        cell_size: 0.25,
        range: 15,
        sensor: SensorModel::truthful(),
    };

    #[test]
    fn a_log_without_errors_is_believed() {
        let (replayed, score) = room().replay(OPTIONS).unwrap();
        // 20×20 cells less the pillar and its shadow.
        assert!((330..=396).contains(&score.open_floor), "{score:?}");
        // A cell that beams cross near its edge alone is not seen.
        assert_eq!(score.closed_percent, 0.0);
        assert!(score.cut_off_percent < 3.0, "{score:?}");
        assert_eq!((score.opened_percent, score.driven_closed), (0.0, 0));
        assert_eq!((score.looks, score.beams), (14, 14 * 180));
        assert_eq!(score.driven, 15);
        // Rows go down: those of the room, counted from its lower left corner.
        let at = |x: i16, y: i16| Cell::new(14 + x, 20 - y);
        let first = replayed.ways()[0][0];
        assert_eq!(cell(first), at(2, 4));
        assert_eq!(replayed.belief(at(10, 4)), Belief::Free);
        assert_eq!(replayed.belief(at(10, -1)), Belief::Wall);
        assert_eq!(replayed.verdict(at(10, -1)), Verdict::Wall);
    }

    /// A scanner that reaches two metres in a room of five: where it hit nothing, no wall is
    /// opened, and nothing is known beyond.
    #[test]
    fn a_beam_that_hit_nothing_frees_no_farther_than_the_scanner_reaches() {
        let mut log = room();
        log.nothing_from = 2.0;
        let far = log.looks.iter_mut().flat_map(|look| &mut look.readings);
        far.for_each(|reading| reading.range = reading.range.min(2.0));
        let (replayed, score) = log.replay(OPTIONS).unwrap();
        assert_eq!((score.opened_percent, score.driven_closed), (0.0, 0));
        // The wall across, 3.9 m away at the nearest.
        let at = |x: i16, y: i16| Cell::new(14 + x, 20 - y);
        assert_eq!(replayed.belief(at(10, 20)), Belief::Unknown);
        assert_eq!(replayed.belief(at(10, -1)), Belief::Wall);
    }

    #[test]
    fn what_a_few_looks_say_against_all_others_is_counted() {
        let mut log = room();
        let truth = log.replay(OPTIONS).unwrap().1;
        // Somebody stands before the robot, 0.6 m away, when it looks for the last time.
        for reading in &mut log.looks[13].readings[..20] {
            reading.range = 0.6;
        }
        let weighed = Options {
            sensor: SensorModel::lidar(),
            ..OPTIONS
        };
        let once = log.replay(weighed).unwrap().1;
        assert_eq!(once.open_floor, truth.open_floor);
        assert_eq!(once.closed_percent, 0.0);
        // And stays for two more looks.
        log.looks
            .extend([log.looks[13].clone(), log.looks[13].clone()]);
        assert!(log.replay(weighed).unwrap().1.closed_percent > 0.0);
    }

    #[test]
    fn a_leap_is_not_driven() {
        let mut log = room();
        log.looks.push(look(1.0, 4.0, 0.0));
        let (replayed, score) = log.replay(OPTIONS).unwrap();
        assert_eq!(replayed.ways().len(), 2);
        assert_eq!(score.driven, 16);
    }

    #[test]
    fn cells_that_do_not_fit_are_refused_with_a_size_that_does() {
        let mut log = room();
        log.looks.push(look(1.0, 1.0, 0.0));
        log.looks.last_mut().unwrap().x = 300.0;
        let error = log.replay(OPTIONS).err().unwrap();
        let CellSizeError::TooMany { suggested, .. } = error else {
            panic!("{error}");
        };
        let words = error.to_string();
        assert!(words.contains("room: the log spans 1231×"), "{words}");
        let larger = Options {
            cell_size: suggested,
            ..OPTIONS
        };
        assert!(log.replay(larger).is_ok());
        for cell_size in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
            let options = Options {
                cell_size,
                ..OPTIONS
            };
            let error = log.replay(options).err().unwrap().to_string();
            assert!(error.contains("expected 0.001 to 1000 m"), "{error}");
        }
    }
}
