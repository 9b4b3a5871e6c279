//! Maps: a drive solved at every combination of several of its numbers.
//!
//! Points are solved line by line, each from the state of its neighbour on the line, lines on all cores. A line runs along a
//! torque where one is among the numbers: while nothing but torques change, and all of them in proportion, the capacity found at one
//! point holds for the next, and points beyond it are known to slip without a search. Where only torques and speeds
//! change the belt is not put together again. What is found does not depend on the number of threads.

use rayon::prelude::*;

use super::summary::{RunningSummary, Steady};
use super::{Answer, Capacity, Most, Outcome, RunningBelt, RunningError};
use crate::assemble::BeltElementType;
use crate::drive::{Drive, Pulley};
use crate::input::{NumberField, broken_rule};
use crate::steady::drive_string::final_value;

/// A number of the drive and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The field.
    pub field: NumberField,
    /// Its values, SI.
    pub values: Vec<f64>,
}

/// What a map found.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Names of the numeric columns: the fields first, then the results.
    pub columns: Vec<String>,
    /// One row a combination, the last axis fastest.
    pub rows: Vec<Row>,
}

/// One point of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `running`, `gross-slip`, `slack`, or `none` where the drive has no answer.
    pub answer: &'static str,
    /// By column; not a number where there is none.
    pub values: Vec<f64>,
    /// Why there is no answer.
    pub error: Option<RunningError>,
}

/// Solves `drive` at every combination of `axes`, telling `done` of every point.
pub fn map(drive: &Drive, axes: &[Axis], done: impl Fn() + Sync) -> Map {
    with_belt_element!(drive, Element => of_elements::<Element>(drive, axes, &done))
}

fn of_elements<E: BeltElementType>(drive: &Drive, axes: &[Axis], done: &(dyn Fn() + Sync)) -> Map {
    let columns = columns(drive, axes);
    let points: usize = axes.iter().map(|axis| axis.values.len()).product();
    let torque = |axis: &Axis| axis.field.key.ends_with(".torque");
    let along = axes
        .iter()
        .position(torque)
        .unwrap_or(axes.len().saturating_sub(1));
    // Distance in the table between neighbours on a line.
    let stride: usize = axes
        .iter()
        .skip(along + 1)
        .map(|axis| axis.values.len())
        .product();
    let length = axes.get(along).map_or(1, |axis| axis.values.len());
    let lines: Vec<Vec<usize>> = (0..points)
        .filter(|point| (point / stride).is_multiple_of(length))
        .map(|first| (0..length).map(|k| first + k * stride).collect())
        .collect();
    let width = columns.len();
    let solved: Vec<(usize, Row)> = (lines.par_iter())
        .flat_map_iter(|line| solve_line::<E>(drive, axes, line, width, done))
        .collect();
    let mut rows = vec![
        Row {
            answer: "none",
            values: Vec::new(),
            error: None,
        };
        points
    ];
    for (point, row) in solved {
        rows[point] = row;
    }
    Map { columns, rows }
}

/// The values of the axes at a point of the table.
fn values_at(axes: &[Axis], point: usize) -> Vec<f64> {
    let mut rest = point;
    let mut values: Vec<f64> = (axes.iter().rev())
        .map(|axis| {
            let value = axis.values[rest % axis.values.len()];
            rest /= axis.values.len();
            value
        })
        .collect();
    values.reverse();
    values
}

/// The drive with these values, if it is one.
pub(super) fn at_values(
    drive: &Drive,
    axes: &[Axis],
    values: &[f64],
) -> Result<Drive, RunningError> {
    let mut there = drive.clone();
    for (axis, value) in axes.iter().zip(values) {
        let field = &axis.field;
        (field.check(*value))
            .and_then(|()| field.with(&there, *value))
            .map(|changed| there = changed)
            .map_err(|error| RunningError::refused(&error))?;
    }
    match broken_rule(&there) {
        Some(broken) => Err(RunningError::Field(broken)),
        None => Ok(there),
    }
}

/// What the points of a line hand on.
struct Neighbour<E> {
    drive: Drive,
    belt: RunningBelt<E>,
    /// The state in which it runs.
    state: Vec<f64>,
}

fn solve_line<E: BeltElementType>(
    drive: &Drive,
    axes: &[Axis],
    line: &[usize],
    width: usize,
    done: &(dyn Fn() + Sync),
) -> Vec<(usize, Row)> {
    let mut neighbour: Option<Neighbour<E>> = None;
    let mut known: Option<(Drive, Capacity)> = None;
    line.iter()
        .map(|&point| {
            let mut row = Row {
                answer: "none",
                values: values_at(axes, point),
                error: None,
            };
            let found = at_values(drive, axes, &row.values).and_then(|there| {
                let outcome = solve_point(&there, &mut neighbour, &mut known)?;
                Ok(RunningSummary::new(&there, &outcome))
            });
            match found {
                Ok(summary) => {
                    row.answer = summary.answer;
                    row.values.extend(results(&summary));
                }
                Err(error) => row.error = Some(error),
            }
            row.values.resize(width, f64::NAN);
            done();
            (point, row)
        })
        .collect()
}

