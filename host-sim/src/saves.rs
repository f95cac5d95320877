//! What the planners of a fleet know, as bytes and back: for the next sortie.
//!
//! A save is two lines of text: a JSON object, and the SHA-256 of that line. What stands in
//! it for each planner is its own [save](planner_core::Persist).

use std::fmt::Write as _;

use planner_core::radio::LinkConfig;
use planner_core::{AnyPlanner, Cell, Extent, RestoreError, RobotId};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::mission::Mission;
use crate::planners::{PlannerKind, Setup};
use crate::world::{World, cells};

const FORMAT: &str = "host-sim save";
const VERSION: u32 = 1;

/// The robots of a fleet, by id.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Save {
    format: String,
    version: u32,
    /// Of the cells of the world.
    world: String,
    robots: Vec<Saved>,
}

/// One robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Saved {
    at: (i16, i16),
    home: (i16, i16),
    /// Its planner's save, in hexadecimal digits.
    planner: String,
}

/// A save that cannot be gone on from.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum SaveError {
    #[error("is no save of a fleet; name a file that explore --save has written")]
    NoSave,
    #[error("is damaged or cut short; explore again without --restore")]
    Damaged,
    #[error(
        "has version {0}, and this program reads version {VERSION}; explore again without --restore"
    )]
    Version(u32),
    #[error("is of a fleet of {saved} robots, not {robots}; use --robots {saved}")]
    Robots { saved: usize, robots: usize },
    #[error(
        "is of another map, or of this one with cells of another size; name that map, or explore \
         again without --restore"
    )]
    World,
    #[error("robot {robot} cannot go on from it: {problem}; explore again without --restore")]
    Planner { robot: usize, problem: RestoreError },
    #[error(
        "the home of robot {robot} is {home}, in cells that robots are to keep out of, or touches \
         them there; keep out of less"
    )]
    HomeKeptOut { robot: usize, home: Cell },
}

impl Save {
    /// Of robots, each with where it is, its home and its planner, in a world. `None`: a
    /// planner cannot be saved.
    pub(crate) fn of<'a, const TW: usize, const TH: usize>(
        world: &World,
        robots: impl Iterator<Item = (Cell, Cell, &'a dyn AnyPlanner<TW, TH>)>,
    ) -> Option<Self> {
        let saved = |(at, home, planner): (Cell, Cell, &dyn AnyPlanner<TW, TH>)| {
            let mut bytes = vec![0; planner.saved_bytes()];
            (planner.save(0, &mut bytes) > 0).then(|| Saved {
                at: (at.x, at.y),
                home: (home.x, home.y),
                planner: hex(&bytes),
            })
        };
        Some(Self {
            format: FORMAT.into(),
            version: VERSION,
            world: digest(world),
            robots: robots.map(saved).collect::<Option<_>>()?,
        })
    }

    /// The save as a file holds it.
    pub fn to_text(&self) -> String {
        let line = serde_json::to_string(self).expect("plain data");
        let check = hex(&Sha256::digest(&line));
        format!("{line}\n{check}\n")
    }

    /// A save out of what a file holds.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(bytes: &[u8]) -> Result<Self, SaveError> {
        #[derive(Deserialize)]
        struct Head {
            format: String,
            version: u32,
        }
        let begin = format!("{{\"format\":\"{FORMAT}\",");
        if !bytes.starts_with(begin.as_bytes()) {
            return Err(SaveError::NoSave);
        }
        let text = str::from_utf8(bytes).map_err(|_| SaveError::Damaged)?;
        let (line, check) = text.split_once('\n').ok_or(SaveError::Damaged)?;
        if check != format!("{}\n", hex(&Sha256::digest(line))) {
            return Err(SaveError::Damaged);
        }
        let head: Head = serde_json::from_str(line).map_err(|_| SaveError::Damaged)?;
        match (head.format.as_str(), head.version) {
            (FORMAT, VERSION) => serde_json::from_str(line).map_err(|_| SaveError::Damaged),
            (_, version) => Err(SaveError::Version(version)),
        }
    }

    /// Where each robot was.
    pub fn positions(&self) -> Vec<Cell> {
        let robots = self.robots.iter();
        robots.map(|of| Cell::new(of.at.0, of.at.1)).collect()
    }

    /// Where each robot began to explore.
    pub fn homes(&self) -> Vec<Cell> {
        let robots = self.robots.iter();
        robots.map(|of| Cell::new(of.home.0, of.home.1)).collect()
    }

    /// Bytes of each planner.
    pub(crate) fn planners(&self) -> impl Iterator<Item = Vec<u8>> + '_ {
        let bytes = |of: &Saved| unhex(&of.planner).unwrap_or_default();
        self.robots.iter().map(bytes)
    }

    /// Whether as many robots can go on from it in this world.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self, world: &World, kind: PlannerKind, robots: usize) -> Result<(), SaveError> {
        if self.robots.len() != robots {
            let saved = self.robots.len();
            return Err(SaveError::Robots { saved, robots });
        }
        if self.world != digest(world) {
            return Err(SaveError::World);
        }
        let numbered = self.planners().enumerate();
        { numbered }
            .find_map(|(robot, bytes)| {
                let restored = restored(world.extent(), kind, robot, &bytes);
                restored
                    .err()
                    .map(|problem| SaveError::Planner { robot, problem })
            })
            .map_or(Ok(()), Err)
    }

    /// The cells that each robot knew, of a save that [fits](Self::check).
    pub(crate) fn known(&self, world: &World, kind: PlannerKind) -> Vec<Vec<Cell>> {
        let extent = world.extent();
        let known = |(robot, bytes): (usize, Vec<u8>)| {
            let planner = restored(extent, kind, robot, &bytes);
            planner.map_or(Vec::new(), |planner| {
                let map = planner.map();
                cells(extent).filter(|cell| map.is_known(*cell)).collect()
            })
        };
        self.planners().enumerate().map(known).collect()
    }
}

/// The largest planner, which holds any save.
type Largest = Box<dyn AnyPlanner<64, 64>>;

fn restored(
    extent: Extent,
    kind: PlannerKind,
    robot: usize,
    bytes: &[u8],
) -> Result<Largest, RestoreError> {
    let setup = Setup {
        id: RobotId(robot as u8),
        extent,
        start: Cell::new(0, 0),
        link: LinkConfig::new(),
        sensor: Default::default(),
        clearance: 0,
        mission: Mission::default(),
    };
    let mut planner: Largest = kind.build(setup).map_err(|_| RestoreError::Grid(extent))?;
    planner.restore(bytes)?;
    Ok(planner)
}

/// Of the size of a world and its cells.
fn digest(world: &World) -> String {
    let Extent { width, height } = world.extent();
    let mut digest = Sha256::new();
    digest.update([width.to_le_bytes(), height.to_le_bytes()].concat());
    let free: Vec<u8> = cells(world.extent())
        .map(|cell| world.is_free(cell).into())
        .collect();
    digest.update(free);
    hex(&digest.finalize()[..16])
}

fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

fn unhex(text: &str) -> Option<Vec<u8>> {
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    let byte = |pair: &[u8; 2]| u8::from_str_radix(str::from_utf8(pair).ok()?, 16).ok();
    rest.is_empty().then(|| pairs.iter().map(byte).collect())?
}
