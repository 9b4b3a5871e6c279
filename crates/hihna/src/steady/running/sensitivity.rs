//! Derivatives of what was found by fields of the drive, by implicit differentiation.
//!
//! With the converged equations `F(z, p) = 0` and the results `y(z, p)`
//!
//! ```text
//! J dz/dp = dF/dp      J = -dF/dz, the tangent of the last iteration      dy/dp = y_z dz/dp + y_p
//! ```
//!
//! so that a field costs a few solutions with a factored matrix. `dz/dp` is corrected by what the residual along the line `z + h dz/dp`,
//! `p + h` still changes,
//!
//! ```text
//! J delta = d/dh F(z + h dz/dp, p + h)
//! ```
//!
//! from zero on: once where J is exact, more often for bristles, whose phases in slip zones take part in J without their motion.
//! The derivative along the line is taken from four residuals (error of order h⁴), and dy/dp along the same line (order h²), with h a ten
//! millionth of the field. Larger steps meet corners of the contact law, which lie close together on coarse meshes: belts sink
//! in by 1e-4 to 1e-3 of lengths. What round-off leaves is 1e-5 of E A over the field. The elements keep their parts of the
//! belt, and the mesh its phase.

use ancf::linear::Solver;

use super::summary::{RunningSummary, Steady};
use super::{Outcome, Running, RunningBelt, RunningError};
use crate::assemble::BeltElementType;
use crate::drive::Drive;
use crate::input::NumberField;
use crate::steady::drive_string::{DriveSensitivity, Input, Output};

/// Step, relative to the field.
const STEP: f64 = 1.0e-7;
/// Step of a field that is zero, SI.
const STEP_FROM_ZERO: f64 = 1.0e-6;
/// Correction of `dz/dp`, relative to it, that counts as converged.
const CONVERGED: f64 = 1.0e-8;
/// The same where round-off keeps corrections from shrinking, and what counts as none of a field that hardly matters: relative to the
/// unknowns, for a field that is doubled.
const ROUND_OFF: f64 = 1.0e-5;
const NOTHING: f64 = 1.0e-8;
/// Most corrections.
const MOST_CORRECTIONS: usize = 100;

impl<E: BeltElementType> RunningBelt<E> {
    /// Derivatives of the results of `running`, the state in which this belt of `drive` runs, by `fields`.
    pub fn sensitivity(
        &mut self,
        drive: &Drive,
        running: &Running,
        fields: &[NumberField],
    ) -> Result<DriveSensitivity, RunningError> {
        let z = &running.state;
        self.newton
            .factor(&mut self.equations, z)
            .map_err(|_| RunningError::Singular)?;
        let outputs: Vec<Output> = self.results(drive, z);
        let mut inputs = Vec::with_capacity(fields.len());
        for field in fields {
            let value = field.value(drive);
            let h = if value == 0.0 {
                STEP_FROM_ZERO
            } else {
                STEP * value.abs()
            };
            let by_field = self.by_field(drive, z, (field, value, h))?;
            let mut ends = Vec::with_capacity(2);
            for step in [h, -h] {
                let there: Vec<f64> = (z.iter().zip(&by_field))
                    .map(|(z, d)| z + step * d)
                    .collect();
                let changed = field
                    .with(drive, value + step)
                    .map_err(|error| RunningError::refused(&error))?;
                let mut moved = self.neighbour(drive, field, value + step)?;
                ends.push(moved.results(&changed, &there));
            }
            let derivatives = (ends[0].iter().zip(&ends[1]))
                .map(|(up, down)| (up.value - down.value) / (2.0 * h))
                .collect();
            inputs.push(Input {
                key: field.key.clone(),
                unit: field.unit,
                value,
                derivatives,
            });
        }
        Ok(DriveSensitivity { outputs, inputs })
    }

