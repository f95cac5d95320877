//! What was last heard of the other robots.

use super::Status;

/// Number of other robots that are remembered; of more, the latest heard.
pub const MAX_PEERS: usize = 15;

/// Steps after which a silent robot is forgotten.
pub const PEER_MEMORY: u8 = 15;

/// Another robot as last heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peer<S = Status> {
    /// Its name.
    pub id: u8,
    /// What it said.
    pub status: S,
    /// Steps since.
    pub age: u8,
    /// Number of the frame that it said it in; 0 where there are no frames.
    pub sequence: u16,
}

/// At most [`MAX_PEERS`] robots, each once.
#[derive(Clone, Debug)]
pub(crate) struct Peers<S = Status>([Place<S>; MAX_PEERS]);

/// Room for one. As an `Option`, but empty is all zero: then a `static` planner
/// takes no flash.
#[repr(u8)]
#[derive(Clone, Copy, Debug)]
enum Place<S> {
    Empty = 0,
    Taken(Peer<S>) = 1,
}

impl<S: Copy> Peers<S> {
    pub(crate) const fn new() -> Self {
        Self([Place::Empty; MAX_PEERS])
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Peer<S>> {
        self.0.iter().filter_map(|place| match place {
            Place::Empty => None,
            Place::Taken(peer) => Some(peer),
        })
    }

    /// The same by frame number `sequence`; older frames than the last are ignored.
    pub(crate) fn hear_frame(&mut self, id: u8, status: S, sequence: u16) {
        let heard = self.iter().find(|peer| peer.id == id);
        let is_news = |peer: &Peer<S>| (sequence.wrapping_sub(peer.sequence) as i16) > 0;
        if heard.is_none_or(is_news) {
            self.put(id, status, sequence);
        }
    }

    /// Replaces what `id` said before, or else takes an empty or the oldest place.
    pub(crate) fn hear(&mut self, id: u8, status: S) {
        self.put(id, status, 0);
    }

    fn put(&mut self, id: u8, status: S, sequence: u16) {
        let staleness = |place: &Place<S>| match place {
            Place::Taken(peer) if peer.id == id => u16::MAX,
            Place::Taken(peer) => u16::from(peer.age),
            Place::Empty => u16::MAX - 1,
        };
        if let Some(place) = self.0.iter_mut().max_by_key(|place| staleness(place)) {
            *place = Place::Taken(Peer {
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
            if let Place::Taken(peer) = place {
                peer.age += 1;
                if peer.age > PEER_MEMORY {
                    *place = Place::Empty;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::Point;

    fn at(x: f32) -> Status {
        Status {
            position: Point::new(x, 0.0, 0.0),
            target: None,
            stopped: false,
        }
    }

    #[test]
    fn remembers_each_robot_once_and_the_latest_of_many() {
        let mut peers = Peers::new();
        for id in 0..20 {
            peers.hear(id, at(0.0));
            peers.hear(id, at(1.0));
            if id == 9 {
                peers.age();
            }
        }
        assert_eq!(peers.iter().count(), MAX_PEERS);
        assert!(peers.iter().all(|peer| peer.status == at(1.0)));
        assert!((10..20).all(|id| peers.iter().any(|peer| peer.id == id)));
        for _ in 0..PEER_MEMORY {
            peers.age();
        }
        assert_eq!(peers.iter().count(), 10);
        peers.age();
        assert_eq!(peers.iter().count(), 0);
    }
}
