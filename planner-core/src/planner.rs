//! The verbs that every planner has.

use core::fmt;

use crate::cell::{Cell, Extent};
use crate::map::{CellSet, Learnt, Map};
use crate::radio::{Frame, FrameError, Heard, Hearsay, MAX_LEN};
use crate::robot::{Action, Motion, RobotId, Status, Wait};
use crate::role::Role;
use crate::sight::{LongSighting, Sighting};
use crate::tile::{TileIndex, TileSet};

/// A planner of one robot on a map of at most `TW`×`TH` tiles.
///
/// One tick of a robot is: [`observe`](Self::observe), any number of exchanges
/// with other robots, [`tick`](Self::tick), and after a move
/// [`report`](Self::report). No call does I/O, allocates or panics, and each does
/// a bounded amount of work.
///
/// A planner of one's own needs these verbs and nothing else:
///
/// ```
/// use planner_core::radio::{FrameError, Heard, Link, LinkConfig, MAX_LEN};
/// use planner_core::sight::look;
/// use planner_core::{
///     Action, Activity, Cell, Direction, Extent, Learnt, Map, Motion, Planner, RobotId, Sighting,
///     Status, Stop,
/// };
///
/// /// Goes straight on, and turns right where something is in the way.
/// struct Straight {
///     map: Map<1, 1>,
///     link: Link<1>,
///     position: Cell,
///     heading: Direction,
/// }
///
/// impl Planner<1, 1> for Straight {
///     fn observe(&mut self, sighting: &Sighting) -> Learnt {
///         self.position = sighting.centre();
///         let learnt = self.map.observe(sighting);
///         self.link.announce(&mut self.map);
///         learnt
///     }
///
///     fn tick(&mut self) -> Action {
///         self.link.tick();
///         if self.map.frontiers() == 0 {
///             return Action::Stop(Stop::Complete);
///         }
///         if !self.map.is_free(self.position.step(self.heading)) {
///             self.heading = Direction::from_index(self.heading as u8 + 1);
///             return Action::Wait;
///         }
///         Action::Move(self.heading)
///     }
///
///     fn resume(&mut self) {}
///
///     fn report(&mut self, motion: Motion) {
///         if motion == Motion::Moved {
///             self.position = self.position.step(self.heading);
///         }
///     }
///
///     fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
///         let status = self.status();
///         self.link.transmit(&self.map, status, buffer)
///     }
///
///     fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
///         self.link.receive(bytes, &mut self.map)
///     }
///
///     fn map(&self) -> &Map<1, 1> {
///         &self.map
///     }
///
///     fn status(&self) -> Status {
///         let activity = Activity::stopped_if(self.map.frontiers() == 0);
///         Status { position: self.position, goal: None, activity }
///     }
/// }
///
/// let extent = Extent::new(8, 1);
/// let mut link = Link::vacant();
/// link.reset(LinkConfig::new(), RobotId(0), extent);
/// let map = Map::new(extent)?;
/// let mut robot = Straight { map, link, position: Cell::new(0, 0), heading: Direction::East };
/// loop {
///     robot.observe(&look(robot.position, 3, |cell| !extent.contains(cell)));
///     match robot.tick() {
///         Action::Move(_) => robot.report(Motion::Moved),
///         Action::Wait => {}
///         Action::Stop(stop) => break assert_eq!(stop, Stop::Complete),
///     }
/// }
/// # Ok::<(), planner_core::ExtentError>(())
/// ```
pub trait Planner<const TW: usize, const TH: usize> {
    /// Takes in what the robot sees from where it stands.
    fn observe(&mut self, sighting: &Sighting) -> Learnt;

    /// Decides. Call it once per tick.
    fn tick(&mut self) -> Action;

    /// Why the last [`tick`](Self::tick) was [`Action::Wait`], and whether the robot is
    /// to look in another direction. `None`: it was not, or this planner does not tell.
    fn waiting(&self) -> Option<Wait> {
        None
    }

    /// Where the robot can go in a straight line instead of the step of the last
    /// [`Action::Move`]: the farthest such cell of its way to the
    /// [goal](Status::goal), at most 12 to 19 cells away each way. Every cell that the line
    /// between the two centres touches is known to be passable; at a corner it touches four.
    /// `None`: the next cell is not passable, or this planner goes step by step.
    ///
    /// A robot that steers there tells where it is with [`observe`](Self::observe) from
    /// any cell, and [reports](Self::report) only what stops it. Poses on the line, on the
    /// way or beside the way keep the plan; others drop it. Work: 16 tiles, and 64 lines of
    /// at most 20 rows each.
    fn waypoint(&self) -> Option<Cell> {
        None
    }

