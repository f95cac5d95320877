//! What every planner of a flying robot over a surface shares: its verbs, what it
//! knows, how it flies, and the way out when nothing is gained any more.
//!
//! One step of a robot is [`observe`](Surveyor::observe); then
//! [`transmit`](Surveyor::transmit) and [`receive`](Surveyor::receive); then
//! [`tick`](Surveyor::tick), which says where to fly, and
//! [`report`](Surveyor::report). No call does I/O, allocates or panics.
//!
//! Where a medium carries more than frames, as in the papers, robots
//! [`hear`](Surveyor::hear) each other and [`merge`](Surveyor::merge) pieces of maps.

mod flight;
mod knowledge;
mod link;
mod mission;
mod news;
mod recovery;
mod trail;

use crate::cell::Cell;
use crate::point::Point;
use crate::radio::{FrameError, MAX_LEN};
use crate::robot::{Action, Motion, RobotId, Status, Wait};
use crate::surface::{Column, Patch};
pub use knowledge::{Knowledge, SetupError};
pub use mission::Mission;
pub use news::MAX_RANGE;
pub use recovery::Recovery;

/// The physics of a fleet: what its sensors reach and which poses are allowed, the
/// constraints C(P) ≤ 0 [Renzaglia2019 §3]. All lengths in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// Sensor range R, above 0 and at most [`MAX_RANGE`].
    pub range: f32,
    /// Longest flight in one step, α, above 0.
    pub step: f32,
    /// Least height over ground, everywhere on the way. At least 0.
    pub min_altitude: f32,
    /// Greatest z.
    pub ceiling: f32,
    /// Least distance from other robots. At least 0.
    pub separation: f32,
    /// How wide the robots are, 0 to [`MAX_CLEARANCE`](crate::surface::MAX_CLEARANCE) columns:
    /// their body is a ball with this radius, and all that is said of the ground under a robot
    /// holds for every column under it. With 0 that is the one of its middle.
    ///
    /// So a robot flies over ground that is known as far to all sides, and never beside a tower
    /// that it could not fly over. The body does not leave the map. It takes a least altitude
    /// of the radius at least, or the ball may touch the ground; a range that shows what
    /// lies under a body one column on; and a start where it has room.
    #[cfg_attr(feature = "serde", serde(default))]
    pub clearance: u8,
}

/// What planners fly above the least altitude, in cells: ground that rises between two
/// columns would forbid flights otherwise.
const MARGIN: f32 = 0.75;

/// The most of it, as a share of what the range leaves: higher up little is seen.
const MARGIN_OF_RANGE: f32 = 0.25;

/// Length of flights without gain after which the recovery begins, in ranges.
const PATIENCE: f32 = 12.5;

impl Limits {
    /// Height over ground at which to fly, `share` of the range if the least altitude
    /// leaves that.
    pub fn cruise(&self, share: f32) -> f32 {
        let left = (self.range - self.min_altitude).max(0.0);
        let margin = MARGIN.min(MARGIN_OF_RANGE * left);
        (self.min_altitude + margin).max(share * self.range)
    }

    /// Steps without gain after which the recovery begins: those of a flight of 12.5 R, 4
    /// to 30,000.
    pub fn patience(&self) -> u16 {
        self.steps_of(PATIENCE * self.range, 4, 30_000)
    }

    /// Whole steps that a flight of `length` cells takes, within bounds.
    pub(crate) fn steps_of(&self, length: f32, least: u16, most: u16) -> u16 {
        ((length / self.step) as u16).clamp(least, most)
    }

    /// All zero: nothing can be flown with them.
    pub(crate) const NONE: Self = Self {
        range: 0.0,
        step: 0.0,
        min_altitude: 0.0,
        ceiling: 0.0,
        separation: 0.0,
        clearance: 0,
    };
}

/// A planner of one robot over a surface of `TW`×`TH` tiles.
pub trait Surveyor<const TW: usize, const TH: usize> {
    /// What the robot knows.
    fn knowledge(&self) -> &Knowledge<TW, TH>;

    /// Begins a step: where the robot is, and the columns that it sees from there.
    ///
    /// From a pose that is not finite, off the map or below the known ground nothing is
    /// learnt and nothing decided: the robot waits, and [`waiting`](Self::waiting) is
    /// [`Wait::Pose`], until a pose is good again.
    ///
    /// What a survey rests on: a look from above a column, no farther from it than the
    /// sensor's range, shows that column. A sensor that shows no column of the map from there a
    /// hundred times in a row is taken to have failed: [`Stop::Unseen`](crate::Stop::Unseen),
    /// until it shows something. Before the first look the robot waits, for [`Wait::Sight`].
    fn observe(&mut self, at: Point, columns: &[Column]);

    /// Decides. Call it once per step.
    ///
    /// The stop is [`Stop::Complete`](crate::Stop::Complete) if every column of the map is
    /// known; else the robot gave up, and the reason names a column. Every later tick
    /// returns the same, until the robot hears of more, or [`resume`](Self::resume).
    fn tick(&mut self) -> Action<Point>;

