//! The cells of a view as pixels, one each.

use egui::{Color32, ColorImage};
use host_sim::record::grid::Record;
use host_sim::run::Stepping;
use planner_core::map::Level;
use planner_core::tile::TileIndex;
use planner_core::{Cell, Direction, Extent};

use crate::colors::{Colors, mix};
use crate::playback::Playback;
use crate::watch::Watch;

/// What a view shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The real world; what nobody has seen is pale.
    World,
    /// What all robots together have seen.
    Team,
    /// What one robot knows.
    Robot(usize),
}

/// What is drawn into a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Ways of the robots, so many ticks back; 0: none.
    pub trail: u32,
    /// Where robots are going.
    pub goals: bool,
    /// The steps to which they are committed.
    pub plans: bool,
    /// Free cells beside the unknown.
    pub frontiers: bool,
    /// Which robot is nearest to each cell, in steps.
    pub owners: bool,
    /// Cells on which a robot has stood.
    pub visited: bool,
    /// How far the selected robot's search over the whole map has got.
    pub search: bool,
    /// What the votes of the selected robot's looks say: ink for walls, blue for free
    /// cells, the stronger the more.
    pub votes: bool,
    /// What was heard, lost or under way in the last tick.
    pub radio: bool,
}

/// A trail without an end.
pub const ALL_TICKS: u32 = 10_000;

impl Default for Layers {
    fn default() -> Self {
        Self {
            trail: ALL_TICKS,
            goals: true,
            plans: true,
            frontiers: true,
            owners: false,
            visited: false,
            search: true,
            votes: false,
            radio: false,
        }
    }
}

/// What is known of a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    Unknown,
    Free,
    Obstacle,
    Doubtful,
    /// Free, and taken for an obstacle before.
    FreeAgain,
}

/// Every cell of the watched world in its colour, as `subject` has it.
pub fn image(watch: &Watch, subject: Subject, layers: &Layers, colors: &Colors) -> ColorImage {
    let extent = watch.scenario().world.extent();
    let state = watch.state();
    let known = match (subject, state) {
        (Subject::Robot(robot), Some(state)) => of_robot(state, robot, extent),
        _ => cells(extent).map(|cell| of_team(watch, cell)).collect(),
    };
    let width = usize::from(extent.width);
    let at = |cell: Cell| known[cell.y as usize * width + cell.x as usize];
    let pixel = |cell| pixel(watch, subject, layers, colors, at, cell);
    let mut pixels: Vec<_> = cells(extent).map(pixel).collect();
    let free = |cell: Cell| matches!(at(cell), Known::Free | Known::FreeAgain);
    if layers.owners && subject != Subject::World {
        for (pixel, owner) in pixels.iter_mut().zip(owners(watch, free)) {
            if let Some(owner) = owner.filter(|_| *pixel != colors.frontier) {
                *pixel = mix(*pixel, colors.robot(owner.into()), 0.3);
            }
        }
    }
    if let (Subject::Robot(robot), Some(state), true) = (subject, state, layers.search) {
        for (tile, cells) in tiles(extent).map(|tile| (tile, state.searched(robot, tile))) {
            for cell in planner_core::tile::bits(cells).map(|bit| tile.cell(bit)) {
                if extent.contains(cell) {
                    let pixel = &mut pixels[cell.y as usize * width + cell.x as usize];
                    *pixel = mix(*pixel, colors.searched, 0.6);
                }
            }
        }
    }
    if let (Subject::Robot(robot), Some(state), true) = (subject, state, layers.votes) {
        for (pixel, cell) in pixels.iter_mut().zip(cells(extent)) {
            let votes = state.votes(robot, cell);
            let color = match votes > 0 {
                true => colors.ink,
                false => colors.changed,
            };
            *pixel = mix(*pixel, color, f32::from(votes.abs()) / 4.0);
        }
    }
    ColorImage::new([width, extent.height.into()], pixels)
}

