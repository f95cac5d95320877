//! What goes wrong in a run, as options.

use clap::Args;
use host_sim::fleet::{
    Arrival, Blind, Closure, Death, Faults, LostPose, Restart, Resume, SensorFailure,
};
use host_sim::medium::{AirFaults, Forger, Partition, Reach};

use super::explore::parse_share;

/// Options of the air, and of robots, cells and senses that fail.
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
    kill: Vec<Death>,
    /// ROBOT@TICK: this robot is not there before this tick. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    late: Vec<Arrival>,
    /// ROBOT@TICK: this robot starts anew where it stands, with an empty map, also
    /// if it was dead. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    restart: Vec<Restart>,
    /// ROBOT@TICK: this robot is told to go on with its map, also if it had stopped. May
    /// be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    resume: Vec<Resume>,
    /// X,Y or X,Y@FROM-UNTIL: nobody can enter this cell, always or in the ticks from
    /// FROM until before UNTIL, and no sensor shows that. May be given again.
    #[arg(long, value_name = "X,Y[@FROM-UNTIL]")]
    close: Vec<Closure>,
    /// X,Y or X,Y@FROM-UNTIL: no sensor says anything of this cell, as of glass. May be
    /// given again.
    #[arg(long, value_name = "X,Y[@FROM-UNTIL]")]
    blind: Vec<Blind>,
    /// ROBOT@TICK: from this tick on this robot's sensor shows nothing. May be given
    /// again.
    #[arg(long, value_name = "ROBOT@TICK")]
    sensor_fails: Vec<SensorFailure>,
    /// ROBOT@FROM-UNTIL: in these ticks this robot's pose lies off the grid. May be given
    /// again.
    #[arg(long, value_name = "ROBOT@FROM-UNTIL")]
    pose_lost: Vec<LostPose>,
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
        let kill = self.kill.iter().map(|of| ("kill", of.robot));
        let late = self.late.iter().map(|of| ("late", of.robot));
        let restart = self.restart.iter().map(|of| ("restart", of.robot));
        let resume = self.resume.iter().map(|of| ("resume", of.robot));
        let sensor_fails = self.sensor_fails.iter();
        let sensor_fails = sensor_fails.map(|of| ("sensor-fails", of.robot));
        let pose_lost = self.pose_lost.iter().map(|of| ("pose-lost", of.robot));
        let mut named = kill
            .chain(late)
            .chain(restart)
            .chain(resume)
            .chain(sensor_fails)
            .chain(pose_lost);
        if let Some((option, robot)) = named.find(|(_, robot)| usize::from(robot.0) >= robots) {
            return Err(format!(
                "--{option}: there is no robot {}; robots are numbered 0 to {}",
                robot.0,
                robots - 1
            ));
        }
        Ok(Faults {
            deaths: self.kill.clone(),
            arrivals: self.late.clone(),
            restarts: self.restart.clone(),
            resumes: self.resume.clone(),
            closures: self.close.clone(),
            blind: self.blind.clone(),
            sensor_failures: self.sensor_fails.clone(),
            lost_poses: self.pose_lost.clone(),
        })
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