    /// Why the last [`tick`](Self::tick) was [`Action::Wait`], where the planner tells.
    fn waiting(&self) -> Option<Wait>;

    /// Goes on after a stop with the map at hand: what was given up is tried again.
    /// Without a stop it does only the latter.
    fn resume(&mut self);

    /// Flies home, to above where it started, and stops there with
    /// [`Stop::Home`](crate::Stop::Home), or says why not: [`Blocked`](crate::Stop::Blocked),
    /// [`Held`](crate::Stop::Held) or [`NoWay`](crate::Stop::NoWay). Also from a stop;
    /// [`resume`](Self::resume) then goes on. False where the planner cannot.
    fn go_home(&mut self) -> bool {
        false
    }

    /// Tells the planner how many more ticks in the air the robot's energy allows, hovering
    /// as well as flying. It counts down by itself; a number measured anew replaces it. The
    /// robot turns back in time, as `survey/mission.rs` proves, and stops at home with
    /// [`Stop::Home`](crate::Stop::Home). False where the planner cannot.
    fn energy(&mut self, left: u32) -> bool {
        let _ = left;
        false
    }

    /// Says how the last [`Action::Move`] went, and where the robot is now. One that the wind
    /// pushed aside has [moved](Motion::Moved): only a flight that is not made is refused.
    fn report(&mut self, motion: Motion, at: Point);

    /// Writes the next frame for the radio and returns its length, or `None` while the
    /// budget allows none. Call it as often as it gives one, after
    /// [`observe`](Self::observe) and after [`report`](Self::report).
    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize>;

    /// Takes in another robot's frame; gives the number of columns that it brought.
    ///
    /// # Errors
    /// See [`FrameError`]; nothing has changed then.
    fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError>;

    /// What the robot tells the others about itself.
    fn status(&self) -> Status<Point, Cell>;

    /// Takes in what robot `id` told about itself.
    fn hear(&mut self, id: RobotId, status: Status<Point, Cell>);

    /// Takes in a piece of another robot's map.
    fn merge(&mut self, patch: &Patch);

    /// Cells, tiles, candidates and samples looked at by the last
    /// [`tick`](Self::tick): what its time is proportional to.
    fn work(&self) -> u32;
}

/// How a robot decides. Whoever says that is a [`Surveyor`]: the rest is done by what the
/// robot knows.
pub trait Pilot<const TW: usize, const TH: usize> {
    /// What the robot knows.
    fn knowledge(&self) -> &Knowledge<TW, TH>;

    /// The same, to be told more.
    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH>;

    /// What to do in a step in which there is something to decide.
    fn decide(&mut self) -> Action<Point>;

    /// A step of the way home, of a pilot that can: [`Recovery::fly_home`].
    fn fly_home(&mut self) -> Option<Action<Point>> {
        None
    }

    /// What to do in any step.
    fn act(&mut self) -> Action<Point> {
        let begun = self.knowledge_mut().begin_tick();
        let homeward = if self.knowledge_mut().is_to_go_home() {
            self.fly_home()
        } else {
            None
        };
        let action = match homeward.or(begun) {
            Some(action) => action,
            None => self.decide(),
        };
        let action = match action {
            Action::Stop(_) if homeward.is_none() && Pilot::knowledge(self).comes_home() => {
                self.fly_home().unwrap_or(action)
            }
            _ => action,
        };
        self.knowledge_mut().end_tick(action)
    }
}

impl<P, const TW: usize, const TH: usize> Surveyor<TW, TH> for P
where
    P: Pilot<TW, TH>,
{
    fn knowledge(&self) -> &Knowledge<TW, TH> {
        Pilot::knowledge(self)
    }

    fn observe(&mut self, at: Point, columns: &[Column]) {
        self.knowledge_mut().observe(at, columns);
    }

    fn tick(&mut self) -> Action<Point> {
        self.act()
    }

    fn waiting(&self) -> Option<Wait> {
        Pilot::knowledge(self).waiting()
    }

    fn resume(&mut self) {
        self.knowledge_mut().resume();
    }

    fn go_home(&mut self) -> bool {
        self.knowledge_mut().send_home();
        true
    }

    fn energy(&mut self, left: u32) -> bool {
        self.knowledge_mut().set_energy(left);
        true
    }

    fn report(&mut self, motion: Motion, at: Point) {
        self.knowledge_mut().report(motion, at);
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        self.knowledge_mut().transmit(buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        self.knowledge_mut().receive(bytes)
    }

    fn status(&self) -> Status<Point, Cell> {
        Pilot::knowledge(self).status()
    }

    fn hear(&mut self, id: RobotId, status: Status<Point, Cell>) {
        self.knowledge_mut().hear(id, status);
    }

    fn merge(&mut self, patch: &Patch) {
        self.knowledge_mut().merge(patch);
    }

    fn work(&self) -> u32 {
        Pilot::knowledge(self).work()
    }
}

#[cfg(test)]
mod tests;
