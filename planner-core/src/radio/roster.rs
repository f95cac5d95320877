//! What was last heard of the other robots.

use crate::robot::{RobotId, Status};
use crate::zeroed::Maybe;

/// Number of other robots that are remembered; of more, the latest heard.
pub const MAX_PEERS: usize = 15;

/// Steps after which a silent robot is forgotten.
pub const PEER_MEMORY: u8 = 15;

/// Another robot as last heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peer<P, G = P> {
    /// Its name.
    pub id: RobotId,
    /// What it said.
    pub status: Status<P, G>,
    /// Steps since.
    pub age: u8,
    /// Number of the frame that it said it in; 0 where there are no frames.
    pub sequence: u16,
}

/// At most [`MAX_PEERS`] robots, each once.
#[derive(Clone, Debug)]
pub(crate) struct Roster<P, G = P>([Maybe<Peer<P, G>>; MAX_PEERS]);

impl<P: Copy, G: Copy> Roster<P, G> {
    pub(crate) const fn new() -> Self {
        Self([Maybe::Nothing; MAX_PEERS])
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Peer<P, G>> {
        self.0.iter().filter_map(|place| match place {
            Maybe::Nothing => None,
            Maybe::Just(peer) => Some(peer),
        })
    }

    /// Those that still explore.
    pub(crate) fn rivals(&self) -> impl Iterator<Item = &Peer<P, G>> {
        self.iter().filter(|peer| !peer.status.has_stopped())
    }

    /// Takes in what a robot said, by frame number `sequence`; older frames than its last are ignored.
    pub(crate) fn hear_frame(&mut self, id: RobotId, status: Status<P, G>, sequence: u16) {
        let heard = self.iter().find(|peer| peer.id == id);
        let is_news = |peer: &Peer<P, G>| (sequence.wrapping_sub(peer.sequence) as i16) > 0;
        if heard.is_none_or(is_news) {
            self.put(id, status, sequence);
        }
    }

    /// Replaces what `id` said before, or else takes an empty or the oldest place.
    pub(crate) fn hear(&mut self, id: RobotId, status: Status<P, G>) {
        self.put(id, status, 0);
    }

    fn put(&mut self, id: RobotId, status: Status<P, G>, sequence: u16) {
        let staleness = |place: &Maybe<Peer<P, G>>| match place {
            Maybe::Just(peer) if peer.id == id => u16::MAX,
            Maybe::Just(peer) => u16::from(peer.age),
            Maybe::Nothing => u16::MAX - 1,
        };
        if let Some(place) = self.0.iter_mut().max_by_key(|place| staleness(place)) {
            *place = Maybe::Just(Peer {
                id,
                status,
                age: 0,
                sequence,
            });
        }
    }

    /// One step passes.
    pub(crate) fn age(&mut self) {
        for place in &mut self.0 {
            if let Maybe::Just(peer) = place {
                peer.age += 1;
                if peer.age > PEER_MEMORY {
                    *place = Maybe::Nothing;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::Point;
    use crate::robot::Activity;

    fn at(x: f32) -> Status<Point> {
        Status {
            position: Point::new(x, 0.0, 0.0),
            goal: None,
            activity: Activity::Exploring,
        }
    }

    #[test]
    fn remembers_each_robot_once_and_the_latest_of_many() {
        let mut peers = Roster::new();
        for id in 0..20 {
            peers.hear(RobotId(id), at(0.0));
            peers.hear(RobotId(id), at(1.0));
            if id == 9 {
                peers.age();
            }
        }
        assert_eq!(peers.iter().count(), MAX_PEERS);
        assert!(peers.iter().all(|peer| peer.status == at(1.0)));
        assert!((10..20).all(|id| peers.iter().any(|peer| peer.id == RobotId(id))));
        for _ in 0..PEER_MEMORY {
            peers.age();
        }
        assert_eq!(peers.iter().count(), 10);
        peers.age();
        assert_eq!(peers.iter().count(), 0);
    }
}