/// Brings a picture of [`image()`] from an earlier tick to the shown one, where that takes
/// only the cells that were seen or visited since; false if it takes more.
pub fn update(
    image: &mut ColorImage,
    since: u32,
    watch: &Watch,
    subject: Subject,
    layers: &Layers,
    colors: &Colors,
) -> bool {
    let shown = watch.shown();
    // Who is nearest, and what one robot hears, changes cells anywhere.
    if shown < since || matches!(subject, Subject::Robot(_)) || layers.owners {
        return false;
    }
    let extent = watch.scenario().world.extent();
    let at = |cell| of_team(watch, cell);
    let mut renew = |cell: Cell| {
        let index = cell.y as usize * image.size[0] + cell.x as usize;
        image.pixels[index] = pixel(watch, subject, layers, colors, at, cell);
    };
    for &cell in watch.news(since..shown) {
        renew(cell);
        // What was a frontier may be none any more.
        let beside = Direction::ALL.map(|way| cell.step(way));
        let beside = beside.into_iter().filter(|&cell| extent.contains(cell));
        beside.for_each(&mut renew);
    }
    for record in (since..shown).flat_map(|tick| watch.records_of(tick)) {
        renew(record.at);
    }
    true
}

/// A cell in its colour, given what is known; what a robot believes wrongly is reddish.
fn pixel(
    watch: &Watch,
    subject: Subject,
    layers: &Layers,
    colors: &Colors,
    known: impl Fn(Cell) -> Known,
    cell: Cell,
) -> Color32 {
    let world = &watch.scenario().world;
    let is_frontier = || {
        let is_open = |next| matches!(known(next), Known::Unknown | Known::Doubtful);
        let beside = |next: Cell| world.extent().contains(next) && is_open(next);
        Direction::ALL.iter().any(|&way| beside(cell.step(way)))
    };
    let mistaken = |believed| mix(believed, colors.lost, 0.5);
    match (known(cell), subject) {
        (Known::Free, Subject::Robot(_)) if !world.is_free(cell) => mistaken(colors.free),
        (Known::Obstacle, Subject::Robot(_)) if world.is_free(cell) => mistaken(colors.obstacle),
        (Known::Free, Subject::World) => colors.free,
        (Known::Free, _) if layers.frontiers && is_frontier() => colors.frontier,
        (Known::Free, _) if layers.visited && watch.is_visited(cell) => colors.visited,
        (Known::Free, _) => colors.free,
        (Known::Obstacle, _) => colors.obstacle,
        (Known::Doubtful, _) => colors.doubtful,
        (Known::FreeAgain, _) => colors.changed,
        (Known::Unknown, Subject::World) if !world.is_free(cell) => colors.hidden,
        (Known::Unknown, Subject::World) if watch.reachable().contains(cell) => colors.unseen,
        (Known::Unknown, _) => colors.unknown,
    }
}

/// What all robots together know of a cell.
fn of_team(watch: &Watch, cell: Cell) -> Known {
    match (watch.is_seen(cell), watch.scenario().world.is_free(cell)) {
        (false, _) => Known::Unknown,
        (true, true) => Known::Free,
        (true, false) => Known::Obstacle,
    }
}

fn of_robot(state: &dyn Stepping, robot: usize, extent: Extent) -> Vec<Known> {
    let width = usize::from(extent.width);
    let mut known = vec![Known::Unknown; extent.cells() as usize];
    for at in tiles(extent) {
        let tile = state.tile(robot, at);
        let again = tile.at(Level::FreeAgain) | tile.at(Level::FreeForGood);
        let kinds = [
            (tile.doubtful(), Known::Doubtful),
            (tile.free(), Known::Free),
            (tile.obstacle(), Known::Obstacle),
            (again, Known::FreeAgain),
        ];
        for (cells, kind) in kinds {
            for cell in planner_core::tile::bits(cells).map(|bit| at.cell(bit)) {
                if extent.contains(cell) {
                    known[cell.y as usize * width + cell.x as usize] = kind;
                }
            }
        }
    }
    known
}

/// For each free cell the robot from which it can be reached in the fewest steps; of
/// equals the lowest.
fn owners(watch: &Watch, free: impl Fn(Cell) -> bool) -> Vec<Option<u8>> {
    let extent = watch.scenario().world.extent();
    let index = |cell: Cell| cell.y as usize * usize::from(extent.width) + cell.x as usize;
    let mut owners = vec![None; extent.cells() as usize];
    let mut wave = Vec::new();
    for (cell, robot) in watch.positions().into_iter().zip(0..) {
        if owners[index(cell)].is_none() {
            owners[index(cell)] = Some(robot);
            wave.push(cell);
        }
    }
    let mut next = 0;
    while let Some(&cell) = wave.get(next) {
        next += 1;
        for step in Direction::ALL.map(|way| cell.step(way)) {
            if extent.contains(step) && free(step) && owners[index(step)].is_none() {
                owners[index(step)] = owners[index(cell)];
                wave.push(step);
            }
        }
    }
    owners
}

