//! Derivatives of what a drive settles to by the fields of its drive file, exact to round-off.
//!
//! A field is seeded as a dual number; belt path, stiffness, closure and results carry its derivative
//! along: no differences are taken. Results have the kinks that
//! [`string::sensitivity`](crate::steady::string::sensitivity) names. A radius is changed with the
//! centres kept, a belt's `length` with everything else.

use num_dual::Dual64;
use thiserror::Error;

use super::numbers::{Field, Path};
use super::{DriveString, SteadyError};
use crate::input::nearest;
use crate::number::Number;
use crate::steady::string::{Answer, Running};

/// Results of a running drive and their derivatives by fields of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveSensitivity {
    /// The results.
    pub outputs: Vec<Output>,
    /// The fields, with the derivatives of all results by each.
    pub inputs: Vec<Input>,
}

/// A result.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name as in `summary.json`: `pulley.driven.speed`, `span.driver-driven.tension`.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Value, SI.
    pub value: f64,
}

/// A field of the drive file.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its path: `belt.length`, `pulley.driven.radius`.
    pub key: String,
    /// Unit.
    pub unit: &'static str,
    /// Value, SI; of a profile the one that it ends with.
    pub value: f64,
    /// `derivatives[r]`: of result `r` by this field, SI.
    pub derivatives: Vec<f64>,
}

impl Input {
    /// Relative change of `output`, the result of index `r`, per relative change of this field [-];
    /// none where the result is zero.
    pub fn elasticity(&self, r: usize, output: &Output) -> Option<f64> {
        let elasticity = self.derivatives.get(r)? * self.value / output.value;
        (output.value != 0.0).then_some(elasticity)
    }
}

/// A key that is no input of the string theory.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{key}` is no field that the theory of the string reads")]
pub struct UnknownInput {
    /// The key asked for.
    pub key: String,
    /// A field of a similar name.
    pub nearest: Option<String>,
    /// All fields that it reads.
    pub known: Vec<String>,
}

impl DriveString {
    /// The fields of the drive file that the theory reads: keys of [`Self::sensitivity`].
    pub fn inputs(&self) -> Vec<String> {
        let mut numbers = self.numbers.clone();
        let fields = numbers.fields().into_iter();
        fields.map(|(field, ..)| self.key(field)).collect()
    }

    /// Positions in [`Self::inputs`] of fields given by key; pulleys by name or by number from 0.
    pub fn find_inputs(&self, keys: &[String]) -> Result<Vec<usize>, UnknownInput> {
        let mut numbers = self.numbers.clone();
        let fields: Vec<_> = numbers.fields().into_iter().map(|(f, ..)| f).collect();
        let find = |key: &String| {
            let position = fields.iter().position(|field| {
                *key == self.key(*field)
                    || matches!(field, Field::Pulley(i, name) if *key == format!("pulley.{i}.{name}"))
            });
            position.ok_or_else(|| {
                let known = self.inputs();
                UnknownInput {
                    key: key.clone(),
                    nearest: nearest(key, known.iter().map(String::as_str)).map(str::to_owned),
                    known,
                }
            })
        };
        keys.iter().map(find).collect()
    }

    /// Derivatives of the results by the fields at `positions` in [`Self::inputs`]; nothing where the
    /// drive does not run.
    pub fn sensitivity(
        &self,
        positions: &[usize],
    ) -> Result<Option<DriveSensitivity>, SteadyError> {
        let Answer::Running(running) = self.solve()? else {
            return Ok(None);
        };
        let outputs = self.outputs(&running, &self.numbers.path(&self.layout));
        let outputs = outputs
            .into_iter()
            .map(|(name, unit, value)| Output { name, unit, value });
        let mut inputs = Vec::with_capacity(positions.len());
        for &position in positions {
            let mut seeded = self.numbers.map(Dual64::from_re);
            let Some((field, unit, number)) = seeded.fields().into_iter().nth(position) else {
                continue;
            };
            number.eps = 1.0;
            let (key, value) = (self.key(field), number.re);
            let path = seeded.path(&self.layout);
            let string = seeded.string(
                &path,
                &self.layout,
                &self.order,
                self.direction,
                (self.string.model, self.string.closure),
            );
            // The same drive: it runs as the plain one does.
            let Answer::Running(running) = string.solve().map_err(|error| self.named(error))?
            else {
                return Ok(None);
            };
            let outputs = self.outputs(&running, &path);
            inputs.push(Input {
                key,
                unit,
                value,
                derivatives: outputs.into_iter().map(|(.., value)| value.eps).collect(),
            });
        }
        Ok(Some(DriveSensitivity {
            outputs: outputs.collect(),
            inputs,
        }))
    }

    fn key(&self, field: Field) -> String {
        match field {
            Field::Whole(table, name) => format!("{table}.{name}"),
            Field::Pulley(i, name) => format!("pulley.{}.{name}", self.names[i]),
        }
    }

    /// All results with their units, always in the same order.
    fn outputs<D: Number>(
        &self,
        running: &Running<D>,
        path: &Path<D>,
    ) -> Vec<(String, &'static str, D)> {
        let mut outputs = Vec::new();
        for i in 0..self.names.len() {
            let p = self.pulley(running, path, i);
            let parts = [
                ("speed", "rad/s", p.speed),
                ("torque", "N m", p.torque),
                ("external_torque", "N m", p.external_torque),
                ("power", "W", p.power),
                ("hub_force_x", "N", p.hub_force[0]),
                ("hub_force_y", "N", p.hub_force[1]),
                ("slip_speed", "m/s", p.slip_speed),
                ("wrap_angle", "rad", p.wrap_angle),
                ("slip_angle", "rad", p.slip_angle),
                ("stick_angle", "rad", p.stick_angle),
                ("speed_loss", "-", p.speed_loss),
                ("friction_loss", "W", p.friction_loss),
            ];
            let named = |(part, unit, value)| (format!("pulley.{}.{part}", p.name), unit, value);
            outputs.extend(parts.map(named));
        }
        for i in 0..self.names.len() {
            let s = self.span(running, path, i);
            let parts = [
                ("tension", "N", s.tension),
                ("pressing_tension", "N", s.pressing_tension),
                ("strain", "-", s.strain),
                ("speed", "m/s", s.speed),
                ("length", "m", s.length),
            ];
            let named = |(part, unit, value)| (format!("span.{}.{part}", s.name), unit, value);
            outputs.extend(parts.map(named));
        }
        let mut whole = |name: &str, unit, value| outputs.push((name.to_owned(), unit, value));
        whole("power_in", "W", running.power_in);
        whole("power_out", "W", running.power_out);
        whole("power_lost", "W", running.friction_loss);
        if let Some(efficiency) = running.efficiency {
            whole("efficiency", "-", efficiency);
        }
        if let Some(capacity) = &running.capacity {
            whole("capacity.factor", "-", capacity.factor);
            let torque = if capacity.torque.re() < 0.0 {
                -capacity.torque
            } else {
                capacity.torque
            };
            whole("capacity.largest_torque", "N m", torque);
        }
        outputs
    }
}

#[cfg(test)]
mod tests;
