//! Linear equations with constant coefficients: pins, clamps, rollers, joints, prescribed motion.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::ConstraintError;
use crate::state::{Motion, State};

/// Coefficients below this part of the largest are what rounding left of zero.
const VANISHED: f64 = 1.0e-12;

/// One equation `sum_i c_i q_i = g(t)`.
#[derive(Debug)]
pub struct LinearEquation {
    /// What the user calls the constraint; several equations may share it.
    pub name: String,
    /// Coordinates and coefficients.
    pub terms: Vec<(usize, f64)>,
    /// The right-hand side and its derivatives.
    pub value: Arc<dyn Motion>,
}

impl LinearEquation {
    /// `C` and its rate.
    pub(super) fn values(&self, state: State<'_>) -> [f64; 2] {
        let [value, rate, _] = self.value.at(state.time);
        let sum = |x: &[f64]| self.terms.iter().map(|(i, c)| c * x[*i]).sum::<f64>();
        [sum(state.q) - value, sum(state.v) - rate]
    }
}

/// An equation solved for a coordinate of its own: `q_d = sum_k s_k g_k(t) - sum_i c_i q_i`.
#[derive(Clone, Debug)]
pub(super) struct ReducedEquation {
    pub name: String,
    pub dependent: usize,
    pub terms: Vec<(usize, f64)>,
    /// Equations and factors that the right-hand side is made of.
    pub sources: Vec<(usize, f64)>,
}

struct Row {
    name: String,
    dependent: usize,
    terms: BTreeMap<usize, f64>,
    sources: BTreeMap<usize, f64>,
}

impl Row {
    fn subtract(&mut self, factor: f64, other: &Row) {
        for (i, value) in &other.terms {
            *self.terms.entry(*i).or_default() -= factor * value;
        }
        for (k, value) in &other.sources {
            *self.sources.entry(*k).or_default() -= factor * value;
        }
    }

    fn clean(&mut self, largest: f64) {
        self.terms
            .retain(|_, value| value.abs() > VANISHED * largest);
    }
}

/// Gauss-Jordan elimination. Coordinates below `chain` are preferred as dependent ones.
pub(super) fn reduce(
    equations: &[LinearEquation],
    chain: usize,
    prescribed: &[usize],
) -> Result<Vec<ReducedEquation>, ConstraintError> {
    let mut rows: Vec<Row> = Vec::new();
    for (k, equation) in equations.iter().enumerate() {
        let largest = (equation.terms.iter()).fold(0.0_f64, |m, (_, value)| m.max(value.abs()));
        let mut row = Row {
            name: equation.name.clone(),
            dependent: 0,
            terms: BTreeMap::new(),
            sources: BTreeMap::from([(k, 1.0)]),
        };
        for (i, value) in &equation.terms {
            *row.terms.entry(*i).or_default() += value;
        }
        for other in &rows {
            if let Some(factor) = row.terms.get(&other.dependent).copied() {
                row.subtract(factor, other);
                row.terms.remove(&other.dependent);
            }
        }
        row.clean(largest);
        if row.terms.is_empty() {
            return Err(no_pivot(equations, &row));
        }
        let Some(dependent) = pivot(&row, chain, prescribed) else {
            return Err(ConstraintError::Overdetermined {
                name: row.name,
                others: vec!["prescribed motions".to_owned()],
            });
        };
        let scale = row.terms.remove(&dependent).unwrap_or(1.0);
        row.dependent = dependent;
        row.terms.values_mut().for_each(|value| *value /= scale);
        row.sources.values_mut().for_each(|value| *value /= scale);
        for other in &mut rows {
            if let Some(factor) = other.terms.remove(&dependent) {
                other.subtract(factor, &row);
                other.clean(1.0);
            }
        }
        rows.push(row);
    }
    Ok(rows
        .into_iter()
        .map(|row| ReducedEquation {
            name: row.name,
            dependent: row.dependent,
            terms: row.terms.into_iter().collect(),
            sources: (row.sources.into_iter())
                .filter(|(_, factor)| *factor != 0.0)
                .collect(),
        })
        .collect())
}

/// The coordinate that an equation determines: among the large coefficients one of the chain, the
/// last of those.
fn pivot(row: &Row, chain: usize, prescribed: &[usize]) -> Option<usize> {
    let free = || (row.terms.iter()).filter(|(i, _)| !prescribed.contains(i));
    let largest = free().fold(0.0_f64, |m, (_, value)| m.max(value.abs()));
    free()
        .filter(|(_, value)| value.abs() >= 0.5 * largest)
        .map(|(i, _)| *i)
        .max_by_key(|i| (*i < chain, *i))
}

/// The error for an equation whose coefficients vanish after elimination.
fn no_pivot(equations: &[LinearEquation], row: &Row) -> ConstraintError {
    let mut names: Vec<String> = Vec::new();
    let (mut excess, mut scale) = (0.0, 0.0_f64);
    for (k, factor) in row.sources.iter().filter(|(_, factor)| **factor != 0.0) {
        let term = factor * equations[*k].value.at(0.0)[0];
        excess += term;
        scale = scale.max(term.abs());
        if !names.contains(&equations[*k].name) {
            names.push(equations[*k].name.clone());
        }
    }
    if excess.abs() > VANISHED * scale {
        ConstraintError::Contradiction { names, excess }
    } else {
        ConstraintError::Repetition { names }
    }
}