    /// Goes on after a stop with the map at hand: somebody opened a door, carried the
    /// robot, or wants it to try again what it gave up. What refused a step or showed
    /// nothing is tried anew. Without a stop it does only the latter.
    fn resume(&mut self);

    /// Says how the step of the last [`Action::Move`] went.
    fn report(&mut self, motion: Motion);

    /// Writes the next frame for the others and returns its length, or `None` if
    /// there is nothing to send or the budget of bytes is used up. May be called
    /// until it returns `None`.
    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize>;

    /// Takes in a frame of another robot, at any time.
    ///
    /// # Errors
    /// The frame says nothing to this robot; nothing but [`hearsay`](Self::hearsay) has
    /// changed then.
    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError>;

    /// How much of the map is from others, and what speaks against them. All zero where
    /// a planner does not count.
    fn hearsay(&self) -> Hearsay {
        Hearsay::default()
    }

    /// Whether the looks have contradicted the map for long: of the walls that they showed
    /// again lately, most were free. The robot is then not where its poses say, or its
    /// sensor is broken: what it adds to the map is worth nothing. Never where a planner
    /// does not compare.
    fn is_lost(&self) -> bool {
        false
    }

    /// What the robot knows.
    fn map(&self) -> &Map<TW, TH>;

    /// What the robot would tell the others about itself.
    fn status(&self) -> Status;
}

/// What else a planner does where robots meet: in media that carry whole maps instead of
/// frames, and in an [`exchange`](crate::role::exchange) with a robot in its way.
pub trait Contact<const TW: usize, const TH: usize>: Planner<TW, TH> {
    /// The tiles of the map that changed since the last call. For media that
    /// carry whole maps; what is taken here is not transmitted first any more.
    fn take_changed(&mut self) -> TileSet<TH>;

    /// Joins the given tiles of another robot's map into the own one.
    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt;

    /// Takes in what robot `id` told about itself.
    fn hear(&mut self, id: RobotId, status: Status);

    /// Reads a frame for all robots of the same grid and key that hear it. `None`: this
    /// planner reads each frame itself, in [`receive`](Planner::receive).
    fn read(&self, bytes: &[u8]) -> Option<Result<Frame, FrameError>> {
        let _ = bytes;
        None
    }

    /// As [`receive`](Planner::receive), of a frame that [`read`](Self::read) has read.
    ///
    /// # Errors
    /// As of `receive`.
    fn receive_read(
        &mut self,
        bytes: &[u8],
        read: &Result<Frame, FrameError>,
    ) -> Result<Heard, FrameError> {
        let _ = read;
        self.receive(bytes)
    }

    /// What the robot is about to do, for an [`exchange`](crate::role::exchange)
    /// with a robot in its way. `None`: this planner does not exchange roles.
    fn role(&self) -> Option<Role> {
        None
    }

    /// Takes over another robot's role.
    fn adopt(&mut self, role: Role) {
        let _ = role;
    }
}

/// What displays and measurements ask a planner for. None of it is needed.
pub trait Inspect<const TW: usize, const TH: usize>: Planner<TW, TH> {
    /// Work of the last [`tick`](Planner::tick), counted in tile operations and rows of
    /// the decision window; 0 where a planner does not count.
    fn work(&self) -> u32 {
        0
    }

    /// Steps to the goal that the last [`tick`](Planner::tick) assigned. `None`: it
    /// assigned none, or this planner does not tell.
    fn assignment(&self) -> Option<u32> {
        None
    }

    /// By how many more looks a cell near the robot was seen blocked than free, -3 to 3, for
    /// displays; 0 where a planner does not count.
    fn votes(&self, cell: Cell) -> i8 {
        let _ = cell;
        0
    }

    /// Known free cells that the robot's body covers from nowhere, as far as is known: niches
    /// and gaps that are too narrow for it. 0 for a robot that is not wider than a cell. Work:
    /// the whole map, about 2,000 instructions for each free cell; for a stop.
    fn narrow_cells(&self) -> u32 {
        0
    }

