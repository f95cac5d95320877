//! The local choice: the heading along which most unknown surface would be shown.

use heapless::Vec;

use super::vicinity::Vicinity;
use super::{Choice, CoordinatedSurvey, HISTORY};
use crate::cao::{Degree, Frame, Model, Sample};
use crate::list;
use crate::math;
use crate::point::Point;

/// Probed headings.
const HEADINGS: u8 = 8;

/// A local step is worth it if a probe shows at least this share of what a swath
/// through unknown surface would.
const LEAST: f32 = 0.4;

/// After a local step that gained less than this share of 2Rα, the probes are not
/// trusted: something ahead cannot be seen.
const LEAST_GAIN: f32 = 0.11;

/// As long as it gains, a robot with a rival nearer than this, in ranges, makes no local
/// steps: their views overlap, and shared out frontiers lead them apart.
const APART: f32 = 2.0;

/// The same with so many rivals nearer than that. Fewer have room enough, and over a town
/// they would lose more by it.
const CROWD: usize = 3;
const CROWD_APART: f32 = 4.0;

/// Places that a probe looks at ahead, a quarter of a range apart.
const LOOKAHEAD: u8 = 4;
const SPACING: f32 = 0.25;

/// Worth of a place ahead against the one before it.
const DISCOUNT: f32 = 0.825;

/// Radius of what a robot is taken to see from cruise height, as a share of R.
const SIGHT: f32 = 0.85;

/// The most of it, as a share of what the range reaches on flat ground from there.
const SIGHT_OF_FLAT: f32 = 0.912;

/// Worth of a column along known surface or the border, beside 1 for any column: a
/// swath then runs along what is known and leaves no strips behind.
const RIM: f32 = 4.4;

/// How much the past counts against a probe in the cubic's fit.
const PAST_WEIGHT: f32 = 0.375;

/// Ridge of that fit, per row.
const RIDGE: f32 = 1e-3;

/// Random candidates.
const CANDIDATES: u8 = 48;

/// Rivals whose part of the surface is left to them.
const NEIGHBOURS: usize = 6;

/// Rows of the fit: the past and the probes.
const ROWS: usize = HISTORY + HEADINGS as usize;

impl<const TW: usize, const TH: usize> CoordinatedSurvey<TW, TH> {
    /// The best step into a swath of unknown surface, if there is one and no rival is
    /// about it too.
    ///
    /// Cost: a [`Vicinity`], 64 rows for each rival, 8 probes of 4 discs; then 48
    /// candidates, each of them 4 discs or 20 terms of the cubic.
    #[inline(never)] // what it keeps on the stack goes with it
    pub(super) fn best_swath(&mut self, gain: f32) -> Option<Point> {
        let step = self.config.limits.step;
        let trusted = gain >= LEAST_GAIN * 2.0 * self.config.limits.range * step;
        let in_company = gain > 0.0 && self.is_among_rivals();
        if core::mem::take(&mut self.local) && !trusted || in_company {
            return None;
        }
        let vicinity = self.own_vicinity();
        let phase = self.rng.angle();
        let mut probes: Vec<Sample, ROWS> = Vec::new();
        for i in 0..HEADINGS {
            let heading = phase + core::f32::consts::TAU / f32::from(HEADINGS) * f32::from(i);
            let at = self.knowledge.step_along(heading, step, self.cruise());
            if self.knowledge.may_fly(at) {
                let value = self.shown_along(vicinity, heading);
                // There are more rows than headings.
                let _ = probes.push(Sample {
                    at,
                    value,
                    weight: 1.0,
                });
            }
        }
        let rows = u32::from(HEADINGS) * self.disc_rows();
        self.knowledge.count_work(rows);
        if !probes.iter().any(|probe| probe.value >= LEAST) {
            return None;
        }
        let to = match self.config.choice {
            Choice::Map => self.best_candidate(|robot, heading, _| {
                let rows = robot.disc_rows();
                robot.knowledge.count_work(rows);
                robot.shown_along(vicinity, heading)
            }),
            Choice::Cubic => {
                let model = self.fit(probes)?;
                self.best_candidate(|_, _, to| model.value(to))
            }
        };
        self.local = to.is_some();
        to
    }

