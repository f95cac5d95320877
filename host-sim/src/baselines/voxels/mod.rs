//! What `voxel_survey` is compared with: the closest frontier, and a centre that assigns groups
//! of frontiers, among voxels.
//!
//! A frontier is an unknown voxel beside a known free one. A robot cannot fly there: it flies
//! to the nearest place, in steps, from which the known map leaves it in sight. Both look for
//! it anew in every step, over the whole map.

mod chart;
mod wave;

use planner_core::RobotId;
use planner_core::volume::Voxel;

pub use chart::{Body, Chart};
use wave::Wave;

/// The first step of robot `id` to the nearest place that shows a frontier, and the number of
/// places and lines of sight that were tried.
pub fn closest(chart: &mut Chart, id: RobotId, here: Voxel) -> (Option<Voxel>, u32) {
    let mut wave = Wave::new(chart, here, id.0.into());
    let before = chart.lines();
    let mut places = 0;
    let mut found = None;
    while let Some(place) = wave.next(chart) {
        places += 1;
        if chart.shows_frontier(place) {
            found = wave.first_step(chart, place);
            break;
        }
    }
    (found, places + (chart.lines() - before))
}

/// A group of frontiers: the places that show the member of it that is nearest to its
/// middle, of those that any place shows.
type Group = Vec<Voxel>;

/// The first step of each robot, by a centre: frontiers are grouped by leader clustering of
/// the sensor's range; robot and group of the shortest way are matched first, and robots that
/// are left over start a new round. Also returns the number of places, pairs and lines of
/// sight that were tried.
pub fn assign(chart: &mut Chart, robots: &[Voxel]) -> (Vec<Option<Voxel>>, u32) {
    let before = chart.lines();
    let mut work = 0;
    let waves: Vec<Wave> = robots
        .iter()
        .enumerate()
        .map(|(id, &robot)| {
            let mut wave = Wave::new(chart, robot, id);
            while wave.next(chart).is_some() {
                work += 1;
            }
            wave
        })
        .collect();
    let groups: Vec<Group> = clusters(chart, &mut work)
        .into_iter()
        .filter_map(|cluster| {
            cluster.into_iter().find_map(|member| {
                let mut places = chart.shown_from(member).to_vec();
                places.retain(|&place| {
                    let mut steps = waves.iter().map(|wave| wave.steps_to(chart, place));
                    steps.any(|steps| steps.is_some())
                });
                (!places.is_empty()).then_some(places)
            })
        })
        .collect();
    // Steps of each robot to each group, and the place in it.
    let nearest = |wave: &Wave, group: &Group| {
        let places = group.iter();
        let places = places.filter_map(|&place| Some((wave.steps_to(chart, place)?, place)));
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
            steps[robot] = waves[robot].first_step(chart, place);
            free.retain(|&it| it != robot);
            open.retain(|&it| it != group);
        }
        if free.len() == before {
            break;
        }
    }
    (steps, work + (chart.lines() - before))
}

/// Leader clustering; the members of each cluster by their distance from its middle.
fn clusters(chart: &Chart, work: &mut u32) -> Vec<Vec<Voxel>> {
    let most = u32::from(chart.range()).pow(2);
    let mut clusters: Vec<Vec<Voxel>> = Vec::new();
    for voxel in chart.frontiers() {
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
    use std::ops::Range;

    use planner_core::Extent;

    use super::*;
    use crate::scene::{Scene, look};

    fn body(range: u8) -> Body {
        Body {
            range,
            clearance: 1,
        }
    }

    /// A tunnel along x, `known` and free between walls, five voxels wide and high.
    fn tunnel(length: u16, known: Range<i16>, range: u8) -> Chart {
        let mut chart = Chart::new(Extent::new(length, 5), 5, body(range));
        let planes = (0..5).flat_map(|z| (0..5).map(move |y| (y, z)));
        let voxels = planes.flat_map(|(y, z)| known.clone().map(move |x| Voxel::new(x, y, z)));
        let is_wall = |at: Voxel| [0, 4].contains(&at.y) || [0, 4].contains(&at.z);
        let view: Vec<_> = voxels.map(|at| (at, is_wall(at))).collect();
        chart.learn(&view);
        chart
    }

    fn at(x: i16) -> Voxel {
        Voxel::new(x, 2, 2)
    }

    #[test]
    fn a_robot_flies_to_where_it_sees_a_frontier_and_no_farther() {
        let mut chart = tunnel(40, 0..20, 8);
        assert_eq!(closest(&mut chart, RobotId(0), at(4)).0, Some(at(5)));
        // The frontier at 20 is in sight from 12 on.
        assert_eq!(closest(&mut chart, RobotId(0), at(11)).0, Some(at(12)));
        assert_eq!(closest(&mut chart, RobotId(0), at(12)).0, Some(at(12)));
        assert_eq!(
            closest(&mut tunnel(20, 0..20, 8), RobotId(0), at(4)).0,
            None
        );
    }

    #[test]
    fn a_centre_sends_robots_to_groups_of_their_own_and_the_rest_again() {
        // The other end is unknown, too.
        let mut chart = tunnel(60, 1..40, 6);
        let (steps, _) = assign(&mut chart, &[at(20), at(18), at(19)]);
        assert_eq!(steps, [Some(at(21)), Some(at(17)), Some(at(18))]);
        // Nobody is nearer to the far end, yet one goes there.
        let (steps, _) = assign(&mut chart, &[at(10), at(9)]);
        assert_eq!(steps, [Some(at(11)), Some(at(8))]);
        let (steps, _) = assign(&mut tunnel(20, 0..20, 6), &[at(10), at(9)]);
        assert_eq!(steps, [None, None]);
    }

    /// What was found out before is no other than what is found out now.
    #[test]
    fn what_is_remembered_still_holds() {
        let scene = Scene::town(3, 24);
        let new = || Chart::new(scene.extent(), scene.levels(), body(5));
        let mut chart = new();
        let mut here = scene.start(1).unwrap();
        let mut views = Vec::new();
        for _ in 0..60 {
            views.push(look(&scene, here, 5));
            chart.learn(&views[views.len() - 1]);
            let mut afresh = new();
            views.iter().for_each(|view| afresh.learn(view));
            let to = closest(&mut chart, RobotId(0), here).0;
            assert_eq!(to, closest(&mut afresh, RobotId(0), here).0);
            let robots = [here, scene.start(1).unwrap()];
            let orders = assign(&mut chart, &robots).0;
            assert_eq!(orders, assign(&mut afresh, &robots).0);
            here = to.unwrap();
        }
    }
}
