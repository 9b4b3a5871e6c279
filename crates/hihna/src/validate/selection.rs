//! Cases by name.

use thiserror::Error;

use super::Case;
use crate::input::nearest;

/// No case has this name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no validation case or group `{name}`")]
pub struct UnknownCase {
    /// The name asked for.
    pub name: String,
    /// A case or group of a similar name.
    pub nearest: Option<String>,
}

/// The cases that `names` pick, in the order of the catalogue; no names pick all.
///
/// A name is that of a case, or of a group: the beginning of names up to a `/` or a `-`, such as
/// `chapter-2`.
pub fn select<'a>(cases: &'a [Case], names: &[String]) -> Result<Vec<&'a Case>, UnknownCase> {
    for name in names {
        if !cases.iter().any(|case| picks(name, &case.name)) {
            let groups = cases.iter().filter_map(|case| case.name.split_once('/'));
            let known = cases
                .iter()
                .map(|case| case.name.as_str())
                .chain(groups.map(|(group, _)| group));
            return Err(UnknownCase {
                nearest: nearest(name, known).map(str::to_owned),
                name: name.clone(),
            });
        }
    }
    Ok(cases
        .iter()
        .filter(|case| names.is_empty() || names.iter().any(|name| picks(name, &case.name)))
        .collect())
}

fn picks(name: &str, case: &str) -> bool {
    case.strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(['/', '-']))
}
