//! What one robot did in one tick, in every kind of world.

use std::fmt;

use planner_core::volume::Voxel;
use planner_core::{Cell, Point};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use sha2::{Digest, Sha256};

use super::Format;
use crate::robot::Sent;

/// A kind of world, by what its records hold.
pub trait Kind: Copy + fmt::Debug + PartialEq {
    /// What the header of its files says.
    const FORMAT: Format;
    /// A place of a robot.
    type Place: Numbers;
    /// What came of a decision, as the number of an action.
    type Deed: Copy + fmt::Debug + PartialEq + Into<u8> + TryFrom<u8, Error = String>;
    /// What a robot goes to.
    type Goal: Goal;
    /// A reward, or nothing.
    type Gain: Numbers;
}

/// One decision of one robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Record<K: Kind> {
    /// In which tick, from 0.
    pub tick: u32,
    /// Whose.
    pub robot: u8,
    /// In a grid where the robot decided, else where it was after that.
    pub at: K::Place,
    /// What came of it.
    #[serde(with = "action")]
    pub deed: K::Deed,
    /// Where the robot was going; in a file and in the digest -1 for nowhere.
    #[serde(with = "goal")]
    pub goal: Option<K::Goal>,
    /// Over heights, what the last step added to the robot's reward [Renzaglia2019 eq. 1].
    pub gain: K::Gain,
    /// Cells, columns or voxels on its map.
    pub known: u32,
    /// Work of the decision, as the planner counts it.
    pub work: u32,
    /// What it sent by radio in this tick.
    pub sent: Sent,
}

/// Columns of a record.
pub trait Numbers: Copy + fmt::Debug + PartialEq + Serialize + DeserializeOwned {
    /// What the numbers are.
    const COLUMNS: &'static [&'static str];

    /// Adds the numbers to a digest.
    fn add_to(&self, sha: &mut Sha256);
}

/// A place that may be a goal.
pub trait Goal: Numbers {
    /// What stands for none.
    const NOWHERE: Self;
}

impl<K: Kind> Record<K> {
    /// What the numbers of a record are.
    pub(super) fn columns() -> Vec<String> {
        let name = |name: &&str| String::from(*name);
        let goal = K::Goal::COLUMNS.iter().map(|name| format!("goal_{name}"));
        ["tick", "robot"]
            .iter()
            .chain(K::Place::COLUMNS)
            .chain(&["action"])
            .map(name)
            .chain(goal)
            .chain(K::Gain::COLUMNS.iter().map(name))
            .chain(["known", "work"].iter().map(name))
            .chain(Sent::COLUMNS.iter().map(name))
            .collect()
    }

    /// Adds the numbers to a digest.
    pub(super) fn add_to(&self, sha: &mut Sha256) {
        let goal = self.goal.unwrap_or(K::Goal::NOWHERE);
        sha.update(self.tick.to_le_bytes());
        sha.update([self.robot]);
        self.at.add_to(sha);
        sha.update([self.deed.into()]);
        goal.add_to(sha);
        self.gain.add_to(sha);
        sha.update(self.known.to_le_bytes());
        sha.update(self.work.to_le_bytes());
        self.sent.add_to(sha);
    }
}

/// No columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Nothing {}

macro_rules! numbers {
    ($type:ty: $($column:ident),*) => {
        impl Numbers for $type {
            const COLUMNS: &'static [&'static str] = &[$(stringify!($column)),*];

            fn add_to(&self, sha: &mut Sha256) {
                $(sha.update(self.$column.to_le_bytes());)*
            }
        }
    };
}

numbers!(Cell: x, y);
numbers!(Voxel: x, y, z);
numbers!(Point: x, y, z);
numbers!(Sent: frames, bytes);

impl Numbers for f32 {
    const COLUMNS: &'static [&'static str] = &["gain"];

    fn add_to(&self, sha: &mut Sha256) {
        sha.update(self.to_le_bytes());
    }
}

impl Numbers for Nothing {
    const COLUMNS: &'static [&'static str] = &[];

    fn add_to(&self, _: &mut Sha256) {}
}

impl Goal for Cell {
    const NOWHERE: Self = Self::new(-1, -1);
}

impl Goal for Voxel {
    const NOWHERE: Self = Self::new(-1, -1, -1);
}

mod action {
    use super::*;

    pub(super) fn serialize<D: Copy + Into<u8>, S: Serializer>(
        deed: &D,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        to.serialize_u8((*deed).into())
    }

    pub(super) fn deserialize<'de, T: Deserializer<'de>, D: TryFrom<u8, Error = String>>(
        from: T,
    ) -> Result<D, T::Error> {
        D::try_from(u8::deserialize(from)?).map_err(T::Error::custom)
    }
}

mod goal {
    use super::*;

    pub(super) fn serialize<G: Goal, S: Serializer>(
        goal: &Option<G>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        goal.unwrap_or(G::NOWHERE).serialize(to)
    }

    pub(super) fn deserialize<'de, T: Deserializer<'de>, G: Goal>(
        from: T,
    ) -> Result<Option<G>, T::Error> {
        Ok(Some(G::deserialize(from)?).filter(|&goal| goal != G::NOWHERE))
    }
}
