//! What goes wrong in a run, as options.

use std::str::FromStr;

use clap::Args;
use host_sim::fleet::{Arrival, Death, Faults, Restart};
use host_sim::medium::{AirFaults, Forger, Partition, Reach};
use planner_core::RobotId;

use super::explore::parse_share;

/// Options of the air and of robots that fail.
#[derive(Args)]
#[command(next_help_heading = "What goes wrong")]
pub(super) struct FaultArgs {
    /// Share of messages lost, 0 to 1.
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_share)]
    pub(super) loss: f64,
    /// Who hears whom: all, sight (no obstacle between), or the number of cells
    /// that robots may be apart.
    #[arg(long, value_name = "WHO", default_value = "all", value_parser = parse_reach)]
    radio_range: Reach,
    /// Share of radio frames that arrive with wrong bits or cut short, 0 to 1.
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_share)]
    corrupt: f64,
    /// Share of radio frames that arrive twice, 0 to 1.
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_share)]
    duplicate: f64,
    /// Radio frames arrive up to this many ticks late, and overtake each other.
    #[arg(long, value_name = "TICKS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..=10_000))]
    delay: u32,
    /// N or N:KIND: somebody without the key lets every robot hear N forged frames a
    /// tick. KIND: any (robots and tiles, all drawn), or about robots only: hints,
    /// own-cell, around, goal, jump, stolen, crowd.
    #[arg(long, value_name = "N:KIND")]
    forge: Option<Forger>,
    /// FROM-UNTIL:N: in the ticks from FROM until before UNTIL, robots 0 to N-1 and
    /// the others do not hear each other. May be given again.
    #[arg(long, value_name = "FROM-UNTIL:N", value_parser = parse_partition)]
    partition: Vec<Partition>,
    /// ROBOT@TICK: this robot (from 0) dies in this tick. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    kill: Vec<Event>,
    /// ROBOT@TICK: this robot is not there before this tick. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    late: Vec<Event>,
    /// ROBOT@TICK: this robot starts anew where it stands, with an empty map, also
    /// if it was dead. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    restart: Vec<Event>,
}

impl FaultArgs {
    pub(super) fn air(&self) -> AirFaults {
        AirFaults {
            reach: self.radio_range,
            partitions: self.partition.clone(),
            duplication: self.duplicate,
            delay: self.delay,
            corruption: self.corrupt,
            forger: self.forge,
        }
    }

    /// What happens to which of so many robots.
    ///
    /// # Errors
    /// A robot that is not there, with the numbers that are.
    pub(super) fn of_robots(&self, robots: usize) -> Result<Faults, String> {
        for (option, events) in [
            ("kill", &self.kill),
            ("late", &self.late),
            ("restart", &self.restart),
        ] {
            if let Some(event) = events.iter().find(|of| usize::from(of.robot) >= robots) {
                let (robot, last) = (event.robot, robots - 1);
                return Err(format!(
                    "--{option}: there is no robot {robot}; robots are numbered 0 to {last}"
                ));
            }
        }
        let robot = |event: &Event| RobotId(event.robot);
        Ok(Faults {
            deaths: (self.kill.iter())
                .map(|event| Death {
                    robot: robot(event),
                    tick: event.tick,
                })
                .collect(),
            arrivals: (self.late.iter())
                .map(|event| Arrival {
                    robot: robot(event),
                    tick: event.tick,
                })
                .collect(),
            restarts: (self.restart.iter())
                .map(|event| Restart {
                    robot: robot(event),
                    tick: event.tick,
                })
                .collect(),
            closures: Vec::new(),
        })
    }
}

/// Something that happens to a robot in a tick.
#[derive(Clone, Copy)]
struct Event {
    robot: u8,
    tick: u32,
}

impl FromStr for Event {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.split_once('@')
            .and_then(|(robot, tick)| {
                Some(Self {
                    robot: robot.parse().ok()?,
                    tick: tick.parse().ok()?,
                })
            })
            .ok_or("expected ROBOT@TICK, for example 2@100: robot 2 in tick 100")
    }
}

fn parse_partition(text: &str) -> Result<Partition, &'static str> {
    let read = || {
        let (ticks, border) = text.split_once(':')?;
        let (from, until) = ticks.split_once('-')?;
        Some(Partition {
            from: from.parse().ok()?,
            until: until.parse().ok()?,
            border: border.parse().ok()?,
        })
    };
    read()
        .filter(|partition| partition.from < partition.until && partition.border > 0)
        .ok_or("expected FROM-UNTIL:N, for example 50-200:2: in ticks 50 to 199 robots 0 and 1 are cut off from the others")
}

fn parse_reach(text: &str) -> Result<Reach, String> {
    match text {
        "all" => Ok(Reach::Everywhere),
        "sight" => Ok(Reach::LineOfSight),
        _ => text
            .parse()
            .map(Reach::Cells)
            .map_err(|_| "expected all, sight or a number of cells, for example 12".into()),
    }
}