    /// The cells of a tile that the search over the whole map has reached, for
    /// displays; none if no search is under way, or this planner does not tell.
    fn searched(&self, at: TileIndex) -> u64 {
        let _ = at;
        0
    }
}

/// Where a robot is sent, and how far it may go. By default a planner knows none of it.
///
/// Home is where the robot started. It goes there, or to any other cell, by a shortest way
/// over cells that are known to be free and did not refuse a step. Meanwhile it observes and
/// reports as ever, and tells the others that it explores no more.
pub trait Errands<const TW: usize, const TH: usize>: Planner<TW, TH> {
    /// Goes home and stops there, with [`Stop::Home`](crate::Stop::Home), or says why not:
    /// [`Stop::Blocked`](crate::Stop::Blocked), [`Stop::Held`](crate::Stop::Held) or
    /// [`Stop::NoWay`](crate::Stop::NoWay). Also from a stop. [`Planner::resume`] then goes
    /// on exploring. False where the planner cannot.
    fn go_home(&mut self) -> bool {
        false
    }

    /// As [`go_home`](Self::go_home), to any cell: it stops there with
    /// [`Stop::Arrived`](crate::Stop::Arrived). False for a cell outside of the grid, and
    /// where the planner cannot; nothing has changed then.
    fn go_to(&mut self, cell: Cell) -> bool {
        let _ = cell;
        false
    }

    /// Tells the planner how many more steps the robot's energy allows; each step that is
    /// reported as [`Motion::Moved`] takes one off until it is told again. Call it before the
    /// first tick, and whenever the number is measured anew; a robot that follows
    /// [waypoints](Planner::waypoint) and reports no steps calls it often.
    ///
    /// The robot turns back while what is left lasts for the shortest known way home, and
    /// stops there with [`Stop::Home`](crate::Stop::Home); told more energy then,
    /// [`Planner::resume`] goes on exploring. It comes home whatever the place looks like,
    /// if no way that it knows is blocked and no number is told that is less than was left.
    /// False where the planner cannot.
    fn energy(&mut self, left: u32) -> bool {
        let _ = left;
        false
    }

    /// From now on the robot enters none of these cells, nor touches one with its body, and
    /// need not see them; they replace those of before, and `None` lifts the ban. Each robot
    /// of a fleet may have others.
    ///
    /// "Complete" then means: whatever can be reached without them is known, except for these
    /// cells themselves. On the robot's map they are walls, as what lies beyond its edge, and
    /// nothing else is kept of them; they are never told to others. Looks go across them,
    /// so frontiers may be seen behind them that no way leads to: the robot then stops as
    /// [`OutOfReach`](crate::Stop::OutOfReach). Sent into them, it stops as
    /// [`NoWay`](crate::Stop::NoWay). Carried into them it stays, and waits for a
    /// [pose](Wait::Pose) elsewhere.
    ///
    /// A robot that had stopped goes on. Work: as of [`Planner::resume`], and every tile with
    /// its neighbours.
    ///
    /// # Errors
    /// The robot or its home lies in them, or the planner cannot; nothing has changed then.
    fn keep_out(&mut self, cells: Option<&'static CellSet<TW, TH>>) -> Result<(), KeepOutError> {
        let _ = cells;
        Err(KeepOutError::Unable)
    }
}

/// Sensors that reach beyond [`MAX_RADIUS`](crate::sight::MAX_RADIUS). By default a planner
/// knows only what is near.
pub trait LongSight<const TW: usize, const TH: usize>: Planner<TW, TH> {
    /// Takes in what the robot sees of a tile beyond that radius: cells free and blocked, a
    /// bit each. Only cells of which nothing is known count: one look does not speak against
    /// others from so far. Call it after [`Planner::observe`]. Work: the tile and its four
    /// neighbours.
    fn observe_far(&mut self, at: TileIndex, free: u64, blocked: u64) -> Learnt {
        let _ = (at, free, blocked);
        Learnt::default()
    }

    /// [`Planner::observe`] of what is near, and [`observe_far`](Self::observe_far) of the
    /// rest. Work: that of `observe`, and of at most 81 tiles.
    fn observe_long(&mut self, sighting: &LongSighting) -> Learnt
    where
        Self: Sized,
    {
        let mut learnt = self.observe(&sighting.near());
        for (at, free, blocked) in sighting.far_tiles() {
            learnt += self.observe_far(at, free, blocked);
        }
        learnt
    }
}

