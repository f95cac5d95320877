//! The places in which robots are tried, and what can be seen there.

use super::*;

pub(super) const EXTENT: Extent = Extent::new(11, 10);
pub(super) const LEVELS: u8 = 7;
pub(super) const RANGE: u8 = 4;

pub(super) const CONFIG: Config = Config {
    range: RANGE,
    ..Config::new()
};

pub(super) type Robot = VoxelSurvey<2, 2, 7>;

pub(super) fn all() -> impl Iterator<Item = Voxel> {
    (0..LEVELS as i16)
        .flat_map(|z| (0..10).flat_map(move |y| (0..11).map(move |x| Voxel::new(x, y, z))))
}

pub(super) fn is_inside(voxel: Voxel) -> bool {
    EXTENT.contains(voxel.cell()) && (0..LEVELS as i16).contains(&voxel.z)
}

/// What a sensor at `eye` shows.
pub(super) fn look(walls: &BTreeSet<Voxel>, eye: Voxel) -> Vec<(Voxel, bool)> {
    let range = u32::from(RANGE * RANGE);
    all()
        .filter(|&voxel| eye.distance_squared(voxel) <= range)
        .filter(|&voxel| in_sight(eye, voxel, |at| !walls.contains(&at)))
        .map(|voxel| (voxel, walls.contains(&voxel)))
        .collect()
}

/// Whether a body touches no wall.
pub(super) fn is_clear(walls: &BTreeSet<Voxel>, clearance: u8, voxel: Voxel) -> bool {
    is_inside(voxel) && body_voxels(clearance, voxel).all(|at| !walls.contains(&at))
}

/// The places that can be reached, by brute force.
pub(super) fn reached(walls: &BTreeSet<Voxel>, start: Voxel, clearance: u8) -> Vec<Voxel> {
    flood(start, |voxel| is_clear(walls, clearance, voxel))
}

/// All that steps over poses lead to.
fn flood(start: Voxel, is_pose: impl Fn(Voxel) -> bool) -> Vec<Voxel> {
    let mut reached = Vec::from([start]);
    let mut next = 0;
    while let Some(&at) = reached.get(next) {
        next += 1;
        for beside in at.beside() {
            if is_pose(beside) && !reached.contains(&beside) {
                reached.push(beside);
            }
        }
    }
    reached
}

/// Every voxel that is seen from any of them.
pub(super) fn visible(walls: &BTreeSet<Voxel>, start: Voxel, clearance: u8) -> BTreeSet<Voxel> {
    let views = reached(walls, start, clearance);
    let views = views.iter().flat_map(|&eye| look(walls, eye));
    views.map(|(voxel, _)| voxel).collect()
}

pub(super) const START: Voxel = Voxel::new(5, 5, 4);

/// The slice, and the view that was begun within it.
pub(super) const MOST_WORK: u32 = SLICE + 32 + VIEW;
/// Five times two tiles by two of seven levels, 81 rows eight times, and a ray for each of 257
/// voxels within the range.
pub(super) const VIEW: u32 = 5 * 28 + 8 * 81 + 3 * 257;

pub(super) type Scattered = BTreeSet<(i16, i16, i16)>;
pub(super) type Slabs = Vec<((i16, i16, i16), (i16, i16, i16))>;

pub(super) fn walls() -> impl Strategy<Value = (Scattered, Slabs)> {
    (
        prop::collection::btree_set((0i16..11, 0i16..10, 0i16..7), 0..40),
        prop::collection::vec(
            ((0i16..11, 0i16..10, 0i16..7), (1i16..7, 1i16..7, 1i16..4)),
            0..5,
        ),
    )
}

/// Single voxels and slabs, with room for a robot at the start.
pub(super) fn scene(scattered: &Scattered, slabs: &Slabs) -> BTreeSet<Voxel> {
    let mut walls: BTreeSet<Voxel> = scattered
        .iter()
        .map(|&(x, y, z)| Voxel::new(x, y, z))
        .collect();
    for &((x, y, z), (wide, deep, high)) in slabs {
        walls.extend(all().filter(|v| {
            (x..x + wide).contains(&v.x)
                && (y..y + deep).contains(&v.y)
                && (z..z + high).contains(&v.z)
        }));
    }
    for voxel in body_voxels(CONFIG.clearance, START) {
        walls.remove(&voxel);
    }
    walls
}

