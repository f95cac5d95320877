//! Conditions as options of a command and as parts of an address: the same names in both,
//! in every command.

use clap::{Args, Command, FromArgMatches};
use planner_core::radio::{Key, LinkConfig};

use super::{
    AirFaults, CellSpan, Conditions, Event, Faults, Forger, LimitsArgs, MediumKind, MissionArgs,
    Partition, Preset, Reach, RobotSpan, ScenarioError, TroubleArgs, key,
};
use crate::world::World;

/// The options of a robot's radio.
#[derive(Args, Clone)]
pub struct LinkArgs {
    /// Bytes that a robot may send by radio in a tick on average; less than a frame: one
    /// every few ticks. Default: 55 on the ground, 550 in the air.
    #[arg(long, value_name = "BYTES")]
    byte_budget: Option<u16>,
    /// Sign frames, and take signed ones only: the fleet's secret as 32 hex digits, or a
    /// file that holds them.
    #[arg(long, value_name = "HEX|FILE", value_parser = key::parse)]
    key: Option<Key>,
}

impl LinkArgs {
    /// How a robot on the ground uses the radio.
    pub fn link(&self) -> LinkConfig {
        let usual = LinkConfig::new();
        LinkConfig {
            bytes_per_tick: self.byte_budget.unwrap_or(usual.bytes_per_tick),
            key: self.key,
            ..usual
        }
    }
}

/// The options that set [`Conditions`]. What is not given stays as it is.
#[derive(Args, Clone)]
#[command(next_help_heading = "Conditions and faults")]
pub struct ConditionsArgs {
    /// How robots tell each other what they know: in radio frames of at most 55 bytes, or
    /// ideally, everything at once as in the papers. Default: radio.
    #[arg(long, value_name = "NAME")]
    medium: Option<MediumKind>,
    /// Ticks between two exchanges of maps, or between two transmissions of a robot; 0:
    /// never. Default: 1.
    #[arg(long, value_name = "D")]
    sync: Option<u32>,
    #[command(flatten)]
    link: LinkArgs,
    /// Share of messages lost, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    loss: Option<f64>,
    /// Who hears whom: all, sight (no obstacle between), or the number of cells
    /// that robots may be apart. Default: all.
    #[arg(long, value_name = "WHO")]
    radio_range: Option<Reach>,
    /// FROM-UNTIL:N: in the ticks from FROM until before UNTIL, robots 0 to N-1 and
    /// the others do not hear each other. May be given again.
    #[arg(long, value_name = "FROM-UNTIL:N")]
    partition: Vec<Partition>,
    /// Share of radio frames that arrive twice, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    duplicate: Option<f64>,
    /// Radio frames arrive up to this many ticks late, and overtake each other.
    #[arg(long, value_name = "TICKS", value_parser = clap::value_parser!(u32).range(..=10_000))]
    delay: Option<u32>,
    /// Share of radio frames that arrive with wrong bits or cut short, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    corrupt: Option<f64>,
    /// N or N:KIND: somebody without the key lets every robot hear N forged frames a
    /// tick. KIND: any (robots and tiles, all drawn), or about robots only: hints,
    /// own-cell, around, goal, jump, stolen, crowd.
    #[arg(long, value_name = "N:KIND")]
    forge: Option<Forger>,
    /// Seed of all chance in the run. Default: 1 on the ground, 0 in the air.
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Give up after this many ticks. Default: 1000 and 8 for each reachable cell, for
    /// bmilrv 100; in the air 20000.
    #[arg(long, value_name = "T")]
    max_ticks: Option<u32>,
    /// ROBOT@TICK: this robot (from 0) dies in this tick. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    kill: Vec<Event>,
    /// ROBOT@TICK: this robot arrives in this tick. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    late: Vec<Event>,
    /// ROBOT@TICK: this robot starts anew where it is, with an empty map, also
    /// if it was dead. May be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    restart: Vec<Event>,
    /// ROBOT@TICK: this robot is told to go on with its map, also if it had stopped. May
    /// be given again.
    #[arg(long, value_name = "ROBOT@TICK")]
    resume: Vec<Event>,
    /// X,Y or X,Y@FROM-UNTIL: nobody can enter this cell, always or in the ticks from
    /// FROM until before UNTIL, and no sensor shows that. May be given again.
    #[arg(long, value_name = "X,Y[@FROM-UNTIL]")]
    close: Vec<CellSpan>,
    /// X,Y or X,Y@FROM-UNTIL: this cell is blocked, and sensors show it: a door is shut, or
    /// somebody stands there. May be given again.
    #[arg(long, value_name = "X,Y[@FROM-UNTIL]")]
    shut: Vec<CellSpan>,
    /// X,Y or X,Y@FROM-UNTIL: no sensor says anything of this cell, as of glass. May be
    /// given again.
    #[arg(long, value_name = "X,Y[@FROM-UNTIL]")]
    blind: Vec<CellSpan>,
    /// ROBOT@TICK: from this tick on this robot's sensor shows nothing. May be given
    /// again.
    #[arg(long, value_name = "ROBOT@TICK")]
    sensor_fails: Vec<Event>,
    /// ROBOT@FROM-UNTIL: in these ticks this robot's pose lies off the grid. May be given
    /// again.
    #[arg(long, value_name = "ROBOT@FROM-UNTIL")]
    pose_lost: Vec<RobotSpan>,
    /// The robots' model of their sensors: truthful (always right), lidar (errors come and
    /// go) or rangers (errors depend on the place). For the explorer; among voxels truthful or rangers.
    /// Default: truthful.
    #[arg(long, value_name = "NAME")]
    preset: Option<Preset>,
    /// In the air, flights and hovers end off where they should: along each axis by this many
    /// cells, the standard deviation, 0 to 1: the metres of drift in a step, divided by the side
    /// of a cell. Robots know where they have come to. Default: 0.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    wind: Option<f64>,
    #[command(flatten)]
    mission: MissionArgs,
    #[command(flatten)]
    limits: LimitsArgs,
    #[command(flatten)]
    trouble: TroubleArgs,
}

