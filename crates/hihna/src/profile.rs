//! Functions of time that drives prescribe: speeds, angles, torques.
//!
//! With `x = t - start`, `T = end - start`, a ramp is `from + (to - from) x / T` and a half-cosine
//! `from + (to - from) (1 - cos(pi x / T)) / 2` between `start` and `end`; both are constant outside.
//! A table is linear between its points and constant outside.

use std::f64::consts::PI;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::units;

/// A scalar function of time, continuous, with finitely many kinks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
        #[schemars(schema_with = "units::of_the_field")]
        from: f64,
        /// Value after `end`.
        #[schemars(schema_with = "units::of_the_field")]
        to: f64,
        /// Start of the change [s].
        #[schemars(schema_with = "units::time")]
        start: f64,
        /// End of the change [s].
        #[schemars(schema_with = "units::time")]
        end: f64,
    },
    /// Half a cosine from `from` at `start` to `to` at `end`, constant outside.
    HalfCosine {
        /// Value before `start`.
        #[schemars(schema_with = "units::of_the_field")]
        from: f64,
        /// Value after `end`.
        #[schemars(schema_with = "units::of_the_field")]
        to: f64,
        /// Start of the change [s].
        #[schemars(schema_with = "units::time")]
        start: f64,
        /// End of the change [s].
        #[schemars(schema_with = "units::time")]
        end: f64,
    },
    /// Linear between the given points, constant outside.
    Table {
        /// Times [s], increasing.
        #[schemars(schema_with = "units::times")]
        time: Vec<f64>,
        /// Value at each time.
        #[schemars(schema_with = "units::list_of_the_field")]
        value: Vec<f64>,
    },
}

impl Profile {
    /// Value at time `t` [s].
    ///
    /// ```
    /// use hihna::profile::{Profile, Varying};
    ///
    /// let speed = Profile::Varying(Varying::Ramp { from: 0.0, to: 12.0, start: 0.5, end: 1.5 });
    /// assert_eq!(speed.value(0.0), 0.0);
    /// assert_eq!(speed.value(1.0), 6.0);
    /// assert_eq!(speed.value(2.0), 12.0);
    /// ```
    pub fn value(&self, t: f64) -> f64 {
        self.piece(t).value
    }

    /// First derivative at time `t` [s], at a kink the one to the right.
    ///
    /// ```
    /// use hihna::profile::{Profile, Varying};
    ///
    /// let speed = Profile::Varying(Varying::Ramp { from: 0.0, to: 12.0, start: 0.5, end: 1.5 });
    /// assert_eq!(speed.derivative(0.5), 12.0);
    /// assert_eq!(speed.derivative(1.5), 0.0);
    /// ```
    pub fn derivative(&self, t: f64) -> f64 {
        self.piece(t).derivative
    }

    /// Second derivative at time `t` [s], at a kink the one to the right.
    pub fn second_derivative(&self, t: f64) -> f64 {
        self.piece(t).second_derivative
    }

    /// Integral over time from 0 to `t` [s], in closed form.
    ///
    /// ```
    /// use hihna::profile::{Profile, Varying};
    ///
    /// let speed = Profile::Varying(Varying::Ramp { from: 0.0, to: 12.0, start: 0.5, end: 1.5 });
    /// assert_eq!(speed.integral(2.5), 18.0);
    /// ```
    pub fn integral(&self, t: f64) -> f64 {
        self.primitive(t) - self.primitive(0.0)
    }

