//! External torques on pulleys: a function of time plus what the driven machine takes at its speed.
//!
//! With the speed omega of the pulley and `s = omega / omega_0`, a load opposes the motion by
//!
//! ```text
//! viscous   T = -T_0 s            generators on a resistance, bearings, fluid couplings
//! fan       T = -T_0 s |s|        fans, centrifugal pumps
//! table     T linear between the given points, constant beyond them, with the sign given
//! ```

use std::fmt;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::profile::Profile;
use crate::units;

/// A torque that depends on the speed of its pulley.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Load {
    /// In proportion to the speed.
    Viscous {
        /// Torque against the motion at `speed` [N m].
        #[schemars(schema_with = "units::torque", extend("minimum" = 0.0))]
        torque: f64,
        /// The speed at which it is given [rad/s].
        #[schemars(schema_with = "units::angular_velocity", extend("exclusiveMinimum" = 0.0))]
        speed: f64,
    },
    /// With the square of the speed.
    Fan {
        /// Torque against the motion at `speed` [N m].
        #[schemars(schema_with = "units::torque", extend("minimum" = 0.0))]
        torque: f64,
        /// The speed at which it is given [rad/s].
        #[schemars(schema_with = "units::angular_velocity", extend("exclusiveMinimum" = 0.0))]
        speed: f64,
    },
    /// Linear between points, constant beyond the first and the last.
    Table {
        /// Speeds, increasing [rad/s].
        #[schemars(schema_with = "units::angular_velocities")]
        speed: Vec<f64>,
        /// External torques at these speeds, positive counter-clockwise [N m].
        #[schemars(schema_with = "units::torques")]
        torque: Vec<f64>,
    },
}

impl Load {
    /// The external torque at `omega` [N m] and its derivative by it [N m s].
    pub fn at(&self, omega: f64) -> (f64, f64) {
        match self {
            Self::Viscous { torque, speed } => (-torque * omega / speed, -torque / speed),
            Self::Fan { torque, speed } => {
                let part = omega / speed;
                (
                    -torque * part * part.abs(),
                    -2.0 * torque * part.abs() / speed,
                )
            }
            Self::Table { speed, torque } => {
                let next = speed.partition_point(|known| *known <= omega);
                let at = |i: usize| speed.get(i).copied().zip(torque.get(i).copied());
                match (next.checked_sub(1).and_then(at), at(next)) {
                    (Some((s0, t0)), Some((s1, t1))) => {
                        let slope = (t1 - t0) / (s1 - s0);
                        (t0 + slope * (omega - s0), slope)
                    }
                    (Some((_, torque)), None) | (None, Some((_, torque))) => (torque, 0.0),
                    (None, None) => (0.0, 0.0),
                }
            }
        }
    }
}

/// An external torque that the program running a drive states itself.
pub trait TorqueLaw: fmt::Debug + Send + Sync {
    /// The torque on the pulley [N m], positive counter-clockwise, and its derivative by the speed [N m s], at
    /// `time` [s] and `speed` [rad/s]. Over time it should be smooth: steps do not end at its kinks.
    fn at(&self, time: f64, speed: f64) -> (f64, f64);
}

/// A torque given by a function of time and speed alone: the derivative is a central difference, two more calls.
#[derive(Clone, Copy)]
pub struct ByDifferences<F>(pub F);

/// Speed [rad/s] below which the step of the difference no longer shrinks.
const SMOOTH: f64 = 1.0e-3;

impl<F> fmt::Debug for ByDifferences<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("ByDifferences")
    }
}

impl<F: Fn(f64, f64) -> f64 + Send + Sync> TorqueLaw for ByDifferences<F> {
    fn at(&self, time: f64, speed: f64) -> (f64, f64) {
        let torque = &self.0;
        difference(speed, &mut |speed| Some(torque(time, speed))).unwrap_or((f64::NAN, f64::NAN))
    }
}

/// Value and central difference of `torque`; `None` as soon as it has none.
pub fn difference(speed: f64, torque: &mut dyn FnMut(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let h = f64::EPSILON.cbrt() * speed.abs().max(SMOOTH);
    let (back, ahead) = (speed - h, speed + h);
    let value = torque(speed)?;
    Some((value, (torque(ahead)? - torque(back)?) / (ahead - back)))
}

/// All that acts on a pulley from outside of the drive.
#[derive(Clone, Debug)]
pub struct ExternalTorque {
    /// The part that depends on time [N m].
    pub by_time: Profile,
    /// The part that depends on the speed.
    pub by_speed: Option<Load>,
    /// The part that the program running the drive states.
    pub stated: Option<Arc<dyn TorqueLaw>>,
}

impl ExternalTorque {
    /// The torque [N m] at `time` [s] and `speed` [rad/s].
    pub fn value(&self, time: f64, speed: f64) -> f64 {
        self.by_time.value(time)
            + self.by_speed.as_ref().map_or(0.0, |load| load.at(speed).0)
            + self
                .stated
                .as_ref()
                .map_or(0.0, |law| law.at(time, speed).0)
    }

    /// Its derivative by the speed [N m s].
    pub fn derivative(&self, time: f64, speed: f64) -> f64 {
        self.by_speed.as_ref().map_or(0.0, |load| load.at(speed).1)
            + self
                .stated
                .as_ref()
                .map_or(0.0, |law| law.at(time, speed).1)
    }
}

impl From<Profile> for ExternalTorque {
    fn from(by_time: Profile) -> Self {
        Self {
            by_time,
            by_speed: None,
            stated: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loads() -> [Load; 3] {
        [
            Load::Viscous {
                torque: 3.0,
                speed: 100.0,
            },
            Load::Fan {
                torque: 3.0,
                speed: 100.0,
            },
            Load::Table {
                speed: vec![-50.0, 0.0, 80.0, 120.0],
                torque: vec![1.0, 0.0, -2.0, -5.0],
            },
        ]
    }

    /// Values at the speed where they are given, and at twice that.
    #[test]
    fn closed_forms() {
        let [viscous, fan, table] = loads().map(|load| move |speed: f64| load.at(speed).0);
        for (computed, exact) in [
            (viscous(100.0), -3.0),
            (viscous(-200.0), 6.0),
            (fan(100.0), -3.0),
            (fan(-200.0), 12.0),
            (table(40.0), -1.0),
            (table(100.0), -3.5),
            (table(500.0), -5.0),
            (table(-500.0), 1.0),
        ] {
            assert!((computed - exact).abs() < 1.0e-14, "{computed} {exact}");
        }
    }

    /// Quadratic at most between kinks: a central difference is exact up to rounding, 1e-16 / 1e-3.
    #[test]
    fn derivatives() {
        for load in loads() {
            for speed in [-170.0, -20.0, 30.0, 90.0, 300.0] {
                let h = 1.0e-3;
                let difference = (load.at(speed + h).0 - load.at(speed - h).0) / (2.0 * h);
                assert!(
                    (load.at(speed).1 - difference).abs() < 1.0e-11,
                    "{load:?} at {speed}"
                );
            }
        }
    }
}
