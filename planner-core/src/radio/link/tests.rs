use super::*;
use crate::cell::Cell;
use crate::map::Tile;
use crate::robot::Activity;
use crate::tile::TileIndex;

const EXTENT: Extent = Extent::new(29, 19);
const STATUS: Status = Status {
    position: Cell::new(3, 4),
    goal: None,
    activity: Activity::Exploring,
};

type Small = Link<4>;

fn link(id: u8, config: LinkConfig) -> Small {
    let mut link = Small::vacant();
    link.reset(config, RobotId(id), EXTENT);
    link
}

fn map() -> Map<4, 4> {
    Map::new(EXTENT).unwrap()
}

/// A map of which something is known.
fn explored() -> Map<4, 4> {
    let mut map = map();
    for at in [TileIndex::new(0, 0), TileIndex::new(3, 2)] {
        let known = 0x0000_3c3c_3c3c_0f0f;
        map.join_tile(at, Tile::seen(known, 0));
    }
    map
}

/// The next frame of a robot whose budget grows until it may send one.
fn next_frame(link: &mut Small, map: &Map<4, 4>) -> std::vec::Vec<u8> {
    let mut buffer = [0; MAX_LEN];
    loop {
        if let Some(length) = link.transmit(map, STATUS, &mut buffer) {
            return buffer[..length].to_vec();
        }
        link.tick();
    }
}

#[test]
fn the_grid_id_hashes_size_origin_and_resolution() {
    let id = GridId::of(Extent::new(64, 48), (0, -1500), 100);
    assert_eq!(id, GridId(0x93bb));
    assert_ne!(id, GridId::of(Extent::new(48, 64), (0, -1500), 100));
    assert_ne!(id, GridId::of(Extent::new(64, 48), (-1500, 0), 100));
    assert_ne!(id, GridId::of(Extent::new(64, 48), (0, -1500), 50));
}

#[test]
fn a_frame_brings_tiles_and_status_once() {
    let (mut sender, mut receiver) = (link(1, LinkConfig::new()), link(2, LinkConfig::new()));
    let mut heard_by = map();
    let mut told = explored();
    sender.announce(&mut told);
    let frame = next_frame(&mut sender, &told);
    let heard = receiver.receive(&frame, &mut heard_by).unwrap();
    assert_eq!(heard.from, RobotId(1));
    assert_eq!(heard.status, Some(STATUS));
    assert_eq!(heard.learnt.cells, told.known_cells());
    // Late, repeated or replayed: tiles still join, the status is old.
    let again = receiver.receive(&frame, &mut heard_by).unwrap();
    assert_eq!(again.status, None);
    assert!(!again.learnt.anything());
}

#[test]
fn an_error_changes_nothing() {
    let mut sender = link(1, LinkConfig::new());
    let mut told = explored();
    sender.announce(&mut told);
    let frame = next_frame(&mut sender, &told);
    let elsewhere = LinkConfig {
        origin_mm: (1, 0),
        ..LinkConfig::new()
    };
    for (mut receiver, error) in [
        (sender.clone(), FrameError::Own),
        (link(1, LinkConfig::new()), FrameError::SameId(RobotId(1))),
        (
            link(2, elsewhere),
            FrameError::OtherGrid(sender.sender.grid),
        ),
    ] {
        let (mut before, mut heard_by) = (receiver.clone(), map());
        assert_eq!(receiver.receive(&frame, &mut heard_by), Err(error));
        // But for the counters.
        before.sender.hearsay = receiver.sender.hearsay;
        assert_eq!(receiver, before);
        assert!(heard_by == map());
    }
}

#[test]
fn an_echo_is_told_from_a_robot_of_the_same_id() {
    let (mut robot, mut twin) = (link(1, LinkConfig::new()), link(1, LinkConfig::new()));
    let frames: std::vec::Vec<_> = (0..20)
        .map(|_| next_frame(&mut robot, &explored()))
        .collect();
    let same_id = Err(FrameError::SameId(RobotId(1)));
    for (age, frame) in (1..).zip(frames.iter().rev()) {
        let echo = robot.receive(frame, &mut map());
        assert_eq!(
            echo == Err(FrameError::Own),
            age <= ECHOES,
            "{age}: {echo:?}"
        );
    }
    // The twin is behind, so each notices the other; with the same numbers too, as soon
    // as they have different things to say.
    assert_eq!(twin.receive(&frames[0], &mut map()), same_id);
    for frame in &frames {
        let other = next_frame(&mut twin, &map());
        assert_eq!(twin.receive(frame, &mut map()), same_id);
        assert_eq!(robot.receive(&other, &mut map()), same_id);
    }
    assert_eq!(twin.hearsay().same_id, 21);
    assert!(std::format!("{}", FrameError::SameId(RobotId(1))).contains("id 1"));
}

