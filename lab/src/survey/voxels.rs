//! Towns of voxels: streets, rooms, bridges, cube by cube.

use egui::Shape;
use host_sim::draw::{animate, oblique_voxels, usual_cut};
use host_sim::record::voxels::VoxelTrace;
use host_sim::run::voxels::Simulation;
use host_sim::scene::Scene;
use host_sim::scene::octree::OcTree;
use image::RgbImage;
use planner_core::volume::{Heading, Voxel};
use planner_core::{Extent, Point};

use super::SurveySetup;
use super::eye::{Blocks, Eye};
use super::flight::{Cost, Drone, Flight, Layers, shade};
use super::sight::{self, Sight};
use crate::colors::Colors;

/// Not seen.
const NEVER: u32 = u32::MAX;

/// A run among voxels.
pub(super) struct Voxels {
    source: Source,
    /// Since which step each voxel has been seen, level by level.
    seen_since: Vec<u32>,
    /// How much of what was found is in `seen_since`.
    taken: usize,
}

enum Source {
    Running(Box<Simulation>),
    Opened(Box<VoxelTrace>),
}

impl Source {
    fn trace(&self) -> &VoxelTrace {
        match self {
            Self::Running(run) => run.trace(),
            Self::Opened(trace) => trace,
        }
    }
}

/// How a voxel is drawn.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    Nothing,
    Hidden,
    Seen,
}

impl Voxels {
    pub(super) fn new(scene: &Scene, setup: &SurveySetup) -> Result<Self, String> {
        let run = Simulation::new(scene, &setup.voxel_scenario());
        let run = run.map_err(|error| error.to_string())?;
        Ok(Self::with(Source::Running(Box::new(run))))
    }

    pub(super) fn opened(trace: VoxelTrace) -> Self {
        let mut voxels = Self::with(Source::Opened(Box::new(trace)));
        voxels.take();
        voxels
    }

    fn with(source: Source) -> Self {
        let voxels = source.trace().scene.voxels().count();
        Self {
            seen_since: vec![NEVER; voxels],
            source,
            taken: 0,
        }
    }

    fn trace(&self) -> &VoxelTrace {
        self.source.trace()
    }

    /// Takes in what was found since the last time.
    fn take(&mut self) {
        let trace = self.source.trace();
        for &(step, voxel, _) in &trace.found[self.taken..] {
            let since = &mut self.seen_since[index(&trace.scene, voxel)];
            *since = (*since).min(step);
        }
        self.taken = trace.found.len();
    }
}

fn index(scene: &Scene, Voxel { x, y, z }: Voxel) -> usize {
    let Extent { width, height } = scene.extent();
    (z as usize * usize::from(height) + y as usize) * usize::from(width) + x as usize
}

impl Flight for Voxels {
    fn step(&mut self) -> bool {
        let Source::Running(run) = &mut self.source else {
            return false;
        };
        let goes_on = run.step();
        self.take();
        goes_on
    }

    fn seen(&self) -> &[u32] {
        &self.trace().seen
    }

    fn all(&self) -> u32 {
        self.trace().visible
    }

    fn is_complete(&self) -> bool {
        self.trace().all_stopped && self.trace().complete()
    }

    fn violations(&self) -> (&'static str, u32) {
        let count = self.trace().violations;
        ("beside or into something", count)
    }

    fn mishaps(&self) -> Vec<String> {
        let trace = self.trace();
        let is_windy = !trace.scenario.conditions.wind.is_none();
        let contacts = trace.contacts;
        let ends = || format!("The wind ended {contacts} steps beside or in something.");
        let mut mishaps: Vec<_> = is_windy.then(ends).into_iter().collect();
        // A trace that was opened does not say them.
        let errs = !trace.scenario.conditions.trouble.is_none();
        if errs && matches!(self.source, Source::Running(_)) {
            let (bumps, claims) = (trace.bumps, trace.false_claims);
            mishaps.push(format!("{bumps} steps ended at what was not seen."));
            mishaps.push(format!(
                "{claims} drones say that all is known while something is not."
            ));
        }
        mishaps
    }

    fn costs(&self) -> Vec<Cost> {
        Cost::of(&self.trace().records)
    }

    fn digest(&self) -> String {
        self.trace().digest()
    }

