//! The planner, and what the simulator asks of it.

use bridge::{
    Cost, FrameBytes, Hello, Inbox, MAX_MESSAGE, Request, SeenVoxels, VERSION, VoxelAnswer,
    VoxelReply, VoxelRequest, VoxelState, Welcome, voxels_hash,
};
use firmware::{CLOCK_HZ, Host, Stopwatch, Trouble, memory};
use planner_core::radio::MAX_LEN;
use planner_core::volume::VoxelPatch;
use planner_core::voxel_survey::VoxelSurvey;
use static_cell::ConstStaticCell;

/// For 40×40×24 voxels.
type Robot = VoxelSurvey<5, 5, 24>;

static ROBOT: ConstStaticCell<Robot> = ConstStaticCell::new(Robot::vacant());
/// Voxels on their way into the planner.
static SEEN: ConstStaticCell<SeenVoxels> = ConstStaticCell::new(SeenVoxels::new());
static INBOX: ConstStaticCell<Inbox> = ConstStaticCell::new(Inbox::new());
static OUTBOX: ConstStaticCell<[u8; MAX_MESSAGE]> = ConstStaticCell::new([0; MAX_MESSAGE]);

/// Answers requests until the simulator has none left.
pub(crate) fn serve() -> Result<(), Trouble> {
    let host = Host::connect()?;
    let (inbox, outbox) = (INBOX.take(), OUTBOX.take());
    let stopwatch = Stopwatch::start();

    let (robot, seen) = (ROBOT.take(), SEEN.take());
    let prepared = match host.ask(inbox)? {
        Request::Voxels {
            planner,
            id,
            extent,
            levels,
        } => robot.reset(planner, id, extent, levels),
        Request::Start { .. } | Request::Survey { .. } => {
            return host.answer(&Welcome::NotHosted, outbox);
        }
        _ => return Err(Trouble::NotStarted),
    };
    if let Err(error) = prepared {
        return host.answer(&Welcome::Refused(error), outbox);
    }
    let hello = Hello {
        version: VERSION,
        clock_hz: CLOCK_HZ,
    };
    host.answer(&Welcome::Ready(hello), outbox)?;
    loop {
        let request = host.ask(inbox)?;
        let Some((reply, cost)) = obey(robot, seen, &stopwatch, request) else {
            return Ok(());
        };
        let answer = VoxelAnswer {
            cost,
            state: VoxelState {
                status: robot.status(),
                heading: robot.heading(),
            },
            reply,
        };
        host.answer(&answer, outbox)?;
    }
}

/// Does what is asked for, and says what the planner's call took.
/// `None`: the simulator has finished.
fn obey(
    robot: &mut Robot,
    seen: &mut SeenVoxels,
    stopwatch: &Stopwatch,
    request: VoxelRequest<'_>,
) -> Option<(VoxelReply, Cost)> {
    let done = |((), cost)| (VoxelReply::Done, cost);
    Some(match request {
        VoxelRequest::Look(voxels) => {
            // More than there is room for show in the map that the simulator compares.
            let _ = seen.extend_from_slice(&voxels);
            (VoxelReply::Done, Cost::default())
        }
        VoxelRequest::Observe(at, heading) => {
            let observed = stopwatch.measure(|| robot.observe_towards(at, heading, seen.iter()));
            seen.clear();
            done(observed)
        }
        VoxelRequest::Tick => {
            let (action, cost) = stopwatch.measure(|| robot.tick());
            let map = robot.volume();
            let decided = VoxelReply::Decided {
                action,
                work: robot.work(),
                map: voxels_hash(|tile, z| map.patch(tile, z), |tile, z| map.after(tile, z)),
            };
            (decided, cost)
        }
        VoxelRequest::Pass => done(stopwatch.measure(|| robot.pass())),
        VoxelRequest::Resume => done(stopwatch.measure(|| robot.resume())),
        VoxelRequest::Energy(left) => done(stopwatch.measure(|| robot.energy(left))),
        VoxelRequest::Transmit => {
            let mut buffer = [0; MAX_LEN];
            let (length, cost) = stopwatch.measure(|| robot.transmit(&mut buffer));
            let frame = length.and_then(|length| buffer.get(..length));
            let frame = frame.and_then(|frame| FrameBytes::from_slice(frame).ok());
            (VoxelReply::Frame(frame), cost)
        }
        VoxelRequest::Receive(bytes) => {
            let (heard, cost) = stopwatch.measure(|| robot.receive(bytes));
            (VoxelReply::Heard(heard), cost)
        }
        VoxelRequest::Hear(id, status) => done(stopwatch.measure(|| robot.hear(id, status))),
        VoxelRequest::Merge {
            tile,
            z,
            known,
            occupied,
        } => {
            let patch = VoxelPatch {
                tile,
                z,
                known,
                occupied,
            };
            let (_, cost) = stopwatch.measure(|| robot.merge(&patch));
            (VoxelReply::Done, cost)
        }
        VoxelRequest::Memory => {
            let memory = memory::taken(size_of::<Robot>());
            (VoxelReply::Memory(memory), Cost::default())
        }
        VoxelRequest::End => return None,
    })
}