impl ConditionsArgs {
    /// The seed, if it is given.
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// The option that names cells to keep out of, if one is given.
    pub fn limit(&self) -> Option<&'static str> {
        self.limits.option()
    }

    /// Finds the cells of areas in metres.
    ///
    /// # Errors
    /// The map does not say how wide its cells are.
    pub fn lay(&mut self, world: &World) -> Result<(), ScenarioError> {
        Ok(self.limits.lay(world)?)
    }

    /// Whether frames are to be signed.
    pub fn has_key(&self) -> bool {
        self.link.key.is_some()
    }

    /// Sets what is given.
    ///
    /// # Errors
    /// A budget of bytes for a medium that has none; areas in metres that are not
    /// [laid](Self::lay).
    pub fn set(self, conditions: &mut Conditions) -> Result<(), ScenarioError> {
        let Conditions {
            medium,
            sync,
            byte_budget,
            loss,
            air,
            key,
            seed,
            max_ticks,
            faults,
            trouble,
            preset,
            mission,
            limits,
            wind,
        } = conditions;
        let AirFaults {
            reach,
            partitions,
            duplication,
            delay,
            corruption,
            forger,
        } = air;
        let Faults {
            deaths,
            arrivals,
            restarts,
            resumes,
            closures,
            shut,
            blind,
            sensor_failures,
            lost_poses,
        } = faults;
        replace(medium, self.medium);
        replace(sync, self.sync);
        replace(byte_budget, self.link.byte_budget);
        replace(loss, self.loss);
        replace(reach, self.radio_range);
        partitions.extend(self.partition);
        replace(duplication, self.duplicate);
        replace(delay, self.delay);
        replace(corruption, self.corrupt);
        *forger = self.forge.or(*forger);
        *key = self.link.key.or(*key);
        replace(seed, self.seed);
        replace(max_ticks, self.max_ticks);
        deaths.extend(self.kill);
        arrivals.extend(self.late);
        restarts.extend(self.restart);
        resumes.extend(self.resume);
        closures.extend(self.close);
        shut.extend(self.shut);
        blind.extend(self.blind);
        sensor_failures.extend(self.sensor_fails);
        lost_poses.extend(self.pose_lost);
        *trouble = self.trouble.over(*trouble);
        replace(preset, self.preset);
        *mission = self.mission.over(*mission);
        replace(&mut wind.deviation, self.wind);
        self.limits.over(limits)?;
        match (medium, self.link.byte_budget) {
            (MediumKind::Ideal, Some(_)) => Err(ScenarioError::NoFrames("byte-budget")),
            _ => Ok(()),
        }
    }
}

