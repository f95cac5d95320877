//! The planner of a robot that flies, and what the simulator asks of it.

use bridge::{
    Cost, Hello, Inbox, MAX_MESSAGE, Seen, SurveyAnswer, SurveyReply, SurveyRequest,
    SurveyorConfig, VERSION, Welcome, frame_hash, patches_hash, surface_hash,
};
use firmware::{CLOCK_HZ, Host, Stopwatch, Trouble, memory};
use planner_core::coordinated_survey::CoordinatedSurvey;
use planner_core::fcao::Fcao;
use planner_core::radio::MAX_LEN;
use planner_core::survey::{SetupError, Surveyor};
use planner_core::{Extent, RobotId};
use static_cell::ConstStaticCell;

/// Tiles along a side of the map: 104×104 columns.
const TILES: usize = 13;

/// The planners that the image can host. One of them is used, so they share a place: side
/// by side they do not fit in the RAM of the chip.
enum Hosted {
    Coordinated(CoordinatedSurvey<TILES, TILES>),
    Fcao(Fcao<TILES, TILES>),
}

/// From here the other planner is copied: the stack has no room for one.
const FCAO: Hosted = Hosted::Fcao(Fcao::vacant());

/// All zero, so in `.bss`.
static HOSTED: ConstStaticCell<Hosted> =
    ConstStaticCell::new(Hosted::Coordinated(CoordinatedSurvey::vacant()));

/// Columns on their way into the planner.
static SEEN: ConstStaticCell<Seen> = ConstStaticCell::new(Seen::new());

type Robot = dyn Surveyor<TILES, TILES>;

/// Answers requests until the simulator has none left.
pub(crate) fn serve(
    host: &Host,
    inbox: &mut Inbox,
    outbox: &mut [u8; MAX_MESSAGE],
    stopwatch: &Stopwatch,
    (planner, id, extent): (SurveyorConfig, RobotId, Extent),
) -> Result<(), Trouble> {
    let (planner, size) = match prepare(planner, id, extent) {
        Ok(prepared) => prepared,
        Err(error) => return host.answer(&Welcome::Grounded(error), outbox),
    };
    let hello = Hello {
        version: VERSION,
        clock_hz: CLOCK_HZ,
    };
    host.answer(&Welcome::Ready(hello), outbox)?;
    let seen = SEEN.take();
    loop {
        let request = host.ask(inbox)?;
        let Some((reply, cost)) = obey(planner, size, seen, stopwatch, request) else {
            return Ok(());
        };
        let answer = SurveyAnswer {
            cost,
            state: planner.status(),
            reply,
        };
        host.answer(&answer, outbox)?;
    }
}

/// Sets up the planner, in place. Returns its size too.
#[inline(never)] // what it keeps on the stack goes with it
fn prepare(
    planner: SurveyorConfig,
    id: RobotId,
    extent: Extent,
) -> Result<(&'static mut Robot, usize), SetupError> {
    let hosted = HOSTED.take();
    if let SurveyorConfig::Fcao(_) = planner {
        *hosted = FCAO;
    }
    match (hosted, planner) {
        (Hosted::Fcao(planner), SurveyorConfig::Fcao(config)) => {
            planner.reset(config, id, extent)?;
            Ok((planner, size_of::<Fcao<TILES, TILES>>()))
        }
        (Hosted::Coordinated(planner), SurveyorConfig::Coordinated(config)) => {
            planner.reset(config, id, extent)?;
            Ok((planner, size_of::<CoordinatedSurvey<TILES, TILES>>()))
        }
        _ => unreachable!("it was put there just now"),
    }
}

/// Does what is asked for, and says what the planner's call took.
/// `None`: the simulator has finished.
fn obey(
    planner: &mut Robot,
    size: usize,
    seen: &mut Seen,
    stopwatch: &Stopwatch,
    request: SurveyRequest<'_>,
) -> Option<(SurveyReply, Cost)> {
    let done = |((), cost)| (SurveyReply::Done, cost);
    Some(match request {
        SurveyRequest::Look(columns) => {
            // More than there is room for show in the map that the simulator compares.
            let _ = seen.extend_from_slice(&columns);
            (SurveyReply::Done, Cost::default())
        }
        SurveyRequest::Observe(at) => {
            let ((), cost) = stopwatch.measure(|| planner.observe(at, seen));
            seen.clear();
            (SurveyReply::Told(patches_hash(planner.knowledge())), cost)
        }
        SurveyRequest::Hear(id, status) => done(stopwatch.measure(|| planner.hear(id, status))),
        SurveyRequest::Merge(record) => {
            let patch = record.patch();
            done(stopwatch.measure(|| planner.merge(&patch)))
        }
        SurveyRequest::Tick => {
            let (action, cost) = stopwatch.measure(|| planner.tick());
            let knowledge = planner.knowledge();
            let decided = SurveyReply::Decided {
                action,
                waiting: planner.waiting(),
                work: planner.work(),
                gain: knowledge.gain(),
                reward: knowledge.reward(),
                map: surface_hash(knowledge.surface()),
            };
            (decided, cost)
        }
        SurveyRequest::Resume => done(stopwatch.measure(|| planner.resume())),
        SurveyRequest::Report(motion, at) => done(stopwatch.measure(|| planner.report(motion, at))),
        SurveyRequest::Transmit => {
            let mut frame = [0; MAX_LEN];
            let (length, cost) = stopwatch.measure(|| planner.transmit(&mut frame));
            let frame = length.and_then(|length| frame.get(..length));
            (SurveyReply::Sent(frame.map(frame_hash)), cost)
        }
        SurveyRequest::Receive(bytes) => {
            let (heard, cost) = stopwatch.measure(|| planner.receive(bytes));
            (SurveyReply::Heard(heard), cost)
        }
        SurveyRequest::Memory => (SurveyReply::Memory(memory::taken(size)), Cost::default()),
        SurveyRequest::End => return None,
    })
}
