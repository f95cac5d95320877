//! Where a sensor that does not show all round is turned.

use super::{Sensor, VoxelSurvey};
use crate::robot::Action;
use crate::volume::{Heading, Voxel};

/// Looks in a row from one place with the sensor turned elsewhere than was asked for, after
/// which it is taken to show nothing there.
const TURNING: u8 = 16;

/// Headings that the robot has looked at from where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Turn {
    /// Where the next look should go.
    pub(super) wanted: Heading,
    /// Where the looks from here went, a bit for each heading.
    pub(super) looked: u8,
    /// Looks from here since one went where it should.
    late: u8,
    /// Looks from here that do not count yet.
    looks: u8,
}

impl Turn {
    pub(super) const NONE: Self = Self {
        wanted: Heading::EAST,
        looked: 0,
        late: 0,
        looks: 0,
    };

    /// Takes in a look; gives the heading that it stands for. A sensor that does not turn is
    /// taken to have turned in the end, so that what it should have shown is missed. One that
    /// errs looks so often before that counts, else it gives none.
    fn look(&mut self, heading: Heading, often: u8) -> Option<Heading> {
        self.late = if heading == self.wanted {
            0
        } else {
            self.late.saturating_add(1)
        };
        let heading = if self.late < TURNING {
            heading
        } else {
            self.late = 0;
            self.wanted
        };
        self.looks = self.looks.saturating_add(1);
        if self.looks < often {
            return None;
        }
        self.looks = 0;
        self.looked |= heading.bit();
        Some(heading)
    }
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Where the sensor should be turned in the next look. It may be turned while the robot
    /// flies. Of no matter where it shows the same all round.
    pub const fn heading(&self) -> Heading {
        self.turn_to.wanted
    }

    /// The robot is at `at`.
    pub(super) fn arrive(&mut self, at: Voxel) {
        if at != self.position {
            self.turn_to = Turn {
                wanted: self.turn_to.wanted,
                ..Turn::NONE
            };
        }
        let is_from_pose = at == self.position
            || self.mission.is_home(self.position)
            || self.volume.is_pose(self.position, self.clearance);
        self.mission
            .arrive(is_from_pose.then_some(self.position), at);
        self.position = at;
    }

    /// Takes in a look from here: nothing more is to be seen, unless other headings show
    /// more. Gives the heading that the look stands for, if it counts.
    pub(super) fn look_towards(&mut self, heading: Heading) -> Option<Heading> {
        let heading = self.turn_to.look(heading, self.sensor.looks())?;
        if self.field.is_round() || self.turn_to.looked == u8::MAX {
            self.finish(self.position);
        }
        Some(heading)
    }

    /// Headings that were looked at from `pose`.
    pub(super) fn looked_from(&self, pose: Voxel) -> u8 {
        if pose == self.position {
            self.turn_to.looked
        } else {
            0
        }
    }

    /// A look from here in another direction, if one shows something and the last look from
    /// anywhere showed nothing new: what may be in sight from here and is not would lead the
    /// robot back here otherwise.
    pub(super) fn look_round(&mut self) -> Option<Action<Voxel, Voxel>> {
        let here = self.position;
        let has_more = !self.field.is_round() || self.sensor == Sensor::Errs;
        let is_open = has_more && self.fruitless > 0 && !self.done.get(here);
        (is_open && self.gain(here, 1) > 0).then_some(Action::Wait)
    }

    /// Turns the sensor to what shows most from the place of the next look.
    ///
    /// Cost: a view, if it does not show all round.
    pub(super) fn turn(&mut self, place: Voxel) {
        if self.field.is_round() || self.done.get(place) {
            return;
        }
        let (gain, heading) = self.best_heading(place, u32::MAX);
        if gain > 0 {
            self.turn_to.wanted = heading;
        }
    }
}
