//! Friction laws: force per length of belt from slip and normal force.
//!
//! A law is a type with one method, in a file of its own. To add one: a file in `friction/`, a variant
//! of [`Law`], one of [`crate::drive::Friction`] and the arms that the compiler then asks for (see
//! CONTRIBUTING.md). A program that only wants a law for itself gives one to its run by
//! [`crate::user_laws`].

mod coulomb;
mod creep_rate;
mod elastic_plastic;
mod stated;
mod stribeck;

pub use coulomb::Coulomb;
pub use creep_rate::CreepRate;
pub use elastic_plastic::ElasticPlastic;
pub use stated::{ByDifferences, Stated, StatedFriction, differences};
pub use stribeck::Stribeck;

use std::fmt;

use ancf::scalar::Scalar;

use crate::drive::Friction;

/// How a point of the belt moves against the surface of a pulley, positive counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Slip<S> {
    /// Slip velocity v_t [m/s].
    pub velocity: S,
    /// Elastic displacement z since the point last stuck freely [m]; zero for laws without memory.
    pub displacement: S,
}

/// Developed friction at a point: the force per length [N/m] in the direction of the slip (the belt
/// feels its opposite) and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Developed<S> {
    /// Force per length [N/m], with the sign of the slip.
    pub force: S,
    /// Derivative by the slip velocity [N s/m²].
    pub by_velocity: S,
    /// Derivative by the elastic displacement [N/m²].
    pub by_displacement: S,
    /// Derivative by the magnitude of the normal force per length [-].
    pub by_normal: S,
}

/// A law of dry friction.
pub trait FrictionLaw: Clone + fmt::Debug + Send + Sync {
    /// The friction under `slip` and a normal force per length of magnitude `normal` [N/m].
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S>;

    /// For laws with memory: the largest elastic displacement [m] that a point under the normal force
    /// per length `normal` [N/m] keeps at the end of a step. `None` for laws without memory.
    fn elastic_limit(&self, normal: f64) -> Option<f64> {
        let _ = normal;
        None
    }

    /// How far a point is from the corner of the law where friction stops to follow the slip: positive
    /// below it, zero at it, in the law's own unit. `None` for a law without a corner.
    fn reserve(&self, slip: Slip<f64>, normal: f64) -> Option<f64>;

    /// The steepest rise of the force per length with the slip velocity [N s/m²] under a normal force
    /// per length `normal` [N/m]: it bounds the steps of explicit integrators.
    fn steepest_damping(&self, normal: f64) -> f64;

    /// The steepest rise of the force per length with the elastic displacement [N/m²].
    fn steepest_stiffness(&self) -> f64 {
        0.0
    }
}

/// No friction: the belt settles on its pulleys with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictionless;

impl FrictionLaw for Frictionless {
    #[inline(always)]
    fn develop<S: Scalar>(&self, _: Slip<S>, _: S) -> Developed<S> {
        Developed {
            force: S::zero(),
            by_velocity: S::zero(),
            by_displacement: S::zero(),
            by_normal: S::zero(),
        }
    }

    fn reserve(&self, _: Slip<f64>, _: f64) -> Option<f64> {
        None
    }

    fn steepest_damping(&self, _: f64) -> f64 {
        0.0
    }
}

/// Any of the laws: what a pulley's surface does.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// No friction.
    Frictionless(Frictionless),
    /// Creep-rate law.
    CreepRate(CreepRate),
    /// Regularised Coulomb law.
    Coulomb(Coulomb),
    /// Coulomb law that weakens with slip.
    Stribeck(Stribeck),
    /// Bristles with memory.
    ElasticPlastic(ElasticPlastic),
    /// A law of the program that runs the drive.
    Stated(Stated),
}

impl Law {
    /// The law that a drive file states, on a surface whose normal force acts `grip` times: 1 on a flat
    /// face, `1 / sin(angle / 2)` in a groove. Only the coefficients of friction grow with it.
    #[must_use]
    pub fn new(friction: &Friction, grip: f64) -> Self {
        match *friction {
            Friction::CreepRate { coefficient, slope } => Self::CreepRate(CreepRate {
                coefficient: coefficient * grip,
                slope,
            }),
            Friction::Coulomb {
                coefficient,
                velocity,
            } => Self::Coulomb(Coulomb {
                coefficient: coefficient * grip,
                velocity,
            }),
            Friction::Stribeck {
                static_coefficient,
                sliding_coefficient,
                stribeck_velocity,
                velocity,
            } => Self::Stribeck(Stribeck {
                static_coefficient: static_coefficient * grip,
                sliding_coefficient: sliding_coefficient * grip,
                stribeck_velocity,
                velocity,
            }),
            Friction::ElasticPlastic {
                coefficient,
                stiffness,
                damping,
            } => Self::ElasticPlastic(ElasticPlastic {
                coefficient: coefficient * grip,
                stiffness,
                damping,
            }),
        }
    }

    /// The law with `grip` times its coefficients of friction and a rise with the slip `softness` times
    /// less steep (what remembers keeps its stiffness): the way to it from an easier one.
    #[must_use]
    pub fn eased(&self, grip: f64, softness: f64) -> Self {
        match *self {
            // Nothing is known of a stated law that could be eased; steady running takes the drive's own.
            Self::Stated(ref law) => Self::Stated(law.clone()),
            Self::Frictionless(law) => Self::Frictionless(law),
            Self::CreepRate(CreepRate { coefficient, slope }) => Self::CreepRate(CreepRate {
                coefficient: coefficient * grip,
                slope: slope / softness,
            }),
            Self::Coulomb(Coulomb {
                coefficient,
                velocity,
            }) => Self::Coulomb(Coulomb {
                coefficient: coefficient * grip,
                velocity: velocity * grip * softness,
            }),
            Self::Stribeck(law) => Self::Stribeck(Stribeck {
                static_coefficient: law.static_coefficient * grip,
                sliding_coefficient: law.sliding_coefficient * grip,
                stribeck_velocity: law.stribeck_velocity * grip * softness,
                velocity: law.velocity * grip * softness,
            }),
            Self::ElasticPlastic(law) => Self::ElasticPlastic(ElasticPlastic {
                coefficient: law.coefficient * grip,
                ..law
            }),
        }
    }

    /// Whether the law remembers displacements.
    pub fn has_memory(&self) -> bool {
        self.elastic_limit(0.0).is_some()
    }
}

/// Calls a method of whichever law it is.
macro_rules! each {
    ($self:ident, $law:ident => $call:expr) => {
        match $self {
            Self::Frictionless($law) => $call,
            Self::CreepRate($law) => $call,
            Self::Coulomb($law) => $call,
            Self::Stribeck($law) => $call,
            Self::ElasticPlastic($law) => $call,
            Self::Stated($law) => $call,
        }
    };
}

impl FrictionLaw for Law {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        each!(self, law => law.develop(slip, normal))
    }

    fn elastic_limit(&self, normal: f64) -> Option<f64> {
        each!(self, law => law.elastic_limit(normal))
    }

    fn reserve(&self, slip: Slip<f64>, normal: f64) -> Option<f64> {
        each!(self, law => law.reserve(slip, normal))
    }

    fn steepest_damping(&self, normal: f64) -> f64 {
        each!(self, law => law.steepest_damping(normal))
    }

    fn steepest_stiffness(&self) -> f64 {
        each!(self, law => law.steepest_stiffness())
    }
}
