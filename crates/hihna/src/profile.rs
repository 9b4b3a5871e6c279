//! Functions of time that drives prescribe: speeds, angles, torques.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scalar function of time, continuous, with finitely many kinks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Profile {
    /// The same value at all times.
    Constant(f64),
    /// A value that changes in time.
    Varying(Varying),
}

/// The kinds of time-varying profiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Varying {
    /// Linear from `from` at `start` to `to` at `end`, constant outside.
    Ramp {
        /// Value before `start`.
        from: f64,
        /// Value after `end`.
        to: f64,
        /// Start of the change [s].
        start: f64,
        /// End of the change [s].
        end: f64,
    },
    /// Half a cosine from `from` at `start` to `to` at `end`, constant outside.
    HalfCosine {
        /// Value before `start`.
        from: f64,
        /// Value after `end`.
        to: f64,
        /// Start of the change [s].
        start: f64,
        /// End of the change [s].
        end: f64,
    },
    /// Linear between the given points, constant outside.
    Table {
        /// Times [s], increasing.
        time: Vec<f64>,
        /// Value at each time.
        value: Vec<f64>,
    },
}
