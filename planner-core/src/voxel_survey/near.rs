//! The poses around the robot: where a short flight shows the most.

use heapless::Vec;

use super::VoxelSurvey;
use crate::list;
use crate::robot::Action;
use crate::volume::{Voxel, voxel_work};

/// Poses around the robot that are considered.
pub(super) const POSES: usize = 512;

/// Those of them whose view is looked at in one step.
const VIEWS: usize = 40;

/// Unknown voxels in certain sight that are counted.
const ENOUGH: u32 = 128;

/// Half of the side of the window that they lie in.
const WINDOW: i16 = 16;
const _: () = assert!(
    2 * WINDOW as u32 <= u32::BITS,
    "a row of the window is a u32"
);
const _: () = assert!(
    WINDOW <= i8::MAX as i16,
    "where a pose is in the window is an i8 each way"
);
const _: () = assert!(POSES <= u16::MAX as usize, "a pose's number is a u16");

/// What a view is worth of which nothing is certain: it may turn out to show nothing.
const UNSURE: f32 = 0.1;

/// What a view is worth to which a rival is nearer.
const RIVALS_SHARE: f32 = 0.25;

/// Work of a voxel that is considered.
const POSE: u32 = 4;

/// Work on them after which no further ones are: room for views is left. Only wide bodies take
/// so much.
const MOST_POSES: u32 = super::SLICE / 2;

/// Steps that a flight costs beside its length.
const START: u32 = 2;

/// A pose that can be reached, and the number of the one before it.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Where it is, seen from the robot.
    offset: [i8; 3],
    pub(super) before: u16,
    pub(super) steps: u16,
}

impl Place {
    const OWN: Self = Self {
        offset: [0; 3],
        before: 0,
        steps: 0,
    };

    pub(super) fn at(self, here: Voxel) -> Voxel {
        let [x, y, z] = self.offset.map(i16::from);
        Voxel::new(
            here.x.saturating_add(x),
            here.y.saturating_add(y),
            here.z.saturating_add(z),
        )
    }

    /// The next one, numbered `number`, to a voxel beside it.
    fn next(self, number: u16, at: Voxel, here: Voxel) -> Self {
        let offset = [(at.x, here.x), (at.y, here.y), (at.z, here.z)];
        Self {
            offset: offset.map(|(at, here)| at.saturating_sub(here) as i8),
            before: number,
            steps: self.steps.saturating_add(1),
        }
    }
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// A flight to the pose near by that is certain to show the most for its distance; `None` if
    /// all poses near by are done.
    pub(super) fn look_near(&mut self) -> Option<Action<Voxel, Voxel>> {
        let here = self.position;
        let mut places = Vec::new();
        self.find_places(&mut places, self.clearance);
        let best = loop {
            self.work = self.work.saturating_add(places.len() as u32);
            let is_open = |place: &&Place| !self.done.get(place.at(here));
            let open = places.iter().filter(is_open).count();
            if open == 0 {
                return None;
            }
            let best = self.best_of(&places, open.div_ceil(VIEWS));
            // Views that show nothing are done with: the others are looked at next.
            if best.is_some() || self.work >= super::SLICE {
                break best;
            }
        };
        let Some(mut number) = best else {
            return Some(Action::Wait);
        };
        self.way.clear();
        if let Some(goal) = places.get(usize::from(number)) {
            self.goal = goal.at(here);
        }
        for _ in 0..POSES {
            let Some(place) = places.get(usize::from(number)) else {
                break;
            };
            if place.steps == 0 {
                break;
            }
            list::push_out(&mut self.way, place.at(here));
            number = place.before;
        }
        Some(self.follow().unwrap_or(Action::Wait))
    }

    /// The number of the best of `places`, looked at in strides until the slice is used up.
    fn best_of(&mut self, places: &[Place], stride: usize) -> Option<u16> {
        let here = self.position;
        let chosen: Vec<(u16, Place), VIEWS> = list::collect(
            (0u16..)
                .zip(places)
                .filter(|(_, place)| !self.done.get(place.at(here)))
                .step_by(stride.max(1))
                .map(|(number, &place)| (number, place)),
        );
        let mut best: Option<(f32, u16)> = None;
        for &(number, place) in &chosen {
            if self.work >= super::SLICE {
                break;
            }
            let at = place.at(here);
            let mut gain = self.sure_gain(at, ENOUGH) as f32;
            if gain == 0.0 && self.work < super::SLICE {
                gain = UNSURE * self.gain(at, 1) as f32;
            }
            if gain == 0.0 {
                continue;
            }
            let share = if self.is_a_rivals(at) {
                RIVALS_SHARE
            } else {
                1.0
            };
            let score = share * gain / (START + u32::from(place.steps)) as f32;
            if best.is_none_or(|(most, _)| score > most) {
                best = Some((score, number));
            }
        }
        best.map(|(_, number)| number)
    }

    /// The poses of a body of this clearance around the robot, nearest first, the robot's own
    /// place in front.
    // Not in line: its window would stay on the stack beside the views.
    #[inline(never)]
    pub(super) fn find_places(&mut self, places: &mut Vec<Place, POSES>, clearance: u8) {
        // One bit for each voxel of the window that was looked at.
        let mut seen = [[0u32; 2 * WINDOW as usize]; 2 * WINDOW as usize];
        let here = self.position;
        let mut visit = |at: Voxel| {
            let index =
                |a: i16, b: i16| usize::try_from(a.saturating_sub(b).saturating_add(WINDOW));
            let (Ok(x), Ok(y), Ok(z)) = (
                index(at.x, here.x),
                index(at.y, here.y),
                index(at.z, here.z),
            ) else {
                return false;
            };
            let bit = 1u32.checked_shl(x as u32).unwrap_or(0);
            let Some(row) = seen.get_mut(z).and_then(|level| level.get_mut(y)) else {
                return false;
            };
            let is_new = bit != 0 && *row & bit == 0;
            *row |= bit;
            is_new
        };
        visit(here);
        let _ = places.push(Place::OWN);
        let pose = POSE + voxel_work(clearance);
        let most = self.work.saturating_add(MOST_POSES);
        for number in 0..POSES {
            let Some(&place) = places.get(number) else {
                break;
            };
            if self.work >= most {
                break;
            }
            for at in place.at(here).beside() {
                if places.is_full() || !visit(at) {
                    continue;
                }
                self.work = self.work.saturating_add(pose);
                if self.volume.is_pose(at, clearance) && !self.closed.get(at) {
                    let _ = places.push(place.next(number as u16, at, here));
                }
            }
        }
    }
}
