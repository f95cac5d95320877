use std::collections::HashMap;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::rng::Rng;
use crate::sight::look;

type Small = Map<12, 12>;

const VISITED: [Level; 3] = [Level::Visited, Level::FreeAgain, Level::FreeForGood];

const EXTENT: Extent = Extent::new(90, 90);

fn map() -> Small {
    Small::new(EXTENT).unwrap()
}

/// The obviously correct evidence: a number a cell.
#[derive(Default)]
struct Naive {
    levels: HashMap<(i16, i16), Level>,
    counts: HashMap<(i16, i16), i8>,
    voted_from: Option<Cell>,
    has_voted: bool,
}

impl Naive {
    fn level(&self, cell: Cell) -> Level {
        self.levels
            .get(&(cell.x, cell.y))
            .copied()
            .unwrap_or_default()
    }

    fn observe(&mut self, sighting: &Sighting, model: &SensorModel, purpose: Purpose, barren: u8) {
        let centre = sighting.centre();
        let corner = |at: i16| ((at + 4) >> 3) * 8 - 16;
        let (west, north) = (corner(centre.x), corner(centre.y));
        let holds =
            |(x, y): (i16, i16)| (west..west + 32).contains(&x) && (north..north + 32).contains(&y);
        self.counts.retain(|&at, _| holds(at));
        let votes_on_all = model.votes == Votes::PerLook || self.voted_from != Some(centre);
        let votes = votes_on_all || purpose != Purpose::None && !self.has_voted;
        let flips = votes && !self.has_voted;
        if votes {
            self.voted_from = Some(centre);
            self.has_voted = true;
        }
        let margin = model.margin.clamp(1, 3).saturating_sub(barren / 8).max(1) as i8;
        let own = self.level(centre);
        let own = match own {
            Level::Wall => Level::FreeAgain,
            Level::WallAgain => Level::FreeForGood,
            own => own.max(Level::Visited),
        };
        self.levels.insert((centre.x, centre.y), own);
        self.counts.insert((centre.x, centre.y), -3);
        let free = sighting.free_cells().map(|cell| (cell, false));
        let blocked = sighting.blocked_cells().map(|cell| (cell, true));
        for (cell, is_blocked) in free
            .chain(blocked)
            .filter(|(cell, _)| EXTENT.contains(*cell))
        {
            let at = (cell.x, cell.y);
            let level = self.level(cell);
            let is_near = |range: u8| cell.chebyshev(centre) <= u16::from(range);
            let is_known = level >= Level::Free;
            let is_wall = matches!(level, Level::Wall | Level::WallAgain);
            let flip_range = match level {
                _ if is_wall == is_blocked && is_near(model.sure_range) => u8::MAX,
                level if VISITED.contains(&level) => model.visited_range,
                _ => model.flip_range,
            };
            let is_asked = match purpose {
                Purpose::None => false,
                Purpose::Sides(sides) => Direction::ALL
                    .iter()
                    .any(|side| sides >> *side as u8 & 1 == 1 && centre.step(*side) == cell),
                Purpose::Within(range) => is_near(range),
                Purpose::Walls => is_wall && !is_blocked,
            };
            let may_vote = level == Level::Unknown
                || (level == Level::Doubtful && votes || is_known && flips && is_near(flip_range))
                    && (votes_on_all || is_asked);
            let mut count = self.counts.get(&at).copied().unwrap_or(0);
            let counts = may_vote && (!is_blocked || is_known || is_near(model.sure_range));
            if counts {
                count = (count + if is_blocked { 1 } else { -1 }).clamp(-3, 3);
                if holds(at) {
                    self.counts.insert(at, count);
                }
            }
            let after = match (level, is_blocked) {
                (Level::Unknown | Level::Doubtful | Level::Free | Level::Visited, true)
                    if counts && count >= margin =>
                {
                    Level::Wall
                }
                (Level::Unknown, true) => Level::Doubtful,
                (Level::Unknown, false) => Level::Free,
                (Level::Doubtful, false) if count <= 0 => Level::Free,
                (Level::FreeAgain, true) if counts && count >= margin => Level::WallAgain,
                (Level::Wall, false) if counts && count <= -margin => Level::FreeAgain,
                (Level::WallAgain, false) if counts && count <= -margin => Level::FreeForGood,
                (level, _) => level,
            };
            self.levels.insert(at, after);
        }
    }
}