fn replace<T>(setting: &mut T, given: Option<T>) {
    if let Some(given) = given {
        *setting = given;
    }
}

impl Conditions {
    /// Sets what the option of this name sets, but no key; `None`: there is no such
    /// option, or no such value.
    pub fn set(&mut self, name: &str, value: &str) -> Option<()> {
        let options = ConditionsArgs::augment_args(Command::new("conditions"));
        let options = options.no_binary_name(true).disable_help_flag(true);
        let option = match value {
            "" => format!("--{name}"),
            _ => format!("--{name}={value}"),
        };
        let given = options.try_get_matches_from([option]);
        let given = ConditionsArgs::from_arg_matches(&given.ok()?).ok()?;
        (!given.has_key()).then_some(())?;
        given.set(self).ok()
    }

    /// What differs from `usual`, as names and values of options; the key is told to
    /// nobody.
    pub fn settings(&self, usual: &Self) -> Vec<(&'static str, String)> {
        let Self {
            medium,
            sync,
            byte_budget,
            loss,
            air,
            key: _,
            seed,
            max_ticks,
            faults,
            trouble,
            preset,
            mission,
            limits,
            wind,
        } = self;
        let AirFaults {
            reach,
            partitions,
            duplication,
            delay,
            corruption,
            forger,
        } = air;
        let Faults {
            deaths,
            arrivals,
            restarts,
            resumes,
            closures,
            shut,
            blind,
            sensor_failures,
            lost_poses,
        } = faults;
        let is_radio = *medium == MediumKind::Radio;
        let mut settings = Vec::new();
        let mut say = |name, differs: bool, value: &dyn ToString| {
            if differs {
                settings.push((name, value.to_string()));
            }
        };
        say("medium", *medium != usual.medium, medium);
        say("sync", *sync != usual.sync, sync);
        let differs = is_radio && *byte_budget != usual.byte_budget;
        say("byte-budget", differs, byte_budget);
        say("loss", *loss != usual.loss, loss);
        say("radio-range", *reach != usual.air.reach, reach);
        let air = &usual.air;
        say("duplicate", *duplication != air.duplication, duplication);
        say("delay", *delay != air.delay, delay);
        say("corrupt", *corruption != air.corruption, corruption);
        say("seed", *seed != usual.seed, seed);
        say("preset", *preset != usual.preset, preset);
        say("max-ticks", *max_ticks != usual.max_ticks, max_ticks);
        fn all<T: ToString>(
            name: &'static str,
            values: impl IntoIterator<Item = T>,
        ) -> impl Iterator<Item = (&'static str, String)> {
            values.into_iter().map(move |of| (name, of.to_string()))
        }
        settings.extend(all("forge", forger));
        settings.extend(all("partition", partitions));
        settings.extend(all("kill", deaths));
        settings.extend(all("late", arrivals));
        settings.extend(all("restart", restarts));
        settings.extend(all("resume", resumes));
        settings.extend(all("close", closures));
        settings.extend(all("shut", shut));
        settings.extend(all("blind", blind));
        settings.extend(all("sensor-fails", sensor_failures));
        settings.extend(all("pose-lost", lost_poses));
        settings.extend(mission.settings());
        settings.extend(limits.settings());
        settings.extend(wind.settings());
        settings.extend(trouble.settings(&usual.trouble));
        settings
    }
}

/// A share of something, 0 to 1.
///
/// # Errors
/// What is expected.
pub fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a share from 0 (nothing) to 1 (everything), for example 0.6".into()),
    }
}
