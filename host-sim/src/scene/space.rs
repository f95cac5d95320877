//! The free space of a scene: where robots can fly, and where they start.

use planner_core::volume::Voxel;

use super::{Marks, Scene};

impl Scene {
    /// The places that a robot of this clearance reaches from `start`.
    pub(super) fn reached(&self, start: Voxel, clearance: u8) -> Marks {
        let mut reached = Marks::of(self);
        reached.insert(self, start);
        self.flood(start, clearance, &mut reached);
        reached
    }

    /// Marks what is reached from `start`, and gives all of it.
    fn flood(&self, start: Voxel, clearance: u8, reached: &mut Marks) -> Vec<Voxel> {
        let mut places = vec![start];
        let mut next = 0;
        while let Some(&at) = places.get(next) {
            next += 1;
            for beside in at.beside() {
                if self.is_pose(beside, clearance) && reached.insert(self, beside) {
                    places.push(beside);
                }
            }
        }
        places
    }

    /// Where robots start unless told otherwise: above the ground near the north-west
    /// corner, or wherever there is room first. In a scene from a file it is the
    /// lowest place over known ground in the largest room, the nearest to that corner; a room is
    /// what one can fly about in.
    pub fn start(&self, clearance: u8) -> Option<Voxel> {
        let corner = Voxel::new(2, 2, 2);
        let distance = |voxel: &Voxel| voxel.distance_squared(corner);
        if self.frame.is_none() {
            let places = self.voxels();
            let places = places.filter(|at| at.z >= 2 && self.is_pose(*at, clearance));
            return places.min_by_key(distance);
        }
        let mut reached = Marks::of(self);
        let mut largest = Vec::new();
        for at in self.voxels() {
            if self.is_pose(at, clearance) && reached.insert(self, at) {
                let room = self.flood(at, clearance, &mut reached);
                if room.len() > largest.len() {
                    largest = room;
                }
            }
        }
        let places = || largest.iter().copied();
        let stands = places().filter(|at| self.ground_under(*at).is_some());
        let lowest = stands.min_by_key(|at| (at.z, distance(at)));
        lowest.or_else(|| places().min_by_key(distance))
    }

    /// The occupied voxel below `voxel` with nothing but free ones between; `None`: none is known.
    pub(crate) fn ground_under(&self, voxel: Voxel) -> Option<Voxel> {
        let mut below = (0..voxel.z).rev().map(|z| Voxel { z, ..voxel });
        let ground = below.find(|at| self.is_solid(*at));
        ground.filter(|at| self.is_occupied(*at))
    }

    /// The place for a robot of this clearance that is nearest to `voxel`.
    pub fn nearest_pose(&self, voxel: Voxel, clearance: u8) -> Option<Voxel> {
        let places = self.voxels().filter(|at| self.is_pose(*at, clearance));
        places.min_by_key(|at| at.distance_squared(voxel))
    }

    /// How many voxels that the scene does not know lie beside a free one that `is_seen`
    /// has: there the scan ends.
    pub(crate) fn edge(&self, is_seen: impl Fn(Voxel) -> bool) -> u32 {
        use planner_core::volume::Content::{Free, Unknown};
        let is_edge = |voxel: &Voxel| {
            let mut beside = voxel.beside().into_iter();
            self.content(*voxel) == Some(Unknown)
                && beside.any(|at| self.content(at) == Some(Free) && is_seen(at))
        };
        self.voxels().filter(is_edge).count() as u32
    }
}

#[cfg(test)]
mod tests {
    use planner_core::Extent;
    use planner_core::volume::Content::{Free, Occupied, Unknown};

    use super::*;
    use crate::scene::Frame;

    /// A scan with a floor in its east only, and a table on it.
    #[test]
    fn robots_start_low_over_known_ground() {
        let content = |at: Voxel| match (at.x, at.y, at.z) {
            (0 | 11, ..) | (_, 0 | 7, _) | (_, _, 9) => Unknown,
            (6.., _, 0) | (6 | 7, _, 3) => Occupied,
            (.., 0) => Unknown,
            _ => Free,
        };
        let scene = Scene::from_contents("half", Extent::new(12, 8), 10, content);
        let scene = scene.framed(Some(Frame::PLAIN));
        assert_eq!(scene.start(1), Some(Voxel::new(8, 2, 2)));
        assert_eq!(
            scene.ground_under(Voxel::new(8, 2, 2)),
            Some(Voxel::new(8, 2, 0))
        );
        assert_eq!(scene.ground_under(Voxel::new(3, 2, 5)), None);
        // Where no ground is known, as far to the north-west as one can.
        let air = Scene::from_contents("air", Extent::new(12, 8), 10, |at| match content(at) {
            Occupied => Unknown,
            content => content,
        });
        let air = air.framed(Some(Frame::PLAIN));
        assert_eq!(air.start(1), Some(Voxel::new(2, 2, 2)));
    }
}
