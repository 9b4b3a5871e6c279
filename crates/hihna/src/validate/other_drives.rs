//! What any drive must keep: a free idler's speed, torques and tensions, hub forces, the capstan law.

use super::time_run::{Line, TimeRun};
use super::{CaseError, Quantities};

const THREE_PULLEYS: &str = include_str!("../../../../examples/three_pulleys.toml");
const STICK_AND_SLIP: &str = include_str!("../../../../examples/stick_and_slip.toml");

/// Driver, loaded pulley and idler.
pub(super) fn three_pulleys() -> Result<Quantities, CaseError> {
    let run = TimeRun::new(THREE_PULLEYS, &[])?;
    let steady = [1.2, 1.6];
    let [driver, driven, idler] = [0, 1, 2].map(|p| &run.drive.pulley[p]);
    let ratio = run.mean("idler.speed", steady)? / run.mean("driver.speed", steady)?;
    let tension = |p: usize| run.mean(&format!("{}.tension", run.span(p)), steady);
    let (slack, tight, after_idler) = (tension(0)?, tension(1)?, tension(2)?);
    let torque = |name: &str| run.mean(&format!("{name}.torque"), steady);
    Ok(vec![
        (
            "idler's speed ratio over that of the radii".to_owned(),
            ratio * idler.radius / driver.radius,
        ),
        (
            "driver's torque over tension difference times radius".to_owned(),
            torque("driver")? / ((slack - after_idler) * driver.radius),
        ),
        (
            "driven torque over tension difference times radius".to_owned(),
            torque("driven")? / ((tight - slack) * driven.radius),
        ),
        (
            "idler's torque less tension difference times radius".to_owned(),
            torque("idler")? - (after_idler - tight) * idler.radius,
        ),
        (
            "hub forces from the spans' T - rho A v2".to_owned(),
            run.hub_force_error(steady)?,
        ),
    ])
}

/// Parts of the arc in which the belt is looked at.
const SECTIONS: usize = 40;
/// How far the belt needs at the exit to come off the pulley, left out [rad].
const END_ZONE: f64 = 0.1;

/// The driven pulley's slip arc under the elastic-plastic law.
pub(super) fn stick_and_slip() -> Result<Quantities, CaseError> {
    let times: Vec<String> = (0..40)
        .map(|i| format!("{:.5}", 0.9 + 0.007_37 * f64::from(i)))
        .collect();
    let times = format!("run.profile_times=[{}]", times.join(", "));
    let run = TimeRun::new(STICK_AND_SLIP, &[&times])?;
    let driven = 1;
    let coefficient = run.drive.contact.friction.coefficient();
    let sweep = run.outcome.layout.arcs[driven].sweep.abs();
    let width = (sweep - END_ZONE) / SECTIONS as f64;
    let (mut slip, mut friction_in_stick, mut stick_from) = (Vec::new(), 0.0_f64, 0.0);
    let mut slides = [true; SECTIONS];
    let place = |angle: f64| {
        (0..SECTIONS).find(|k| angle >= *k as f64 * width && angle < (k + 1) as f64 * width)
    };
    for row in run.rows_on(driven) {
        let exhausted =
            row.friction_force.abs() >= (1.0 - 1.0e-9) * coefficient * row.normal_force.abs();
        if let Some(k) = place(run.angle(driven, row)) {
            slides[k] &= exhausted;
        }
    }
    let begin = slides
        .iter()
        .rposition(|slides| !slides)
        .map_or(0, |k| k + 1);
    let slip_from = begin as f64 * width;
    for row in run.rows_on(driven) {
        let angle = run.angle(driven, row);
        let flow = run.line_density() * row.speed / (1.0 + row.strain_engineering);
        let pressing = row.tension - flow * row.speed;
        if angle >= slip_from && angle < sweep - END_ZONE {
            slip.push((angle, pressing.ln()));
        }
        // The first third of the arc, after the belt has come on, sticks.
        if angle > END_ZONE && angle < sweep / 3.0 {
            friction_in_stick += row.friction_force / row.normal_force;
            stick_from += 1.0;
        }
    }
    Ok(vec![
        (
            "growth of ln(T - rho A v2) per angle in the slip arc".to_owned(),
            Line::through(&slip).slope,
        ),
        ("slip arc".to_owned(), sweep - END_ZONE - slip_from),
        (
            "friction over normal force in the first third of the arc".to_owned(),
            friction_in_stick.abs() / stick_from,
        ),
    ])
}
