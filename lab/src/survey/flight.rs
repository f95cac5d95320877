//! A fleet that flies, or has flown, whatever its world is made of.

use egui::{Color32, Shape};
use host_sim::record::{Deed, Kind, Record};
use host_sim::scenario::Faults;
use host_sim::scene::octree::OcTree;
use image::RgbImage;
use planner_core::volume::Heading;
use planner_core::{Extent, Point, RobotId};

use super::SurveySetup;
use super::eye::Eye;
use super::heights::Heights;
use super::sight::Sight;
use super::voxels::Voxels;
use crate::colors::{Colors, mix};
use crate::decisions::stop;

/// What is drawn of a survey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// The ground that nobody has seen, pale.
    pub hidden: bool,
    /// The greatest height.
    pub ceiling: bool,
    /// What the selected drone's sensor has in its field; faintly that of all, if none is
    /// selected.
    pub sensor: bool,
    /// Of voxels only so many levels from below: to look into rooms.
    pub levels: u8,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            hidden: true,
            ceiling: false,
            sensor: true,
            levels: u8::MAX,
        }
    }
}

/// One run of a fleet, step by step; a step is flown once and then remembered.
pub(super) trait Flight {
    /// Flies one step; false if there is none any more.
    fn step(&mut self) -> bool;

    /// What had been seen after each step, from the look before the first.
    fn seen(&self) -> &[u32];

    /// What there is to see.
    fn all(&self) -> u32;

    /// Whether everything was seen and every drone has stopped.
    fn is_complete(&self) -> bool;

    /// What should never happen, in words, and how many flights did it.
    fn violations(&self) -> (&'static str, u32);

    /// What befell drones that did nothing wrong, in sentences.
    fn mishaps(&self) -> Vec<String>;

    /// What each step took.
    fn costs(&self) -> Vec<Cost>;

    /// The digest of the trace.
    fn digest(&self) -> String;

    /// The name of the place.
    fn name(&self) -> &str;

    /// Its size on the ground plan.
    fn extent(&self) -> Extent;

    /// Whether y leads north in it, as in files of scenes, and not south.
    fn is_northward(&self) -> bool;

    /// Levels of voxels, if it is made of them.
    fn levels(&self) -> Option<u8>;

    /// The way of each drone in the first so many steps.
    fn ways(&self, steps: usize) -> Vec<Vec<Point>>;

    /// What its sensor shows, of each drone.
    fn sight(&self) -> Sight;

    /// Where each drone's sensor is turned after so many steps, if it has sides.
    fn headings(&self, steps: usize) -> Vec<Heading>;

    /// The height of what lies beneath a drone.
    fn beneath(&self, at: Point) -> f32;

    /// What had been seen after so many steps, and what was hidden.
    fn ground(&self, steps: usize, eye: &Eye, layers: &Layers, colors: &Colors) -> Shape;

    /// A picture from aside after so many steps.
    fn picture(&self, steps: u32) -> RgbImage;

    /// An animation up to the last step, as GIF.
    fn animation(&self) -> Result<Vec<u8>, String>;

    /// The trace as host-sim writes it.
    fn file(&self) -> Result<Vec<u8>, String>;

    /// What had been seen after so many steps, as an octree.
    fn octree(&self, steps: u32) -> OcTree;

    /// What a drone did in the last of so many steps.
    fn drone(&self, drone: usize, steps: u32) -> Drone;
}

/// What a step took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cost {
    /// Largest work of a drone.
    pub(super) work: u32,
    /// Bytes that all drones sent.
    pub(super) bytes: u64,
}

impl Cost {
    /// Of each step in which somebody decided.
    pub(super) fn of<K: Kind>(records: &[Record<K>]) -> Vec<Self> {
        let mut costs = Vec::new();
        for record in records {
            let step = record.tick as usize;
            if costs.len() <= step {
                costs.resize(step + 1, Self::default());
            }
            costs[step].work = costs[step].work.max(record.work);
            costs[step].bytes += u64::from(record.sent.bytes);
        }
        costs
    }
}

/// A drone at the shown step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drone {
    /// What it does, where, and at what cost: names and values.
    pub rows: Vec<(&'static str, String)>,
    /// Whether it lives.
    pub is_alive: bool,
    /// Whether it has stopped.
    pub has_stopped: bool,
}

impl Drone {
    /// Reads it out of the records of a trace; `place` writes where it is.
    pub(super) fn of<K>(
        (records, faults): (&[Record<K>], &Faults),
        drone: usize,
        steps: u32,
        place: impl Fn(K::Place) -> String,
    ) -> Self
    where
        K: Kind<Deed = Deed>,
        K::Goal: std::fmt::Display,
    {
        let done = records.partition_point(|record| record.tick < steps);
        let own = || {
            let own = records[..done].iter();
            own.filter(|record| usize::from(record.robot) == drone)
        };
        let is_alive = faults.is_alive(RobotId(drone.min(255) as u8), steps);
        let last = own().last();
        let state = match last.map(|record| record.deed) {
            _ if !is_alive => "not there, or dead".into(),
            None => "about to begin".into(),
            Some(Deed::Flew) => "flies".into(),
            Some(Deed::Refused) => "kept from flying, for another drone's sake".into(),
            Some(Deed::Hovered) => "hovers".into(),
            Some(Deed::Stopped(reason)) => stop(reason).into(),
        };
        let mut rows = vec![("state", state)];
        if let Some(record) = last {
            let goal = record.goal;
            rows.push(("at", place(record.at)));
            rows.push(("goal", goal.map_or("none".into(), |goal| goal.to_string())));
            rows.push(("known", record.known.to_string()));
            rows.push(("work in this step", record.work.to_string()));
            rows.push(("bytes in this step", record.sent.bytes.to_string()));
        }
        let bytes: u64 = own().map(|record| u64::from(record.sent.bytes)).sum();
        rows.push(("bytes sent so far", bytes.to_string()));
        let work = own().map(|record| record.work).max().unwrap_or(0);
        rows.push(("largest work in a step", work.to_string()));
        let has_stopped = last.is_some_and(|record| matches!(record.deed, Deed::Stopped(_)));
        Self {
            rows,
            is_alive,
            has_stopped,
        }
    }
}

/// A run before its first step.
pub(super) fn open(setup: &SurveySetup) -> Result<Box<dyn Flight>, String> {
    match setup.terrain.scene(setup.size) {
        Some(scene) => Ok(Box::new(Voxels::new(&scene, setup)?)),
        None => Ok(Box::new(Heights::new(setup)?)),
    }
}

/// From low to high in colours whose brightness rises with the height, so that they
/// need no hue.
pub(super) fn shade(share: f32, colors: &Colors) -> Color32 {
    let (low, high) = match colors == &Colors::DARK {
        true => (
            Color32::from_rgb(40, 80, 100),
            Color32::from_rgb(250, 235, 190),
        ),
        false => (
            Color32::from_rgb(70, 110, 130),
            Color32::from_rgb(255, 242, 205),
        ),
    };
    mix(low, high, share.clamp(0.0, 1.0))
}
