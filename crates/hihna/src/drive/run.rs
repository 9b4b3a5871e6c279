//! The time run: how long, how exact, how it starts and ends, what it writes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::units;

/// The time run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// End of the run [s].
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub end_time: f64,
    /// Time between rows of the history [s].
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub output_interval: f64,
    /// Aimed-at relative accuracy of speeds and tensions [-].
    #[schemars(schema_with = "units::ratio", extend("exclusiveMinimum" = 0.0, "maximum" = 0.1))]
    pub accuracy: f64,
    /// Time step.
    pub step: Step,
    /// Time integrator.
    pub integrator: Integrator,
    /// State at time zero.
    pub start: Start,
    /// When the run ends.
    pub until: Until,
    /// Times at which the belt's profile is recorded [s]; empty: the end.
    #[schemars(schema_with = "units::times")]
    pub profile_times: Vec<f64>,
    /// The line of a belt in space that the profile shows: 0 for one edge, 1 for the other [-].
    #[serde(skip_serializing_if = "is_the_middle")]
    #[schemars(schema_with = "units::ratio", extend("minimum" = 0.0, "maximum" = 1.0))]
    pub profile_line: f64,
    /// Time between the frames of the moving belt [s]; absent: no frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))]
    pub frame_interval: Option<f64>,
    /// Time of the first frame [s].
    #[schemars(schema_with = "units::time", extend("minimum" = 0.0))]
    pub frame_start: f64,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            end_time: 1.5,
            output_interval: 1.0e-3,
            accuracy: 1.0e-3,
            step: Step::Named(AutoStep::Auto),
            integrator: Integrator::Auto,
            start: Start::Rest,
            until: Until::End,
            profile_times: Vec::new(),
            profile_line: MIDDLE,
            frame_interval: None,
            frame_start: 0.0,
        }
    }
}

/// The time step: chosen by the program, or fixed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Step {
    /// Fixed [s].
    Fixed(#[schemars(schema_with = "units::time", extend("exclusiveMinimum" = 0.0))] f64),
    /// Chosen from `accuracy`.
    Named(AutoStep),
}

/// The one named step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AutoStep {
    /// Chosen from `accuracy`.
    Auto,
}

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Generalized-alpha with TR-BDF2 as fall-back.
    #[default]
    Auto,
    /// Generalized-alpha alone.
    GeneralizedAlpha,
    /// TR-BDF2 alone.
    TrBdf2,
    /// Explicit Runge-Kutta of fourth order.
    RungeKutta,
}

/// State at time zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Equilibrium at rest on the pulleys, without friction.
    #[default]
    Rest,
    /// Steady running with the values that all profiles have at time zero.
    Steady,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Until {
    /// At `end_time`.
    #[default]
    End,
    /// When the means of speeds and tensions have settled, at `end_time` at the latest.
    Steady,
}

/// The line in the middle of the belt.
const MIDDLE: f64 = 0.5;

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_the_middle(line: &f64) -> bool {
    line.to_bits() == MIDDLE.to_bits()
}
