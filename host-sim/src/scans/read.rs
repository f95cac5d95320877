//! Logs as files: a look a line, or CARMEN's lines.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::str::FromStr;

use thiserror::Error;

use super::{Log, Look, Reading};
use crate::excerpt::{excerpt, printable};

/// Bytes of a file that are read.
const MOST_BYTES: u64 = 256 << 20;
/// Bytes of a line.
const MOST_LINE: u64 = 1 << 20;
/// How MCAP recordings begin.
const MCAP: &[u8] = b"\x89MCAP";
/// Largest number that is read: metres from the origin, radians.
pub(super) const FARTHEST: f64 = 1e6;

/// How the two formats begin their lines.
const READ: &str = "a look a line: `x y heading bearing range …`, or CARMEN's FLASER and \
                    ROBOTLASER lines";

/// A log that cannot be read, and why.
#[derive(Debug, Error)]
#[error("{}: {problem}", printable(file))]
pub struct LogError {
    /// The file as it was named.
    pub file: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What is wrong with a log. Lines and fields count from 1.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum Problem {
    #[error("no such file; check the path")]
    Missing,
    #[error("cannot be read: {0}; check that it is a file that you may read")]
    Unreadable(#[from] io::Error),
    #[error("is no file but a folder or a device; expected a log of scans: {READ}")]
    NoFile,
    #[error("has more than {} MiB; cut the log into parts", MOST_BYTES >> 20)]
    TooLong,
    #[error(
        "is an MCAP recording, and reading those was left out of this program; run it with \
         `cargo run --release --features mcap --`, or write its scans as text, {READ}"
    )]
    Mcap,
    #[error(
        "cannot be read as an MCAP recording: {0}; mend it with `mcap recover`, or write it anew \
         without compression (`mcap compress --compression none`)"
    )]
    Bag(String),
    #[error("holds no sensor_msgs/LaserScan; record the topic of the scans, too")]
    NoScanInBag,
    #[error(
        "tells nowhere where the scans of frame {0} were taken; record /tf and /tf_static, or \
         odometry of that frame, too"
    )]
    NoPoseInBag(String),
    #[error("line {line}: has more than {} bytes; expected {READ}", MOST_LINE)]
    LongLine { line: usize },
    #[error("line {line}: is not UTF-8 text; expected {READ}")]
    NotText { line: usize },
    #[error("line {line}, field {field}: expected {expected}, found \"{found}\"")]
    Field {
        line: usize,
        field: usize,
        expected: &'static str,
        found: String,
    },
    #[error("line {line}: ends after {found} fields; expected {expected} more")]
    Short {
        line: usize,
        found: usize,
        expected: &'static str,
    },
    #[error(
        "holds no scan with a pose; expected {READ} (RAWLASER lines have no pose: let a SLAM \
         program correct the log first)"
    )]
    NoScan,
}

impl Log {
    /// Reads a log, line by line. Which format it is, each line tells. Lines that are
    /// empty, that begin with `#`, and CARMEN's other messages say nothing.
    ///
    /// # Errors
    /// [`LogError`] names the line and the field, and what was expected.
    pub fn read(path: &Path) -> Result<Self, LogError> {
        let log = open(path).and_then(|file| Self::from_file(BufReader::new(file)));
        let mut log = log.map_err(|problem| LogError {
            file: path.display().to_string(),
            problem,
        })?;
        log.name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        Ok(log)
    }

    fn from_file(mut file: impl BufRead) -> Result<Self, Problem> {
        if !file.fill_buf()?.starts_with(MCAP) {
            return Self::from_lines(file);
        }
        #[cfg(feature = "mcap")]
        {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            super::bag::log(&bytes)
        }
        #[cfg(not(feature = "mcap"))]
        Err(Problem::Mcap)
    }

    /// A log out of lines.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_lines(mut lines: impl BufRead) -> Result<Self, Problem> {
        let mut log = Self::default();
        let mut says: Option<f32> = None;
        let mut bytes = Vec::new();
        for line in 1.. {
            bytes.clear();
            (&mut lines)
                .take(MOST_LINE + 1)
                .read_until(b'\n', &mut bytes)?;
            if bytes.is_empty() {
                break;
            }
            if bytes.len() as u64 > MOST_LINE {
                return Err(Problem::LongLine { line });
            }
            let text = str::from_utf8(&bytes).map_err(|_| Problem::NotText { line })?;
            if let Some((look, largest)) = Fields::of(line, text).look()? {
                log.looks.push(look);
                says = largest.map_or(says, |range| Some(says.map_or(range, |r| r.max(range))));
            }
        }
        if log.looks.is_empty() {
            return Err(Problem::NoScan);
        }
        let readings = log.looks.iter().flat_map(|look| &look.readings);
        let largest = readings.map(|reading| reading.range).fold(0.0, f32::max);
        log.nothing_from = says.unwrap_or(largest);
        Ok(log)
    }
}

