//! Step, tolerances and integrator of a run.

use ancf::dynamics::{Control, Method};

use crate::assemble::Mounting;
use crate::drive::{Drive, Integrator, Step};
use crate::friction::FrictionLaw;
use crate::profile::Profile;
use crate::user_laws::UserLaws;

/// Accuracy at which the constants below hold.
const REFERENCE_ACCURACY: f64 = 1.0e-3;

/// Accepted error of predicted belt velocities, relative to the nominal speed. Of 0.01, 0.02 and 0.03,
/// tried on the base case with 20, 30 and 60 elements, the coarsest: the peak of the driven speed moves
/// by less than 1e-4 of it between them.
const PREDICTION_TOLERANCE: f64 = 0.03;

/// Largest step relative to `1 / omega` of the slowest swing, or of the fastest prescribed irregularity: its
/// second-order dispersion `(omega h)² / 12` is 2e-4 then.
const SWING_STEP: f64 = 0.05;

/// Surface speed of the fastest driver [m/s]; where nothing is driven, a hundredth of the belt's
/// longitudinal wave speed.
#[must_use]
pub fn nominal_speed(drive: &Drive) -> f64 {
    let driven = drive
        .pulley
        .iter()
        .map(|pulley| {
            let speed = pulley.speed.as_ref().map_or(0.0, Profile::bound);
            let turning = pulley.angle.as_ref().map_or(0.0, slope_bound);
            speed.max(turning) * pulley.radius
        })
        .fold(0.0, f64::max);
    if driven > 0.0 {
        driven
    } else {
        0.01 * (drive.belt.axial_factor * drive.belt.youngs_modulus / drive.belt.density).sqrt()
    }
}

/// Greatest magnitude of the derivative: every kind of piece has it at its start or in its middle.
fn slope_bound(profile: &Profile) -> f64 {
    let kinks = profile.kinks();
    let middles = kinks.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    kinks
        .iter()
        .copied()
        .chain(middles)
        .fold(0.0, |bound, t| f64::max(bound, profile.derivative(t).abs()))
}

/// Step, tolerances and kinks of a run.
///
/// The belt's velocity turns by `h v / R` per step where it meets a pulley; a prediction by constant
/// acceleration misses the step of the centripetal acceleration there by `h v² / R`. The largest step
/// lets the belt turn by a fiftieth of a radian; [`PREDICTION_TOLERANCE`] finds smaller ones. Both go
/// with the square root of the accuracy, as the schemes are of second order.
pub(super) fn control(drive: &Drive, laws: &UserLaws, mounting: &Mounting) -> Control {
    let run = &drive.run;
    let speed = nominal_speed(drive);
    let fineness = (run.accuracy / REFERENCE_ACCURACY).sqrt();
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    let method = match run.integrator {
        Integrator::Auto => Method::Auto,
        Integrator::GeneralizedAlpha => Method::GeneralizedAlpha,
        Integrator::TrBdf2 => Method::TrBdf2,
        Integrator::RungeKutta => Method::RungeKutta,
    };
    let (step, error_tolerance) = match (run.step, method) {
        (Step::Fixed(step), _) => (step, None),
        (Step::Named(_), Method::RungeKutta) => (explicit_step(drive, laws, mounting), None),
        (Step::Named(_), _) => (
            (0.02 * smallest / speed * fineness)
                .min(SWING_STEP * fineness / slowest_swing(drive, mounting))
                .min(SWING_STEP * fineness / fastest_and_slowest_harmonic(drive).0)
                .min(run.end_time),
            Some(PREDICTION_TOLERANCE * speed * fineness),
        ),
    };
    let mut kinks: Vec<f64> = drive
        .pulley
        .iter()
        .flat_map(|p| [Some(&p.torque), p.speed.as_ref(), p.angle.as_ref()])
        .flatten()
        .flat_map(crate::profile::Profile::kinks)
        .collect();
    // Where a hub changes its velocity at once, damping and friction of the contact jump.
    let mut jumps: Vec<f64> = drive
        .pulley
        .iter()
        .filter_map(|pulley| pulley.displacement.as_ref())
        .flat_map(|hub| [&hub.x, &hub.y, &hub.z])
        .flat_map(crate::profile::Profile::kinks)
        .collect();
    jumps.sort_by(f64::total_cmp);
    kinks.sort_by(f64::total_cmp);
    Control {
        method,
        step,
        error_tolerance,
        newton_tolerance: 2.0e-7 * speed * (run.accuracy / REFERENCE_ACCURACY),
        kinks,
        jumps,
    }
}

