//! The local choice: the direction in which most unknown surface lies ahead, by a
//! cubic fitted to probes of the map and to the past [Renzaglia2019 eq. 3 to 7].

use heapless::Vec;

use super::vicinity::Vicinity;
use super::{CoordinatedSurvey, HISTORY};
use crate::cao::{Degree, Frame, Model, Sample};
use crate::math;
use crate::point::Point;

/// Probed headings.
const HEADINGS: u8 = 8;

/// A swath with less than this share unknown is not worth a local step.
const LEAST: f32 = 0.4;

/// How much the past counts against a probe.
const PAST_WEIGHT: f32 = 0.2;

/// Ridge of the fit, per row.
const RIDGE: f32 = 1e-3;

/// Random candidates.
const CANDIDATES: u8 = 48;

/// Rows of the fit: the past and the probes.
const ROWS: usize = HISTORY + HEADINGS as usize;

impl<const TW: usize, const TH: usize> CoordinatedSurvey<TW, TH> {
    /// The best step into a swath that is unknown enough, if there is one.
    ///
    /// Cost: 8 probes of 10 columns each, a fit of 16 rows, 48 candidates.
    pub(super) fn best_swath(&mut self) -> Option<Point> {
        let here = self.knowledge.position();
        let step = self.config.limits.step;
        let phase = self.rng.angle();
        let mut vicinity = Vicinity::new(self.knowledge.surface(), here);
        if self.config.tune[11] > 0.5 {
            for peer in self.knowledge.rivals() {
                vicinity.leave_to(peer.status.position, here, self.config.tune[20] > 0.5);
            }
        }
        let mut rows: Vec<Sample, ROWS> = Vec::new();
        let mut most = 0.0f32;
        for i in 0..HEADINGS {
            let heading = phase + core::f32::consts::TAU / f32::from(HEADINGS) * f32::from(i);
            let to = self.knowledge.step_along(heading, step, self.cruise());
            if self.knowledge.may_fly(to) {
                let value = if self.config.tune[16] > 0.0 {
                    self.shown_ahead(vicinity, heading)
                } else {
                    self.unknown_ahead(to, heading)
                };
                most = most.max(value);
                // There is room for as many as there are headings.
                let _ = rows.push(Sample {
                    at: to,
                    value,
                    weight: 1.0,
                });
            }
        }
        self.look_at(u32::from(HEADINGS) * 10);
        if most < self.config.tune[2] {
            return None;
        }
        let reward = self.knowledge.reward();
        let area = 2.0 * self.config.limits.range * step;
        let past = self
            .history
            .samples(|before| (before - reward) / area, self.config.tune[15]);
        for sample in past {
            let _ = rows.push(sample);
        }
        self.look_at((ROWS * ROWS) as u32);
        let frame = Frame {
            origin: here,
            scale: 1.0 / (step * math::sqrt(6.0)),
        };
        let model = Model::fit::<ROWS>(&rows, frame, Degree::Cubic, RIDGE * rows.len() as f32)?;
        self.best_candidate(&model, vicinity)
    }

    // [Renzaglia2019 eq. 6, 7], on the surface at cruise height instead of the sphere.
    fn best_candidate(&mut self, model: &Model, vicinity: Vicinity) -> Option<Point> {
        let mut best: Option<(f32, Point)> = None;
        for _ in 0..CANDIDATES {
            let heading = self.rng.angle();
            let to = self
                .knowledge
                .step_along(heading, self.config.limits.step, self.cruise());
            let value = if self.config.tune[5] > 0.5 {
                if self.config.tune[16] > 0.0 {
                    self.shown_ahead(vicinity, heading)
                } else {
                    self.unknown_ahead(to, heading)
                }
            } else {
                model.value(to)
            };
            if best.is_none_or(|(most, _)| value > most) && self.knowledge.may_fly(to) {
                best = Some((value, to));
            }
        }
        self.look_at(u32::from(CANDIDATES));
        best.map(|(_, to)| to)
    }

    fn shown_ahead(&self, mut vicinity: Vicinity, heading: f32) -> f32 {
        let here = self.knowledge.position();
        let step = self.config.limits.step;
        let radius = self.config.tune[17] * self.config.limits.range;
        let (sin, cos) = math::sin_cos(heading);
        let (mut value, mut most, mut worth) = (0.0f32, 0.0f32, 1.0f32);
        for k in 1..=self.config.tune[16] as i32 {
            let d = k as f32 * step;
            let (number, rim) = vicinity.take_disc(here.offset(d * cos, d * sin, 0.0), radius);
            value += worth * (number as f32 + self.config.tune[19] * rim as f32);
            most += worth * 2.0 * radius * step;
            worth *= self.config.tune[18];
        }
        value / most
    }

    /// Share of unknown columns in two rows across the swath ahead of `from`.
    fn unknown_ahead(&self, from: Point, heading: f32) -> f32 {
        let range = self.config.limits.range;
        let surface = self.knowledge.surface();
        let (sin, cos) = math::sin_cos(heading);
        let (mut inside, mut unknown) = (0.0f32, 0.0);
        for (ahead, weight) in [
            (self.config.tune[3] * range, 1.0),
            (self.config.tune[4] * range, 0.8),
        ] {
            for lateral in [-0.8, -0.4, 0.0, 0.4, 0.8] {
                let beside = lateral * self.config.tune[6] * range;
                let cell = from
                    .offset(ahead * cos - beside * sin, ahead * sin + beside * cos, 0.0)
                    .cell();
                if surface.extent().contains(cell) {
                    inside += weight;
                    let at = Point::over(cell, 0.0);
                    let own = from.plan_distance(at);
                    let contested = self.config.tune[11] > 0.0
                        && self
                            .knowledge
                            .rivals()
                            .any(|peer| peer.status.position.plan_distance(at) < own);
                    unknown += if surface.is_unknown(cell) {
                        if contested {
                            weight * (1.0 - self.config.tune[11])
                        } else {
                            weight
                        }
                    } else {
                        0.0
                    };
                }
            }
        }
        if self.config.tune[7] > 0.5 {
            return unknown / 9.0;
        }
        if inside > 0.0 { unknown / inside } else { 0.0 }
    }
}
