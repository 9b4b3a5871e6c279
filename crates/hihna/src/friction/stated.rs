//! Friction laws that the program running a drive states itself.

use std::fmt;
use std::sync::Arc;

use ancf::scalar::Scalar;

use super::{Developed, FrictionLaw, Slip};

/// A friction law of the program that runs a drive: plain numbers in and out, called point by point. For laws of
/// the library, which serve whole registers, see [`FrictionLaw`].
pub trait StatedFriction: fmt::Debug + Send + Sync {
    /// The force per length [N/m], of plates per area [N/m²], in the direction of the slip (the belt feels its
    /// opposite), and its derivatives by the slip velocity [N s/m²] and by the normal force [-], at the slip
    /// velocity [m/s] and the normal force per length [N/m] or area, which is positive. Grooves do not act on it.
    /// Where the first derivative is zero friction counts as exhausted.
    fn develop(&self, slip_velocity: f64, normal_force: f64) -> (f64, [f64; 2]);

    /// The steepest rise with the slip velocity [N s/m²] under `normal_force`: it bounds the steps of the
    /// explicit integrator. At rest, unless the law says otherwise.
    fn steepest_damping(&self, normal_force: f64) -> f64 {
        self.develop(0.0, normal_force).1[0].abs()
    }
}

/// A law given by its force alone: derivatives are central differences, four more calls a point.
///
/// ```
/// use hihna::friction::{ByDifferences, StatedFriction};
///
/// let law = ByDifferences(|slip: f64, normal: f64| 0.8 * normal * (slip / 0.05).tanh());
/// let (force, [by_slip, by_normal]) = law.develop(0.0, 100.0);
/// assert_eq!((force, by_normal), (0.0, 0.0));
/// assert!((by_slip - 0.8 * 100.0 / 0.05).abs() < 1.0e-6 * by_slip);
/// ```
#[derive(Clone, Copy)]
pub struct ByDifferences<F>(pub F);

/// Slip velocity [m/s] and normal force [N/m] below which steps no longer shrink with the argument: the law is
/// taken to be smooth on this scale.
const SMOOTH: [f64; 2] = [1.0e-3, 1.0];

impl<F> fmt::Debug for ByDifferences<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("ByDifferences")
    }
}

impl<F: Fn(f64, f64) -> f64 + Send + Sync> StatedFriction for ByDifferences<F> {
    fn develop(&self, slip_velocity: f64, normal_force: f64) -> (f64, [f64; 2]) {
        let force = &self.0;
        differences(slip_velocity, normal_force, &mut |v, n| Some(force(v, n)))
            .unwrap_or((f64::NAN, [f64::NAN; 2]))
    }
}

/// Value and central differences of `force`; `None` as soon as it has none. The step, the cube root of the machine
/// epsilon times the argument, balances the error of the formula with rounding.
pub fn differences(
    slip_velocity: f64,
    normal_force: f64,
    force: &mut dyn FnMut(f64, f64) -> Option<f64>,
) -> Option<(f64, [f64; 2])> {
    let step = f64::EPSILON.cbrt();
    let value = force(slip_velocity, normal_force)?;
    let h = step * slip_velocity.abs().max(SMOOTH[0]);
    let (back, ahead) = (slip_velocity - h, slip_velocity + h);
    let by_slip = (force(ahead, normal_force)? - force(back, normal_force)?) / (ahead - back);
    let h = step * normal_force.max(SMOOTH[1]);
    // No law has to answer for a normal force below zero.
    let (less, more) = ((normal_force - h).max(0.0), normal_force + h);
    let by_normal = (force(slip_velocity, more)? - force(slip_velocity, less)?) / (more - less);
    Some((value, [by_slip, by_normal]))
}

/// A stated law among the others.
#[derive(Clone, Debug)]
pub struct Stated(pub Arc<dyn StatedFriction>);

impl PartialEq for Stated {
    /// Whether it is the same object: nothing else can be known of functions.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl FrictionLaw for Stated {
    // Not inlined: the loops over the library's own laws stay as short as they are.
    #[cold]
    #[inline(never)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        // Lanes without a point repeat the last point.
        let mut last = None;
        let (force, [by_velocity, by_normal]) =
            S::apply([slip.velocity, normal], &mut |[v, n]| match last {
                Some((known, answer)) if known == [v.to_bits(), n.to_bits()] => answer,
                // Outside of contact nothing rubs.
                _ if n <= 0.0 => (0.0, [0.0; 2]),
                _ => {
                    let answer = self.0.develop(v, n);
                    last = Some(([v.to_bits(), n.to_bits()], answer));
                    answer
                }
            });
        Developed {
            force,
            by_velocity,
            by_displacement: S::zero(),
            by_normal,
        }
    }

    fn reserve(&self, _: Slip<f64>, _: f64) -> Option<f64> {
        None
    }

    fn steepest_damping(&self, normal: f64) -> f64 {
        self.0.steepest_damping(normal)
    }
}