fn tiles(extent: Extent) -> impl Iterator<Item = TileIndex> {
    let (columns, rows) = (extent.width.div_ceil(8), extent.height.div_ceil(8));
    (0..rows).flat_map(move |y| (0..columns).map(move |x| TileIndex::new(x as u8, y as u8)))
}

/// All cells, row by row.
pub(crate) fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    let row = move |y| (0..extent.width as i16).map(move |x| Cell::new(x, y));
    (0..extent.height as i16).flat_map(row)
}

/// The way of each robot as corners, over the last `trail` ticks before the shown one.
pub(crate) fn ways(watch: &Watch, trail: u32) -> Vec<Vec<Cell>> {
    let robots = watch.scenario().starts.len();
    let mut ways: Vec<Vec<Cell>> = vec![Vec::new(); robots];
    for record in trail_records(watch, trail) {
        let Some(way) = ways.get_mut(usize::from(record.robot)) else {
            continue;
        };
        if way.is_empty() {
            way.push(record.at);
        }
        let cell = record.after();
        if way.last() == Some(&cell) {
            continue;
        }
        extend(way, cell);
    }
    ways
}

/// Adds a cell to a way of corners.
pub(crate) fn extend(way: &mut Vec<Cell>, cell: Cell) {
    if let [.., a, b] = way[..]
        && (b.x - a.x).signum() == (cell.x - b.x).signum()
        && (b.y - a.y).signum() == (cell.y - b.y).signum()
    {
        way.pop();
    }
    way.push(cell);
}

/// What happened in the last `trail` ticks before the shown one.
pub(crate) fn trail_records(watch: &Watch, trail: u32) -> &[Record] {
    let begin = match trail {
        ALL_TICKS.. => 0,
        ticks => watch.shown().saturating_sub(ticks),
    };
    let records = watch.records();
    &records[records.partition_point(|record| record.tick < begin)..]
}

/// A pixel image as bytes, three a pixel.
pub(crate) fn rgb(pixels: &[Color32]) -> impl Iterator<Item = u8> + '_ {
    pixels
        .iter()
        .flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::Setup;

    #[test]
    fn votes_are_drawn_where_the_looks_of_the_robot_were() {
        let setup = Setup::from_address("map=generate:rooms:64x64:3&robots=1&preset=rangers");
        let mut watch = Watch::new(setup.unwrap().scenario().unwrap()).unwrap();
        (0..20).for_each(|_| _ = watch.tick());
        let drawn = |votes| {
            let layers = Layers {
                votes,
                ..Layers::default()
            };
            image(&watch, Subject::Robot(0), &layers, &Colors::LIGHT)
        };
        let (with, without) = (drawn(true), drawn(false));
        let at = watch.positions()[0];
        let mut near = 0;
        for ((with, without), cell) in with
            .pixels
            .iter()
            .zip(&without.pixels)
            .zip(cells(watch.scenario().world.extent()))
        {
            let has_vote = watch.state().unwrap().votes(0, cell) != 0;
            assert_eq!(with != without, has_vote, "{cell}");
            assert!(!has_vote || cell.chebyshev(at) < 32);
            near += u32::from(has_vote);
        }
        assert!(near > 20, "{near}");
    }

    #[test]
    fn a_picture_kept_from_tick_to_tick_is_the_picture() {
        let setup = Setup::from_address("map=generate:rooms:32x24:3&robots=3&kill=1@30").unwrap();
        let mut watch = Watch::new(setup.scenario().unwrap()).unwrap();
        let (layers, colors) = (
            Layers {
                visited: true,
                ..Layers::default()
            },
            &Colors::LIGHT,
        );
        for subject in [Subject::World, Subject::Team] {
            watch.show(0);
            let mut kept = image(&watch, subject, &layers, colors);
            for ticks in [1, 1, 5, 20, 60] {
                let since = watch.shown();
                for _ in 0..ticks {
                    watch.tick();
                }
                assert!(update(&mut kept, since, &watch, subject, &layers, colors));
                let anew = image(&watch, subject, &layers, colors);
                assert!(kept.pixels == anew.pixels, "{subject:?} in tick {since}");
            }
            let since = watch.shown();
            watch.show(since - 1);
            assert!(!update(&mut kept, since, &watch, subject, &layers, colors));
        }
    }
}
