//! Somebody in the air who writes frames of his own: he hears and sees everything, and
//! has no key.

use planner_core::radio::{Key, MAX_LEN};
use planner_core::{Activity, RobotId};

use super::{Claim, Station};
use crate::dice::Dice;
use crate::scenario::{Forger, Forgery};

/// A forger at work. He draws from a generator of his own, so the air is as without him.
pub(super) struct Desk {
    forger: Forger,
    sequence: u16,
    dice: Dice,
    /// He has no key of the fleet, so he tries one.
    key: Key,
}

impl Desk {
    pub(super) fn new(forger: Forger, seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x666f_7267_6572);
        let mut key = [0; 16];
        dice.fill(&mut key);
        Self {
            forger,
            sequence: 0,
            dice,
            key: Key(key),
        }
    }

    /// Lets every robot hear what is forged for it in `tick`.
    pub(super) fn forge<S: Station>(&mut self, tick: u32, robots: &mut [S]) {
        self.sequence = self.sequence.wrapping_add(1);
        let ids: Vec<RobotId> = robots.iter().map(Station::id).collect();
        let Some(first) = robots.first().map(Station::place) else {
            return;
        };
        for robot in robots.iter_mut().filter(|robot| robot.is_awake()) {
            for frame in self.frames(tick, robot, &ids, first) {
                let mut buffer = [0; MAX_LEN];
                for key in [None, Some(&self.key)] {
                    let length = S::encode(&frame, key, &mut buffer);
                    let frame = &buffer[..length];
                    let read = robot.read(frame);
                    robot.receive(frame, &read);
                }
            }
        }
    }

    fn frames<S: Station>(
        &mut self,
        tick: u32,
        robot: &S,
        ids: &[RobotId],
        first: S::Place,
    ) -> Vec<S::Frame> {
        let frames = self.forger.frames;
        let ghosts = 0..frames.min(256);
        let ghost = |id: u16, position| Claim {
            sender: RobotId(id as u8),
            sequence: self.sequence,
            position,
            goal: None,
            activity: Activity::Exploring,
        };
        let claims: Vec<Claim<S::Place>> = match (self.forger.kind, robot.goal()) {
            (Forgery::Any, _) => return (0..frames).map(|_| self.drawn(robot, true)).collect(),
            (Forgery::Hints, _) => return (0..frames).map(|_| self.drawn(robot, false)).collect(),
            (Forgery::OwnCell, _) => ghosts.map(|id| ghost(id, robot.place())).collect(),
            (Forgery::Around, _) => (robot.around().into_iter())
                .zip(ghosts)
                .map(|(place, id)| ghost(100 + id, place))
                .collect(),
            (Forgery::Goal | Forgery::Jump, None) => Vec::new(),
            (Forgery::Goal, goal @ Some(place)) => ghosts
                .map(|id| Claim {
                    goal,
                    ..ghost(id, place)
                })
                .collect(),
            (Forgery::Jump, Some(place)) => {
                let is_there = (tick / 3).is_multiple_of(2);
                let at = if is_there { place } else { robot.corner() };
                ghosts.map(|id| ghost(id, at)).collect()
            }
            (Forgery::Stolen, _) if !tick.is_multiple_of(200) => Vec::new(),
            (Forgery::Stolen, _) => ids
                .iter()
                .map(|id| Claim {
                    sequence: (tick as u16).wrapping_add(30_000),
                    activity: Activity::Stopped,
                    ..ghost(id.0.into(), robot.corner())
                })
                .collect(),
            (Forgery::Crowd, _) => (0..256).map(|id| ghost(id, first)).collect(),
        };
        let forged = |claim| robot.forged(claim, 0, &mut self.dice);
        claims.into_iter().map(forged).collect()
    }

    /// A frame with anything in it, in the right form.
    fn drawn<S: Station>(&mut self, robot: &S, with_pieces: bool) -> S::Frame {
        let dice = &mut self.dice;
        let position = robot.anywhere(dice);
        let goal = (dice.below(2) == 0).then(|| robot.anywhere(dice));
        let activity = match dice.below(8) {
            0 => Activity::Stopped,
            _ => Activity::Exploring,
        };
        let pieces = if with_pieces { dice.below(3) } else { 0 };
        let claim = Claim {
            sender: RobotId(dice.below(256) as u8),
            sequence: dice.below(1 << 16) as u16,
            position,
            goal,
            activity,
        };
        robot.forged(claim, pieces, dice)
    }
}
