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

/// [`PREDICTION_TOLERANCE`] after a velocity has jumped, times this and relative to that jump: steps are a seventh of the
/// time in which the belt follows, `(h / tau)² / 2 = 0.3 * 0.03`, so that the energy that this dissipates is resolved.
const AFTER_A_JUMP: f64 = 0.3;

/// Largest step relative to `1 / omega` of the slowest swing, or of the fastest prescribed irregularity: its
/// second-order dispersion `(omega h)² / 12` is 2e-4 then.
const SWING_STEP: f64 = 0.05;

/// Least number of steps of a run whose steps are chosen, so that also a short one resolves how the drive sets off.
const LEAST_STEPS: f64 = 200.0;

/// Slowest speed to which tolerances are fitted, relative to that of [`wave_bound`]: rounding of slower motion is no
/// longer far below them.
const SLOWEST: f64 = 1.0e-3;

/// Greatest prescribed speed of a surface or a hub in the run [m/s]; where nothing moves, a hundredth of the belt's
/// longitudinal wave speed.
#[must_use]
pub fn nominal_speed(drive: &Drive) -> f64 {
    let prescribed = fastest_until(drive, drive.run.end_time);
    if prescribed > 0.0 {
        prescribed.max(SLOWEST * wave_bound(drive))
    } else {
        wave_bound(drive)
    }
}

/// A hundredth of the belt's longitudinal wave speed [m/s].
fn wave_bound(drive: &Drive) -> f64 {
    0.01 * (drive.belt.axial_factor * drive.belt.youngs_modulus / drive.belt.density).sqrt()
}

/// Greatest prescribed speed of a surface or a hub up to `time` [m/s].
fn fastest_until(drive: &Drive, time: f64) -> f64 {
    (drive.pulley.iter())
        .map(|pulley| {
            let speed = (pulley.speed.as_ref()).map_or(0.0, |speed| value_bound(speed, time));
            let turning = (pulley.angle.as_ref()).map_or(0.0, |angle| slope_bound(angle, time));
            let hub = pulley.displacement.as_ref().map_or(0.0, |hub| {
                let [x, y, z] = [&hub.x, &hub.y, &hub.z].map(|axis| slope_bound(axis, time));
                x.hypot(y).hypot(z)
            });
            (speed.max(turning) * pulley.radius).max(hub)
        })
        .fold(0.0, f64::max)
}

/// Greatest magnitude up to `time`: pieces between kinks are monotonic.
fn value_bound(profile: &Profile, time: f64) -> f64 {
    let kinks = profile.kinks().into_iter().filter(|kink| *kink < time);
    kinks
        .chain([0.0, time])
        .fold(0.0, |bound, t| f64::max(bound, profile.value(t).abs()))
}

/// Greatest magnitude of the derivative up to `time`: every kind of piece has it at its start or in its middle.
fn slope_bound(profile: &Profile, time: f64) -> f64 {
    let kinks = profile.kinks();
    let middles = kinks
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1].min(time)));
    let starts = kinks.iter().copied().filter(|kink| *kink < time);
    (starts.chain(middles.filter(|middle| *middle < time)))
        .fold(0.0, |bound, t| f64::max(bound, profile.derivative(t).abs()))
}

/// Times at which a hub changes its velocity at once, so that damping and friction of the contact jump, and by how much
/// relative to the nominal `speed`.
fn jumps(drive: &Drive, speed: f64) -> Vec<(f64, f64)> {
    let least = SLOWEST * wave_bound(drive) / speed;
    let mut jumps = Vec::new();
    for hub in drive.pulley.iter().filter_map(|p| p.displacement.as_ref()) {
        let axes = [&hub.x, &hub.y, &hub.z];
        for kink in axes.iter().flat_map(|axis| axis.kinks()) {
            let before = if kink > 0.0 { kink.next_down() } else { -1.0 };
            let [x, y, z] = axes.map(|axis| axis.derivative(kink) - axis.derivative(before));
            let factor = AFTER_A_JUMP * x.hypot(y).hypot(z) / speed;
            jumps.push((
                kink,
                if factor > 0.0 {
                    factor.clamp(least.min(1.0), 1.0)
                } else {
                    1.0
                },
            ));
        }
    }
    jumps.sort_by(|a, b| a.0.total_cmp(&b.0));
    jumps
}

/// Times up to which all prescribed motion is slower than the nominal `speed`, and how much slower: tolerances are
/// relative to what moves, so that the balance of a tensioner that is drawn before the drive starts closes too.
fn slower_beginnings(drive: &Drive, speed: f64, kinks: &[f64]) -> Vec<(f64, f64)> {
    let least = (SLOWEST * wave_bound(drive) / speed).min(1.0);
    (kinks.iter().copied().chain([drive.run.end_time]))
        .map(|until| (until, fastest_until(drive, until) / speed))
        .filter(|(until, factor)| *until > 0.0 && *factor > 0.0 && *factor < 1.0)
        .map(|(until, factor)| (until, factor.max(least)))
        .collect()
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
                .min(run.end_time / LEAST_STEPS),
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
    let jumps = jumps(drive, speed);
    kinks.sort_by(f64::total_cmp);
    let mut changes: Vec<f64> = (jumps.iter().map(|(jump, _)| *jump))
        .chain(kinks.iter().copied())
        .collect();
    changes.sort_by(f64::total_cmp);
    Control {
        method,
        step,
        error_tolerance,
        tightened: slower_beginnings(drive, speed, &changes),
        newton_tolerance: 2.0e-7 * speed * (run.accuracy / REFERENCE_ACCURACY),
        kinks,
        jumps,
    }
}

/// Angular frequency [rad/s] of the slowest swing of a free pulley, and of the belt that goes with it, on the two spans beside it, zero if
/// no pulley is free: the vibration that a changing speed excites first.
pub(super) fn slowest_swing(drive: &Drive, mounting: &Mounting) -> f64 {
    let belt = &drive.belt;
    let stiffness = belt.axial_factor * belt.youngs_modulus * drive.area();
    // Spans are no longer than the belt: the estimate is on the slow side.
    let per_length = drive.pulley.len() as f64 / mounting.length;
    let mass = belt.density * drive.area() / per_length;
    drive
        .pulley
        .iter()
        .filter(|pulley| !pulley.is_driver())
        .map(|p| {
            let moved = p.inertia / (p.radius * p.radius) + mass;
            (2.0 * stiffness * per_length / moved).sqrt()
        })
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
