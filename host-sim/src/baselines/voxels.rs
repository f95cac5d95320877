//! What `voxel_survey` is compared with: the closest frontier, and a centre that assigns groups
//! of frontiers, among voxels.
//!
//! A frontier is an unknown voxel beside a known free one. A robot cannot fly there: it flies
//! to the nearest place, in steps, from which the known map leaves it in sight. Both look for
//! it anew in every step, over the whole map.

use std::collections::VecDeque;

use planner_core::Extent;
use planner_core::volume::{Content, Voxel, in_sight};

/// What is known of a box of voxels.
pub trait Known {
    /// Size on the ground plan.
    fn extent(&self) -> Extent;
    /// Number of levels.
    fn levels(&self) -> u8;
    /// What is known of `voxel`; outside of the box it is free.
    fn content(&self, voxel: Voxel) -> Content;

    /// Whether a robot may be at `voxel`: it and what is beside it are known to be free.
    fn is_pose(&self, voxel: Voxel) -> bool {
        let is_free = |voxel: Voxel| self.content(voxel) == Content::Free;
        self.index(voxel).is_some() && is_free(voxel) && voxel.beside().into_iter().all(is_free)
    }

    /// The place of a voxel of the box in a table, level by level.
    fn index(&self, voxel: Voxel) -> Option<usize> {
        let Extent { width, height } = self.extent();
        let is_inside = self.extent().contains(voxel.cell())
            && (0..i16::from(self.levels())).contains(&voxel.z);
        let [x, y, z] = [voxel.x, voxel.y, voxel.z].map(|at| at as usize);
        is_inside.then(|| (z * usize::from(height) + y) * usize::from(width) + x)
    }

    /// Number of voxels.
    fn size(&self) -> usize {
        self.extent().cells() as usize * usize::from(self.levels())
    }
}

/// All that anybody has seen.
#[derive(Clone, Debug)]
pub struct Union {
    extent: Extent,
    levels: u8,
    contents: Vec<Content>,
}

impl Union {
    /// Of a box of which nobody has seen anything.
    pub fn new(extent: Extent, levels: u8) -> Self {
        let size = extent.cells() as usize * usize::from(levels);
        Self {
            extent,
            levels,
            contents: vec![Content::Unknown; size],
        }
    }

    /// Takes in what one look shows.
    pub fn learn(&mut self, view: &[(Voxel, bool)]) {
        for &(voxel, is_solid) in view {
            if let Some(index) = self.index(voxel) {
                self.contents[index] = match is_solid {
                    true => Content::Occupied,
                    false => Content::Free,
                };
            }
        }
    }

    /// The frontiers, level by level.
    fn frontiers(&self) -> Vec<Voxel> {
        let (width, height) = (self.extent.width as i16, self.extent.height as i16);
        let rows = (0..i16::from(self.levels)).flat_map(|z| (0..height).map(move |y| (y, z)));
        let voxels = rows.flat_map(|(y, z)| (0..width).map(move |x| Voxel::new(x, y, z)));
        voxels.filter(|&voxel| is_frontier(self, voxel)).collect()
    }
}

impl Known for Union {
    fn extent(&self) -> Extent {
        self.extent
    }

    fn levels(&self) -> u8 {
        self.levels
    }

    fn content(&self, voxel: Voxel) -> Content {
        self.index(voxel)
            .map_or(Content::Free, |index| self.contents[index])
    }
}

/// Whether `voxel` is unknown and beside a known free one of the box.
fn is_frontier(map: &(impl Known + ?Sized), voxel: Voxel) -> bool {
    let is_free = |at: &Voxel| map.index(*at).is_some() && map.content(*at) == Content::Free;
    map.content(voxel) == Content::Unknown && voxel.beside().iter().any(is_free)
}

/// The voxels within a range of the middle one.
struct Ball(Vec<Voxel>);

impl Ball {
    fn new(range: u8) -> Self {
        let reach = i16::from(range);
        let side = move || -reach..=reach;
        let planes = side().flat_map(move |z| side().map(move |y| (y, z)));
        let voxels = planes.flat_map(move |(y, z)| side().map(move |x| Voxel::new(x, y, z)));
        let (middle, most) = (Voxel::new(0, 0, 0), u32::from(range).pow(2));
        Self(
            voxels
                .filter(|at| at.distance_squared(middle) <= most)
                .collect(),
        )
    }

