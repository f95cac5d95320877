//! What a run leaves behind.

use planner_core::surface::Column;
use planner_core::survey::Stop;
use planner_core::{Cell, Extent, Point};

/// One decision of one robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// In which step.
    pub step: u32,
    /// Whose.
    pub robot: u8,
    /// Where the robot is after it.
    pub at: Point,
    /// What the robot's last step added to its reward [Renzaglia2019 eq. 1].
    pub gain: f32,
    /// The frontier that it announces.
    pub target: Option<Cell>,
    /// Whether it has stopped, and why.
    pub stop: Option<Stop>,
    /// Whether the flight controller refused the flight.
    pub blocked: bool,
    /// Work of the decision, as the planner counts it.
    pub work: u32,
}

/// Steps at which something happened that never should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Safety {
    /// Flights below the least altitude or above the ceiling.
    pub altitude_violations: u32,
    /// Flights through the ground or out of the box.
    pub obstacle_violations: u32,
    /// Pairs of robots too near to each other.
    pub separation_violations: u32,
    /// Flights longer than a step.
    pub step_violations: u32,
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Size of the terrain.
    pub extent: Extent,
    /// Number of robots at the start.
    pub robots: usize,
    /// Where they started.
    pub starts: Vec<Point>,
    /// Every decision, in order.
    pub records: Vec<Record>,
    /// Columns that anybody had seen after each number of steps, from 0.
    pub seen: Vec<u32>,
    /// The columns in the order in which they were seen, each with the step.
    pub found: Vec<(u32, Column)>,
    /// Whether the run ended because every living robot had stopped.
    pub all_stopped: bool,
    /// What should never happen.
    pub safety: Safety,
    /// Host time of each decision; not part of the digest, and empty in the browser.
    pub decision_nanoseconds: Vec<u64>,
}

impl Trace {
    pub(super) fn new(extent: Extent, starts: Vec<Point>) -> Self {
        Self {
            extent,
            robots: starts.len(),
            starts,
            records: Vec::new(),
            seen: Vec::new(),
            found: Vec::new(),
            all_stopped: false,
            safety: Safety::default(),
            decision_nanoseconds: Vec::new(),
        }
    }

    /// Steps until `share` of all columns had been seen.
    pub fn steps_to(&self, share: f64) -> Option<u32> {
        let wanted = (share * f64::from(self.extent.cells())).ceil() as u32;
        self.seen
            .iter()
            .position(|&seen| seen >= wanted)
            .map(|step| step as u32)
    }

    /// Whether all columns had been seen at the end.
    pub fn complete(&self) -> bool {
        self.steps_to(1.0).is_some()
    }

    /// The columns that anybody had seen after `steps` steps.
    pub fn mapped(&self, steps: u32) -> impl Iterator<Item = Column> + '_ {
        self.found
            .iter()
            .take_while(move |(step, _)| *step <= steps)
            .map(|(_, column)| *column)
    }

    /// Steps until the last living robot had stopped, if all have.
    pub fn steps_to_stopped(&self) -> Option<u32> {
        self.all_stopped.then(|| self.seen.len() as u32 - 1)
    }

    /// Where `robot` was, from the start until after `steps` steps.
    pub fn way(&self, robot: usize, steps: u32) -> Vec<Point> {
        let start = self.starts.get(robot).copied();
        let records = self
            .records
            .iter()
            .filter(|record| usize::from(record.robot) == robot);
        start
            .into_iter()
            .chain(
                records
                    .take_while(|record| record.step < steps)
                    .map(|record| record.at),
            )
            .collect()
    }

    /// One line for each decision, positions in cells.
    pub fn write_csv(&self, mut to: impl std::io::Write) -> std::io::Result<()> {
        writeln!(to, "step,robot,x,y,z,gain,work,refused,stopped")?;
        for record in &self.records {
            let Record {
                step,
                robot,
                at,
                gain,
                work,
                blocked,
                stop,
                ..
            } = record;
            let stopped = stop.is_some();
            writeln!(
                to,
                "{step},{robot},{},{},{},{gain},{work},{blocked},{stopped}",
                at.x, at.y, at.z
            )?;
        }
        Ok(())
    }

    /// A number that two runs share only if every decision is the same, bit for bit
    /// (FNV-1a).
    pub fn digest(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        let mut eat = |word: u32| {
            for byte in word.to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        for record in &self.records {
            eat(record.step);
            eat(u32::from(record.robot));
            for coordinate in [record.at.x, record.at.y, record.at.z] {
                eat(coordinate.to_bits());
            }
            eat(u32::from(record.stop.is_some()) | u32::from(record.blocked) << 1);
        }
        hash
    }
}
