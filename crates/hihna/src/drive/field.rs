//! How fields are written: defaults are left out, counts fit TOML's integers.

use serde::Serializer;

/// Whether a field is not worth a line.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Writes a count; one beyond the range of TOML's integers, which no drive may have, is cut to it.
#[allow(clippy::trivially_copy_pass_by_ref)] // serde's signature
pub(super) fn count<S: Serializer>(count: &usize, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_i64(i64::try_from(*count).unwrap_or(i64::MAX))
}