#[test]
fn a_number_far_ahead_is_no_news_and_silences_nobody() {
    let (mut sender, mut receiver) = (link(1, LinkConfig::new()), link(2, LinkConfig::new()));
    let is_news = |receiver: &mut Small, sender: &mut Small| {
        let frame = next_frame(sender, &map());
        let heard = receiver.receive(&frame, &mut map()).unwrap();
        heard.status.is_some()
    };
    assert!(is_news(&mut receiver, &mut sender));
    for ahead in [100, 1000, 30_000, 40_000] {
        let mut forger = link(1, LinkConfig::new());
        forger.sender.sequence = sender.sender.sequence.wrapping_add(ahead);
        assert!(!is_news(&mut receiver, &mut forger), "{ahead}");
        assert!(is_news(&mut receiver, &mut sender), "{ahead}");
    }
    // Who has sent unheard for a while is believed all the same, under any budget.
    for bytes_per_tick in [55, 550, 5500] {
        let config = LinkConfig {
            bytes_per_tick,
            ..LinkConfig::new()
        };
        let (mut sender, mut receiver) = (link(1, config), link(2, config));
        assert!(is_news(&mut receiver, &mut sender));
        // Miri is a thousand times slower.
        let silences: &[u16] = if cfg!(miri) { &[1] } else { &[1, 10, 100, 255] };
        for &ticks in silences {
            let mut sent = 0u32;
            for _ in 0..ticks {
                receiver.tick();
                sender.tick();
                let mut buffer = [0; MAX_LEN];
                while sender.transmit(&map(), STATUS, &mut buffer).is_some() {
                    sent += 1;
                }
            }
            if sent > i16::MAX as u32 - 1000 {
                // Half of all numbers went by: nobody can tell late from new.
                break;
            }
            sender.tick();
            assert!(
                is_news(&mut receiver, &mut sender),
                "{bytes_per_tick} {ticks}"
            );
        }
    }
}

#[test]
fn what_others_told_first_and_what_speaks_against_it_is_counted() {
    use crate::sight::look;
    let mut receiver = link(2, LinkConfig::new());
    let mut heard_by = map();
    // It stands at 4,4 beside a wall in column 6.
    let here = Cell::new(4, 4);
    let sighting = look(here, 3, |cell| cell.x == 6);
    heard_by.observe(&sighting);
    heard_by.stand(here);
    let (at, _) = TileIndex::of(here).unwrap();
    receiver.look(&sighting, at, 0);
    let say =
        |receiver: &mut Small, heard_by: &mut Map<4, 4>, id, free: &[Cell], walls: &[Cell]| {
            let mut told = map();
            for (cells, obstacle) in [(free, false), (walls, true)] {
                for &cell in cells {
                    let (at, bit) = TileIndex::of(cell).unwrap();
                    told.join_tile(at, Tile::seen(bit, if obstacle { bit } else { 0 }));
                }
            }
            let mut sender = link(id, LinkConfig::new());
            sender.announce(&mut told);
            receiver
                .receive(&next_frame(&mut sender, &told), heard_by)
                .unwrap();
        };
    let cell = Cell::new;
    // The truth, and something new.
    say(
        &mut receiver,
        &mut heard_by,
        3,
        &[here, cell(20, 4)],
        &[cell(6, 4)],
    );
    let hearsay = receiver.hearsay();
    assert_eq!((hearsay.cells, hearsay.contradictions), (1, 0));
    // The axes of robot 4 are turned: one wall where there is none, and the other way
    // round. Robot 5 once saw a wall that is not there.
    say(
        &mut receiver,
        &mut heard_by,
        4,
        &[cell(6, 5)],
        &[cell(5, 5), cell(4, 5)],
    );
    say(&mut receiver, &mut heard_by, 5, &[], &[here]);
    let hearsay = receiver.hearsay();
    assert_eq!(hearsay.contradictions, 4);
    assert_eq!(hearsay.contradicted_by, Some(RobotId(4)));
    // What it saw in column 6 there was another robot.
    let (_, body) = TileIndex::of(cell(6, 5)).unwrap();
    receiver.look(&sighting, at, body);
    say(&mut receiver, &mut heard_by, 4, &[cell(6, 5)], &[]);
    assert_eq!(receiver.hearsay().contradictions, 4);
    receiver.joined(Learnt {
        cells: 7,
        closed: 0,
        ..Learnt::default()
    });
    assert_eq!(receiver.hearsay().cells, 8);
}

#[test]
fn sequence_numbers_wrap_around() {
    let (mut sender, mut receiver) = (link(1, LinkConfig::new()), link(2, LinkConfig::new()));
    sender.sender.sequence = u16::MAX - 1;
    let mut heard_by = map();
    let frames: std::vec::Vec<_> = (0..4).map(|_| next_frame(&mut sender, &map())).collect();
    for frame in &frames {
        let heard = receiver.receive(frame, &mut heard_by).unwrap();
        assert_eq!(heard.status, Some(STATUS));
    }
    for frame in &frames {
        let heard = receiver.receive(frame, &mut heard_by).unwrap();
        assert_eq!(heard.status, None);
    }
}