/// A scene, and what is wrong with it.
#[derive(Clone, Debug, Default)]
pub(super) struct World {
    pub(super) walls: BTreeSet<Voxel>,
    /// Voxels that no step enters.
    pub(super) glass: BTreeSet<Voxel>,
    /// Voxels that no look shows.
    pub(super) dark: BTreeSet<Voxel>,
    pub(super) silent_from: Option<u32>,
}

impl World {
    pub(super) fn look(&self, eye: Voxel, step: u32) -> Vec<(Voxel, bool)> {
        if self.silent_from.is_some_and(|from| step >= from) {
            return Vec::new();
        }
        let mut view = look(&self.walls, eye);
        view.retain(|(voxel, _)| !self.dark.contains(voxel));
        view
    }

    /// What is seen from any place that can be reached over voxels that let a robot in,
    /// all of whose neighbours can be known.
    pub(super) fn visible(&self) -> BTreeSet<Voxel> {
        let blocks = self
            .walls
            .union(&self.dark)
            .copied()
            .collect::<BTreeSet<_>>();
        let is_pose = |voxel: Voxel| {
            is_inside(voxel)
                && !self.glass.contains(&voxel)
                && !blocks.contains(&voxel)
                && voxel.beside().iter().all(|beside| !blocks.contains(beside))
        };
        let reached = flood(START, is_pose);
        let views = reached.iter().flat_map(|&eye| self.look(eye, 0));
        views.map(|(voxel, _)| voxel).collect()
    }

    /// Flies from `at` until the robot stops.
    pub(super) fn fly(
        &self,
        robot: &mut Robot,
        at: &mut Voxel,
        script: &Script,
        loud: u32,
        most: u32,
    ) -> (Stop<Voxel>, u32) {
        for step in 0..most {
            robot.observe(*at, &self.look(*at, step));
            if step < loud && !script.is_empty() {
                for &(id, status) in &script[step as usize % script.len()] {
                    robot.hear(RobotId(id), status);
                }
            }
            match robot.tick() {
                Action::Move(to) => {
                    assert_eq!(at.distance_squared(to), 1);
                    assert!(!self.walls.contains(&to));
                    if !self.glass.contains(&to) {
                        *at = to;
                    }
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    for _ in 0..3 {
                        robot.observe(*at, &self.look(*at, step));
                        assert_eq!(robot.tick(), Action::Stop(stop));
                    }
                    return (stop, step);
                }
            }
        }
        panic!("no stop: {self:?}");
    }

    pub(super) fn is_true(&self, stop: Stop<Voxel>, robot: &Robot) {
        let volume = robot.volume();
        assert_eq!(stop.left(), volume.frontiers());
        match stop {
            Stop::Complete | Stop::OutOfReach { .. } => {
                for voxel in self.visible() {
                    assert!(volume.content(voxel) != Content::Unknown, "{voxel}");
                }
            }
            Stop::Unseen { at, .. } => {
                assert!(
                    is_inside(at) && volume.content(at) == Content::Unknown,
                    "{at}"
                );
            }
            Stop::Blocked { at, .. } => assert!(self.glass.contains(&at), "{at}"),
            other => panic!("{other}"),
        }
    }
}

/// What others say in the steps of the script, round and round.
pub(super) type Script = Vec<Vec<(u8, Status<Voxel>)>>;

pub(super) fn script() -> impl Strategy<Value = Script> {
    let coordinate = || prop_oneof![9 => -2i16..14, 1 => any::<i16>()];
    let voxel = move || {
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Voxel::new(x, y, z))
    };
    let status = (voxel(), prop::option::of(voxel()), any::<bool>()).prop_map(
        |(position, goal, stopped)| Status {
            position,
            goal,
            activity: Activity::stopped_if(stopped),
        },
    );
    prop::collection::vec(prop::collection::vec((1u8..20, status), 0..16), 0..8)
}

pub(super) fn places(most: usize) -> impl Strategy<Value = BTreeSet<Voxel>> {
    let voxel = (0i16..11, 0i16..10, 0i16..7).prop_map(|(x, y, z)| Voxel::new(x, y, z));
    prop::collection::btree_set(voxel, 0..most)
        .prop_map(|set| set.into_iter().filter(|&voxel| voxel != START).collect())
}
