//! Terrains of one height a column, as blocks that are painted from back to front.

use std::sync::Arc;

use egui::Shape;
use host_sim::draw::{animate, oblique_view, top_view};
use host_sim::record::heights::{Record, Trace};
use host_sim::run::heights::{self, Stepping};
use host_sim::scene::octree::OcTree;
use host_sim::terrain::{Terrain, TerrainSource};
use image::RgbImage;
use planner_core::volume::{Field, Heading};
use planner_core::{Cell, Extent, Point};

use super::SurveySetup;
use super::eye::{Blocks, Eye};
use super::flight::{Cost, Drone, Flight, Layers, shade};
use super::sight::Sight;
use crate::colors::Colors;

/// A run over heights.
pub(super) struct Heights {
    terrain: Arc<Terrain>,
    source: Source,
    /// Columns that have been seen, row by row: since which step, and how high.
    seen: Vec<Option<(usize, f32)>>,
    /// How much of what was found is in `seen`.
    taken: usize,
}

enum Source {
    Running(Box<dyn Stepping>),
    Opened(Box<Trace>),
}

impl Heights {
    pub(super) fn new(setup: &SurveySetup) -> Result<Self, String> {
        if let TerrainSource::File(name) = &setup.terrain {
            return Err(format!(
                "{} is only in the trace that was opened: choose hills or a town, or run \
                 `host-sim survey --terrain FILE` and open its trace.csv",
                name.display()
            ));
        }
        let terrain = Arc::new(setup.terrain.load(setup.size)?);
        let run = heights::open(terrain.clone(), &setup.scenario());
        let run = run.map_err(|error| error.to_string())?;
        Ok(Self::with(terrain, Source::Running(run)))
    }

    pub(super) fn opened(trace: Trace) -> Self {
        let terrain = Arc::new(trace.terrain.clone());
        let mut heights = Self::with(terrain, Source::Opened(Box::new(trace)));
        heights.take();
        heights
    }

    fn with(terrain: Arc<Terrain>, source: Source) -> Self {
        Self {
            seen: vec![None; terrain.extent().cells() as usize],
            terrain,
            source,
            taken: 0,
        }
    }

    fn trace(&self) -> &Trace {
        match &self.source {
            Source::Running(run) => run.trace(),
            Source::Opened(trace) => trace,
        }
    }

    /// Takes in what was found since the last time.
    fn take(&mut self) {
        let width = usize::from(self.terrain.extent().width);
        let found = match &self.source {
            Source::Running(run) => &run.trace().found,
            Source::Opened(trace) => &trace.found,
        };
        for (step, column) in &found[self.taken..] {
            let index = column.cell.y as usize * width + column.cell.x as usize;
            self.seen[index].get_or_insert((*step as usize, column.height.cells()));
        }
        self.taken = found.len();
    }
}

impl Flight for Heights {
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
        self.terrain.extent().cells()
    }

    fn is_complete(&self) -> bool {
        self.trace().all_stopped && self.trace().complete()
    }

    fn violations(&self) -> (&'static str, u32) {
        let count = self.trace().safety.violations();
        ("too low, too high or too near to another", count)
    }

    fn mishaps(&self) -> Vec<String> {
        let trace = self.trace();
        let is_windy = !trace.scenario.conditions.wind.is_none();
        let contacts = trace.contacts;
        let ends =
            || format!("The wind ended {contacts} steps on the ground or too near to another.");
        is_windy.then(ends).into_iter().collect()
    }

    fn costs(&self) -> Vec<Cost> {
        Cost::of(&self.trace().records)
    }

    fn digest(&self) -> String {
        self.trace().digest()
    }

    fn name(&self) -> &str {
        self.terrain.name()
    }

    fn is_northward(&self) -> bool {
        let scale = self.terrain.scale();
        scale.is_some_and(|scale| scale.northward)
    }

    fn extent(&self) -> Extent {
        self.terrain.extent()
    }

    fn levels(&self) -> Option<u8> {
        None
    }

    fn ways(&self, steps: usize) -> Vec<Vec<Point>> {
        let trace = self.trace();
        let mut ways: Vec<_> = trace.starts.iter().map(|&start| vec![start]).collect();
        let flown = |record: &Record| (record.tick as usize) < steps;
        let done = trace.records.partition_point(flown);
        for record in &trace.records[..done] {
            ways[usize::from(record.robot)].push(record.at);
        }
        ways
    }

    fn sight(&self) -> Sight {
        Sight {
            range: self.trace().scenario.limits.range,
            field: Field::ALL_ROUND,
        }
    }

    fn headings(&self, _: usize) -> Vec<Heading> {
        Vec::new()
    }

    fn beneath(&self, at: Point) -> f32 {
        let ground = self.terrain.height(at.cell());
        ground.map_or(0.0, |height| height.cells())
    }

    fn ground(&self, steps: usize, eye: &Eye, layers: &Layers, colors: &Colors) -> Shape {
        let extent = self.terrain.extent();
        let highest = self.terrain.highest().cells().max(1.0);
        let width = usize::from(extent.width);
        let mut blocks = Blocks::new(eye);
        for (x, y) in eye.columns(extent) {
            let seen = self.seen[y as usize * width + x as usize];
            let (height, color) = match seen.filter(|(since, _)| *since <= steps) {
                Some((_, height)) => (height, shade(height / highest, colors)),
                None if layers.hidden => {
                    let height = self.terrain.height(Cell::new(x, y));
                    (height.map_or(0.0, |height| height.cells()), colors.unknown)
                }
                None => continue,
            };
            let at = (f32::from(x), f32::from(y));
            if height > 0.0 {
                blocks.across(at, (0.0, height), color);
                blocks.along(at, (0.0, height), color);
            }
            blocks.top(at, height, color);
        }
        blocks.shape()
    }

    fn picture(&self, steps: u32) -> RgbImage {
        oblique_view(self.trace(), steps)
    }

    fn animation(&self) -> Result<Vec<u8>, String> {
        let (trace, mut gif) = (self.trace(), Vec::new());
        let steps = trace.seen.len() as u32;
        animate(steps, |step| top_view(trace, step), &mut gif)
            .map_err(|error| error.to_string())?;
        Ok(gif)
    }

    fn octree(&self, steps: u32) -> OcTree {
        self.trace().octree(steps)
    }

    fn drone(&self, drone: usize, steps: u32) -> Drone {
        let trace = self.trace();
        let faults = &trace.scenario.conditions.faults;
        Drone::of((&trace.records, faults), drone, steps, |at| {
            format!("{:.1}, {:.1}, {:.1}", at.x, at.y, at.z)
        })
    }

    fn file(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let written = self.trace().write(&mut bytes);
        written.map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}
