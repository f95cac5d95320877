//! Robots that turn to look, by a planner of their own and by the simulator.

use std::sync::Arc;

use host_sim::planners::{PlannerKind, Setup};
use host_sim::robot::Deed;
use host_sim::run::{self, Host, Site};
use host_sim::scenario::grid::Scenario;
use host_sim::world::{Family, World};
use host_sim::{draw, record};
use planner_core::radio::{FrameError, Heard, MAX_LEN};
use planner_core::{
    Action, AnyPlanner, Cell, Contact, Direction, Errands, Inspect, Learnt, LongSight, Map, Motion,
    Persist, Planner, RobotId, Sighting, Status, TileSet, Wait,
};

use super::{scenario, traced};

/// Looks in all four directions from every cell that it comes to, then does what the
/// planner within decides.
struct LooksAround<const TW: usize, const TH: usize> {
    inner: Box<dyn AnyPlanner<TW, TH>>,
    at: Option<Cell>,
    to_come: std::slice::Iter<'static, Direction>,
    look: Option<Wait>,
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for LooksAround<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        if self.at != Some(sighting.centre()) {
            self.at = Some(sighting.centre());
            self.to_come = Direction::ALL.iter();
        }
        self.inner.observe(sighting)
    }

    fn tick(&mut self) -> Action {
        self.look = self.to_come.next().copied().map(Wait::Look);
        match self.look {
            Some(_) => Action::Wait,
            None => self.inner.tick(),
        }
    }

    fn waiting(&self) -> Option<Wait> {
        self.look.or_else(|| self.inner.waiting())
    }

    fn resume(&mut self) {
        self.inner.resume();
    }

    fn report(&mut self, motion: Motion) {
        self.inner.report(motion);
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        self.inner.transmit(buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        self.inner.receive(bytes)
    }

    fn map(&self) -> &Map<TW, TH> {
        self.inner.map()
    }

    fn status(&self) -> Status {
        self.inner.status()
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for LooksAround<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        self.inner.take_changed()
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        self.inner.join(other, tiles)
    }

    fn hear(&mut self, id: RobotId, status: Status) {
        self.inner.hear(id, status);
    }
}

impl<const TW: usize, const TH: usize> Errands<TW, TH> for LooksAround<TW, TH> {}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for LooksAround<TW, TH> {}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for LooksAround<TW, TH> {}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for LooksAround<TW, TH> {
    fn work(&self) -> u32 {
        self.inner.work()
    }
}

/// Robots that look around.
#[derive(Clone)]
struct LookingAround;

impl Site for LookingAround {}

impl Host for LookingAround {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn AnyPlanner<TW, TH>> {
        Box::new(LooksAround {
            inner: kind.build(setup).unwrap(),
            at: None,
            to_come: Direction::ALL.iter(),
            look: None,
        })
    }
}

#[test]
fn robots_that_turn_see_everything_with_any_field_of_view() {
    for (fov, family) in [1, 62, 90, 180, 360].into_iter().zip(Family::ALL) {
        let mut scenario = scenario(PlannerKind::Explorer, family, 6);
        scenario.fov = fov;
        scenario.conditions.max_ticks *= 5;
        let (outcome, trace) = run::run_on(&LookingAround, &scenario, traced()).unwrap();
        let trace = trace.unwrap();
        assert!(outcome.is_complete(), "{fov} degrees in {family}");
        for robot in &outcome.robots {
            assert!(
                robot.stop.unwrap().is_complete(),
                "{fov} degrees in {family}"
            );
            assert_eq!(robot.cells_missed, 0, "{fov} degrees in {family}");
        }
        for direction in Direction::ALL {
            let looked = |record: &&record::grid::Record| record.deed == Deed::Looked(direction);
            assert!(trace.records.iter().any(|record| looked(&record)));
        }
        // Whoever follows the trace sees what the robots saw.
        let mut replay = draw::Replay::new(&trace);
        while replay.tick() {}
        assert_eq!(replay.seen_cells(), outcome.seen_cells);
    }
}

#[test]
fn nothing_is_seen_beside_a_narrow_field_of_view() {
    let world = World::from_fn("open", planner_core::Extent::new(20, 9), |_| false);
    let start = Cell::new(4, 4);
    let mut scenario = Scenario::new(Arc::new(world.unwrap()), vec![start], PlannerKind::Explorer);
    (scenario.fov, scenario.range, scenario.conditions.max_ticks) = (62, 3, 1);
    let mut running = run::open(&scenario, None).unwrap();
    running.tick();
    // To the east, five cells and the own one; then it turns to what it has not seen.
    let seen = running.robot(0);
    assert_eq!((seen.heading, seen.known_cells), (Direction::South, 6));
    assert_eq!(running.outcome().seen_cells, 6);
}
