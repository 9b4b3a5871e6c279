//! The published side: the data files under `validation/`.

use serde::Deserialize;
use thiserror::Error;

use super::{COMPUTATIONS, Compute, DATA, Finding};

/// A group of published values that one computation reproduces.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name: group, `/`, topic.
    pub name: String,
    /// What it is about.
    pub title: String,
    /// Publication, section, figure or table.
    pub source: String,
    /// Its quantities.
    pub rows: Vec<Row>,
    compute: Compute,
}

/// A quantity, what is published of it, and how the computed value is judged.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name, unique in its case.
    pub quantity: String,
    /// Unit of the values.
    #[serde(default = "dimensionless")]
    pub unit: String,
    /// The value as printed.
    pub published: Option<f64>,
    /// What is stated in words or by a figure's shape.
    pub statement: Option<String>,
    /// The value to judge against where the printed one is a misprint or none is printed.
    pub reference: Option<f64>,
    /// Largest magnitude of the deviation, absolute.
    pub tolerance: Option<f64>,
    /// Least value that agrees with the statement.
    pub at_least: Option<f64>,
    /// Largest value that agrees with the statement.
    pub at_most: Option<f64>,
    /// Why the tolerance or the bound is what it is; by default that of the case.
    #[serde(default)]
    pub reason: String,
    /// Misprints and readings.
    #[serde(default)]
    pub note: String,
    /// Decimals that are printed of the published value; by default those of the case.
    pub decimals: Option<usize>,
    /// Whether the program computes it; another program's value is only shown.
    #[serde(default = "yes")]
    pub computed: bool,
}

fn dimensionless() -> String {
    "-".to_owned()
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    publication: String,
    case: Vec<CaseData>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CaseData {
    name: String,
    title: String,
    source: String,
    /// Reason of the rows that give none.
    #[serde(default)]
    reason: String,
    /// Printed decimals of the rows that give none.
    decimals: Option<usize>,
    /// Unit of the rows that give none.
    unit: Option<String>,
    /// Tolerance of the rows with a printed value that are computed and give none.
    tolerance: Option<f64>,
    row: Vec<Row>,
}

/// The embedded data is not what the program expects: a defect of the program, not of its input.
#[derive(Debug, Error)]
pub enum CatalogueError {
    /// A data file is not read.
    #[error("a validation data file cannot be read: {0}")]
    Data(#[from] toml::de::Error),
    /// A case of the data has no computation.
    #[error("the validation case `{0}` has no computation")]
    NoComputation(String),
}

/// All cases, in the order of the data files.
pub fn catalogue() -> Result<Vec<Case>, CatalogueError> {
    let mut cases = Vec::new();
    for text in DATA {
        let File { publication, case } = toml::from_str(text)?;
        for data in case {
            cases.push(data.case(&publication)?);
        }
    }
    Ok(cases)
}

impl CaseData {
    fn case(self, publication: &str) -> Result<Case, CatalogueError> {
        let found = COMPUTATIONS.iter().find(|(name, _)| *name == self.name);
        let Some((_, compute)) = found else {
            return Err(CatalogueError::NoComputation(self.name));
        };
        let mut rows = self.row;
        for row in &mut rows {
            if row.reason.is_empty() && row.is_judged_by(self.tolerance) {
                row.reason.clone_from(&self.reason);
            }
            if row.is_judged_by(self.tolerance) && row.statement.is_none() {
                row.tolerance = row.tolerance.or(self.tolerance);
            }
            row.decimals = row.decimals.or(self.decimals);
            if let (Some(unit), "-") = (&self.unit, row.unit.as_str()) {
                row.unit.clone_from(unit);
            }
        }
        Ok(Case {
            source: format!("{publication}, {}", self.source),
            name: self.name,
            title: self.title,
            rows,
            compute: *compute,
        })
    }
}

impl Row {
    fn is_judged_by(&self, tolerance: Option<f64>) -> bool {
        let target = self.published.or(self.reference);
        let bounded = self.at_least.or(self.at_most);
        self.computed && (bounded.is_some() || target.and(self.tolerance.or(tolerance)).is_some())
    }

    /// Whether the computed value is judged, not only shown.
    pub fn is_judged(&self) -> bool {
        self.is_judged_by(None)
    }
}

impl Case {
    /// Computes the case and judges its rows.
    pub fn findings(&self) -> Vec<Finding> {
        let computed = (self.compute)();
        self.rows
            .iter()
            .map(|row| match &computed {
                Ok(values) => {
                    let value = values
                        .iter()
                        .find(|(quantity, _)| *quantity == row.quantity)
                        .map(|(_, value)| *value);
                    Finding::new(self, row, value, None)
                }
                Err(error) => Finding::new(self, row, None, Some(error.to_string())),
            })
            .collect()
    }
}
