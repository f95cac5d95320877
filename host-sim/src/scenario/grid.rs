//! Runs in a grid of cells.

use std::sync::Arc;

use planner_core::explorer::{MAX_CLEARANCE, bodies_touch, body_cells};
use planner_core::{Cell, sight};

use super::{Conditions, Motion, Preset, ScenarioError};
use crate::planners::PlannerKind;
use crate::saves::{Save, SaveError};
use crate::sensor::{ALL_AROUND, Sensor};
use crate::world::{Reachable, World};

/// Everything that a run follows from. The same scenario gives the same run on
/// every machine.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// What is explored.
    pub world: Arc<World>,
    /// Where each robot starts; as many robots as starts, 1 to 255.
    pub starts: Vec<Cell>,
    /// The planner of each robot.
    pub planner: PlannerKind,
    /// Sensor range in cells, 1 to 31; more than 15 for planners that
    /// [see so far](PlannerKind::sees_far), and looks that do not err.
    pub range: u8,
    /// The sensor's field of view around the robot's heading, in degrees, 1 to
    /// [`ALL_AROUND`]. Robots begin turned to the east.
    pub fov: u16,
    /// Whether a cell holds at most one robot.
    pub solid: bool,
    /// Cells that the robots' bodies reach beyond the one of their centre, 0 to 3; see
    /// [`Config::clearance`](planner_core::explorer::Config::clearance).
    pub clearance: u8,
    /// How bodies move, in metres and seconds; `None`: a cell a tick. Where robots are
    /// neither solid nor have a clearance, they pass through each other.
    pub motion: Option<Motion>,
    /// What its robots know when they start; `None`: nothing.
    pub restored: Option<Arc<Save>>,
    /// What all worlds share.
    pub conditions: Conditions,
}

impl Scenario {
    /// A scenario with the defaults: sensor range 5 all around, the ideal medium with an
    /// exchange in every tick, shared cells, seed 0, no faults, and ticks enough
    /// for any planner that gets anywhere.
    pub fn new(world: Arc<World>, starts: Vec<Cell>, planner: PlannerKind) -> Self {
        let max_ticks = default_max_ticks(&world.reachable(&starts), planner);
        Self {
            world,
            starts,
            planner,
            range: 5,
            fov: ALL_AROUND,
            solid: false,
            clearance: 0,
            motion: None,
            restored: None,
            conditions: Conditions::new(0, max_ticks),
        }
    }

    /// Sets how bodies move, with ticks enough for it.
    pub fn move_in_metres(&mut self, motion: Option<Motion>) {
        let ticks = |motion: Option<Motion>| motion.map_or(1, |of| of.ticks_a_step());
        let conditions = &mut self.conditions;
        conditions.max_ticks = conditions.max_ticks / ticks(self.motion) * ticks(motion);
        self.motion = motion;
    }

    /// Whether the scenario can be run.
    ///
    /// # Errors
    /// What is out of range.
    pub fn check(&self) -> Result<(), ScenarioError> {
        self.conditions.check(self.starts.len())?;
        if !self.conditions.wind.is_none() {
            return Err(ScenarioError::NotHere {
                option: "wind",
                world: "on the ground",
            });
        }
        if !(1..=sight::MAX_LONG_RADIUS).contains(&self.range) {
            let expected = format!("1 to {} cells", sight::MAX_LONG_RADIUS);
            return Err(ScenarioError::setting("range", self.range, expected));
        }
        if self.range > sight::MAX_RADIUS {
            if !self.planner.sees_far() {
                return Err(ScenarioError::ShortSighted {
                    planner: self.planner,
                    range: self.range,
                });
            }
            let is_off = |motion: &Motion| motion.slip > 0.0 || motion.odometry_error > 0.0;
            if self.conditions.trouble.has_errors() || self.motion.as_ref().is_some_and(is_off) {
                let expected = format!("1 to {} cells where looks or poses err", sight::MAX_RADIUS);
                return Err(ScenarioError::setting("range", self.range, expected));
            }
        }
        if !(1..=ALL_AROUND).contains(&self.fov) {
            let expected = format!("1 to {ALL_AROUND} degrees");
            return Err(ScenarioError::setting("fov", self.fov, expected));
        }
        if self.fov < ALL_AROUND && !self.planner.turns_sensor() {
            return Err(ScenarioError::NeverTurns {
                planner: self.planner,
                fov: self.fov,
            });
        }
        let preset = self.conditions.preset;
        if preset != Preset::Truthful && !self.planner.weighs_looks() {
            return Err(ScenarioError::OnlyTruthful {
                planner: self.planner,
                preset,
            });
        }
        self.check_body()?;
        self.check_motion()?;
        let planner = self.planner;
        if let Some((option, _)) = self.conditions.mission.settings().first()
            && !planner.knows_home()
        {
            return Err(ScenarioError::NeverHome { option, planner });
        }
        let extent = self.world.extent();
        self.conditions.faults.check_cells(extent)?;
        self.check_limits()?;
        self.check_save()?;
        for (robot, &start) in self.starts.iter().enumerate() {
            if !self.world.is_free(start) {
                return Err(ScenarioError::Start { robot, start });
            }
            if self.solid
                && let Some(first) = self.starts[..robot].iter().position(|&cell| cell == start)
            {
                return Err(ScenarioError::SharedStart {
                    first,
                    second: robot,
                    start,
                });
            }
        }
        Ok(())
    }