#[test]
fn a_sender_that_starts_anew_is_believed_after_a_silence_of_its_old_numbers() {
    let (mut old, mut receiver) = (link(1, LinkConfig::new()), link(2, LinkConfig::new()));
    old.sender.sequence = 1000;
    receiver
        .receive(&next_frame(&mut old, &map()), &mut map())
        .unwrap();
    let mut new = link(1, LinkConfig::new());
    let is_believed = |receiver: &mut Small, new: &mut Small| {
        let frame = next_frame(new, &map());
        receiver
            .receive(&frame, &mut map())
            .unwrap()
            .status
            .is_some()
    };
    assert!(!is_believed(&mut receiver, &mut new));
    for _ in 0..=SILENCE {
        receiver.tick();
    }
    assert!(is_believed(&mut receiver, &mut new));
    assert!(is_believed(&mut receiver, &mut new));
}

#[test]
fn of_more_senders_than_are_remembered_the_oldest_is_forgotten() {
    let mut receiver = link(255, LinkConfig::new());
    for id in 0..=SENDERS as u8 {
        let frame = next_frame(&mut link(id, LinkConfig::new()), &map());
        receiver.receive(&frame, &mut map()).unwrap();
        receiver.tick();
    }
    let senders: std::vec::Vec<_> = receiver.latest.iter().map(|of| of.sender.0).collect();
    assert_eq!(senders.len(), SENDERS);
    assert!(!senders.contains(&0) && senders.contains(&(SENDERS as u8)));
}

#[test]
fn the_budget_is_kept_on_average() {
    for bytes_per_tick in [0, 1, 7, 54, 55, 56, 200] {
        let config = LinkConfig {
            bytes_per_tick,
            ..LinkConfig::new()
        };
        let mut sender = link(1, config);
        let mut told = explored();
        let mut sent = 0;
        for tick in 1..=60u32 {
            sender.announce(&mut told);
            let mut buffer = [0; MAX_LEN];
            while let Some(length) = sender.transmit(&told, STATUS, &mut buffer) {
                sent += length as u32;
            }
            assert!(
                sent <= tick * u32::from(bytes_per_tick),
                "{bytes_per_tick} in {tick}"
            );
            sender.tick();
        }
        assert_eq!(sent == 0, bytes_per_tick == 0, "{bytes_per_tick}");
    }
}

#[test]
fn a_silent_robot_saves_up_one_frame_only() {
    let config = LinkConfig {
        bytes_per_tick: 10,
        ..LinkConfig::new()
    };
    let mut sender = link(1, config);
    for _ in 0..1000 {
        sender.tick();
    }
    let mut buffer = [0; MAX_LEN];
    assert!(sender.transmit(&explored(), STATUS, &mut buffer).is_some());
    assert!(sender.transmit(&explored(), STATUS, &mut buffer).is_none());
}

#[cfg(feature = "keyed")]
#[test]
fn a_replayed_signed_frame_says_nothing_new() {
    let config = LinkConfig {
        key: Some(Key([3; 16])),
        ..LinkConfig::new()
    };
    let (mut sender, mut receiver) = (link(1, config), link(2, config));
    let frame = next_frame(&mut sender, &explored());
    let mut heard_by = map();
    assert!(
        receiver
            .receive(&frame, &mut heard_by)
            .unwrap()
            .status
            .is_some()
    );
    let replayed = receiver.receive(&frame, &mut heard_by).unwrap();
    assert_eq!(replayed.status, None);
    let stranger = next_frame(&mut link(1, LinkConfig::new()), &explored());
    assert!(receiver.receive(&stranger, &mut heard_by).is_err());
}

/// Of a crowd the last of those unheard for longest is forgotten, and believed again.
#[test]
fn of_a_crowd_the_oldest_is_forgotten() {
    let mut link = link(0, LinkConfig::new());
    let senders = 1..=SENDERS as u8;
    for sender in senders {
        assert!(link.is_news(RobotId(sender), 7));
        assert!(!link.is_news(RobotId(sender), 7));
        if sender == 3 {
            link.tick();
        }
    }
    // Robots 1 to 3 are the oldest.
    assert!(link.is_news(RobotId(100), 7));
    assert!(!link.is_news(RobotId(2), 7));
    assert!(link.is_news(RobotId(3), 7));
    assert!(!link.is_news(RobotId(1), 7));
    assert!(!link.is_news(RobotId(100), 7));
    assert!(link.is_news(RobotId(2), 7));
}