    fn about(&self, middle: Voxel) -> impl Iterator<Item = Voxel> {
        let moved = move |at: &Voxel| Voxel::new(middle.x + at.x, middle.y + at.y, middle.z + at.z);
        self.0.iter().map(moved)
    }
}

/// Whether `map` leaves `voxel` in sight of `eye`.
fn shows(map: &(impl Known + ?Sized), eye: Voxel, voxel: Voxel) -> bool {
    in_sight(eye, voxel, |at| map.content(at) == Content::Free)
}

/// The ways from one place to all that can be reached over known ground.
struct Wave {
    /// By place: steps, and where the last one came from; nothing where no way leads.
    steps: Vec<Option<(u32, Voxel)>>,
    front: VecDeque<Voxel>,
    start: Voxel,
}

impl Wave {
    fn new(map: &(impl Known + ?Sized), start: Voxel) -> Self {
        let mut steps = vec![None; map.size()];
        if let Some(index) = map.index(start) {
            steps[index] = Some((0, start));
        }
        Self {
            steps,
            front: VecDeque::from([start]),
            start,
        }
    }

    /// The next place, by the number of steps.
    fn next(&mut self, map: &(impl Known + ?Sized)) -> Option<Voxel> {
        let at = self.front.pop_front()?;
        let (steps, _) = self.steps[map.index(at)?]?;
        for beside in at.beside() {
            if let Some(index) = map.index(beside)
                && self.steps[index].is_none()
                && map.is_pose(beside)
            {
                self.steps[index] = Some((steps + 1, at));
                self.front.push_back(beside);
            }
        }
        Some(at)
    }

    fn steps_to(&self, map: &(impl Known + ?Sized), place: Voxel) -> Option<u32> {
        let index = map.index(place)?;
        self.steps[index].map(|(steps, _)| steps)
    }

    /// The first step on the way to `place`; the place itself if the robot is there.
    fn first_step(&self, map: &(impl Known + ?Sized), place: Voxel) -> Option<Voxel> {
        let mut at = place;
        loop {
            let (_, before) = self.steps[map.index(at)?]?;
            if before == self.start {
                return Some(at);
            }
            at = before;
        }
    }
}

/// The first step to the nearest place that shows a frontier, and the number of places and
/// lines of sight that were tried.
pub fn closest(map: &(impl Known + ?Sized), here: Voxel, range: u8) -> (Option<Voxel>, u32) {
    let ball = Ball::new(range);
    let mut wave = Wave::new(map, here);
    let mut work = 0;
    while let Some(place) = wave.next(map) {
        work += 1;
        let shows_one = |voxel: Voxel| {
            is_frontier(map, voxel) && {
                work += 1;
                shows(map, place, voxel)
            }
        };
        if ball.about(place).any(shows_one) {
            return (wave.first_step(map, place), work);
        }
    }
    (None, work)
}

/// A group of frontiers: the places that show the member of it that is nearest to its
/// middle, of those that any place shows.
type Group = Vec<Voxel>;

/// The first step of each robot, by a centre: frontiers are grouped by leader clustering of
/// radius `range`; robot and group of the shortest way are matched first, and robots that are
/// left over start a new round. Also returns the number of places, pairs and lines of sight
/// that were tried.
pub fn assign(union: &Union, robots: &[Voxel], range: u8) -> (Vec<Option<Voxel>>, u32) {
    let mut work = 0;
    let waves: Vec<Wave> = robots
        .iter()
        .map(|&robot| {
            let mut wave = Wave::new(union, robot);
            while wave.next(union).is_some() {
                work += 1;
            }
            wave
        })
        .collect();
    let ball = Ball::new(range);
    let is_reached = |place: Voxel| {
        let steps = waves.iter().filter_map(|wave| wave.steps_to(union, place));
        steps.count() > 0
    };
    let groups: Vec<Group> = clusters(&union.frontiers(), range, &mut work)
        .into_iter()
        .map(|cluster| {
            let mut members = cluster.into_iter();
            let group = members.find_map(|member| {
                let places = ball.about(member).filter(|&place| is_reached(place));
                let places = places.filter(|&place| {
                    work += 1;
                    shows(union, place, member)
                });
                Some(places.collect::<Group>()).filter(|places| !places.is_empty())
            });
            group.unwrap_or_default()
        })
        .filter(|group| !group.is_empty())
        .collect();
    // Steps of each robot to each group, and the place in it.
    let nearest = |wave: &Wave, group: &Group| {
        let places = group.iter();
        let places = places.filter_map(|&place| Some((wave.steps_to(union, place)?, place)));
        places.min_by_key(|(steps, _)| *steps)
    };
    let ways: Vec<Vec<_>> = waves
        .iter()
        .map(|wave| groups.iter().map(|group| nearest(wave, group)).collect())
        .collect();
    work += (waves.len() * groups.len()) as u32;
    let mut steps = vec![None; robots.len()];
    let mut free: Vec<usize> = (0..robots.len()).collect();
    while !free.is_empty() {
        let before = free.len();
        let mut open: Vec<usize> = (0..groups.len()).collect();
        loop {
            let pairs = free.iter().flat_map(|&robot| {
                let of_robot = &ways[robot];
                open.iter().filter_map(move |&group| {
                    let (steps, place) = of_robot[group]?;
                    Some((steps, robot, group, place))
                })
            });
            let Some((_, robot, group, place)) = pairs.min_by_key(|pair| (pair.0, pair.1, pair.2))
            else {
                break;
            };
            steps[robot] = waves[robot].first_step(union, place);
            free.retain(|&it| it != robot);
            open.retain(|&it| it != group);
        }
        if free.len() == before {
            break;
        }
    }
    (steps, work)
}