fn model() -> impl Strategy<Value = SensorModel> {
    let votes = prop_oneof![Just(Votes::PerLook), Just(Votes::PerPlace)];
    (0..5u8, votes, [0..=15u8, 0..=15, 0..=15]).prop_map(
        |(margin, votes, [sure_range, flip_range, visited_range])| SensorModel {
            margin,
            votes,
            sure_range,
            flip_range,
            visited_range,
            sees_robots: false,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: ProptestConfig::default().cases.min(64),
        ..ProptestConfig::default()
    })]

    /// Counters by words in a window that moves are a number a cell, for any walk with
    /// jumps, and whatever is seen.
    #[test]
    fn evidence_is_that_of_a_number_a_cell(
        model in model(),
        from in (0i16..90, 0i16..90),
        steps in proptest::collection::vec((-2i16..=2, -2i16..=2, 0u8..20, (any::<bool>(), 0u8..40)), 1..40),
        radius in 1u8..=15,
        seed in any::<u64>(),
    ) {
        let mut dice = Rng::new(seed, 0);
        let (mut map, mut evidence, mut naive) = (map(), Evidence::new(), Naive::default());
        let (mut x, mut y) = from;
        for (dx, dy, jump, (ticks, purpose)) in steps {
            let purpose = match purpose {
                0..16 => Purpose::Sides(purpose),
                16..20 => Purpose::Walls,
                20..24 => Purpose::Within(purpose - 20),
                _ => Purpose::None,
            };
            let by = if jump == 0 { 13 } else { 1 };
            (x, y) = ((x + by * dx).clamp(0, 89), (y + by * dy).clamp(0, 89));
            if ticks {
                evidence.tick();
                naive.has_voted = false;
            }
            if jump == 1 {
                evidence.rest();
            }
            let wrong: Vec<bool> = (0..256).map(|_| dice.next_u32() >> 30 == 0).collect();
            let sighting = look(Cell::new(x, y), radius, |cell| {
                !EXTENT.contains(cell)
                    || (cell.x % 7 == 3) != wrong[(cell.x * 31 + cell.y) as usize % 256]
            });
            naive.observe(&sighting, &model, purpose, evidence.barren());
            evidence.observe(&mut map, &sighting, &model, purpose, |_| 0);
            for cell in sighting.free_cells().chain(sighting.blocked_cells()) {
                if EXTENT.contains(cell) {
                    prop_assert_eq!(map.level(cell), naive.level(cell), "{} from {},{}", cell, x, y);
                    let count = naive.counts.get(&(cell.x, cell.y));
                    prop_assert_eq!(evidence.votes(cell), count.copied().unwrap_or(0));
                }
            }
        }
    }

    /// A truthful sensor is taken at its word.
    #[test]
    fn truthful_looks_are_taken_as_they_are(
        walls in proptest::collection::vec(any::<bool>(), 64),
        looks in proptest::collection::vec((0i16..90, 0i16..90, 1u8..=15), 1..12),
    ) {
        let blocked = |cell: Cell| {
            !EXTENT.contains(cell) || walls[(cell.x * 13 + cell.y * 7) as usize % 64]
        };
        let (mut weighed, mut taken, mut evidence) = (map(), map(), Evidence::new());
        for (x, y, radius) in looks {
            let cell = Cell::new(x, y);
            if blocked(cell) {
                continue;
            }
            evidence.tick();
            let sighting = look(cell, radius, blocked);
            evidence.observe(&mut weighed, &sighting, &SensorModel::truthful(), Purpose::None, |_| 0);
            taken.observe(&sighting);
            taken.stand(cell);
        }
        weighed.take_changed();
        taken.take_changed();
        prop_assert!(weighed == taken);
    }
}

fn seen(evidence: &mut Evidence, map: &mut Small, from: Cell, cell: Cell, blocked: bool) -> Level {
    let mut sighting = Sighting::new(from);
    if blocked {
        sighting.see_blocked(cell);
    } else {
        sighting.see_free(cell);
    }
    evidence.tick();
    evidence.observe(
        map,
        &sighting,
        &SensorModel::rangers(),
        Purpose::None,
        |_| 0,
    );
    map.level(cell)
}

#[test]
fn rangers_believe_a_wall_from_three_places_and_refute_one_that_was_told() {
    let (mut map, mut evidence) = (map(), Evidence::new());
    let wall = Cell::new(22, 20);
    let from = |x| Cell::new(20, x);
    let mut look_at = |y, blocked| seen(&mut evidence, &mut map, from(y), wall, blocked);
    assert_eq!(look_at(20, true), Level::Doubtful);
    assert_eq!(look_at(20, true), Level::Doubtful, "the same place");
    assert_eq!(look_at(19, true), Level::Doubtful);
    assert_eq!(look_at(20, true), Level::Wall);

    let told = Cell::new(30, 30);
    let (at, bit) = TileIndex::of(told).unwrap();
    map.join_tile(at, crate::map::Tile::seen(0, bit));
    let mut look_at = |x, y| seen(&mut evidence, &mut map, Cell::new(x, y), told, false);
    assert_eq!(look_at(28, 30), Level::Wall);
    assert_eq!(look_at(27, 30), Level::Wall, "from afar");
    assert_eq!(look_at(28, 29), Level::Wall);
    assert_eq!(look_at(28, 31), Level::FreeAgain);
}

