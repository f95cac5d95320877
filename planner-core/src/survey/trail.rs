//! The way home as a taut string: the corners at which it turns.

use super::flight::Sky;
use crate::point::Point;

/// Corners of a way, home included.
const CORNERS: usize = 22;

/// A way of straight parts: from the robot to the last corner, from each corner to the one
/// before, and so home, which is the first.
#[derive(Clone, Debug)]
pub(super) struct Trail {
    corners: [Point; CORNERS],
    length: u8,
    /// An earlier corner, to be tried as a short cut next.
    cursor: u8,
    /// Whether the way leads by where the robot was last, for which there is no room.
    is_full: bool,
    /// Where the robot was last when the way was whole.
    last: Point,
    /// Ticks since then.
    astray: u32,
}

impl Trail {
    /// All zero: no way.
    pub(super) const fn vacant() -> Self {
        Self {
            corners: [Point::new(0.0, 0.0, 0.0); CORNERS],
            length: 0,
            cursor: 0,
            is_full: false,
            last: Point::new(0.0, 0.0, 0.0),
            astray: 0,
        }
    }

    /// The robot is at home.
    pub(super) fn begin(&mut self, home: Point) {
        self.length = 0;
        self.push(home);
        self.is_full = false;
        self.last = home;
        self.astray = 0;
    }

    /// Whether it is known to lead home from where the robot is.
    pub(super) const fn is_whole(&self) -> bool {
        self.length > 0 && self.astray == 0
    }

    /// Whether it has as many corners as there is room for, and the robot is beyond.
    pub(super) const fn is_full(&self) -> bool {
        self.is_full
    }

    /// Home.
    pub(super) fn home(&self) -> Option<Point> {
        self.corner(0)
    }

    /// The end of its first straight part from here.
    pub(super) fn next(&self) -> Option<Point> {
        match self.is_full {
            true => Some(self.last),
            false => self.last_corner(),
        }
    }

    /// Steps home from `here`, where the robot is; a guess while the way is not whole.
    pub(super) fn steps<const TW: usize, const TH: usize>(
        &self,
        here: Point,
        sky: &Sky<'_, TW, TH>,
    ) -> u32 {
        let last = self.is_full.then_some(self.last);
        let corners = (0..self.length)
            .rev()
            .filter_map(|number| self.corner(number));
        let (steps, _) = last
            .into_iter()
            .chain(corners)
            .fold((self.astray, here), |(steps, at), to| {
                (steps.saturating_add(sky.steps(at, to)), to)
            });
        steps
    }

    /// The robot is `here` now, at most a flight from where it was last.
    ///
    /// Cost: at most 7 straight ways.
    pub(super) fn follow<const TW: usize, const TH: usize>(
        &mut self,
        here: Point,
        sky: &Sky<'_, TW, TH>,
    ) {
        let Some(corner) = self.last_corner() else {
            return;
        };
        if !sky.is_way(here, corner) && !self.turn(here, corner, sky) {
            return;
        }
        self.is_full = false;
        self.astray = 0;
        self.last = here;
        for _ in 0..2 {
            let number = self.length.checked_sub(2);
            match number.and_then(|number| self.corner(number)) {
                Some(corner) if sky.is_way(here, corner) => self.length -= 1,
                _ => break,
            }
        }
        self.shorten(here, sky);
    }

    /// Lets the way lead by where the robot was last, or straight to an earlier corner;
    /// says whether it now leads from `here` to its last corner.
    fn turn<const TW: usize, const TH: usize>(
        &mut self,
        here: Point,
        corner: Point,
        sky: &Sky<'_, TW, TH>,
    ) -> bool {
        let has_turned = self.last != here && self.last != corner && sky.is_way(here, self.last);
        if has_turned && usize::from(self.length) < CORNERS {
            self.push(self.last);
            return true;
        }
        if self.shorten(here, sky) {
            return true;
        }
        if has_turned {
            self.is_full = true;
            self.astray = 0;
        } else if self.length == 1 && (here.x, here.y) == (corner.x, corner.y) && here.z > corner.z
        {
            // It rose from where nothing may fly: that far it will come home.
            self.begin(here);
            return true;
        } else {
            self.astray = self.astray.saturating_add(1);
        }
        false
    }

    /// Tries one of the earlier corners, another one each time.
    fn shorten<const TW: usize, const TH: usize>(
        &mut self,
        here: Point,
        sky: &Sky<'_, TW, TH>,
    ) -> bool {
        let earlier = self.length.saturating_sub(2);
        let Some(number) = self.cursor.wrapping_add(1).checked_rem(earlier) else {
            return false;
        };
        self.cursor = number;
        let is_shorter = self
            .corner(number)
            .is_some_and(|corner| sky.is_way(here, corner));
        if is_shorter {
            self.length = number + 1;
        }
        is_shorter
    }