/// Leader clustering; the members of each cluster by their distance from its middle.
fn clusters(frontiers: &[Voxel], range: u8, work: &mut u32) -> Vec<Vec<Voxel>> {
    let most = u32::from(range).pow(2);
    let mut clusters: Vec<Vec<Voxel>> = Vec::new();
    for &voxel in frontiers {
        let found = clusters.iter_mut().find(|cluster| {
            *work += 1;
            cluster[0].distance_squared(voxel) <= most
        });
        match found {
            Some(cluster) => cluster.push(voxel),
            None => clusters.push(vec![voxel]),
        }
    }
    for cluster in &mut clusters {
        let number = cluster.len() as i32;
        let sum =
            |axis: fn(&Voxel) -> i16| cluster.iter().map(|it| i32::from(axis(it))).sum::<i32>();
        let [x, y, z] = [sum(|it| it.x), sum(|it| it.y), sum(|it| it.z)];
        let middle = [x, y, z].map(|sum| (sum / number) as i16);
        let middle = Voxel::new(middle[0], middle[1], middle[2]);
        cluster.sort_by_key(|it| it.distance_squared(middle));
    }
    clusters
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tunnel along x, known and free up to `known`, five voxels wide and high.
    fn tunnel(length: u16, known: i16) -> Union {
        let mut union = Union::new(Extent::new(length, 5), 5);
        let planes = (0..5).flat_map(|z| (0..5).map(move |y| (y, z)));
        let voxels = planes.flat_map(|(y, z)| (0..known).map(move |x| Voxel::new(x, y, z)));
        let is_wall = |at: Voxel| [0, 4].contains(&at.y) || [0, 4].contains(&at.z);
        let view: Vec<_> = voxels.map(|at| (at, is_wall(at))).collect();
        union.learn(&view);
        union
    }

    fn at(x: i16) -> Voxel {
        Voxel::new(x, 2, 2)
    }

    #[test]
    fn a_robot_flies_to_where_it_sees_a_frontier_and_no_farther() {
        let union = tunnel(40, 20);
        assert_eq!(closest(&union, at(4), 8).0, Some(at(5)));
        // The frontier at 20 is in sight from 12 on.
        assert_eq!(closest(&union, at(11), 8).0, Some(at(12)));
        assert_eq!(closest(&union, at(12), 8).0, Some(at(12)));
        assert_eq!(closest(&tunnel(20, 20), at(4), 8).0, None);
    }

    #[test]
    fn a_centre_sends_robots_to_groups_of_their_own_and_the_rest_again() {
        let mut union = tunnel(60, 40);
        // The other end is unknown, too.
        let planes = (0..5).flat_map(|z| (0..5).map(move |y| Voxel::new(0, y, z)));
        for voxel in planes {
            let index = union.index(voxel).unwrap();
            union.contents[index] = Content::Unknown;
        }
        let (steps, _) = assign(&union, &[at(20), at(18), at(19)], 6);
        assert_eq!(steps, [Some(at(21)), Some(at(17)), Some(at(18))]);
        // Nobody is nearer to the far end, yet one goes there.
        let (steps, _) = assign(&union, &[at(10), at(9)], 6);
        assert_eq!(steps, [Some(at(11)), Some(at(8))]);
        let (steps, _) = assign(&tunnel(20, 20), &[at(10), at(9)], 6);
        assert_eq!(steps, [None, None]);
    }
}
