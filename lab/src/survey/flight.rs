//! A fleet that flies, or has flown, whatever its world is made of.

use egui::{Color32, Shape};
use image::RgbImage;
use planner_core::{Extent, Point};

use super::SurveySetup;
use super::eye::Eye;
use super::heights::Heights;
use super::voxels::Voxels;
use crate::colors::{Colors, mix};

/// What is drawn of a survey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// The ground that nobody has seen, pale.
    pub hidden: bool,
    /// The greatest height.
    pub ceiling: bool,
    /// Of voxels only so many levels from below: to look into rooms.
    pub levels: u8,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            hidden: true,
            ceiling: false,
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

    /// The digest of the trace.
    fn digest(&self) -> String;

    /// The name of the place.
    fn name(&self) -> &str;

    /// Its size on the ground plan.
    fn extent(&self) -> Extent;

    /// Levels of voxels, if it is made of them.
    fn levels(&self) -> Option<u8>;

    /// The way of each drone in the first so many steps.
    fn ways(&self, steps: usize) -> Vec<Vec<Point>>;

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
