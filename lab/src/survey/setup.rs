//! What is flown.

mod address;

use std::ops::RangeInclusive;

use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{Conditions, MediumKind, Mission, Preset, Trouble, voxels};
use host_sim::scene::{Fov, Sensor};
use host_sim::terrain::TerrainSource;
use planner_core::volume::MAX_CLEARANCE;

/// Numbers of drones.
pub const ROBOTS: RangeInclusive<u8> = 1..=32;
/// Least altitudes.
pub const ALTITUDES: RangeInclusive<f32> = 1.0..=6.0;
/// Greatest heights.
pub const CEILINGS: RangeInclusive<f32> = 20.0..=60.0;
/// Sensor ranges in cells.
pub const RANGES: RangeInclusive<u8> = 2..=12;
/// Voxels that bodies reach beyond the one of their middle.
pub const CLEARANCES: RangeInclusive<u8> = 0..=MAX_CLEARANCE;

/// What is flown.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveySetup {
    /// What is mapped.
    pub terrain: TerrainSource,
    /// Columns along a side.
    pub size: u16,
    /// How the drones decide over heights.
    pub planner: Planner,
    /// The same among voxels.
    pub voxel_planner: voxels::Planner,
    /// Number of drones.
    pub robots: u8,
    /// Sensor range in cells.
    pub range: u8,
    /// What the drones see of what is in range and in sight.
    pub sensor: Sensor,
    /// The image of a camera.
    pub fov: Fov,
    /// Voxels that the drones' bodies reach beyond the one of their middle.
    pub clearance: u8,
    /// Least altitude over ground, in cells.
    pub min_altitude: f32,
    /// Greatest height, in cells.
    pub ceiling: f32,
    /// What all worlds share.
    pub conditions: Conditions,
    /// Whether a place that is only in a trace is made of voxels.
    pub is_scene: bool,
}

impl Default for SurveySetup {
    fn default() -> Self {
        Self {
            terrain: TerrainSource::Gaussian(0),
            size: 60,
            planner: Planner::CoordinatedSurvey,
            voxel_planner: voxels::Planner::default(),
            robots: 4,
            range: 8,
            sensor: Sensor::default(),
            fov: Fov::default(),
            clearance: 1,
            min_altitude: 2.0,
            ceiling: 40.0,
            conditions: Conditions {
                medium: MediumKind::Radio,
                ..Conditions::flown(0)
            },
            is_scene: false,
        }
    }
}

impl SurveySetup {
    /// The scenario over a terrain of heights.
    pub fn scenario(&self) -> Scenario {
        let mut scenario = Scenario::new(self.planner, self.robots.into(), 0);
        scenario.limits.range = self.range.into();
        scenario.limits.min_altitude = self.min_altitude;
        scenario.limits.ceiling = self.ceiling;
        scenario.conditions.clone_from(&self.conditions);
        scenario
    }

    /// The scenario in a town of voxels.
    pub fn voxel_scenario(&self) -> voxels::Scenario {
        voxels::Scenario {
            planner: self.voxel_planner,
            range: self.range,
            clearance: self.clearance,
            field: self.sensor.field_for(self.fov, self.clearance),
            conditions: self.conditions.clone(),
            ..voxels::Scenario::new(self.robots.into(), 0)
        }
    }

    /// The setup that gives this trace, as far as the menus reach.
    pub fn of(trace: &Trace) -> Self {
        let (scenario, limits) = (&trace.scenario, trace.scenario.limits);
        let size = trace.extent.width;
        let drawn = |terrain: &TerrainSource| terrain.load(size).as_ref() == Ok(&trace.terrain);
        Self {
            terrain: drawn_as(trace.terrain.name(), drawn),
            size,
            planner: scenario.planner,
            robots: trace.robots.min(255) as u8,
            range: limits.range as u8,
            min_altitude: limits.min_altitude,
            ceiling: limits.ceiling,
            conditions: scenario.conditions.clone(),
            ..Self::default()
        }
    }

    /// Whether it gives this trace.
    pub fn gives(&self, trace: &Trace) -> bool {
        self.is_drawn() && self.scenario() == trace.scenario
    }

    /// As [`of`](Self::of), among voxels.
    pub fn of_voxels(trace: &VoxelTrace) -> Self {
        let (scenario, scene) = (&trace.scenario, &trace.scene);
        let size = scene.extent().width;
        let drawn = |terrain: &TerrainSource| terrain.scene(size).as_ref() == Some(scene);
        let (sensor, fov) = Sensor::of(scenario.field).unwrap_or_default();
        let terrain = drawn_as(scene.name(), drawn);
        Self {
            is_scene: matches!(terrain, TerrainSource::File(_)),
            terrain,
            size,
            voxel_planner: scenario.planner,
            robots: scenario.robots.min(255) as u8,
            range: scenario.range,
            sensor,
            fov,
            clearance: scenario.clearance,
            conditions: scenario.conditions.clone(),
            ..Self::default()
        }
    }

    /// As [`gives`](Self::gives), among voxels.
    pub fn gives_voxels(&self, trace: &VoxelTrace) -> bool {
        let said = trace.scenario.start;
        let usual = said.filter(|_| said == trace.scene.start(trace.scenario.clearance));
        let scenario = voxels::Scenario {
            start: usual,
            ..self.voxel_scenario()
        };
        self.is_drawn() && scenario == trace.scenario
    }

