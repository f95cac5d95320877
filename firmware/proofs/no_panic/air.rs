//! Robots that fly: over heights, and among voxels.

use core::hint::black_box;

use planner_core::coordinated_survey::{self, Choice, CoordinatedSurvey};
use planner_core::fcao::{self, Fcao};
use planner_core::radio::MAX_LEN;
use planner_core::surface::{Column, Height, Patch};
use planner_core::survey::{Limits, Mission, Surveyor};
use planner_core::tile::TileIndex;
use planner_core::volume::{Field, Voxel, VoxelPatch};
use planner_core::voxel_survey::{self, VoxelSurvey};
use planner_core::{Activity, Motion, Point, Status};
use static_cell::ConstStaticCell;

use super::any;

static FCAO: ConstStaticCell<Fcao<8, 8>> = ConstStaticCell::new(Fcao::vacant());
static COORDINATED: ConstStaticCell<CoordinatedSurvey<8, 8>> =
    ConstStaticCell::new(CoordinatedSurvey::vacant());

pub(super) fn call_all() {
    if let Some(robot) = FCAO.try_take() {
        let config = black_box(fcao::Config::new(limits(), 1));
        let _ = black_box(robot.reset(config, any::id(), any::extent()));
        drive(robot);
    }
    if let Some(robot) = COORDINATED.try_take() {
        let config = black_box(coordinated_survey::Config {
            limits: limits(),
            link: any::link(),
            seed: 1,
            choice: Choice::Cubic,
            mission: black_box(Mission {
                come_home: true,
                energy: 9,
            }),
        });
        let _ = black_box(robot.reset(config, any::id(), any::extent()));
        drive(robot);
    }
    fly_among_voxels();
}

/// The verbs of [`Surveyor`].
fn drive<const TW: usize, const TH: usize>(robot: &mut impl Surveyor<TW, TH>) {
    let column = Column {
        cell: any::cell(),
        height: black_box(Height(9)),
    };
    robot.observe(point(), &black_box([column; 4]));
    let status = Status {
        position: point(),
        goal: black_box(Some(any::cell())),
        activity: black_box(Activity::Exploring),
    };
    robot.hear(any::id(), status);
    let patch = Patch {
        tile: tile(),
        cells: black_box(1),
        heights: black_box([Height(9); 64]),
        fresh: black_box(true),
    };
    robot.merge(&patch);
    let mut frame = black_box([0; MAX_LEN]);
    black_box(robot.transmit(&mut frame));
    let _ = black_box(robot.receive(any::bytes(&frame)));
    black_box(robot.tick());
    black_box((robot.energy(9), robot.go_home()));
    black_box(robot.tick());
    robot.report(black_box(Motion::Moved), point());
    black_box((robot.status(), robot.work()));
    let surface = robot.knowledge().surface();
    black_box((
        surface.is_frontier(any::cell()),
        surface.height(any::cell()),
    ));
}

/// The verbs of [`VoxelSurvey`].
fn fly_among_voxels() {
    let config = black_box(voxel_survey::Config {
        range: 4,
        clearance: 2,
        field: Field::CAMERA,
        sensor: black_box(voxel_survey::Sensor::Errs),
        come_home: true,
        energy: 100,
        link: any::link(),
    });
    let levels = black_box(8);
    let robot = VoxelSurvey::<4, 4, 16>::new(config, any::id(), any::extent(), levels);
    let Ok(mut robot) = robot else {
        return;
    };
    robot.observe(voxel(), &black_box([(voxel(), false); 4]));
    let status = Status {
        position: voxel(),
        goal: black_box(Some(voxel())),
        activity: black_box(Activity::Exploring),
    };
    robot.hear(any::id(), status);
    let mut frame = black_box([0; MAX_LEN]);
    black_box(robot.transmit(&mut frame));
    let _ = black_box(robot.receive(any::bytes(&frame)));
    let patch: VoxelPatch = black_box(robot.volume().patch(tile(), black_box(1)));
    black_box(robot.merge(&patch));
    black_box(robot.tick());
    robot.energy(black_box(50));
    robot.go_home();
    black_box(robot.tick());
    black_box((robot.status(), robot.work(), robot.position()));
    black_box(robot.volume().known_voxels());
}

fn limits() -> Limits {
    black_box(Limits {
        range: 8.0,
        step: 2.0,
        min_altitude: 1.0,
        ceiling: 20.0,
        separation: 1.0,
        clearance: 2,
    })
}

fn point() -> Point {
    black_box(Point::new(1.0, 1.0, 5.0))
}

fn tile() -> TileIndex {
    black_box(TileIndex { x: 0, y: 0 })
}

fn voxel() -> Voxel {
    black_box(Voxel::new(1, 1, 1))
}