fn open(path: &Path) -> Result<File, Problem> {
    let missing = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => Problem::Missing,
        _ => error.into(),
    };
    // Neither a pipe without a writer nor a device without an end is waited for.
    let about = fs::metadata(path).map_err(missing)?;
    if !about.is_file() {
        return Err(Problem::NoFile);
    }
    if about.len() > MOST_BYTES {
        return Err(Problem::TooLong);
    }
    File::open(path).map_err(missing)
}

/// What is left of a line.
struct Fields<'a> {
    line: usize,
    /// Fields read.
    read: usize,
    rest: std::str::SplitWhitespace<'a>,
}

impl<'a> Fields<'a> {
    fn of(line: usize, text: &'a str) -> Self {
        Self {
            line,
            read: 0,
            rest: text.split_whitespace(),
        }
    }

    fn next(&mut self) -> Option<&'a str> {
        let field = self.rest.next()?;
        self.read += 1;
        Some(field)
    }

    fn parse<T: FromStr>(
        &self,
        field: &str,
        expected: &'static str,
        is_valid: impl Fn(&T) -> bool,
    ) -> Result<T, Problem> {
        let value = field.parse().ok().filter(is_valid);
        value.ok_or_else(|| Problem::Field {
            line: self.line,
            field: self.read,
            expected,
            found: excerpt(field),
        })
    }

    fn need(&mut self, expected: &'static str) -> Result<&'a str, Problem> {
        self.next().ok_or(Problem::Short {
            line: self.line,
            found: self.read,
            expected,
        })
    }

    fn count(&mut self, expected: &'static str) -> Result<usize, Problem> {
        let field = self.need(expected)?;
        // A beam takes two bytes at least.
        self.parse(field, expected, |count| *count as u64 <= MOST_LINE / 2)
    }

    fn number(&mut self, expected: &'static str) -> Result<f64, Problem> {
        let field = self.need(expected)?;
        self.parse(field, expected, is_near)
    }

    fn range(&mut self) -> Result<f32, Problem> {
        Ok(self.number("a range in metres")? as f32)
    }

    /// The look that the line holds, if it holds one, and the range from which on its
    /// readings hit nothing, if it says so.
    fn look(mut self) -> Result<Option<(Look, Option<f32>)>, Problem> {
        let Some(first) = self.next() else {
            return Ok(None);
        };
        Ok(match first {
            "FLASER" => Some((self.flaser()?, None)),
            "ROBOTLASER1" | "ROBOTLASER2" => {
                let (look, largest) = self.robot_laser()?;
                Some((look, Some(largest)))
            }
            _ if first.starts_with(|sign: char| sign.is_ascii_uppercase() || sign == '#') => None,
            _ => Some((self.plain(first)?, None)),
        })
    }

    /// `x y heading bearing range bearing range …`
    fn plain(mut self, x: &str) -> Result<Look, Problem> {
        let x = self.parse(x, X, is_near)?;
        let (y, heading) = (self.number(Y)?, self.number(HEADING)?);
        let mut readings = Vec::new();
        while let Some(field) = self.next() {
            let bearing = self.parse(field, BEARING, is_near)? as f32;
            let range = self.range()?;
            readings.push(Reading { bearing, range });
        }
        Ok(Look {
            x,
            y,
            heading,
            readings,
        })
    }

    /// `num_readings [readings] x y theta odom_x odom_y odom_theta …`: half a turn of
    /// beams, from the right to the left; an odd number has one at both ends.
    fn flaser(mut self) -> Result<Look, Problem> {
        let count = self.count(COUNT)?;
        let step = std::f64::consts::PI / (count - count % 2).max(1) as f64;
        let readings = self.fan(count, -std::f64::consts::FRAC_PI_2, step)?;
        self.placed(readings)
    }

    /// `laser_type start_angle field_of_view angular_resolution maximum_range accuracy
    /// remission_mode num_readings [readings] num_remissions [remissions] laser_x laser_y
    /// laser_theta robot_x …`
    fn robot_laser(mut self) -> Result<(Look, f32), Problem> {
        self.need("the laser's type")?;
        let start = self.number("the first beam's angle in radians")?;
        self.number("the field of view in radians")?;
        let step = self.number("the angle between two beams in radians")?;
        let largest = self.number("the largest range in metres")? as f32;
        self.need("the accuracy")?;
        self.need("the remission mode")?;
        let count = self.count(COUNT)?;
        let readings = self.fan(count, start, step)?;
        for _ in 0..self.count("the number of remissions")? {
            self.need("a remission")?;
        }
        Ok((self.placed(readings)?, largest))
    }

    /// So many ranges, from a bearing on, `step` apart.
    fn fan(&mut self, count: usize, start: f64, step: f64) -> Result<Vec<Reading>, Problem> {
        let reading = |beam| {
            let bearing = (start + step * beam as f64) as f32;
            let range = self.range()?;
            Ok(Reading { bearing, range })
        };
        (0..count).map(reading).collect()
    }

    /// A look from the pose that comes next.
    fn placed(mut self, readings: Vec<Reading>) -> Result<Look, Problem> {
        Ok(Look {
            x: self.number(X)?,
            y: self.number(Y)?,
            heading: self.number(HEADING)?,
            readings,
        })
    }
}