    /// Whether the terrain is one that can be drawn anew.
    pub fn is_drawn(&self) -> bool {
        !matches!(self.terrain, TerrainSource::File(_))
    }

    /// Whether it is flown among voxels.
    pub fn is_of_voxels(&self) -> bool {
        match self.terrain {
            TerrainSource::Town(_) => true,
            TerrainSource::File(_) => self.is_scene,
            TerrainSource::Gaussian(_) | TerrainSource::Urban(_) => false,
        }
    }

    /// Whether its planner takes more sensors than one.
    pub fn has_sensors(&self) -> bool {
        self.is_of_voxels() && self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// Whether its planner knows the way home.
    pub fn has_mission(&self) -> bool {
        !self.is_of_voxels() || self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// Whether looks can err, and its planner can tell.
    pub fn has_errors(&self) -> bool {
        self.is_of_voxels() && self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// The same with looks that are right.
    #[must_use]
    pub fn without_errors(mut self) -> Self {
        self.conditions.trouble = Trouble::default();
        self.conditions.preset = Preset::default();
        self
    }

    /// The same without what does not apply.
    #[must_use]
    pub fn tidied(mut self) -> Self {
        if !self.has_sensors() {
            self.sensor = Sensor::default();
        }
        if self.sensor != Sensor::Camera {
            self.fov = Fov::default();
        }
        if self.is_of_voxels() {
            // A body has to see where it comes to next.
            self.range = self.range.max(self.clearance + 1);
        } else {
            self.clearance = Self::default().clearance;
        }
        if !self.has_mission() {
            self.conditions.mission = Mission::default();
        }
        if !self.has_errors() {
            self = self.without_errors();
        }
        if self.is_drawn() {
            self.size = self.size.min(*self.sizes().end());
        }
        self
    }

    /// Columns along a side: what can be drawn in time.
    pub fn sizes(&self) -> RangeInclusive<u16> {
        16..=if self.is_of_voxels() { 64 } else { 128 }
    }
}

/// The terrain that was drawn under this name, if it is that.
fn drawn_as(name: &str, is_it: impl Fn(&TerrainSource) -> bool) -> TerrainSource {
    let drawn = name.replacen('-', ":", 1).parse().ok();
    let is_drawn = |terrain: &TerrainSource| !matches!(terrain, TerrainSource::File(_));
    drawn
        .filter(|terrain| is_drawn(terrain) && is_it(terrain))
        .unwrap_or_else(|| TerrainSource::File(name.into()))
}

#[cfg(test)]
/// Setups to try things with.
pub(super) mod tests {
    use host_sim::scenario::Wind;

    use super::*;

    fn conditions() -> Conditions {
        Conditions {
            loss: 0.25,
            ..Conditions::flown(7)
        }
    }

    pub(in crate::survey) fn unusual() -> SurveySetup {
        SurveySetup {
            terrain: TerrainSource::Urban(3),
            size: 24,
            planner: Planner::Fcao,
            robots: 2,
            range: 6,
            min_altitude: 1.5,
            ceiling: 50.0,
            conditions: conditions(),
            ..SurveySetup::default()
        }
    }

    pub(in crate::survey) fn town() -> SurveySetup {
        SurveySetup {
            terrain: TerrainSource::Town(2),
            size: 24,
            robots: 3,
            range: 6,
            conditions: conditions(),
            ..SurveySetup::default()
        }
    }

    /// Home, in time, through wind.
    fn homing() -> Conditions {
        Conditions {
            mission: Mission {
                come_home: true,
                energy: 2000,
            },
            wind: Wind { deviation: 0.2 },
            ..conditions()
        }
    }

    /// The same over heights.
    pub(in crate::survey) fn blown() -> SurveySetup {
        SurveySetup {
            conditions: homing(),
            ..unusual()
        }
    }

    /// The same among voxels, by drones that are as small as they can be.
    pub(in crate::survey) fn blown_about_rooms() -> SurveySetup {
        SurveySetup {
            clearance: 0,
            conditions: homing(),
            ..town()
        }
    }

    /// Wide drones that see ahead.
    fn wide() -> SurveySetup {
        SurveySetup {
            clearance: 2,
            ..filmed()
        }
    }

    pub(in crate::survey) fn filmed() -> SurveySetup {
        SurveySetup {
            sensor: Sensor::Camera,
            fov: Fov::new(100, 60).unwrap(),
            ..town()
        }
    }

    /// By looks that err, which the drones expect.
    pub(in crate::survey) fn misled() -> SurveySetup {
        SurveySetup {
            conditions: Conditions {
                trouble: Trouble {
                    false_walls: 0.01,
                    false_frees: 0.01,
                    ..Trouble::default()
                },
                preset: Preset::Rangers,
                ..conditions()
            },
            ..town()
        }
    }

    /// By what the planner of the core is compared with.
    pub(in crate::survey) fn compared() -> SurveySetup {
        SurveySetup {
            voxel_planner: voxels::Planner::Greedy,
            ..town()
        }
    }

    /// One of each kind.
    pub(in crate::survey) fn all() -> [SurveySetup; 9] {
        let hills = SurveySetup {
            size: 24,
            ..SurveySetup::default()
        };
        [
            hills,
            unusual(),
            blown(),
            town(),
            filmed(),
            wide(),
            compared(),
            blown_about_rooms(),
            misled(),
        ]
    }
}
