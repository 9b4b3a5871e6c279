//! Fields of a drive that hold one number, by their path: what studies change.

use serde_json::Value;
use thiserror::Error;

use super::shape::{Bounds, Shape};
use super::{nearest, rules};
use crate::drive::Drive;
use crate::profile::{Profile, Varying};

/// A field that holds a number, or a profile in time, of which the value counts that it ends with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberField {
    /// Its path with pulleys by name: `pulley.driven.torque`.
    pub key: String,
    /// SI unit; empty for ratios.
    pub unit: &'static str,
    /// Names and indices on the way to it.
    path: Vec<String>,
}

/// A key that is no such field of the drive.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{key}` is no field of this drive that holds a number")]
pub struct UnknownNumber {
    /// The key asked for.
    pub key: String,
    /// A field of a similar name.
    pub nearest: Option<String>,
}

/// Why a drive with another number is none.
#[derive(Debug, Error)]
#[error("`{key}` cannot be {value}: {cause}")]
pub struct NumberRefused {
    key: String,
    value: f64,
    cause: String,
}

impl NumberField {
    /// The field of `drive` with the path `key`; pulleys by name or by number from 0.
    pub fn find(drive: &Drive, key: &str) -> Result<Self, UnknownNumber> {
        let all = Self::all(drive);
        let by_number = |field: &Self| field.path.join(".") == key;
        let found = all
            .iter()
            .find(|field| field.key == key || by_number(field));
        found.cloned().ok_or_else(|| UnknownNumber {
            key: key.to_owned(),
            nearest: nearest(key, all.iter().map(|field| field.key.as_str())).map(str::to_owned),
        })
    }

    /// All such fields that `drive` states.
    pub fn all(drive: &Drive) -> Vec<Self> {
        let mut found = Vec::new();
        walk(
            &tree(drive),
            Shape::of_drive(),
            &mut Vec::new(),
            &mut Vec::new(),
            &mut found,
        );
        found
    }

    /// Its value in `drive`, SI.
    pub fn value(&self, drive: &Drive) -> f64 {
        let tree = tree(drive);
        let end = self.path.iter().try_fold(&tree, |at, name| step(at, name));
        end.and_then(last_value).unwrap_or(f64::NAN)
    }

    /// `drive` with `value` in its place, SI; a profile becomes constant.
    pub fn with(&self, drive: &Drive, value: f64) -> Result<Drive, NumberRefused> {
        let mut tree = tree(drive);
        let end = self.path.iter().try_fold(&mut tree, |at, name| match at {
            Value::Object(fields) => fields.get_mut(name),
            Value::Array(items) => items.get_mut(name.parse::<usize>().ok()?),
            _ => None,
        });
        if let Some(end) = end {
            *end = Value::from(value);
        }
        serde_json::from_value(tree).map_err(|cause| self.refused(value, cause.to_string()))
    }

    /// Whether the field may have `value`, whatever the rest of the drive.
    pub fn check(&self, value: f64) -> Result<(), NumberRefused> {
        let bounds = quantity_at(Shape::of_drive(), &self.path).map(|(_, bounds)| bounds);
        match bounds.and_then(|bounds| bounds.broken_by(value, self.unit)) {
            Some(broken) => Err(self.refused(value, format!("it {broken}"))),
            None => Ok(()),
        }
    }

    fn refused(&self, value: f64, cause: String) -> NumberRefused {
        NumberRefused {
            key: self.key.clone(),
            value,
            cause,
        }
    }
}

/// What breaks a rule of drive files that involves several fields, if anything does: what [`NumberField::with`] leaves open.
pub fn broken_rule(drive: &Drive) -> Option<String> {
    let problems = rules::problems(drive);
    let first = problems.into_iter().next();
    first
        .or_else(|| rules::mounting(drive))
        .map(|problem| problem.message)
}

/// The quantity at the end of `path`.
fn quantity_at<'a>(shape: &'a Shape, path: &[String]) -> Option<(&'static str, &'a Bounds)> {
    let Some((name, rest)) = path.split_first() else {
        return quantity(shape);
    };
    match shape {
        Shape::List(item, _) => quantity_at(item, rest),
        Shape::Either(shapes) => shapes.iter().find_map(|shape| quantity_at(shape, path)),
        _ => (shape.fields().filter(|field| field.name == *name))
            .find_map(|field| quantity_at(&field.shape, rest)),
    }
}

fn tree(drive: &Drive) -> Value {
    // A drive has string keys only: this cannot fail.
    serde_json::to_value(drive).unwrap_or(Value::Null)
}

fn step<'a>(at: &'a Value, name: &str) -> Option<&'a Value> {
    match at {
        Value::Object(fields) => fields.get(name),
        Value::Array(items) => items.get(name.parse::<usize>().ok()?),
        _ => None,
    }
}

/// The number that a field holds or ends with.
fn last_value(value: &Value) -> Option<f64> {
    if let Some(number) = value.as_f64() {
        return Some(number);
    }
    match serde_json::from_value(value.clone()).ok()? {
        Profile::Constant(value) => Some(value),
        Profile::Varying(Varying::Ramp { to, .. } | Varying::HalfCosine { to, .. }) => Some(to),
        Profile::Varying(Varying::Table { value, .. }) => value.last().copied(),
    }
}

fn walk(
    value: &Value,
    shape: &Shape,
    names: &mut Vec<String>,
    path: &mut Vec<String>,
    found: &mut Vec<NumberField>,
) {
    if let Some((unit, _)) = quantity(shape)
        && last_value(value).is_some()
    {
        found.push(NumberField {
            key: names.join("."),
            unit,
            path: path.clone(),
        });
        return;
    }
    match (value, shape) {
        (Value::Object(fields), _) => {
            for (name, value) in fields {
                if let Some(field) = shape.fields().find(|field| field.name == *name) {
                    names.push(name.clone());
                    path.push(name.clone());
                    walk(value, &field.shape, names, path, found);
                    names.pop();
                    path.pop();
                }
            }
        }
        (Value::Array(items), Shape::List(item, _)) => {
            for (i, value) in items.iter().enumerate() {
                let name = value["name"]
                    .as_str()
                    .map_or_else(|| i.to_string(), str::to_owned);
                names.push(name);
                path.push(i.to_string());
                walk(value, item, names, path, found);
                names.pop();
                path.pop();
            }
        }
        _ => {}
    }
}

/// Unit and bounds of a quantity, or of a profile of one.
fn quantity(shape: &Shape) -> Option<(&'static str, &Bounds)> {
    match shape {
        Shape::Quantity(dimension, bounds) => Some((dimension.unit, bounds)),
        Shape::Either(shapes) => shapes.iter().find_map(quantity),
        _ => None,
    }
}
