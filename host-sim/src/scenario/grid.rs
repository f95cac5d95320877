//! Runs in a grid of cells.

use std::sync::Arc;

use planner_core::{Cell, sight};

use super::{Conditions, Preset, ScenarioError};
use crate::planners::PlannerKind;
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
    /// What decides in each robot.
    pub planner: PlannerKind,
    /// Sensor range in cells, 1 to 15.
    pub range: u8,
    /// The sensor's field of view around the robot's heading, in degrees, 1 to
    /// [`ALL_AROUND`]. Robots begin turned to the east.
    pub fov: u16,
    /// Whether a cell holds at most one robot.
    pub solid: bool,
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
            conditions: Conditions::new(0, max_ticks),
        }
    }

    /// Whether the scenario can be run.
    ///
    /// # Errors
    /// What is out of range.
    pub fn check(&self) -> Result<(), ScenarioError> {
        self.conditions.check(self.starts.len())?;
        if !(1..=sight::MAX_RADIUS).contains(&self.range) {
            let expected = format!("1 to {} cells", sight::MAX_RADIUS);
            return Err(ScenarioError::setting("range", self.range, expected));
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
        self.check_fault_cells()?;
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

    fn check_fault_cells(&self) -> Result<(), ScenarioError> {
        let extent = self.world.extent();
        let faults = &self.conditions.faults;
        let spans = [
            ("close", &faults.closures),
            ("shut", &faults.shut),
            ("blind", &faults.blind),
        ];
        for (option, spans) in spans {
            if let Some(span) = spans.iter().find(|of| !extent.contains(of.cell)) {
                return Err(ScenarioError::FaultOutside {
                    option,
                    cell: span.cell,
                    extent,
                });
            }
        }
        Ok(())
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
