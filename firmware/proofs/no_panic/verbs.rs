//! Every call that a robot makes, with arguments that the compiler knows nothing of.

use core::hint::black_box;

use planner_core::explorer::{Config, Explorer, exchange};
use planner_core::radio::MAX_LEN;
use planner_core::sight::{Beam, Pose, RangeScan};
use planner_core::{Activity, Cell, Extent, Motion, Planner, RobotId, Sighting, Status};
use static_cell::ConstStaticCell;

static ROBOTS: ConstStaticCell<[Explorer<16, 16>; 2]> =
    ConstStaticCell::new([Explorer::vacant(), Explorer::vacant()]);

/// Calls them all.
pub(crate) fn call_all() {
    let Some([robot, other]) = ROBOTS.try_take() else {
        return;
    };
    for robot in [&mut *robot, &mut *other] {
        let extent = black_box(Extent::new(9, 9));
        let config = black_box(Config::new());
        let _ = black_box(robot.reset(config, id(), extent, cell()));
        drive(robot);
    }
    drive(robot);
    let changed = other.take_changed();
    black_box(robot.join(other.map(), &changed));
    if let (Some(mine), Some(theirs)) = (robot.role(), other.role())
        && let Some((mine, theirs)) = exchange(&mine, cell(), &theirs, cell())
    {
        robot.adopt(mine);
        other.adopt(theirs);
    }
    let mut map = robot.map().clone();
    black_box(map.join(other.map()));
    black_box((map.is_frontier(cell()), map.is_free(cell())));
}

/// The verbs of [`Planner`].
fn drive<const TW: usize, const TH: usize>(robot: &mut impl Planner<TW, TH>) {
    if let Some(sighting) = scan() {
        black_box(robot.observe(&sighting));
    }
    let status = Status {
        position: cell(),
        goal: black_box(Some(cell())),
        activity: black_box(Activity::Exploring),
    };
    robot.hear(id(), status);
    let mut frame = black_box([0; MAX_LEN]);
    black_box(robot.transmit(&mut frame));
    let length = black_box(frame.len());
    let _ = black_box(robot.receive(black_box(frame.get(..length).unwrap_or_default())));
    black_box(robot.tick());
    robot.report(black_box(Motion::Moved));
    black_box((robot.status(), robot.work()));
}

fn scan() -> Option<Sighting> {
    let beams = black_box([Beam {
        bearing: 0.0,
        range: 1.0,
    }]);
    let scan = RangeScan {
        pose: black_box(Pose {
            x: 0.5,
            y: 0.5,
            heading: 0.0,
        }),
        max_range: black_box(4.0),
        beams: &beams,
    };
    scan.sighting().ok()
}

fn cell() -> Cell {
    black_box(Cell::new(1, 1))
}

fn id() -> RobotId {
    black_box(RobotId(1))
}