/// Why a robot cannot keep out of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum KeepOutError {
    /// This planner keeps out of nothing.
    Unable,
    /// The robot is here, and it or its body lies in them.
    Robot(Cell),
    /// Its home is here, and lies in them, or its body does when it is there.
    Home(Cell),
}

impl fmt::Display for KeepOutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unable => write!(f, "this planner keeps out of no cells"),
            Self::Robot(at) => write!(
                f,
                "the robot is at {at}, in cells that it is to keep out of"
            ),
            Self::Home(at) => write!(f, "its home is at {at}, in cells that it is to keep out of"),
        }
    }
}

impl core::error::Error for KeepOutError {}

/// A planner's state as bytes and back: after a brown-out, or for the next sortie. By
/// default a planner has none.
pub trait Persist<const TW: usize, const TH: usize>: Planner<TW, TH> {
    /// Length of a save in bytes; for 64×64 cells 1,604.
    fn saved_bytes(&self) -> usize {
        0
    }

    /// Writes the bytes of a save from number `first` on into `page`, as many as there are
    /// room for or left, and returns how many: so it goes to flash a page at a time. Between
    /// the pages nothing may change, or the save is refused later as damaged. Work: the whole
    /// save, about 100 instructions a byte.
    ///
    /// ```
    /// use planner_core::explorer::{Config, Explorer};
    /// use planner_core::{Cell, Extent, Persist, RobotId};
    ///
    /// let new = || Explorer::<8, 8>::new(Config::new(), RobotId(1), Extent::new(64, 64), Cell::new(5, 5));
    /// let robot = new()?;
    /// let (mut flash, mut page) = (Vec::new(), [0; 256]);
    /// loop {
    ///     let written = robot.save(flash.len(), &mut page);
    ///     if written == 0 {
    ///         break;
    ///     }
    ///     flash.extend(&page[..written]);
    /// }
    /// new()?.restore(&flash)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn save(&self, first: usize, page: &mut [u8]) -> usize {
        let _ = (first, page);
        0
    }

    /// Goes on from a save; what lies behind its last byte does not matter. The planner was
    /// set up as the one that was saved: with the same grid and id, and with a configuration
    /// that may be another. It keeps out of what it does, and has the configuration's energy
    /// until it is told. Home is the one that was saved; an errand, and having stopped, are
    /// forgotten.
    ///
    /// The numbers of its frames go on 32 later, so that others take them for new where as
    /// many were sent since the save.
    ///
    /// # Errors
    /// What is wrong with the save; nothing has changed then.
    fn restore(&mut self, bytes: &[u8]) -> Result<(), RestoreError> {
        let _ = bytes;
        Err(RestoreError::Unable)
    }
}

/// Why a save was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RestoreError {
    /// This planner restores nothing.
    Unable,
    /// It does not begin as a save does: nothing was saved there.
    NoSave,
    /// It has this version, which this library does not read.
    Version(u8),
    /// It is cut short, or some of its bytes are others.
    Damaged,
    /// It is of a grid of this size, or of one with another origin or cells of another size.
    Grid(Extent),
    /// It is of the robot with this id.
    Robot(RobotId),
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unable => write!(f, "this planner restores nothing"),
            Self::NoSave => write!(f, "no save"),
            Self::Version(version) => write!(f, "a save of version {version}, not 1"),
            Self::Damaged => write!(f, "a save that is damaged or cut short"),
            Self::Grid(extent) => write!(
                f,
                "a save of another grid: of {extent} cells, or with another origin or cells of \
                 another size"
            ),
            Self::Robot(id) => write!(f, "a save of robot {}", id.0),
        }
    }
}

impl core::error::Error for RestoreError {}

/// All of them, for whoever hosts planners of several kinds.
pub trait AnyPlanner<const TW: usize, const TH: usize>:
    Contact<TW, TH> + Inspect<TW, TH> + Errands<TW, TH> + Persist<TW, TH> + LongSight<TW, TH>
{
}

impl<P, const TW: usize, const TH: usize> AnyPlanner<TW, TH> for P where
    P: Contact<TW, TH> + Inspect<TW, TH> + Errands<TW, TH> + Persist<TW, TH> + LongSight<TW, TH>
{
}