/// Who stands still to look sees the same error again: only what it asks for counts.
#[test]
fn a_robot_that_stands_still_votes_on_what_it_stands_there_for() {
    let (mut map, mut evidence) = (map(), Evidence::new());
    let (east, north) = (Cell::new(21, 20), Cell::new(20, 19));
    let mut sighting = Sighting::new(Cell::new(20, 20));
    sighting.see_blocked(east);
    sighting.see_blocked(north);
    for _ in 0..3 {
        evidence.tick();
        let purpose = Purpose::Sides(1 << Direction::East as u8);
        evidence.observe(&mut map, &sighting, &SensorModel::rangers(), purpose, |_| 0);
    }
    assert_eq!(map.level(east), Level::Wall);
    assert_eq!(map.level(north), Level::Doubtful);
}

#[test]
fn what_is_blocked_from_afar_is_doubtful_and_free_at_the_first_look_from_near() {
    let (mut map, mut evidence) = (map(), Evidence::new());
    let cell = Cell::new(30, 20);
    for x in 18..25 {
        assert_eq!(
            seen(&mut evidence, &mut map, Cell::new(x, 20), cell, true),
            Level::Doubtful
        );
    }
    assert!(map.is_doubtful(cell) && !map.is_known(cell));
    assert_eq!(
        seen(&mut evidence, &mut map, Cell::new(27, 20), cell, false),
        Level::Free
    );
}

#[test]
fn barren_looks_decide_by_one_vote_at_last() {
    let (mut map, mut evidence) = (map(), Evidence::new());
    let cell = Cell::new(21, 20);
    assert_eq!(
        seen(&mut evidence, &mut map, Cell::new(20, 20), cell, true),
        Level::Doubtful
    );
    for _ in 0..SensorModel::rangers().barren_looks() {
        evidence.rest();
    }
    assert_eq!(
        seen(&mut evidence, &mut map, Cell::new(20, 21), cell, true),
        Level::Wall
    );
    evidence.renew();
    assert_eq!(evidence.barren(), 0);
}

/// The formula of the model's documentation, by drawing: of cells that are looked at until
/// they are decided, few are decided wrongly.
#[test]
fn wrong_decisions_are_as_rare_as_the_margin_says() {
    let mut dice = Rng::new(7, 0);
    for (percent, margin, most) in [(5u32, 2u8, 2.8e-3), (5, 3, 1.5e-4), (20, 3, 1.6e-2)] {
        let cells = 100_000;
        let wrong = (0..cells)
            .filter(|_| {
                let mut counts = Counts::NONE;
                // A free cell, first seen blocked or not.
                loop {
                    match dice.next_u32() % 100 < percent {
                        true => counts.raise(1),
                        false => counts.lower(1),
                    }
                    if counts.at_least(margin) == 1 {
                        return true;
                    }
                    if counts.at_most(margin) == 1 {
                        return false;
                    }
                }
            })
            .count();
        let share = wrong as f64 / f64::from(cells);
        assert!(share <= 2.0 * most, "{percent} %, margin {margin}: {share}");
    }
}

/// A robot that walks along walls and believes itself somewhere else is lost before long;
/// one whose looks are wrong at one cell in ten is not.
#[test]
fn looks_that_contradict_the_map_for_long_are_told() {
    let is_wall = |cell: Cell| !EXTENT.contains(cell) || cell.x % 8 == 3 && cell.y % 8 > 1;
    for (noise, drift, is_lost) in [(0, 0, false), (10, 0, false), (0, 7, true)] {
        let mut dice = Rng::new(3, 0);
        let (mut map, mut evidence) = (map(), Evidence::new());
        for round in 0..3 {
            for x in 5..80i16 {
                // Walls stand where they are; the robot believes to be somewhere else.
                let off = match (round, drift) {
                    (0, _) | (_, 0) => 0,
                    (_, drift) => (dice.next_u32() % drift) as i16,
                };
                let at = Cell::new(x, 16);
                let wrong: Vec<bool> = (0..256).map(|_| dice.next_u32() % 100 < noise).collect();
                let seen = look(at, 6, |cell| {
                    let is_wrong = wrong[(cell.x * 31 + cell.y * 17) as usize % 256];
                    is_wall(Cell::new(cell.x + off, cell.y)) != (is_wrong && cell != at)
                });
                evidence.tick();
                evidence.observe(&mut map, &seen, &SensorModel::lidar(), Purpose::None, |_| 0);
                assert!(is_lost || !evidence.is_lost(), "{noise} %, at {x}");
                if is_lost && evidence.is_lost() {
                    return;
                }
            }
        }
        assert!(!is_lost, "it does not notice");
    }
}
