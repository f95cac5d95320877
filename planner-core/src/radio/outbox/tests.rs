use std::vec::Vec;

use proptest::prelude::*;

use super::*;

type Small = Outbox<6>;
const TILES: (u8, u8) = (7, 6);

fn tile(index: usize) -> TileIndex {
    TileIndex::new((index % 7) as u8, (index / 7) as u8)
}

fn set(indices: &[usize]) -> TileSet<6> {
    let mut set = TileSet::new();
    for &index in indices {
        set.insert(tile(index));
    }
    set
}

fn some_tiles() -> impl Strategy<Value = Vec<usize>> {
    proptest::collection::vec(0..42usize, 1..20)
}

#[test]
fn pop_after_goes_round_and_round() {
    let mut set = set(&[3, 10, 12, 40]);
    let mut last = tile(11);
    let mut order = Vec::new();
    while let Some(next) = set.pop_after(last) {
        order.push(next);
        last = next;
    }
    assert_eq!(order, [tile(12), tile(40), tile(3), tile(10)]);
}

#[test]
fn what_others_tell_is_repeated_at_most() {
    let mut outbox = Small::new();
    outbox.add(&set(&[5, 6, 7]));
    outbox.told(tile(5));
    outbox.told(tile(6));
    outbox.told(tile(6));
    let sent: Vec<_> = (0..6)
        .filter_map(|_| outbox.next(TILES, |_| false))
        .collect();
    assert_eq!(sent, [tile(7), tile(5), tile(7)]);
}

#[test]
fn nothing_known_is_nothing_to_send() {
    let mut outbox = Small::new();
    assert!((0..1000).all(|_| outbox.next(TILES, |_| false).is_none()));
}

proptest! {
    #[test]
    fn changes_go_first_and_twice(changed in some_tiles()) {
        let mut outbox = Small::new();
        let changed = set(&changed);
        outbox.add(&changed);
        let count = changed.iter().count();
        // Of eight tiles two are repetitions, and one is the turn's.
        let slots = count + 3 * count / 5 + 2;
        let mut send = |slots: usize| -> Vec<_> {
            (0..slots).filter_map(|_| outbox.next(TILES, |_| true)).collect()
        };
        let first = send(slots);
        let then = send(slots);
        for at in changed.iter() {
            prop_assert!(first.contains(&at));
            prop_assert!(first.iter().chain(&then).filter(|&&sent| sent == at).count() > 1);
        }
    }

    /// However fast some tiles change, every known tile is sent in bounded time.
    #[test]
    fn nothing_starves(known in some_tiles(), changing in some_tiles()) {
        let mut outbox = Small::new();
        let mut waiting = set(&known);
        let worth = waiting;
        let changing = set(&changing);
        // A turn passes 42 tiles, at worst one in each turn's slot.
        for _ in 0..42 * usize::from(TURN) {
            outbox.add(&changing);
            if let Some(sent) = outbox.next(TILES, |at| worth.contains(at)) {
                waiting.remove(sent);
            }
        }
        prop_assert!(waiting.is_empty());
    }

    /// A new tile does not wait for those that keep changing.
    #[test]
    fn what_is_new_does_not_starve(new in 0..42usize, changing in some_tiles()) {
        let mut outbox = Small::new();
        outbox.add(&set(&[new]));
        let changing = set(&changing);
        let count = changing.iter().count() + 1;
        let slots = count + 3 * count / 5 + 3;
        let sent = (0..slots).any(|_| {
            outbox.add(&changing);
            outbox.next(TILES, |_| true) == Some(tile(new))
        });
        prop_assert!(sent);
    }
}
