//! `hihna steady --sensitivity`: how results change with fields of the drive file.

use std::fmt::Write;

use hihna::steady::drive_string::{DriveSensitivity, DriveString, SteadyError, UnknownInput};
use hihna::summary::Named;
use serde::Serialize;

use crate::diagnostics::Failure;
use crate::quantities::significant;
use crate::tables::columns;

/// Parts of results that the table leaves to `--json`: they say nothing that its rows do not.
const LEFT_OUT: [&str; 8] = [
    ".torque",
    ".power",
    ".stick_angle",
    ".slip_speed",
    ".friction_loss",
    ".pressing_tension",
    ".strain",
    ".contact_angle",
];

/// Elasticities below this are the round-off of terms that cancel; the table shows them as zero.
const ROUND_OFF: f64 = 1.0e-13;

/// The results by one field of the drive file.
#[derive(Debug, Serialize)]
pub struct FieldSensitivity {
    unit: &'static str,
    value: f64,
    /// By the results' names as paths into `steady` and `capacity`.
    results: Named<Change>,
}

#[derive(Debug, Serialize)]
struct Change {
    unit: &'static str,
    value: f64,
    derivative: f64,
    /// Relative change by relative change; null where the result is zero.
    elasticity: Option<f64>,
}

/// Field by field, by its path.
pub type SensitivitySummary = Named<FieldSensitivity>;

/// Sensitivities by the fields of `keys`, once these are known to be inputs; nothing of a drive that
/// does not run.
pub fn summary(
    string: &DriveString,
    positions: &[usize],
) -> Result<Option<SensitivitySummary>, SteadyError> {
    let found = string.sensitivity(positions)?;
    Ok(found.map(|found| by_field(&found)))
}

pub(super) fn by_field(found: &DriveSensitivity) -> SensitivitySummary {
    let fields = found.inputs.iter().map(|input| {
        let results = found.outputs.iter().enumerate().map(|(r, output)| {
            let change = Change {
                unit: output.unit,
                value: output.value,
                derivative: input.derivatives[r],
                elasticity: input.elasticity(r, output),
            };
            (output.name.clone(), change)
        });
        let field = FieldSensitivity {
            unit: input.unit,
            value: input.value,
            results: Named(results.collect()),
        };
        (input.key.clone(), field)
    });
    Named(fields.collect())
}

/// A key that the theory does not read, as an argument that is wrong.
pub fn unknown(error: &UnknownInput) -> Failure {
    let near = error
        .nearest
        .as_ref()
        .map_or_else(String::new, |near| format!("did you mean `{near}`? "));
    Failure::Argument {
        message: error.to_string(),
        help: format!("{near}it reads {}", error.known.join(", ")),
    }
}

/// A table a field.
pub fn in_words(fields: &SensitivitySummary) -> String {
    let mut text = String::new();
    for (key, field) in &fields.0 {
        let name = format!("by {key} = {} {}", significant(field.value), field.unit);
        let header = [
            name.as_str(),
            "value",
            "unit",
            "derivative",
            "per",
            "elasticity",
        ];
        let mut table = columns(&header, &[1, 3, 5]);
        for (name, result) in &field.results.0 {
            if LEFT_OUT.iter().any(|part| name.ends_with(part)) {
                continue;
            }
            let vanishes = result.elasticity.is_some_and(|e| e.abs() < ROUND_OFF);
            let shown = |value: f64| significant(if vanishes { 0.0 } else { value });
            table.add_row([
                name.clone(),
                significant(result.value),
                result.unit.to_owned(),
                shown(result.derivative),
                format!("({})/({})", result.unit, field.unit),
                result.elasticity.map_or_else(|| "-".to_owned(), shown),
            ]);
        }
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}\n", table.trim_fmt());
    }
    text
}
