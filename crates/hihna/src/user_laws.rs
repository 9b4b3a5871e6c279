//! Laws that the program running a drive states in place of the drive's own, without a change to the library.
//!
//! ```
//! use std::sync::Arc;
//! use hihna::friction::ByDifferences;
//! use hihna::simulate::{Flow, simulate_with};
//! use hihna::user_laws::UserLaws;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let short = "run.end_time=0.02".parse()?;
//! let drive = hihna::input::parse("drive", include_str!("../../../examples/two_pulley.toml"), &[short])?;
//! let rubber = |slip: f64, normal: f64| 1.2 * normal * (slip / 0.01).tanh();
//! let fan = |time: f64, speed: f64| -0.01 * (1.0 - (-time / 0.1).exp()) * speed * speed.abs();
//! let laws = UserLaws::default()
//!     .with_friction("driven", Arc::new(ByDifferences(rubber)))
//!     .with_torque("driven", Arc::new(hihna::load::ByDifferences(fan)));
//! let outcome = simulate_with(&drive, &laws, &mut |_| Flow::Continue)?;
//! assert!(outcome.audit.passed());
//! # Ok(())
//! # }
//! ```
//!
//! The drive stays plain data; what it was run with is told by a warning in the outcome.

use std::collections::BTreeMap;
use std::sync::Arc;

use thiserror::Error;

use crate::assemble::Warning;
use crate::drive::{Drive, Pulley, Start};
use crate::friction::{Law, Stated, StatedFriction};
use crate::load::{ExternalTorque, TorqueLaw};
use crate::profile::Profile;

/// What messages call laws of friction.
pub(crate) const FRICTION: &str = "friction";

/// Stated laws by the names of pulleys.
#[derive(Clone, Debug, Default)]
pub struct UserLaws {
    friction: BTreeMap<String, Arc<dyn StatedFriction>>,
    torque: BTreeMap<String, Arc<dyn TorqueLaw>>,
}

/// A stated law that has no place.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum UserLawError {
    /// No pulley has this name.
    #[error("there is a {law} law for pulley `{pulley}`, but the pulleys are {}", known.join(", "))]
    NoPulley {
        /// What the law is of.
        law: &'static str,
        /// The name.
        pulley: String,
        /// The pulleys there are.
        known: Vec<String>,
    },
    /// A pulley whose motion is prescribed takes any torque.
    #[error("there is a torque law for pulley `{pulley}`, but its motion is prescribed")]
    Driven {
        /// The pulley.
        pulley: String,
    },
    /// Steady running is solved with the laws of the drive itself.
    #[error(
        "there is a {law} law for pulley `{pulley}`, but `run.start = \"steady\"` knows the drive's own laws only: start from `rest`"
    )]
    SteadyStart {
        /// What the law is of.
        law: &'static str,
        /// The pulley.
        pulley: String,
    },
}

impl UserLaws {
    /// With `law` as the friction on `pulley`, of the belt's face as of its back.
    #[must_use]
    pub fn with_friction(mut self, pulley: &str, law: Arc<dyn StatedFriction>) -> Self {
        self.friction.insert(pulley.to_owned(), law);
        self
    }

    /// With `law` as the external torque on `pulley`, in place of its `torque` and its `load`.
    #[must_use]
    pub fn with_torque(mut self, pulley: &str, law: Arc<dyn TorqueLaw>) -> Self {
        self.torque.insert(pulley.to_owned(), law);
        self
    }

    /// Whether every law has a pulley in `drive` to act on.
    pub fn check(&self, drive: &Drive) -> Result<(), UserLawError> {
        let friction = self.friction.keys().map(|name| (FRICTION, name));
        let torque = self.torque.keys().map(|name| ("torque", name));
        for (law, name) in friction.chain(torque) {
            match drive.pulley.iter().find(|pulley| pulley.name == *name) {
                None => {
                    return Err(UserLawError::NoPulley {
                        law,
                        pulley: name.clone(),
                        known: drive.pulley.iter().map(|p| p.name.clone()).collect(),
                    });
                }
                Some(pulley) if law == "torque" && pulley.is_driver() => {
                    let pulley = name.clone();
                    return Err(UserLawError::Driven { pulley });
                }
                Some(_) if drive.run.start == Start::Steady => {
                    let pulley = name.clone();
                    return Err(UserLawError::SteadyStart { law, pulley });
                }
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// The friction on `pulley` of `drive`.
    pub(crate) fn friction_on(&self, drive: &Drive, pulley: &Pulley) -> Law {
        match self.friction.get(&pulley.name) {
            Some(law) => Law::Stated(Stated(Arc::clone(law))),
            None => Law::new(drive.friction_on(pulley), pulley.grip()),
        }
    }

    /// Puts the stated laws on pulleys that have the drive's own.
    pub(crate) fn put_on<'a>(
        &self,
        drive: &Drive,
        contacts: impl Iterator<Item = (&'a mut Law, &'a mut ExternalTorque)>,
    ) {
        for ((friction, external), pulley) in contacts.zip(&drive.pulley) {
            if let Some(law) = self.friction.get(&pulley.name) {
                *friction = Law::Stated(Stated(Arc::clone(law)));
            }
            if let Some(law) = self.torque.get(&pulley.name) {
                *external = ExternalTorque {
                    by_time: Profile::Constant(0.0),
                    by_speed: None,
                    stated: Some(Arc::clone(law)),
                };
            }
        }
    }

    /// What readers of the results must know.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = Warning> {
        let friction = self.friction.keys().map(|name| (FRICTION, name));
        let torque = self.torque.keys().map(|name| ("external torque", name));
        friction
            .chain(torque)
            .map(|(law, pulley)| Warning::StatedLaw {
                law,
                pulley: pulley.clone(),
            })
    }
}