/// Whether a place, an angle or a range is one that a robot can have; a number that is
/// not finite is none.
fn is_near(value: &f64) -> bool {
    value.abs() <= FARTHEST
}

const X: &str = "x in metres, or the name of a CARMEN message";
const Y: &str = "y in metres";
const HEADING: &str = "the heading in radians";
const BEARING: &str = "a bearing in radians";
const COUNT: &str = "the number of readings";

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Log, Problem> {
        Log::from_lines(text.as_bytes())
    }

    fn error(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    /// Bearing and range of a beam, in thousandths.
    fn beam(look: &Look, beam: usize) -> (i32, i32) {
        let Reading { bearing, range } = look.readings[beam];
        ((1e3 * bearing).round() as i32, (1e3 * range).round() as i32)
    }

    #[test]
    fn a_look_a_line() {
        let log = read("# a log\n\n1 -2.5 0.5 -0.1 1.5 0.1 3e0\n2 0 0\n").unwrap();
        assert_eq!(log.looks.len(), 2);
        let look = &log.looks[0];
        assert_eq!((look.x, look.y, look.heading), (1.0, -2.5, 0.5));
        assert_eq!((beam(look, 0), beam(look, 1)), ((-100, 1500), (100, 3000)));
        assert_eq!(log.nothing_from, 3.0);
        assert!(log.looks[1].readings.is_empty());
    }

    #[test]
    fn carmen_lines_of_both_kinds() {
        let log = read(
            "# CARMEN Logfile\nPARAM robot_length 0.8\n\
             ODOM 0 0 0 0 0 0 1.0 host 1.0\n\
             FLASER 3 1.0 2.0 81.9 4.0 5.0 0.7 4.1 5.1 0.71 12.5 host 1.5\n\
             ROBOTLASER1 0 -0.5 1.0 0.5 8.0 0.01 0 3 1.0 8.0 2.0 2 7 9 \
             -4.0 -5.0 0.1 0 0 0 0 0 0.3 0.3 1e6 12.6 host 1.6\n\
             RAWLASER1 0 -1.5 3.1 0.1 80 0.01 0 1 5.0 0 13 host 2\n",
        )
        .unwrap();
        let [old, new] = &log.looks[..] else { panic!() };
        assert_eq!((old.x, old.y, old.heading), (4.0, 5.0, 0.7));
        assert_eq!(beam(old, 0), (-1571, 1000));
        assert_eq!(beam(old, 2), (1571, 81_900));
        assert_eq!((new.x, new.y, new.heading), (-4.0, -5.0, 0.1));
        assert_eq!((beam(new, 0), beam(new, 2)), ((-500, 1000), (500, 2000)));
        // As the line says, not as the largest reading would.
        assert_eq!(log.nothing_from, 8.0);
        // An even number of beams has none at the left end.
        let even = read("FLASER 2 1 2 0 0 0 0 0 0 1 host 1").unwrap();
        assert_eq!(beam(&even.looks[0], 1), (0, 2000));
    }

    #[test]
    fn errors_name_line_and_field() {
        for (text, words) in [
            (
                "1 2 3 4 5\n1 2 3 4 nan",
                "line 2, field 5: expected a range in metres",
            ),
            (
                "1 2 3 4 5\n1 2 3 inf 4",
                "line 2, field 4: expected a bearing",
            ),
            ("1 2 1e99", "line 1, field 3: expected the heading"),
            ("1 2 3 4", "line 1: ends after 4 fields; expected a range"),
            ("1 2", "line 1: ends after 2 fields; expected the heading"),
            ("x 2", "line 1, field 1: expected x in metres, or the name"),
            (
                "FLASER 2 1 2 3 4",
                "line 1: ends after 6 fields; expected the heading",
            ),
            (
                "FLASER -1 1",
                "field 2: expected the number of readings, found \"-1\"",
            ),
            (
                "FLASER 99999999999 1",
                "field 2: expected the number of readings",
            ),
            ("ROBOTLASER1 0 0 0 0 0 0 0 1 5 9", "expected a remission"),
            (
                "RAWLASER1 0 0 0 0 8 0 0 1 1 0 1 h 1",
                "holds no scan with a pose",
            ),
            ("", "holds no scan with a pose"),
            ("\u{1b}[2J", "found \"\\u{1b}[2J\""),
        ] {
            let error = error(text);
            assert!(error.contains(words), "{words:?} is not in {error}");
        }
        assert!(matches!(
            Log::from_lines(&b"1 2 3\n\xff"[..]),
            Err(Problem::NotText { line: 2 })
        ));
        assert!(matches!(
            Log::from_file(&b"\x89MCAP0\r\n"[..]),
            Err(Problem::Mcap | Problem::Bag(_) | Problem::NoScanInBag)
        ));
        let endless = std::io::repeat(b'1');
        assert!(matches!(
            Log::from_lines(BufReader::new(endless)),
            Err(Problem::LongLine { line: 1 })
        ));
    }
}
