//! The methods that FCAO is compared with [Renzaglia2019 §5]. Both fly by the same
//! rules as the planners of the core.

use planner_core::radio::LinkConfig;
use planner_core::surface::Surface;
use planner_core::survey::{Knowledge, Limits, Mission, Pilot, Recovery, SetupError};
use planner_core::tile::bits;
use planner_core::{Action, Cell, Extent, Point, RobotId};

/// Height of flights over ground, as a share of the range.
const CRUISE: f32 = 0.5;

/// A robot nearer to its frontier than this, in cells, has reached it.
const REACHED: f32 = 0.5;

/// Who chooses the frontier that a [`Follower`] flies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guide {
    /// The robot: the closest frontier, chosen anew in every step.
    Closest,
    /// The robot: the closest frontier, and the next one when it has reached that
    /// \[Yamauchi1997\].
    ClosestUntilReached,
    /// A centre that knows the map and all robots: [`assign`].
    Centre,
}

/// A robot that flies to one frontier after the other.
///
/// The published methods know no end but a complete map. Here the way out of the core's
/// planners serves them too, so they stop when those would, and for the same reasons.
#[derive(Clone, Debug)]
pub struct Follower<const TW: usize, const TH: usize> {
    knowledge: Knowledge<TW, TH>,
    recovery: Recovery<TW, TH>,
    guide: Guide,
    order: (Option<Cell>, u32),
    /// The frontier that it is to reach.
    target: Option<Cell>,
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
        let mut recovery = Recovery::vacant();
        recovery.reset();
        Ok(Self {
            knowledge,
            recovery,
            guide,
            order: (None, 0),
            target: None,
        })
    }

    /// The same, sent out with this.
    pub fn on(mut self, mission: Mission) -> Self {
        self.knowledge.set_mission(mission);
        self
    }

    /// The centre's orders, which cost `work` to find.
    pub fn send_to(&mut self, target: Option<Cell>, work: u32) {
        self.order = (target, work);
    }

    /// The frontier to fly to, and what it cost to find.
    fn choose(&self) -> (Option<Cell>, u32) {
        let here = self.knowledge.position();
        let is_under_way = |&cell: &Cell| here.plan_distance(Point::over(cell, 0.0)) > REACHED;
        match (self.guide, self.target.filter(is_under_way)) {
            (Guide::Centre, _) => self.order,
            (Guide::ClosestUntilReached, Some(target)) => (Some(target), 1),
            _ => closest_of_all(&self.knowledge),
        }
    }
}

impl<const TW: usize, const TH: usize> Pilot<TW, TH> for Follower<TW, TH> {
    fn knowledge(&self) -> &Knowledge<TW, TH> {
        &self.knowledge
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH> {
        &mut self.knowledge
    }

    fn fly_home(&mut self) -> Option<Action<Point>> {
        Some(self.recovery.fly_home(&mut self.knowledge))
    }

    fn decide(&mut self) -> Action<Point> {
        let limits = self.knowledge.limits();
        if self.knowledge.idle() >= limits.patience() {
            self.target = None;
            return self.recovery.tick(&mut self.knowledge);
        }
        self.knowledge.take_refused();
        let (target, work) = self.choose();
        self.knowledge.set_goal(target);
        self.knowledge.count_work(work);
        let step = target.and_then(|target| {
            let place = Point::over(target, 0.0);
            let cruise = limits.cruise(CRUISE);
            self.knowledge.step_towards(place, cruise)
        });
        // What cannot be approached is not waited for.
        self.target = target.filter(|_| step.is_some());
        step.map_or(Action::Wait, Action::Move)
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

/// Whom a centre serves first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The robot and the group that are nearest to each other.
    NearestPair,
    /// The robots as they are numbered, each with the nearest group that is left.
    Robots,
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
/// and groups are matched by distance, in `order` and `rounds`. Also returns the number of
/// distances computed.
pub fn assign<const TW: usize, const TH: usize>(
    surface: &Surface<TW, TH>,
    robots: &[Point],
    range: f32,
    order: Order,
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
            let first = match order {
                Order::NearestPair => free.len(),
                Order::Robots => 1,
            };
            work += (first * open.len()) as u32;
            let pairs = free.iter().take(first).enumerate().flat_map(|(i, &robot)| {
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
