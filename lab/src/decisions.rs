//! What a robot did lately, and why, as far as its trace and its map tell.

use std::collections::VecDeque;

use host_sim::robot::Deed;
use planner_core::{Cell, Direction, Reason};

use crate::watch::Watch;

/// The side of the window in which the explorer decides without a search, halved.
const NEAR: u16 = 16;

/// One change of mind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The tick in which it was made.
    pub tick: u32,
    /// What and why.
    pub text: String,
}

/// The last `most` decisions of a robot before the shown tick, the latest first.
pub fn decisions(watch: &Watch, robot: usize, most: usize) -> Vec<Decision> {
    let mut found = VecDeque::new();
    let mut goal: Option<Cell> = None;
    let mut stopped = false;
    let own = watch
        .records()
        .iter()
        .filter(|it| usize::from(it.robot) == robot);
    for record in own {
        let mut say = |text: String| {
            if found.len() == most {
                found.pop_back();
            }
            let tick = record.tick;
            found.push_front(Decision { tick, text });
        };
        match record.deed {
            Deed::Blocked(way) => say(format!("blocked on its way {}", name(way))),
            Deed::Held(_) => say("waits for a robot that goes first".into()),
            Deed::Exchanged(_) => say("exchanges roles with the robot in its way".into()),
            Deed::Yielded => say("gives its role to a robot that wanted its cell".into()),
            Deed::Looked(way) => say(format!("looks {}", name(way))),
            Deed::Stopped(reason) if !stopped => say(stop(reason).into()),
            Deed::Moved(_) | Deed::Waited | Deed::Driving | Deed::Stopped(_) => {}
        }
        let has_stopped = matches!(record.deed, Deed::Stopped(_));
        if stopped && !has_stopped {
            say("is told to go on".into());
        }
        stopped = has_stopped;
        if let Some(next) = record.goal.filter(|&next| goal != Some(next)) {
            let why = match goal {
                None => "it had no goal",
                Some(old) if record.at == old => "arrived at the last one",
                Some(old) if is_over(watch, old, record.tick) => {
                    "what was unknown at the last one has been seen"
                }
                Some(_) => "another frontier suits it better",
            };
            let far = match record.at.chebyshev(next) {
                0..=NEAR => "near",
                _ => "far",
            };
            say(format!("goes to {next} ({far}): {why}"));
        }
        goal = record.goal;
    }
    found.into()
}

/// Whether the team had seen everything beside a cell by the end of a tick.
fn is_over(watch: &Watch, cell: Cell, tick: u32) -> bool {
    let extent = watch.scenario().world.extent();
    let beside = Direction::ALL.map(|way| cell.step(way));
    beside
        .into_iter()
        .filter(|&cell| extent.contains(cell))
        .all(|cell| watch.seen_since(cell) <= tick)
}

/// A direction in words.
pub fn name(direction: Direction) -> &'static str {
    match direction {
        Direction::East => "east",
        Direction::South => "south",
        Direction::West => "west",
        Direction::North => "north",
    }
}

/// A record's reason to stop, in words.
pub(crate) fn stop(reason: Reason) -> &'static str {
    match reason {
        Reason::Complete => "stops: complete",
        Reason::Enclosed => "stops: complete, the rest lies behind walls",
        Reason::Blocked => "gives up: the way stayed blocked",
        Reason::BackAtStart => "stops: back at the start with no frontier in view",
        Reason::NoTrace => "stops: no frontier in view and no trace to follow",
        Reason::AtEdge => "stops: complete within the map, whose edge cuts the world off",
        Reason::OutOfReach => "stops: complete, no way leads to what else is in sight",
        Reason::Unseen => "gives up: no look shows what is left",
        Reason::Held => "gives up: a robot stayed in the way",
        Reason::Home => "stops: home",
        Reason::Arrived => "stops: where it was sent",
        Reason::NoWay => "gives up: no known way leads to where it was to go",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::playback::Playback;
    use crate::setup::Setup;

    #[test]
    fn a_robot_tells_its_first_goal_and_its_end() {
        let setup = Setup::from_address("map=circle&robots=2").unwrap();
        let mut watch = Watch::new(setup.scenario().unwrap()).unwrap();
        while watch.tick() {}
        let all = decisions(&watch, 0, usize::MAX);
        assert!(
            all.last().unwrap().text.contains("it had no goal"),
            "{all:?}"
        );
        let edge = "stops: complete within the map, whose edge cuts the world off";
        assert_eq!(all[0].text, edge);
        assert_eq!(decisions(&watch, 0, 3), all[..3]);
    }
}
