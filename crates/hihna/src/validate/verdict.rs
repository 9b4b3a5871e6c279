//! A computed value beside the published one, and the verdict.

use serde::Serialize;

use super::{Case, Row};

/// One row of the validation: an object of `hihna validate --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the case.
    pub case: String,
    /// The quantity.
    pub quantity: String,
    /// Unit of all values of the row.
    pub unit: String,
    /// As printed; nothing where only words or a figure say it.
    pub published: Option<f64>,
    /// What is stated in words or by a figure's shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statement: Option<String>,
    /// What is judged against where it is not the printed value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<f64>,
    /// Nothing for another program's value, and where the computation failed.
    pub computed: Option<f64>,
    /// Computed less reference or published value; outside a bound, the distance to it.
    pub deviation: Option<f64>,
    /// Largest allowed magnitude of the deviation.
    pub tolerance: Option<f64>,
    /// Least value that agrees with the statement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// Largest value that agrees with the statement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// Nothing where the row is only shown.
    pub passed: Option<bool>,
    /// Publication, section, figure or table.
    pub source: String,
    /// Why the tolerance or the bound is what it is.
    pub reason: String,
    /// Misprints and readings; why the computation failed.
    pub note: String,
    /// Decimals that are printed of the published value.
    #[serde(skip)]
    pub decimals: Option<usize>,
}

/// What a row says about the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The computed value agrees with the published one.
    Passed,
    /// It does not, or there is none.
    Failed,
    /// It is not judged.
    Shown,
}

impl Finding {
    /// Judges `computed`; a judged row without a value fails, whatever the reason.
    pub(super) fn new(
        case: &Case,
        row: &Row,
        computed: Option<f64>,
        error: Option<String>,
    ) -> Self {
        let deviation = computed.and_then(|value| row.deviation(value));
        Self {
            case: case.name.clone(),
            quantity: row.quantity.clone(),
            unit: row.unit.clone(),
            published: row.published,
            statement: row.statement.clone(),
            reference: row.reference,
            computed,
            deviation,
            tolerance: row.tolerance,
            at_least: row.at_least,
            at_most: row.at_most,
            passed: row
                .is_judged()
                .then(|| deviation.is_some_and(|deviation| row.allows(deviation))),
            source: case.source.clone(),
            reason: row.reason.clone(),
            note: match error {
                Some(error) if row.computed => format!("not computed: {error}"),
                _ => row.note.clone(),
            },
            decimals: row.decimals,
        }
    }

    /// Passed, failed or only shown.
    pub fn verdict(&self) -> Verdict {
        match self.passed {
            Some(true) => Verdict::Passed,
            Some(false) => Verdict::Failed,
            None => Verdict::Shown,
        }
    }
}

impl Row {
    fn deviation(&self, computed: f64) -> Option<f64> {
        if let Some(target) = self.reference.or(self.published) {
            return Some(computed - target);
        }
        let (low, high) = (self.at_least, self.at_most);
        if low.is_none() && high.is_none() {
            return None;
        }
        let below = low.map_or(0.0, |low| (computed - low).min(0.0));
        let above = high.map_or(0.0, |high| (computed - high).max(0.0));
        // `min` and `max` drop NaN, which must not pass for an agreement.
        Some(if computed.is_nan() {
            computed
        } else {
            below + above
        })
    }

    fn allows(&self, deviation: f64) -> bool {
        deviation.abs() <= self.tolerance.unwrap_or(0.0)
    }
}
