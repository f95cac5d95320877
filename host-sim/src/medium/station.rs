//! What the air needs of a robot and of a world, whatever kind they are of.

use planner_core::radio::{Key, MAX_LEN};
use planner_core::{Activity, RobotId};

use crate::dice::Dice;

/// One robot's end of the air.
pub(crate) trait Station {
    /// Where it can be.
    type Place: Copy;
    /// A frame of its kind of world.
    type Frame;
    /// What a frame was read as, for all who hear it.
    type Read;

    /// Its number, which is also its index in the fleet.
    fn id(&self) -> RobotId;

    /// Where it is.
    fn place(&self) -> Self::Place;

    /// Whether it speaks now, and hears what comes now.
    fn is_awake(&self) -> bool;

    /// Its next frame, if its budget allows one; it is counted as sent.
    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize>;

    /// Reads a frame, as all others would too.
    fn read(&self, frame: &[u8]) -> Self::Read;

    /// A frame comes. What is wrong with it is for the planner to find.
    fn receive(&mut self, frame: &[u8], read: &Self::Read);

    /// Where it says that it goes.
    fn goal(&self) -> Option<Self::Place>;

    /// A corner of its world.
    fn corner(&self) -> Self::Place;

    /// Anywhere in its world.
    fn anywhere(&self, dice: &mut Dice) -> Self::Place;

    /// Places beside it where robots might be, nearest first, from its own on.
    fn around(&self) -> Vec<Self::Place>;

    /// A frame that makes this claim in its world, with so many drawn pieces of a map.
    fn forged(&self, claim: Claim<Self::Place>, pieces: u32, dice: &mut Dice) -> Self::Frame;

    /// Writes a frame, signed if there is a key; gives its length.
    fn encode(frame: &Self::Frame, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize;
}

/// What a forged frame says of a robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim<P> {
    /// Whose frame it pretends to be.
    pub sender: RobotId,
    /// Number of the frame.
    pub sequence: u16,
    /// Where the robot is said to be.
    pub position: P,
    /// Where it is said to go.
    pub goal: Option<P>,
    /// What it is said to have come to.
    pub activity: Activity,
}

/// A world as the air sees it.
pub trait Space {
    /// Where robots can be in it.
    type Place: Copy;
    /// What robots in it read frames as.
    type Read;

    /// Whether two places are at most so many cells apart, as the crow flies.
    fn is_near(&self, from: Self::Place, to: Self::Place, cells: u16) -> bool;

    /// Whether nothing is between them.
    fn is_in_sight(&self, from: Self::Place, to: Self::Place) -> bool;
}