    fn name(&self) -> &str {
        self.trace().scene.name()
    }

    fn is_northward(&self) -> bool {
        true
    }

    fn extent(&self) -> Extent {
        self.trace().scene.extent()
    }

    fn levels(&self) -> Option<u8> {
        Some(self.trace().scene.levels())
    }

    fn ways(&self, steps: usize) -> Vec<Vec<Point>> {
        let middle = |voxel: &Voxel| Point::over(voxel.cell(), f32::from(voxel.z) + 0.5);
        let ways = self.trace().ways.iter();
        ways.map(|way| way.iter().take(steps + 1).map(middle).collect())
            .collect()
    }

    fn sight(&self) -> Sight {
        let scenario = &self.trace().scenario;
        Sight {
            range: scenario.range.into(),
            field: scenario.field,
        }
    }

    fn headings(&self, steps: usize) -> Vec<Heading> {
        let turns = self.trace().headings.iter();
        let last = |turns: &Vec<Heading>| turns.get(steps).or(turns.last()).copied();
        turns.filter_map(last).collect()
    }

    fn beneath(&self, at: Point) -> f32 {
        let (cell, scene) = (at.cell(), &self.trace().scene);
        let below = (0..at.z as i16).rev();
        let solid = |z: &i16| scene.is_occupied(Voxel::new(cell.x, cell.y, *z));
        below
            .into_iter()
            .find(solid)
            .map_or(0.0, |z| f32::from(z) + 1.0)
    }

    fn ground(&self, steps: usize, eye: &Eye, layers: &Layers, colors: &Colors) -> Shape {
        let scene = &self.trace().scene;
        let (extent, levels) = (scene.extent(), scene.levels().min(layers.levels));
        let look = |voxel: Voxel| match scene.is_occupied(voxel) {
            true if voxel.z >= i16::from(levels) => Look::Nothing,
            true if self.seen_since[index(scene, voxel)] as usize <= steps => Look::Seen,
            true if layers.hidden => Look::Hidden,
            _ => Look::Nothing,
        };
        let east = if eye.east_is_near() { 1 } else { -1 };
        let south = if eye.end_is_near() { 1 } else { -1 };
        let mut blocks = Blocks::new(eye);
        for (x, y) in eye.columns(extent) {
            for z in 0..i16::from(levels) {
                let own = look(Voxel::new(x, y, z));
                let color = match own {
                    Look::Nothing => continue,
                    Look::Hidden => colors.unknown,
                    Look::Seen => shade(f32::from(z + 1) / f32::from(scene.levels()), colors),
                };
                let at = (f32::from(x), f32::from(y));
                let (low, high) = (f32::from(z), f32::from(z + 1));
                // What another voxel covers is not drawn.
                if look(Voxel::new(x + east, y, z)) == Look::Nothing {
                    blocks.across(at, (low, high), color);
                }
                if look(Voxel::new(x, y + south, z)) == Look::Nothing {
                    blocks.along(at, (low, high), color);
                }
                if look(Voxel::new(x, y, z + 1)) == Look::Nothing {
                    blocks.top(at, high, color);
                }
            }
        }
        blocks.shape()
    }

    fn picture(&self, steps: u32) -> RgbImage {
        oblique_voxels(self.trace(), steps, usual_cut(self.trace()))
    }

    fn animation(&self) -> Result<Vec<u8>, String> {
        let trace = self.trace();
        let steps = trace.seen.len() as u32;
        let (mut gif, cut) = (Vec::new(), usual_cut(trace));
        animate(steps, |step| oblique_voxels(trace, step, cut), &mut gif)
            .map_err(|error| error.to_string())?;
        Ok(gif)
    }

    fn octree(&self, steps: u32) -> OcTree {
        self.trace().octree(steps)
    }

    fn drone(&self, drone: usize, steps: u32) -> Drone {
        let trace = self.trace();
        let faults = &trace.scenario.conditions.faults;
        let mut seen = Drone::of((&trace.records, faults), drone, steps, |at| at.to_string());
        if let Some(&heading) = self.headings(steps as usize).get(drone) {
            let turned = ("turned to the", sight::name(heading).into());
            seen.rows.insert(1, turned);
        }
        seen
    }

    fn file(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let written = self.trace().write(&mut bytes);
        written.map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}