    fn corner(&self, number: u8) -> Option<Point> {
        let corners = self.corners.get(..usize::from(self.length))?;
        corners.get(usize::from(number)).copied()
    }

    fn last_corner(&self) -> Option<Point> {
        self.corner(self.length.checked_sub(1)?)
    }

    fn push(&mut self, corner: Point) {
        if let Some(place) = self.corners.get_mut(usize::from(self.length)) {
            *place = corner;
            self.length += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::{Cell, Extent};
    use crate::surface::{Column, Height, Surface};
    use crate::survey::Limits;
    use std::vec::Vec;

    const SIDE: i16 = 32;

    /// Known columns to and fro: every other row, joined at its ends by turns.
    fn serpentine() -> Surface<4, 4> {
        let mut surface = Surface::new(Extent::new(SIDE as u16, SIDE as u16)).unwrap();
        for y in 0..SIDE {
            let joint = if y % 4 == 1 { SIDE - 1 } else { 0 };
            for x in (0..SIDE).filter(|&x| y % 2 == 0 || x == joint) {
                let (cell, height) = (Cell::new(x, y), Height(0));
                surface.learn(Column { cell, height });
            }
        }
        surface
    }

    /// Column after column.
    fn way() -> impl Iterator<Item = Point> {
        (0..SIDE).flat_map(|y| {
            let row = (0..SIDE).filter(move |&x| {
                let joint = if y % 4 == 1 { SIDE - 1 } else { 0 };
                y % 2 == 0 || x == joint
            });
            let (ahead, back): (Vec<_>, Vec<_>) = match y % 4 {
                2 => (Vec::new(), row.collect()),
                _ => (row.collect(), Vec::new()),
            };
            let cells = ahead.into_iter().chain(back.into_iter().rev());
            cells.map(move |x| Point::over(Cell::new(x, y), 2.0))
        })
    }

    #[test]
    fn a_way_leads_back_at_every_place_and_says_when_it_is_full() {
        let surface = serpentine();
        let sky = Sky {
            limits: Limits {
                range: 4.0,
                step: 1.5,
                min_altitude: 1.0,
                ceiling: 5.0,
                separation: 1.0,
                clearance: 0,
            },
            surface: &surface,
        };
        let mut trail = Trail::vacant();
        let mut at = Point::over(Cell::new(0, 0), 2.0);
        trail.begin(at);
        let mut flown = 0;
        for to in way() {
            let steps = trail.steps(at, &sky);
            at = to;
            trail.follow(at, &sky);
            flown += 1;
            assert!(trail.is_whole());
            assert!(trail.steps(at, &sky) <= flown.min(steps + 1));
            if trail.is_full() {
                break;
            }
        }
        assert!(trail.is_full() && usize::from(trail.length) == CORNERS);
        let mut left = trail.steps(at, &sky);
        assert!(left > 100);
        while at != Point::over(Cell::new(0, 0), 2.0) {
            let to = sky.step(at, trail.next().unwrap());
            assert!(sky.is_open(at, to));
            at = to;
            trail.follow(at, &sky);
            assert!(trail.is_whole() && !trail.is_full());
            let now = trail.steps(at, &sky);
            assert!(now < left, "{now} of {left}");
            left = now;
        }
        assert_eq!(left, 0);
    }

    #[test]
    fn a_way_is_straight_where_all_is_known() {
        let mut surface: Surface<4, 4> = Surface::new(Extent::new(32, 32)).unwrap();
        for x in 0..32 {
            for y in 0..32 {
                let (cell, height) = (Cell::new(x, y), Height(0));
                surface.learn(Column { cell, height });
            }
        }
        let limits = Limits {
            range: 4.0,
            step: 2.0,
            min_altitude: 1.0,
            ceiling: 5.0,
            separation: 1.0,
            clearance: 0,
        };
        let sky = Sky {
            limits,
            surface: &surface,
        };
        let mut trail = Trail::vacant();
        trail.begin(Point::new(1.5, 1.5, 2.0));
        for (x, y) in [(3.0, 1.5), (4.5, 2.0), (4.5, 4.0), (9.5, 1.5)] {
            trail.follow(Point::new(x, y, 2.0), &sky);
        }
        assert_eq!((trail.length, trail.is_whole()), (1, true));
        assert_eq!(trail.steps(Point::new(9.5, 1.5, 2.0), &sky), 4);
    }
}