    fn check_body(&self) -> Result<(), ScenarioError> {
        let clearance = self.clearance;
        if clearance == 0 {
            return Ok(());
        }
        if clearance > MAX_CLEARANCE {
            let expected = format!("0 to {MAX_CLEARANCE} cells");
            return Err(ScenarioError::setting("clearance", clearance, expected));
        }
        if !self.planner.has_body() {
            return Err(ScenarioError::NoBody {
                planner: self.planner,
                clearance,
            });
        }
        if self.range < clearance + 2 {
            return Err(ScenarioError::setting(
                "range",
                self.range,
                format!(
                    "{} cells or more, with --clearance {clearance}",
                    clearance + 2
                ),
            ));
        }
        for (robot, &start) in self.starts.iter().enumerate() {
            if !self.world.has_room(start, clearance) {
                return Err(ScenarioError::NoRoomAtStart {
                    robot,
                    start,
                    clearance,
                });
            }
            let others = self.starts[..robot].iter();
            if let Some(first) = { others }.position(|&other| bodies_touch(clearance, start, other))
            {
                return Err(ScenarioError::TouchingStarts {
                    first,
                    second: robot,
                    apart: 2 * clearance + 1,
                });
            }
        }
        Ok(())
    }

    fn check_motion(&self) -> Result<(), ScenarioError> {
        let Some(motion) = &self.motion else {
            return Ok(());
        };
        motion.check(self.clearance)?;
        let Conditions {
            faults,
            trouble,
            mission,
            limits,
            ..
        } = &self.conditions;
        let of_steps = [
            ("fov", self.fov < ALL_AROUND),
            ("energy", mission.energy > 0),
            ("keep-out", !limits.keep_out.is_empty()),
            ("only", !limits.only.is_empty()),
            ("late", !faults.arrivals.is_empty()),
            ("close", !faults.closures.is_empty()),
            ("shut", !faults.shut.is_empty()),
            ("misplaced", trouble.misplaced > 0.0),
            ("drift", trouble.drift > 0),
            ("people", trouble.people > 0),
            ("doors", trouble.doors > 0),
        ];
        match of_steps.into_iter().find(|(_, is_used)| *is_used) {
            Some((option, _)) => Err(ScenarioError::NotInMotion(option)),
            None => Ok(()),
        }
    }

    fn check_limits(&self) -> Result<(), ScenarioError> {
        let limits = &self.conditions.limits;
        let (planner, extent) = (self.planner, self.world.extent());
        let Some((option, _)) = limits.areas().next() else {
            return Ok(());
        };
        if !planner.keeps_out() {
            return Err(ScenarioError::GoesAnywhere { option, planner });
        }
        for (option, area) in limits.areas() {
            if let Some(&cell) = area.corners().iter().find(|cell| !extent.contains(**cell)) {
                return Err(ScenarioError::FaultOutside {
                    option,
                    cell,
                    extent,
                });
            }
        }
        match { self.starts.iter() }.position(|start| self.is_kept_out(*start)) {
            Some(robot) => Err(ScenarioError::StartKeptOut {
                robot,
                start: self.starts[robot],
            }),
            None => Ok(()),
        }
    }

    fn check_save(&self) -> Result<(), ScenarioError> {
        let Some(save) = &self.restored else {
            return Ok(());
        };
        let planner = self.planner;
        if !planner.is_saved() {
            let option = "restore";
            return Err(ScenarioError::NeverSaved { option, planner });
        }
        save.check(&self.world, planner, self.starts.len())?;
        let homes = save.homes();
        match homes.iter().position(|home| self.is_kept_out(*home)) {
            Some(robot) => {
                let home = homes[robot];
                Err(SaveError::HomeKeptOut { robot, home }.into())
            }
            None => Ok(()),
        }
    }

    /// Whether a body in this cell touches what robots keep out of.
    fn is_kept_out(&self, at: Cell) -> bool {
        let limits = &self.conditions.limits;
        body_cells(self.clearance, at).any(|cell| limits.keeps_out(cell))
    }

    /// Where each robot began to explore: where it starts, unless it goes on from a save.
    pub fn homes(&self) -> Vec<Cell> {
        let saved = self.restored.as_ref();
        saved.map_or_else(|| self.starts.clone(), |save| save.homes())
    }

    /// The cells that each robot knows when it starts, if it goes on from a save.
    pub(crate) fn known(&self) -> Vec<Vec<Cell>> {
        let saved = self.restored.as_ref();
        saved.map_or_else(Vec::new, |save| save.known(&self.world, self.planner))
    }

    /// What its robots can reach: with a body, the cells that it can sweep.
    pub fn reachable(&self) -> Reachable {
        self.reachable_from(&self.starts)
    }

    /// As [`reachable`](Self::reachable), from other cells.
    pub fn reachable_from(&self, from: &[Cell]) -> Reachable {
        let limits = &self.conditions.limits;
        if limits.is_none() {
            return self.world.reachable_by(from, self.clearance);
        }
        let open = self.world.without(|cell| limits.keeps_out(cell));
        open.reachable_by(from, self.clearance)
    }

    /// The sensor that its robots carry.
    pub fn sensor(&self) -> Arc<Sensor> {
        let world = self.world.clone();
        Arc::new(Sensor::with_fov(world, self.range, self.fov))
    }
}

/// Ticks after which a run is given up if nobody says otherwise: a thousand, and
/// eight for each cell that can be reached, of which one robot that walks to
/// every cell and back needs two. BMILRV may go round many loops many times: a
/// hundred for each cell.
pub fn default_max_ticks(reachable: &Reachable, planner: PlannerKind) -> u32 {
    let each = match planner {
        PlannerKind::Bmilrv => 100,
        _ => 8,
    };
    1000 + each * reachable.count()
}
