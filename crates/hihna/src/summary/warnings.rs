//! What the means of a run tell about its drive, in words.

use super::Report;
use crate::drive::Drive;
use crate::quantities::with_prefix;
use crate::simulate::Settling;

/// Part of the wrap that touches where a belt is said to have lifted off, and of the contact that slips where
/// a belt is said to slip.
const HALF: f64 = 0.5;

/// Pulleys that the belt has left or slips on as a whole, drivers or not: there it is slower or faster than the surface by more than
/// stretching makes it.
pub(super) fn of_running(drive: &Drive, steady: &Report) -> Vec<String> {
    let mut warnings = Vec::new();
    // What a belt loses by its stretch alone is less than its greatest strain.
    let stretch = steady
        .span
        .0
        .iter()
        .fold(0.0, |most, (_, span)| f64::max(most, span.strain));
    let belt = (steady.span.0.iter()).map(|(_, span)| span.speed.abs());
    for (pulley, (name, report)) in drive.pulley.iter().zip(&steady.pulley.0) {
        // The faster of belt and surface: one of them may stand still.
        let surface = report.speed.abs() * pulley.radius;
        let fastest = belt.clone().fold(surface, f64::max);
        let (contact, wrap) = (report.contact_angle, report.wrap_angle);
        if contact < HALF * wrap {
            warnings.push(format!(
                "the belt touches pulley `{name}` on {:.0} of {:.0} degrees only: it has lifted off or gone slack",
                contact.to_degrees(),
                wrap.to_degrees()
            ));
        }
        if report.slip_angle > HALF * contact && report.slip_speed.abs() > stretch * fastest {
            warnings.push(format!(
                "the belt slips on pulley `{name}`: their speeds differ by {:.1} %, more than the belt stretches; friction carries no more than {} there",
                100.0 * report.slip_speed.abs() / fastest,
                with_prefix(report.torque.abs(), "N m")
            ));
        }
    }
    warnings
}

/// Crowned pulleys over whose edges the belt hangs: there contact goes on as if they had no end.
pub(super) fn of_crowns(drive: &Drive, steady: &Report) -> Vec<String> {
    let crowned = drive.pulley.iter().zip(&steady.pulley.0);
    let beyond = crowned.filter_map(|(pulley, (name, report))| {
        let offset = report.lateral.as_ref()?.belt_offset.abs();
        let beyond = 0.5 * drive.belt.width + offset - 0.5 * pulley.crown?.width;
        (beyond > 1.0e-9 * drive.belt.width).then(|| {
            format!(
                "the belt reaches {:.1} mm beyond the edge of pulley `{name}`, where it meets its crown's parabola as if the pulley went on",
                1.0e3 * beyond
            )
        })
    });
    beyond.collect()
}

/// A run that reached its end before its means settled.
pub(super) fn of_settling(settling: &Settling) -> Option<String> {
    if settling.reached {
        return None;
    }
    let seen = if settling.left.is_finite() {
        format!(
            "as the means of windows of {:.4} s have changed, {:.1e} of a nominal value may be left to come, {:.1e} is allowed (the last change was {:.1e})",
            settling.window, settling.left, settling.tolerance, settling.change
        )
    } else {
        format!(
            "after the last kink of the profiles there was no time for three windows of {:.4} s",
            settling.window
        )
    };
    Some(format!(
        "the run reached `run.end_time` before its means settled: {seen}"
    ))
}
