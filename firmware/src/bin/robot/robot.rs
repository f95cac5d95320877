//! The planner, and what the simulator asks of it.

use bridge::{
    Answer, Cost, FrameBytes, Hello, Inbox, MAX_MESSAGE, PlannerConfig, Reply, Request, Rows,
    State, VERSION, Welcome, grid_hash,
};
use firmware::{CLOCK_HZ, COLUMNS, Host, ROWS, Stopwatch, Trouble, memory};
use planner_core::ExtentError;
use planner_core::explorer::Explorer;
use planner_core::local_frontiers::LocalFrontiers;
use planner_core::map::Map;
use planner_core::radio::{MAX_LEN, TileRecord};
use planner_core::tile::{TileIndex, TileSet};
use planner_core::{AnyPlanner, Cell, Extent, RobotId};
use static_cell::ConstStaticCell;

// Every planner that the image can host has its place; one of them is used.
static EXPLORER: ConstStaticCell<Explorer<COLUMNS, ROWS>> =
    ConstStaticCell::new(Explorer::vacant());
static LOCAL_FRONTIERS: ConstStaticCell<LocalFrontiers<COLUMNS, ROWS>> =
    ConstStaticCell::new(LocalFrontiers::vacant());

/// Tiles of another robot's map, on their way into the planner.
static STAGE: ConstStaticCell<Stage> = ConstStaticCell::new(Stage {
    map: Map::vacant(),
    tiles: TileSet::new(),
});

static INBOX: ConstStaticCell<Inbox> = ConstStaticCell::new(Inbox::new());
static OUTBOX: ConstStaticCell<[u8; MAX_MESSAGE]> = ConstStaticCell::new([0; MAX_MESSAGE]);

/// What [`Contact::join`](planner_core::Contact::join) takes. All that ever was put aside for this robot stays
/// on the map: it was joined before, so joining it again changes nothing.
struct Stage {
    map: Map<COLUMNS, ROWS>,
    tiles: TileSet<ROWS>,
}

/// Answers requests until the simulator has none left.
pub(crate) fn serve() -> Result<(), Trouble> {
    let host = Host::connect()?;
    let (inbox, outbox) = (INBOX.take(), OUTBOX.take());
    let stopwatch = Stopwatch::start();

    let (planner, id, extent, start) = match host.ask(inbox)? {
        Request::Start {
            planner,
            id,
            extent,
            start,
        } => (planner, id, extent, start),
        #[cfg(board = "stm32f405")]
        Request::Survey {
            planner,
            id,
            extent,
        } => {
            let setup = (planner, id, extent);
            return crate::survey::serve(&host, inbox, outbox, &stopwatch, setup);
        }
        #[cfg(not(board = "stm32f405"))]
        Request::Survey { .. } => return host.answer(&Welcome::NotHosted, outbox),
        Request::Voxels { .. } => return host.answer(&Welcome::NotHosted, outbox),
        _ => return Err(Trouble::NotStarted),
    };
    let stage = STAGE.take();
    let prepared = prepare(planner, id, extent, start).and_then(|(planner, size)| {
        stage.map.reset(extent)?;
        Ok((planner, size))
    });
    let (planner, size) = match prepared {
        Ok(prepared) => prepared,
        Err(error) => return host.answer(&Welcome::Refused(error), outbox),
    };
    let hello = Hello {
        version: VERSION,
        clock_hz: CLOCK_HZ,
    };
    host.answer(&Welcome::Ready(hello), outbox)?;
    loop {
        let request = host.ask(inbox)?;
        let Some((reply, cost)) = obey(planner, size, stage, &stopwatch, request) else {
            return Ok(());
        };
        let answer = Answer {
            cost,
            state: state(planner),
            reply,
        };
        host.answer(&answer, outbox)?;
    }
}

type Robot = dyn AnyPlanner<COLUMNS, ROWS>;

/// Sets up the planner, in place. Returns its size too.
fn prepare(
    planner: PlannerConfig,
    id: RobotId,
    extent: Extent,
    start: Cell,
) -> Result<(&'static mut Robot, usize), ExtentError> {
    Ok(match planner {
        PlannerConfig::Explorer(config) => {
            let explorer = EXPLORER.take();
            explorer.reset(config, id, extent, start)?;
            (explorer, size_of::<Explorer<COLUMNS, ROWS>>())
        }
        PlannerConfig::LocalFrontiers(config) => {
            let planner = LOCAL_FRONTIERS.take();
            planner.reset(config, id, extent, start)?;
            (planner, size_of::<LocalFrontiers<COLUMNS, ROWS>>())
        }
    })
}

/// Does what is asked for, and says what the planner's call took.
/// `None`: the simulator has finished.
fn obey(
    planner: &mut Robot,
    size: usize,
    stage: &mut Stage,
    stopwatch: &Stopwatch,
    request: Request<'_>,
) -> Option<(Reply, Cost)> {
    let done = |((), cost)| (Reply::Done, cost);
    Some(match request {
        Request::Observe(sighting) => {
            let (learnt, cost) = stopwatch.measure(|| planner.observe(&sighting));
            (Reply::Learnt(learnt), cost)
        }
        Request::Tick => {
            let (action, cost) = stopwatch.measure(|| planner.tick());
            (Reply::Action(action), cost)
        }
        Request::Report(motion) => done(stopwatch.measure(|| planner.report(motion))),
        Request::Resume => done(stopwatch.measure(|| planner.resume())),
        Request::Transmit => {
            let mut buffer = [0; MAX_LEN];
            let (length, cost) = stopwatch.measure(|| planner.transmit(&mut buffer));
            let frame = length.and_then(|length| buffer.get(..length));
            let frame = frame.and_then(|frame| FrameBytes::from_slice(frame).ok());
            (Reply::Frame(frame), cost)
        }
        Request::Receive(bytes) => {
            let (heard, cost) = stopwatch.measure(|| planner.receive(bytes));
            (Reply::Heard(heard), cost)
        }
        Request::TakeChanged => {
            let (changed, cost) = stopwatch.measure(|| planner.take_changed());
            let rows = (0..ROWS as u8).map(|y| changed.row(y)).collect::<Rows>();
            (Reply::Changed(rows), cost)
        }
        Request::Stage(records) => {
            for record in records {
                stage.map.join_tile(record.at, record.tile);
                stage.tiles.insert(record.at);
            }
            (Reply::Done, Cost::default())
        }
        Request::Join => {
            let (learnt, cost) = stopwatch.measure(|| planner.join(&stage.map, &stage.tiles));
            stage.tiles.clear();
            (Reply::Learnt(learnt), cost)
        }
        Request::Hear(id, status) => done(stopwatch.measure(|| planner.hear(id, status))),
        Request::Adopt(role) => done(stopwatch.measure(|| planner.adopt(role))),
        Request::Memory => (Reply::Memory(memory::taken(size)), Cost::default()),
        Request::Start { .. } | Request::Survey { .. } | Request::Voxels { .. } | Request::End => {
            return None;
        }
    })
}

fn state(planner: &Robot) -> State {
    let status = planner.status();
    // Beyond the map's edge there is no robot.
    let at = TileIndex::of(status.position).map_or(TileIndex::new(0, 0), |(at, _)| at);
    State {
        status,
        work: planner.work(),
        map: grid_hash(planner.map()),
        here: TileRecord {
            at,
            tile: planner.map().tile_inside(at),
        },
        role: planner.role(),
        waiting: planner.waiting(),
        hearsay: planner.hearsay(),
    }
}
