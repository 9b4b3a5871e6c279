//! Friction laws: force per length of belt from slip velocity and normal force.
//!
//! A law is a type with one method. To add one: a type here, an arm in
//! [`crate::drive::Friction`], a line in the dispatch of `simulate.rs` (see CONTRIBUTING.md).

use std::fmt;

use ancf::scalar::Scalar;

/// Developed friction at a point: the force per length [N/m] in the direction of the slip (the belt
/// feels its opposite) and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Developed<S> {
    /// Force per length [N/m], with the sign of the slip velocity.
    pub force: S,
    /// Derivative by the slip velocity [N s/m²].
    pub by_slip: S,
    /// Derivative by the magnitude of the normal force per length [-].
    pub by_normal: S,
}

/// A law of dry friction without memory.
pub trait FrictionLaw: Clone + fmt::Debug + Send + Sync {
    /// The friction at slip velocity `slip` [m/s] under a normal force per length of magnitude
    /// `normal` [N/m].
    fn develop<S: Scalar>(&self, slip: S, normal: S) -> Developed<S>;
}

/// Tri-linear creep-rate law (Leamy & Wasfy 2002; Kerkkänen 2006, 3.23):
/// `f_t = sign(v) min(v_s |v|, mu |f_n|)`, the slope a force per length and velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepRate {
    /// Coefficient of friction mu [-].
    pub coefficient: f64,
    /// Creep slope v_s [N s/m²].
    pub slope: f64,
}

impl FrictionLaw for CreepRate {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: S, normal: S) -> Developed<S> {
        let limit = normal * self.coefficient;
        let creep = slip * self.slope;
        let within = limit - creep.abs();
        let sign = slip.select_positive(S::constant(1.0), S::constant(-1.0));
        Developed {
            force: within.select_positive(creep, sign * limit),
            by_slip: within.select_positive(S::constant(self.slope), S::zero()),
            by_normal: within.select_positive(S::zero(), sign * self.coefficient),
        }
    }
}

/// Coulomb's law regularised by a velocity: `f_t = mu |f_n| v / v_r` for `|v| < v_r`, `mu |f_n|`
/// beyond. Unlike creep, the slope grows with the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction mu [-].
    pub coefficient: f64,
    /// Slip velocity v_r at which friction is fully developed [m/s].
    pub velocity: f64,
}

impl FrictionLaw for Coulomb {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: S, normal: S) -> Developed<S> {
        let ratio = slip * (1.0 / self.velocity);
        let within = -ratio.abs() + 1.0;
        let sign = slip.select_positive(S::constant(1.0), S::constant(-1.0));
        let part = within.select_positive(ratio, sign);
        Developed {
            force: part * normal * self.coefficient,
            by_slip: within.select_positive(normal * (self.coefficient / self.velocity), S::zero()),
            by_normal: part * self.coefficient,
        }
    }
}

/// No friction: the belt settles on its pulleys with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictionless;

impl FrictionLaw for Frictionless {
    #[inline(always)]
    fn develop<S: Scalar>(&self, _: S, _: S) -> Developed<S> {
        Developed {
            force: S::zero(),
            by_slip: S::zero(),
            by_normal: S::zero(),
        }
    }
}