    /// Times [s], increasing, at which the function or its first derivative is not smooth.
    ///
    /// ```
    /// use hihna::profile::{Profile, Varying};
    ///
    /// let speed = Profile::Varying(Varying::Ramp { from: 0.0, to: 12.0, start: 0.5, end: 1.5 });
    /// assert_eq!(speed.kinks(), [0.5, 1.5]);
    /// assert!(Profile::Constant(3.0).kinks().is_empty());
    /// ```
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Constant(_) => Vec::new(),
            Self::Varying(
                Varying::Ramp { start, end, .. } | Varying::HalfCosine { start, end, .. },
            ) => {
                vec![*start, *end]
            }
            Self::Varying(Varying::Table { time, .. }) => time.clone(),
        }
    }

    /// Greatest magnitude at any time.
    pub fn bound(&self) -> f64 {
        match self {
            Self::Constant(value) => value.abs(),
            Self::Varying(
                Varying::Ramp { from, to, .. } | Varying::HalfCosine { from, to, .. },
            ) => from.abs().max(to.abs()),
            Self::Varying(Varying::Table { value, .. }) => {
                value.iter().fold(0.0, |bound, v| v.abs().max(bound))
            }
        }
    }

    /// Whether the function is zero at all times.
    pub fn is_zero(&self) -> bool {
        self.bound() == 0.0
    }

    fn piece(&self, t: f64) -> Piece {
        match self {
            Self::Constant(value) => Piece::constant(*value),
            Self::Varying(Varying::Ramp {
                from,
                to,
                start,
                end,
            }) => {
                if t < *start || t >= *end {
                    return Piece::constant(if t < *start { *from } else { *to });
                }
                let slope = (to - from) / (end - start);
                Piece {
                    value: from + slope * (t - start),
                    derivative: slope,
                    second_derivative: 0.0,
                }
            }
            Self::Varying(Varying::HalfCosine {
                from,
                to,
                start,
                end,
            }) => {
                if t < *start || t >= *end {
                    return Piece::constant(if t < *start { *from } else { *to });
                }
                let amplitude = 0.5 * (to - from);
                let frequency = PI / (end - start);
                let (sine, cosine) = (frequency * (t - start)).sin_cos();
                Piece {
                    value: from + amplitude * (1.0 - cosine),
                    derivative: amplitude * frequency * sine,
                    second_derivative: amplitude * frequency * frequency * cosine,
                }
            }
            Self::Varying(Varying::Table { time, value }) => table_piece(time, value, t),
        }
    }

    /// An antiderivative: any constant may be added to it.
    fn primitive(&self, t: f64) -> f64 {
        match self {
            Self::Constant(value) => value * t,
            Self::Varying(Varying::Ramp {
                from,
                to,
                start,
                end,
            }) => {
                let duration = end - start;
                // Time spent before, during and after the change, counted from `start`.
                let (before, during, after) = (
                    t.min(*start) - start,
                    (t - start).clamp(0.0, duration.max(0.0)),
                    (t - end).max(0.0),
                );
                let change = if during > 0.0 {
                    0.5 * (to - from) * during * during / duration
                } else {
                    0.0
                };
                from * (before + during) + change + to * after
            }
            Self::Varying(Varying::HalfCosine {
                from,
                to,
                start,
                end,
            }) => {
                let duration = end - start;
                let (before, during, after) = (
                    t.min(*start) - start,
                    (t - start).clamp(0.0, duration.max(0.0)),
                    (t - end).max(0.0),
                );
                let frequency = PI / duration;
                let change = if during > 0.0 {
                    0.5 * (to - from) * (during - (frequency * during).sin() / frequency)
                } else {
                    0.0
                };
                from * (before + during) + change + to * after
            }
            Self::Varying(Varying::Table { time, value }) => table_primitive(time, value, t),
        }
    }
}

/// Value and derivatives of the smooth piece that holds a time.
struct Piece {
    value: f64,
    derivative: f64,
    second_derivative: f64,
}

impl Piece {
    fn constant(value: f64) -> Self {
        Self {
            value,
            derivative: 0.0,
            second_derivative: 0.0,
        }
    }
}

fn table_piece(time: &[f64], value: &[f64], t: f64) -> Piece {
    let next = time.partition_point(|&point| point <= t);
    let at = |i: usize| time.get(i).copied().zip(value.get(i).copied());
    match (next.checked_sub(1).and_then(at), at(next)) {
        (Some((t0, v0)), Some((t1, v1))) => {
            let slope = (v1 - v0) / (t1 - t0);
            Piece {
                value: v0 + slope * (t - t0),
                derivative: slope,
                second_derivative: 0.0,
            }
        }
        (Some((_, value)), None) | (None, Some((_, value))) => Piece::constant(value),
        (None, None) => Piece::constant(0.0),
    }
}

/// Integral from the first point of the table to `t`.
fn table_primitive(time: &[f64], value: &[f64], t: f64) -> f64 {
    let (Some(&first), Some(&first_value), Some(&last)) =
        (time.first(), value.first(), time.last())
    else {
        return 0.0;
    };
    if t <= first {
        return first_value * (t - first);
    }
    let within: f64 = time
        .windows(2)
        .zip(value.windows(2))
        .take_while(|(times, _)| times[0] < t)
        .map(|(times, values)| {
            let until = t.min(times[1]);
            0.5 * (values[0] + table_piece(times, values, until).value) * (until - times[0])
        })
        .sum();
    within + value.last().unwrap_or(&0.0) * (t - last).max(0.0)
}

impl JsonSchema for Profile {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Profile".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [units::of_the_field(generator), Varying::json_schema(generator)]
        })
    }
}

/// Schema of a torque in time [N m].
pub(crate) fn torque(generator: &mut SchemaGenerator) -> Schema {
    let torque = units::torque(generator);
    profile_of(generator, &torque)
}

/// Schema of a prescribed angle in time [rad].
pub(crate) fn angle(generator: &mut SchemaGenerator) -> Schema {
    let angle = units::angle(generator);
    profile_of(generator, &angle)
}

/// Schema of a displacement in time [m].
pub(crate) fn length(generator: &mut SchemaGenerator) -> Schema {
    let length = units::length(generator);
    profile_of(generator, &length)
}

