//! A drive run through time, and what its history and its belt profiles show.

use std::f64::consts::TAU;

use super::CaseError;
use crate::drive::Drive;
use crate::input::{self, Override};
use crate::observe::ProfileRow;
use crate::simulate::{Flow, Outcome, simulate};

/// A finished run whose audit passed.
pub(super) struct TimeRun {
    pub drive: Drive,
    pub outcome: Outcome,
}

/// Time and value of an extremum of a column.
#[derive(Clone, Copy)]
pub(super) struct Extremum {
    pub time: f64,
    pub value: f64,
}

/// Means over the contact points of one part of an arc, over all profiles.
#[derive(Clone, Copy, Default)]
pub(super) struct Section {
    /// Angle from where the path runs on [rad].
    pub angle: f64,
    pub normal_force: f64,
    pub friction_force: f64,
    pub slip_speed: f64,
}

impl TimeRun {
    pub fn new(text: &str, changes: &[&str]) -> Result<Self, CaseError> {
        let changes = changes
            .iter()
            .map(|change| change.parse())
            .collect::<Result<Vec<Override>, _>>()?;
        let drive = input::parse("example", text, &changes)?;
        let outcome = simulate(&drive, &mut |_| Flow::Continue)?;
        if !outcome.audit.passed() {
            return Err(CaseError::Audit);
        }
        Ok(Self { drive, outcome })
    }

    pub fn column(&self, name: &str) -> Result<Vec<f64>, CaseError> {
        let column = self.outcome.history.column(name);
        column.ok_or_else(|| CaseError::NoColumn(name.to_owned()))
    }

    pub fn mean(&self, name: &str, [from, to]: [f64; 2]) -> Result<f64, CaseError> {
        let mean = self.outcome.history.mean(name, from, to);
        mean.ok_or_else(|| CaseError::NoColumn(name.to_owned()))
    }

    /// The values of a column within a window of time.
    pub fn window(&self, name: &str, [from, to]: [f64; 2]) -> Result<Vec<f64>, CaseError> {
        let (times, values) = (self.column("time")?, self.column(name)?);
        let within = times.iter().map(|t| *t >= from && *t <= to);
        Ok(values
            .into_iter()
            .zip(within)
            .filter_map(|(value, within)| within.then_some(value))
            .collect())
    }

    /// Largest less least value of a column within a window of time.
    pub fn swing(&self, name: &str, window: [f64; 2]) -> Result<f64, CaseError> {
        Ok(range(&self.window(name, window)?))
    }

    /// The largest value of a column, and when.
    pub fn peak(&self, name: &str) -> Result<Extremum, CaseError> {
        let (times, values) = (self.column("time")?, self.column(name)?);
        let largest = times
            .into_iter()
            .zip(values)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        largest
            .map(|(time, value)| Extremum { time, value })
            .ok_or(CaseError::DoesNotRun)
    }

    /// Extrema of a column within a window of time, at least `apart` from each other, by the parabola
    /// through the three rows around each.
    pub fn extrema(
        &self,
        name: &str,
        [from, to]: [f64; 2],
        apart: f64,
    ) -> Result<Vec<Extremum>, CaseError> {
        let (times, values) = (self.column("time")?, self.column(name)?);
        let mut extrema: Vec<Extremum> = Vec::new();
        for (time, value) in times.windows(3).zip(values.windows(3)) {
            let (before, after) = (value[1] - value[0], value[2] - value[1]);
            let last = extrema.last().map_or(f64::NEG_INFINITY, |e| e.time);
            let within = time[1] >= from && time[1] <= to && time[1] > last + apart;
            if !within || before * after >= 0.0 {
                continue;
            }
            let shift = 0.5 * (before + after) / (before - after);
            extrema.push(Extremum {
                time: time[1] + shift * (time[2] - time[1]),
                value: value[1] + 0.25 * (before + after) * shift,
            });
        }
        Ok(extrema)
    }

    /// Line density times speed of a span [kg/s]: the belt that passes.
    pub fn mass_flow(&self, span: &str, window: [f64; 2]) -> Result<f64, CaseError> {
        let strain = self.mean(&format!("{span}.strain"), window)?;
        let speed = self.mean(&format!("{span}.speed"), window)?;
        Ok(self.line_density() * speed / (1.0 + strain))
    }

    /// T - rho A v² of a span [N], with the density of the stretched belt.
    pub fn pressing_tension(&self, span: &str, window: [f64; 2]) -> Result<f64, CaseError> {
        let tension = self.mean(&format!("{span}.tension"), window)?;
        let speed = self.mean(&format!("{span}.speed"), window)?;
        Ok(tension - self.mass_flow(span, window)? * speed)
    }

