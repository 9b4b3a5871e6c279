//! Numbers that a structure is described by, checked before anything is built from them.

use super::StructureError;

/// Refuses `values` of which one is not finite; `what` names them.
pub(super) fn finite(
    what: &str,
    mut values: impl Iterator<Item = f64>,
) -> Result<(), StructureError> {
    match values.find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(StructureError::Value {
            what: what.to_owned(),
            value,
            remedy: "finite",
        }),
    }
}