/// Schema of a prescribed speed in time [rad/s].
pub(crate) fn angular_velocity(generator: &mut SchemaGenerator) -> Schema {
    let angular_velocity = units::angular_velocity(generator);
    profile_of(generator, &angular_velocity)
}

fn profile_of(generator: &mut SchemaGenerator, quantity: &Schema) -> Schema {
    let mut schema = Profile::json_schema(generator);
    for value in schema.ensure_object().values_mut() {
        units::lend_dimension(value, quantity);
    }
    schema
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Profiles with changes that last at least 0.1 s, from -1 s to 6 s.
    fn profiles() -> impl Strategy<Value = Profile> {
        let value = || -10.0..10.0;
        prop_oneof![
            value().prop_map(Profile::Constant),
            (value(), value(), -1.0..2.0, 0.1..2.0).prop_map(|(from, to, start, duration)| {
                Profile::Varying(Varying::Ramp {
                    from,
                    to,
                    start,
                    end: start + duration,
                })
            }),
            (value(), value(), -1.0..2.0, 0.1..2.0).prop_map(|(from, to, start, duration)| {
                Profile::Varying(Varying::HalfCosine {
                    from,
                    to,
                    start,
                    end: start + duration,
                })
            }),
            (-1.0..1.0, prop::collection::vec((0.1..1.0, value()), 1..6)).prop_map(
                |(start, points)| {
                    let mut last = start;
                    let (time, value) = points
                        .into_iter()
                        .map(|(interval, value)| {
                            last += interval;
                            (last, value)
                        })
                        .unzip();
                    Profile::Varying(Varying::Table { time, value })
                }
            ),
        ]
    }

    /// Both derivatives are those of the value: central differences of width 2e-6 s have an error of
    /// about 1e-12 f''' + 1e-16 f / 1e-6, far below the tolerance for these values.
    fn derivatives_match(profile: &Profile, t: f64) {
        let h = 1e-6;
        if profile
            .kinks()
            .iter()
            .any(|kink| (kink - t).abs() <= 2.0 * h)
        {
            return;
        }
        let slope = (profile.value(t + h) - profile.value(t - h)) / (2.0 * h);
        assert!(
            (profile.derivative(t) - slope).abs() < 1e-6,
            "{} {slope}",
            profile.derivative(t)
        );
        let curvature = (profile.derivative(t + h) - profile.derivative(t - h)) / (2.0 * h);
        assert!(
            (profile.second_derivative(t) - curvature).abs() < 1e-4,
            "{} {curvature}",
            profile.second_derivative(t)
        );
    }

    /// Simpson's rule on pieces between kinks; exact for polynomials, and its error for half a cosine
    /// of at least 0.1 s on 200 intervals is below 1e-8 of the amplitude.
    fn integral_matches(profile: &Profile, t: f64) {
        let mut borders = vec![0.0_f64, t];
        borders.extend(
            profile
                .kinks()
                .into_iter()
                .filter(|kink| (kink * (kink - t)) < 0.0),
        );
        borders.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        for piece in borders.windows(2) {
            let h = (piece[1] - piece[0]) / 200.0;
            for i in 0..200 {
                let a = piece[0] + h * f64::from(i);
                sum += h / 6.0
                    * (profile.value(a) + 4.0 * profile.value(a + 0.5 * h) + profile.value(a + h));
            }
        }
        let expected = if t < 0.0 { -sum } else { sum };
        assert!(
            (profile.integral(t) - expected).abs() < 1e-7,
            "{} {expected}",
            profile.integral(t)
        );
    }

    proptest! {
        #[test]
        fn derivatives(profile in profiles(), t in -2.0..8.0) {
            derivatives_match(&profile, t);
        }

        #[test]
        fn integral(profile in profiles(), t in -2.0..8.0) {
            integral_matches(&profile, t);
        }

        #[test]
        fn bounded_and_continuous(profile in profiles(), t in -2.0..8.0) {
            prop_assert!(profile.value(t).abs() <= profile.bound() * (1.0 + 1e-15));
            for kink in profile.kinks() {
                // Steepest slope: 20 within 0.1 s, times pi / 2.
                prop_assert!((profile.value(kink) - profile.value(kink - 1e-9)).abs() < 1e-6);
            }
        }
    }

    /// Nonsense that `validate` reports must not panic before anyone looks.
    #[test]
    fn broken_tables_do_not_panic() {
        for (time, value) in [
            (vec![], vec![]),
            (vec![1.0], vec![]),
            (vec![], vec![1.0]),
            (vec![2.0, 1.0, 1.0], vec![1.0]),
        ] {
            let profile = Profile::Varying(Varying::Table { time, value });
            for t in [-1.0, 1.0, 1.5, 3.0, f64::NAN] {
                let _ = (
                    profile.value(t),
                    profile.derivative(t),
                    profile.integral(t),
                    profile.bound(),
                );
            }
        }
    }
}