    /// Unstretched line density rho A [kg/m].
    pub fn line_density(&self) -> f64 {
        self.drive.belt.density * self.drive.area()
    }

    /// The span that leaves pulley `p`, as columns call it.
    pub fn span(&self, p: usize) -> String {
        let pulleys = &self.drive.pulley;
        format!(
            "{}-{}",
            pulleys[p].name,
            pulleys[(p + 1) % pulleys.len()].name
        )
    }

    /// Largest difference over the pulleys between the hub force and the sum of T - rho A v² of the two
    /// spans in their directions, relative to the sum of both magnitudes.
    pub fn hub_force_error(&self, window: [f64; 2]) -> Result<f64, CaseError> {
        let spans = &self.outcome.layout.spans;
        let mut worst = 0.0;
        let count = self.drive.pulley.len();
        for (p, pulley) in self.drive.pulley.iter().enumerate() {
            let (off, on) = (p, (p + count - 1) % count);
            let [pull_off, pull_on] = [
                self.pressing_tension(&self.span(off), window)?,
                self.pressing_tension(&self.span(on), window)?,
            ];
            let mut error = [0.0; 2];
            for (axis, column) in ["hub_force_x", "hub_force_y"].into_iter().enumerate() {
                let along =
                    |s: usize| (spans[s].end[axis] - spans[s].start[axis]) / spans[s].length;
                let hub = self.mean(&format!("{}.{column}", pulley.name), window)?;
                error[axis] = hub - pull_off * along(off) + pull_on * along(on);
            }
            worst = f64::max(worst, error[0].hypot(error[1]) / (pull_off + pull_on));
        }
        Ok(worst)
    }

    /// Angle of a row about the pulley that it touches, from where the path runs on, in the direction in
    /// which it runs [rad]: between half a gap before the arc and half a gap behind it.
    pub fn angle(&self, p: usize, row: &ProfileRow) -> f64 {
        let arc = &self.outcome.layout.arcs[p];
        let turned = (row.y - arc.center[1]).atan2(row.x - arc.center[0]) - arc.start_angle;
        let gap = 0.5 * (TAU - arc.sweep.abs());
        (turned * arc.sweep.signum() + gap).rem_euclid(TAU) - gap
    }

    /// The rows of all profiles that touch pulley `p`.
    pub fn rows_on(&self, p: usize) -> impl Iterator<Item = &ProfileRow> {
        let name = &self.drive.pulley[p].name;
        self.outcome
            .profile
            .iter()
            .filter(move |row| row.pulley == *name)
    }

    /// Pulley `p` in `count` equal parts from `beyond` before the arc to `beyond` behind it [rad]; parts
    /// without points are left out.
    pub fn sections(&self, p: usize, count: usize, beyond: f64) -> Vec<Section> {
        let width = (self.outcome.layout.arcs[p].sweep.abs() + 2.0 * beyond) / count as f64;
        (0..count)
            .filter_map(|k| {
                let from = k as f64 * width - beyond;
                let mut sum = Section::default();
                let mut points = 0_u32;
                for row in self.rows_on(p) {
                    let angle = self.angle(p, row);
                    if angle >= from && angle < from + width {
                        sum.angle += angle;
                        sum.normal_force += row.normal_force;
                        sum.friction_force += row.friction_force;
                        sum.slip_speed += row.slip_speed;
                        points += 1;
                    }
                }
                let part = f64::from(points).recip();
                (points > 0).then_some(Section {
                    angle: sum.angle * part,
                    normal_force: sum.normal_force * part,
                    friction_force: sum.friction_force * part,
                    slip_speed: sum.slip_speed * part,
                })
            })
            .collect()
    }
}

/// Largest less least of `values`.
pub(super) fn range(values: &[f64]) -> f64 {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest - values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The straight line nearest to points `(x, y)` by least squares.
pub(super) struct Line {
    pub slope: f64,
    /// Root mean square of the distances in y.
    pub deviation: f64,
    /// Mean of y.
    pub mean: f64,
}

impl Line {
    /// Not numbers for less than two points.
    pub fn through(points: &[(f64, f64)]) -> Self {
        let count = points.len() as f64;
        let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let square: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
        let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / square;
        let distances = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2));
        Self {
            slope,
            deviation: (distances.sum::<f64>() / count).sqrt(),
            mean: y,
        }
    }
}