    fn is_among_rivals(&self) -> bool {
        let here = self.knowledge.position();
        let range = self.config.limits.range;
        let rivals_within = |ranges: f32| {
            let rivals = self.knowledge.rivals();
            let is_near = |at: Point| at.plan_distance(here) < ranges * range;
            rivals
                .filter(move |peer| is_near(peer.status.position))
                .count()
        };
        rivals_within(APART) > 0 || rivals_within(CROWD_APART) >= CROWD
    }

    /// The vicinity without what is nearer to others; of many, to the nearest six: the
    /// rest are behind them, and the work stays level in a large fleet.
    #[inline(never)] // what it keeps on the stack goes with it
    fn own_vicinity(&mut self) -> Vicinity {
        let here = self.knowledge.position();
        let mut vicinity = Vicinity::new(self.knowledge.surface(), here);
        let mut nearest: Vec<(f32, Point), NEIGHBOURS> = Vec::new();
        for peer in self.knowledge.rivals() {
            let at = peer.status.position;
            list::keep_least(&mut nearest, here.plan_distance(at), at);
        }
        for &(_, at) in &nearest {
            vicinity.leave_to(at, here);
        }
        self.knowledge.count_work(512 + 64 * nearest.len() as u32);
        vicinity
    }

    /// The cubic through the probes and the past: what J gained before, in the units
    /// of the probes [Renzaglia2019 eq. 3, 5].
    #[inline(never)] // what it keeps on the stack goes with it
    fn fit(&mut self, mut rows: Vec<Sample, ROWS>) -> Option<Model> {
        let step = self.config.limits.step;
        let area = 2.0 * self.config.limits.range * step;
        let reward = self.knowledge.reward();
        for sample in self
            .history
            .samples(|before| (before - reward) / area, PAST_WEIGHT)
        {
            let _ = rows.push(sample);
        }
        self.knowledge.count_work((ROWS * ROWS) as u32);
        let frame = Frame {
            origin: self.knowledge.position(),
            scale: 1.0 / (step * math::sqrt(6.0)),
        };
        Model::fit::<ROWS>(&rows, frame, Degree::Cubic, RIDGE * rows.len() as f32)
    }

    /// The random allowed step with the highest value [Renzaglia2019 eq. 6, 7], on the
    /// surface at cruise height instead of the sphere.
    fn best_candidate(
        &mut self,
        mut value: impl FnMut(&mut Self, f32, Point) -> f32,
    ) -> Option<Point> {
        let mut best: Option<(f32, Point)> = None;
        for _ in 0..CANDIDATES {
            let heading = self.rng.angle();
            let to = self
                .knowledge
                .step_along(heading, self.config.limits.step, self.cruise());
            let value = value(self, heading, to);
            if best.is_none_or(|(most, _)| value > most) && self.knowledge.may_fly(to) {
                best = Some((value, to));
            }
        }
        self.knowledge.count_work(u32::from(CANDIDATES));
        best.map(|(_, to)| to)
    }

    /// What a flight along `heading` would show, 1 being a swath through unknown
    /// surface far from everything known.
    #[inline(never)] // what it keeps on the stack goes with it
    fn shown_along(&self, mut vicinity: Vicinity, heading: f32) -> f32 {
        let here = self.knowledge.position();
        let spacing = SPACING * self.config.limits.range;
        let radius = self.sight();
        let (sin, cos) = math::sin_cos(heading);
        let (mut value, mut most, mut worth) = (0.0f32, 0.0, 1.0);
        for ahead in 1..=LOOKAHEAD {
            let distance = f32::from(ahead) * spacing;
            let place = here.offset(distance * cos, distance * sin, 0.0);
            let shown = vicinity.take_disc(place, radius);
            value += worth * (shown.columns as f32 + RIM * shown.rim as f32);
            most += worth * 2.0 * radius * spacing;
            worth *= DISCOUNT;
        }
        value / most
    }

    /// Radius of what a robot is taken to see from cruise height: little where the least
    /// altitude leaves little of the range.
    fn sight(&self) -> f32 {
        let (range, cruise) = (self.config.limits.range, self.cruise());
        let flat = math::sqrt((range * range - cruise * cruise).max(1.0));
        (SIGHT * range).min(SIGHT_OF_FLAT * flat)
    }

    /// Rows that [`shown_along`](Self::shown_along) counts, for the record of work.
    fn disc_rows(&self) -> u32 {
        u32::from(LOOKAHEAD) * (2.0 * self.sight()) as u32
    }
}