/// Angular frequency [rad/s] of the slowest swing of a free pulley on the two spans beside it, zero if
/// no pulley is free: the vibration that a changing speed excites first.
pub(super) fn slowest_swing(drive: &Drive, mounting: &Mounting) -> f64 {
    let belt = &drive.belt;
    let stiffness = belt.axial_factor * belt.youngs_modulus * drive.area();
    // Spans are no longer than the belt: the estimate is on the slow side.
    let per_length = drive.pulley.len() as f64 / mounting.length;
    drive
        .pulley
        .iter()
        .filter(|pulley| !pulley.is_driver())
        .map(|p| p.radius * (2.0 * stiffness * per_length / p.inertia).sqrt())
        .reduce(f64::min)
        .unwrap_or(0.0)
}

/// Angular frequencies [rad/s] of the fastest and the slowest prescribed irregularity, zero without one.
pub(super) fn fastest_and_slowest_harmonic(drive: &Drive) -> (f64, f64) {
    let all = drive.pulley.iter().flat_map(|pulley| {
        let speed = pulley.speed.as_ref().map_or(0.0, Profile::bound);
        pulley.irregularity.iter().map(move |h| h.order * speed)
    });
    let slowest = all.clone().reduce(f64::min).unwrap_or(0.0);
    (all.fold(0.0, f64::max), slowest)
}

/// A stable step of the explicit scheme: half its real stability limit 2.78 for friction at full
/// creep and contact damping, and half its imaginary one 2.83 for the fastest elastic mode. The
/// consistent mass of a cubic element lets modes be up to four times faster than the local rates.
fn explicit_step(drive: &Drive, laws: &UserLaws, mounting: &Mounting) -> f64 {
    let belt = &drive.belt;
    let line_density = belt.density * drive.area();
    let smallest = drive
        .pulley
        .iter()
        .fold(f64::INFINITY, |r, p| r.min(p.radius));
    let pressure = mounting.tension.max(1.0) / smallest;
    let (slope, bristles) = drive
        .pulley
        .iter()
        .map(|pulley| laws.friction_on(drive, pulley))
        .map(|law| (law.steepest_damping(pressure), law.steepest_stiffness()))
        .fold((0.0, 0.0), |most: (f64, f64), law| {
            (most.0.max(law.0), most.1.max(law.1))
        });
    let rate = 4.0 * (slope + drive.contact.damping) / line_density;
    let contact_mode = 2.0 * (drive.contact.stiffness.max(bristles) / line_density).sqrt();
    let wave = (belt.youngs_modulus / belt.density).sqrt();
    let thickness_mode = wave * 12.0_f64.sqrt() / belt.thickness;
    let length = mounting.length / belt.elements as f64;
    let axial_mode = 4.0 * wave * belt.axial_factor.sqrt() * 3.5 / length;
    let frequency = (3.0_f64.sqrt() * thickness_mode)
        .max(axial_mode)
        .max(contact_mode);
    (0.5 * 2.78 / rate).min(0.5 * 2.83 / frequency)
}

/// The integrator's name in drive files and summaries.
pub(super) fn name(method: Method) -> &'static str {
    match method {
        Method::Auto | Method::GeneralizedAlpha => "generalized-alpha",
        Method::TrBdf2 => "tr-bdf2",
        Method::RungeKutta => "runge-kutta",
    }
}