fn solve_point<E: BeltElementType>(
    drive: &Drive,
    neighbour: &mut Option<Neighbour<E>>,
    known: &mut Option<(Drive, Capacity)>,
) -> Result<Outcome, RunningError> {
    let scaled = (known.as_ref()).and_then(|(before, capacity)| scaled(before, drive, capacity));
    let near = neighbour
        .take()
        .and_then(|near| near.moved_to(drive).ok().flatten());
    let (mut belt, state) = match near {
        Some(near) => (near.belt, Some(near.state)),
        None => (RunningBelt::new(drive)?, None),
    };
    let answer = match (&scaled, &state) {
        (Some(capacity), _) if capacity.factor < 1.0 => Answer::GrossSlip(super::GrossSlip {
            capacity: capacity.clone(),
        }),
        (_, Some(state)) => {
            if let Some(answer) = belt.solve_near(state) {
                answer
            } else {
                belt = RunningBelt::new(drive)?;
                belt.solve()?
            }
        }
        (_, None) => belt.solve()?,
    };
    let capacity = match &answer {
        Answer::Running(running) => scaled.map(Most::Known).or_else(|| belt.capacity(running)),
        _ => None,
    };
    let most = match &answer {
        Answer::GrossSlip(slip) => Some(&slip.capacity),
        _ => capacity.as_ref().and_then(Most::known),
    };
    *known = most.map(|c| (drive.clone(), c.clone()));
    let outcome = Outcome {
        capacity,
        layout: belt.layout().clone(),
        mounting: *belt.mounting(),
        start: belt.start,
        dofs: belt.dofs(),
        warnings: Vec::new(),
        answer,
    };
    let state = match &outcome.answer {
        Answer::Running(running) => Some(running.state.clone()),
        _ => state,
    };
    *neighbour = state.map(|state| Neighbour {
        drive: drive.clone(),
        belt,
        state,
    });
    Ok(outcome)
}

impl<E: BeltElementType> Neighbour<E> {
    /// The same belt in `drive`; nothing where it has other unknowns there.
    fn moved_to(mut self, drive: &Drive) -> Result<Option<Self>, RunningError> {
        if same_but(drive, &self.drive, |now, before| {
            now.speed.clone_from(&before.speed);
            now.torque.clone_from(&before.torque);
        }) {
            self.belt.redirect(drive)?;
        } else {
            let Some(belt) = RunningBelt::beside(drive, &self.belt, &self.state)? else {
                return Ok(None);
            };
            self.belt = belt;
        }
        Ok(Some(self))
    }
}

/// Whether `now` is `before` but for what `restore` sets back on every pulley.
fn same_but(now: &Drive, before: &Drive, restore: impl Fn(&mut Pulley, &Pulley)) -> bool {
    let mut restored = now.clone();
    for (pulley, before) in restored.pulley.iter_mut().zip(&before.pulley) {
        restore(pulley, before);
    }
    restored == *before
}

/// The capacity found of the drive `before` where `now` differs from it by its torques alone, all in proportion.
fn scaled(before: &Drive, now: &Drive, capacity: &Capacity) -> Option<Capacity> {
    let same = same_but(now, before, |now, before| {
        now.torque.clone_from(&before.torque);
    });
    if !same || before.pulley.iter().any(|p| p.load.is_some()) {
        return None;
    }
    let torques = |drive: &Drive| -> Vec<f64> {
        (drive.pulley.iter().map(|p| final_value(&p.torque))).collect()
    };
    let (before, now) = (torques(before), torques(now));
    let (largest, at) = (before.iter().zip(&now)).fold((0.0, 0.0), |most: (f64, f64), (b, n)| {
        if b.abs() > most.0.abs() {
            (*b, *n)
        } else {
            most
        }
    });
    let factor = at / largest;
    let proportional =
        (before.iter().zip(&now)).all(|(b, n)| (n - factor * b).abs() <= 1.0e-12 * at.abs());
    (factor > 0.0 && factor.is_finite() && proportional).then(|| Capacity {
        factor: capacity.factor / factor,
        ..capacity.clone()
    })
}

fn columns(drive: &Drive, axes: &[Axis]) -> Vec<String> {
    let mut columns: Vec<String> = axes.iter().map(|axis| axis.field.key.clone()).collect();
    let results = [
        "speed_loss",
        "power_in",
        "power_out",
        "power_lost",
        "efficiency",
        "margin",
        "overload",
        "power_residual",
    ];
    columns.extend(results.map(str::to_owned));
    for pulley in &drive.pulley {
        for part in [
            "speed",
            "external_torque",
            "hub_force",
            "slip_angle",
            "contact_angle",
        ] {
            columns.push(format!("{}.{part}", pulley.name));
        }
    }
    let next = drive.pulley.iter().cycle().skip(1);
    for (from, to) in drive.pulley.iter().zip(next) {
        columns.push(format!("{}-{}.tension", from.name, to.name));
    }
    columns
}

/// The results in the order of [`columns`].
fn results(summary: &RunningSummary) -> Vec<f64> {
    let nothing = f64::NAN;
    let margin = summary.capacity.as_ref().map_or(nothing, |c| c.factor);
    let overload = summary
        .gross_slip
        .as_ref()
        .map_or(nothing, |slip| slip.overload);
    let Some(steady) = &summary.steady else {
        return vec![
            nothing, nothing, nothing, nothing, nothing, margin, overload,
        ];
    };
    let residual = summary.audit.map_or(nothing, |audit| audit.power_residual);
    let mut values = vec![
        steady.speed_loss,
        steady.power_in,
        steady.power_out,
        steady.power_lost,
        steady.efficiency.unwrap_or(nothing),
        margin,
        overload,
        residual,
    ];
    values.extend(by_part(steady));
    values
}

fn by_part(steady: &Steady) -> Vec<f64> {
    let pulleys = steady.pulley.0.iter().flat_map(|(_, pulley)| {
        let p = &pulley.report;
        let hub = p.hub_force[0].hypot(p.hub_force[1]);
        [
            p.speed,
            p.external_torque,
            hub,
            p.slip_angle,
            p.contact_angle,
        ]
    });
    pulleys
        .chain(steady.span.0.iter().map(|(_, span)| span.tension))
        .collect()
}
