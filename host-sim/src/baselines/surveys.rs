//! The methods that FCAO is compared with [Renzaglia2019 §5]. Both fly by the same
//! rules as the planners of the core.

use planner_core::radio::LinkConfig;
use planner_core::surface::Surface;
use planner_core::survey::{Knowledge, Limits, Pilot, SetupError};
use planner_core::tile::bits;
use planner_core::{Action, Cell, Extent, Point, RobotId, Stop};

/// After how many times the planners' [`Limits::patience`] a [`Follower`] gives up. The
/// published methods never do.
const GIVE_UP: u16 = 20;

/// Height of flights over ground, as a share of the range.
const CRUISE: f32 = 0.5;

/// Who chooses the frontier that a [`Follower`] flies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guide {
    /// The robot: the closest frontier, chosen anew in every step.
    Closest,
    /// A centre that knows the map and all robots: [`assign`].
    Centre,
}

/// A robot that flies to one frontier after the other.
#[derive(Clone, Debug)]
pub struct Follower<const TW: usize, const TH: usize> {
    knowledge: Knowledge<TW, TH>,
    guide: Guide,
    order: (Option<Cell>, u32),
    /// Where a flight was refused since the last gain.
    refused: Option<Cell>,
}

impl<const TW: usize, const TH: usize> Follower<TW, TH> {
    /// A robot over a surface of `extent` columns.
    pub fn new(
        extent: Extent,
        limits: Limits,
        link: LinkConfig,
        id: RobotId,
        guide: Guide,
    ) -> Result<Self, SetupError> {
        let knowledge = Knowledge::new(extent, limits, link, id)?;
        Ok(Self {
            knowledge,
            guide,
            order: (None, 0),
            refused: None,
        })
    }

    /// The centre's orders, which cost `work` to find.
    pub fn send_to(&mut self, target: Option<Cell>, work: u32) {
        self.order = (target, work);
    }
}

impl<const TW: usize, const TH: usize> Pilot<TW, TH> for Follower<TW, TH> {
    fn knowledge(&self) -> &Knowledge<TW, TH> {
        &self.knowledge
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH> {
        &mut self.knowledge
    }

    fn decide(&mut self) -> Action<Point> {
        let limits = self.knowledge.limits();
        if let Some((_, to)) = self.knowledge.take_refused() {
            self.refused = Some(to.cell());
        } else if self.knowledge.gain() > 0.0 {
            self.refused = None;
        }
        if self.knowledge.idle() >= limits.patience().saturating_mul(GIVE_UP) {
            let frontiers = self.knowledge.surface().frontiers();
            let at = self.knowledge.unseen_place();
            return self.knowledge.stop(match self.refused {
                Some(at) => Stop::Blocked { frontiers, at },
                None => Stop::Unseen { frontiers, at },
            });
        }
        let stuck = self.knowledge.idle() >= limits.patience();
        let (target, work) = if self.guide == Guide::Closest || stuck {
            closest_of_all(&self.knowledge)
        } else {
            self.order
        };
        self.knowledge.set_goal(target);
        self.knowledge.count_work(work);
        // The same liveness guard as the planners have.
        let cruise = if stuck {
            limits.min_altitude + 0.1
        } else {
            limits.cruise(CRUISE)
        };
        target
            .and_then(|target| {
                self.knowledge
                    .step_towards(Point::over(target, 0.0), cruise)
            })
            .map_or(Action::Wait, Action::Move)
    }
}

/// What becomes of robots that are more than there are groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounds {
    /// They hover.
    One,
    /// They are matched with all groups once more.
    Many,
}

impl Rounds {
    fn most(self, robots: usize) -> usize {
        match self {
            Self::One => 1,
            Self::Many => robots,
        }
    }
}

/// The closest frontier of all, and the number of tiles and frontiers looked at, as the
/// published method does it: its work grows with the map.
fn closest_of_all<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
) -> (Option<Cell>, u32) {
    let (here, surface) = (knowledge.position(), knowledge.surface());
    let distance = |cell: &Cell| here.plan_distance(Point::over(*cell, 0.0));
    let cells = surface
        .tiles()
        .flat_map(|tile| bits(surface.frontier_cells(tile)).map(move |bit| tile.cell(bit)));
    let closest = cells.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let tiles = surface.tiles().count() as u32;
    (closest, tiles + surface.frontiers())
}

/// The centralised greedy method: frontiers are grouped by leader clustering of
/// radius `range`, the member nearest to a group's centroid stands for it, and robots
/// and groups are matched by the smallest distance left, in `rounds`. Also returns the number of distances computed.
pub fn assign<const TW: usize, const TH: usize>(
    surface: &Surface<TW, TH>,
    robots: &[Point],
    range: f32,
    rounds: Rounds,
) -> (Vec<Option<Cell>>, u32) {
    let mut work = 0;
    let mut groups: Vec<Vec<Point>> = Vec::new();
    let frontiers = surface
        .tiles()
        .flat_map(|tile| bits(surface.frontier_cells(tile)).map(move |bit| tile.cell(bit)));
    for cell in frontiers {
        let at = Point::over(cell, 0.0);
        let mut leaders = groups.iter_mut();
        let group = leaders.find(|group| {
            work += 1;
            group[0].plan_distance(at) <= range
        });
        match group {
            Some(group) => group.push(at),
            None => groups.push(vec![at]),
        }
    }
    let goals: Vec<Point> = groups
        .iter()
        .map(|group| nearest_to_centroid(group, &mut work))
        .collect();
    let mut targets = vec![None; robots.len()];
    let mut free: Vec<usize> = (0..robots.len()).collect();
    for _ in 0..rounds.most(robots.len()) {
        let mut open: Vec<Point> = goals.clone();
        while !free.is_empty() && !open.is_empty() {
            work += (free.len() * open.len()) as u32;
            let pairs = free.iter().enumerate().flat_map(|(i, &robot)| {
                open.iter()
                    .enumerate()
                    .map(move |(j, goal)| (i, j, robots[robot].plan_distance(*goal)))
            });
            let (i, j, _) = pairs
                .min_by(|a, b| a.2.total_cmp(&b.2))
                .expect("neither is empty");
            targets[free.remove(i)] = Some(open.remove(j).cell());
        }
    }
    (targets, work)
}

fn nearest_to_centroid(group: &[Point], work: &mut u32) -> Point {
    *work += group.len() as u32;
    let number = group.len() as f32;
    let x = group.iter().map(|p| p.x).sum::<f32>() / number;
    let y = group.iter().map(|p| p.y).sum::<f32>() / number;
    let centroid = Point::new(x, y, 0.0);
    let distance = |p: &Point| p.plan_distance(centroid);
    *group
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("no group is empty")
}