    /// `dz/dp` by the field of the value p, from steps h.
    fn by_field(
        &mut self,
        drive: &Drive,
        z: &[f64],
        (field, value, h): (&NumberField, f64, f64),
    ) -> Result<Vec<f64>, RunningError> {
        let mut by_field = vec![0.0; z.len()];
        let mut correction = vec![0.0; z.len()];
        let (mut there, mut residual) = (z.to_vec(), z.to_vec());
        let stencil = [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)];
        let mut moved = Vec::with_capacity(stencil.len());
        for (steps, weight) in stencil {
            let belt = self.neighbour(drive, field, value + steps * h)?;
            moved.push((belt, steps * h, weight / (12.0 * h)));
        }
        let scales = self.equations.scales.clone();
        let size = |x: &[f64]| {
            (x.iter().zip(&scales)).fold(0.0, |most: f64, (x, s)| most.max((x * s).abs()))
        };
        let mut before = f64::INFINITY;
        for _ in 0..MOST_CORRECTIONS {
            correction.fill(0.0);
            for (belt, step, weight) in &mut moved {
                for ((there, z), d) in there.iter_mut().zip(z).zip(&by_field) {
                    *there = z + *step * d;
                }
                belt.equations.residual(&there, &mut residual);
                for (sum, r) in correction.iter_mut().zip(&residual) {
                    *sum += *weight * r;
                }
            }
            self.newton.solver.solve(&mut correction);
            for (d, more) in by_field.iter_mut().zip(&correction) {
                *d += more;
            }
            let (more, whole) = (size(&correction), size(&by_field));
            let stalled = more > 0.5 * before;
            before = more;
            let hardly_matters = value != 0.0 && more * value.abs() <= NOTHING * size(z);
            let small = more <= ROUND_OFF * whole || hardly_matters;
            if more <= CONVERGED * whole || (stalled && small) {
                return Ok(by_field);
            }
            if !more.is_finite() {
                break;
            }
        }
        Err(RunningError::Derivatives {
            field: field.key.clone(),
            left: before,
        })
    }

    /// The same belt with another value of one field: same parts of the belt, same phase.
    fn neighbour(
        &self,
        drive: &Drive,
        field: &NumberField,
        value: f64,
    ) -> Result<Self, RunningError> {
        let changed = field
            .with(drive, value)
            .map_err(|error| RunningError::refused(&error))?;
        let mut other = Self::unsettled(&changed, &self.starts)?;
        other.equations.phase = self.equations.phase;
        other.start = self.start;
        other.guess.clone_from(&self.guess);
        Ok(other)
    }

    /// The results of the unknowns `z` by the names that they have in `summary.json`.
    fn results(&mut self, drive: &Drive, z: &[f64]) -> Vec<Output> {
        let outcome = Outcome {
            answer: super::Answer::Running(Box::new(self.observe(z))),
            capacity: None,
            layout: self.layout().clone(),
            mounting: *self.mounting(),
            start: self.start,
            dofs: self.dofs(),
            warnings: Vec::new(),
        };
        RunningSummary::new(drive, &outcome)
            .steady
            .map_or_else(Vec::new, |steady| outputs(&steady))
    }
}

fn outputs(steady: &Steady) -> Vec<Output> {
    let mut outputs = Vec::new();
    let mut add = |name: String, unit, value| outputs.push(Output { name, unit, value });
    for (name, pulley) in &steady.pulley.0 {
        let p = &pulley.report;
        for (part, unit, value) in [
            ("speed", "rad/s", p.speed),
            ("torque", "N m", p.torque),
            ("external_torque", "N m", p.external_torque),
            ("power", "W", p.power),
            ("hub_force_x", "N", p.hub_force[0]),
            ("hub_force_y", "N", p.hub_force[1]),
            ("slip_speed", "m/s", p.slip_speed),
            ("wrap_angle", "rad", p.wrap_angle),
            ("contact_angle", "rad", p.contact_angle),
            ("slip_angle", "rad", p.slip_angle),
            ("stick_angle", "rad", pulley.stick_angle),
            ("speed_loss", "-", p.speed_loss),
            ("friction_loss", "W", p.friction_loss),
        ] {
            add(format!("pulley.{name}.{part}"), unit, value);
        }
    }
    for (name, s) in &steady.span.0 {
        for (part, unit, value) in [
            ("tension", "N", s.tension),
            ("strain", "-", s.strain),
            ("speed", "m/s", s.speed),
        ] {
            add(format!("span.{name}.{part}"), unit, value);
        }
    }
    add("circulation_speed".into(), "m/s", steady.circulation_speed);
    add("power_in".into(), "W", steady.power_in);
    add("power_out".into(), "W", steady.power_out);
    add("power_lost".into(), "W", steady.power_lost);
    if let Some(efficiency) = steady.efficiency {
        add("efficiency".into(), "-", efficiency);
    }
    outputs
}
