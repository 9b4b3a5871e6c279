//! Numbers that no material, section or element can have.

use thiserror::Error;

/// A number that is no number, or out of the range in which what it describes can exist.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{what} is {value}; it must be {remedy}")]
pub struct Unsound {
    /// What the number is, with its unit.
    pub what: &'static str,
    /// The number.
    pub value: f64,
    /// What it must be.
    pub remedy: &'static str,
}

/// Refuses all but positive and finite numbers.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), Unsound> {
    within(
        what,
        value,
        value > 0.0 && value.is_finite(),
        "positive and finite",
    )
}

/// Refuses a number that does not fit.
pub(crate) fn within(
    what: &'static str,
    value: f64,
    fits: bool,
    remedy: &'static str,
) -> Result<(), Unsound> {
    if fits {
        Ok(())
    } else {
        Err(Unsound {
            what,
            value,
            remedy,
        })
    }
}
