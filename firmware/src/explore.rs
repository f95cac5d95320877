//! The robot's main loop, with a world and motors that are only pretended.

use planner_core::sight::look;
use planner_core::{Action, Cell, Inspect, Motion, Stop};

use crate::World;

/// How an exploration went.
pub struct Exploration {
    /// Ticks until the robot stopped.
    pub ticks: u32,
    /// Ticks in which it moved.
    pub steps: u32,
    /// The largest work of one tick, as [`Inspect::work`] counts it.
    pub work: u32,
    /// Why it stopped; `None` where it never did.
    pub stop: Option<Stop>,
}

/// Lets `planner`, which stands at the start of `world`, explore until it stops.
///
/// The planner is behind a pointer as in any image that can host several: no call is
/// inlined, and none takes stack when it is over.
///
/// It is given eight ticks for every cell; a planner that takes more goes round
/// in circles.
pub fn explore<const TW: usize, const TH: usize>(
    planner: &mut dyn Inspect<TW, TH>,
    world: &World,
    range: u8,
) -> Exploration {
    let planner = core::hint::black_box(planner);
    let mut position = world.start();
    let mut exploration = Exploration {
        ticks: 0,
        steps: 0,
        work: 0,
        stop: None,
    };
    while exploration.ticks < 8 * world.extent().cells() {
        exploration.ticks += 1;
        observe(planner, world, position, range);
        let action = planner.tick();
        exploration.work = exploration.work.max(planner.work());
        match action {
            Action::Move(direction) => {
                let next = position.step(direction);
                if world.is_blocked(next) {
                    planner.report(Motion::Blocked);
                } else {
                    position = next;
                    exploration.steps += 1;
                    planner.report(Motion::Moved);
                }
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                exploration.stop = Some(stop);
                break;
            }
        }
    }
    exploration
}

/// Looks around. A function of its own, so that the sighting is not on the stack
/// any more when the planner decides.
#[inline(never)]
fn observe<const TW: usize, const TH: usize>(
    planner: &mut dyn Inspect<TW, TH>,
    world: &World,
    position: Cell,
    range: u8,
) {
    planner.observe(&look(position, range, |cell| world.is_blocked(cell)));
}
