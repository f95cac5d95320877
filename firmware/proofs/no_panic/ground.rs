//! Robots on a grid.

use core::hint::black_box;

use planner_core::explorer::{self, Explorer};
use planner_core::local_frontiers::{self, LocalFrontiers};
use planner_core::map::Map;
use planner_core::radio::MAX_LEN;
use planner_core::role::exchange;
use planner_core::sight::{
    Beam, Bearing, Distances, Pose, RangeScan, RangeSensor, Zone, ZoneSensor, look,
};
use planner_core::tile::TileIndex;
use planner_core::{Activity, AnyPlanner, Contact, Motion, Planner, Sighting, Status};
use static_cell::ConstStaticCell;

use super::any;

static EXPLORERS: ConstStaticCell<[Explorer<16, 16>; 2]> =
    ConstStaticCell::new([Explorer::vacant(), Explorer::vacant()]);
static FRONTIERS: ConstStaticCell<LocalFrontiers<8, 8>> =
    ConstStaticCell::new(LocalFrontiers::vacant());

pub(super) fn call_all() {
    if let Some([robot, other]) = EXPLORERS.try_take() {
        for robot in [&mut *robot, &mut *other] {
            let config = black_box(explorer::Config::new());
            let _ = black_box(robot.reset(config, any::id(), any::extent(), any::cell()));
            drive(robot);
        }
        drive(robot);
        let changed = other.take_changed();
        black_box(robot.join(other.map(), &changed));
        if let (Some(mine), Some(theirs)) = (robot.role(), other.role())
            && let Some((mine, theirs)) = exchange(&mine, any::cell(), &theirs, any::cell())
        {
            robot.adopt(mine);
            other.adopt(theirs);
        }
        ask(robot.map(), other.map());
    }
    if let Some(robot) = FRONTIERS.try_take() {
        let config = black_box(local_frontiers::Config::default());
        let _ = black_box(robot.reset(config, any::id(), any::extent(), any::cell()));
        drive(robot);
        drive(robot);
    }
}

/// What every planner does: [`AnyPlanner`].
fn drive<const TW: usize, const TH: usize>(robot: &mut impl AnyPlanner<TW, TH>) {
    for sighting in [scan(), Some(seen())].into_iter().flatten() {
        black_box(robot.observe(&sighting));
    }
    let status = Status {
        position: any::cell(),
        goal: black_box(Some(any::cell())),
        activity: black_box(Activity::Exploring),
    };
    robot.hear(any::id(), status);
    let mut frame = black_box([0; MAX_LEN]);
    black_box(robot.transmit(&mut frame));
    let _ = black_box(robot.receive(any::bytes(&frame)));
    black_box(robot.tick());
    black_box(robot.waiting());
    robot.report(black_box(Motion::Moved));
    robot.resume();
    black_box((robot.status(), robot.work(), robot.assignment()));
    black_box(robot.searched(black_box(TileIndex::new(1, 1))));
}

/// What a map is asked.
fn ask<const TW: usize, const TH: usize>(own: &Map<TW, TH>, other: &Map<TW, TH>) {
    let mut map = own.clone();
    black_box(map.join(other));
    map.stand(any::cell());
    let cell = any::cell();
    black_box((map.is_frontier(cell), map.is_free(cell)));
    black_box((map.is_known(cell), map.is_visited(cell)));
}

fn scan() -> Option<Sighting> {
    let beams = black_box([Beam {
        bearing: Bearing::from_radians(1.0),
        range: 1.0,
    }]);
    let scan = RangeScan {
        pose: black_box(Pose {
            x: 0.5,
            y: 0.5,
            heading: 0.0,
        }),
        sensor: black_box(RangeSensor::new(4.0)),
        beams: beams.into_iter().chain(zones()?),
    };
    scan.sighting().ok()
}

fn zones() -> Option<[Beam; 8]> {
    let sensor = black_box(ZoneSensor {
        distances: Distances::Radial,
        field_of_view: 0.8,
        max_range_mm: 2000,
        yaw: 1.0,
        pitch: 0.1,
        ahead_mm: 10,
        height_mm: 100,
        floor_mm: 30,
        top_mm: 150,
        cell_mm: 100,
    });
    let zone = Zone::from_vl53(black_box(5), black_box(500));
    Some(sensor.beams().ok()?.read(&black_box([zone; 64])))
}

fn seen() -> Sighting {
    let mut seen = look(any::cell(), any::radius(), |cell| black_box(cell.x > 3));
    seen.see_free(any::cell());
    seen.see_blocked(any::cell());
    seen
}
