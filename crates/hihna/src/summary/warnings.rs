//! What the means of a run tell about its drive, in words.

use super::Report;
use crate::drive::Drive;

/// Part of the contact that slips where a pulley is said to slip as a whole.
const WHOLE: f64 = 0.95;
/// Part of the wrap that touches where a belt is said to have lifted off.
const HALF: f64 = 0.5;

/// Pulleys that the belt has left or slips on as a whole.
pub(super) fn of_running(drive: &Drive, steady: &Report) -> Vec<String> {
    let mut warnings = Vec::new();
    for (pulley, (name, report)) in drive.pulley.iter().zip(&steady.pulley.0) {
        let (contact, wrap) = (report.contact_angle, report.wrap_angle);
        if contact < HALF * wrap {
            warnings.push(format!(
                "the belt touches pulley `{name}` on {:.0} of {:.0} degrees only: it has lifted off or gone slack",
                contact.to_degrees(),
                wrap.to_degrees()
            ));
        }
        let grips = drive.friction_on(pulley).coefficient() > 0.0;
        if grips && report.slip_angle > WHOLE * contact {
            warnings.push(format!(
                "the belt slips on all of pulley `{name}`, to which friction gives no more than {:.4} N m",
                report.torque.abs()
            ));
        }
    }
    warnings
}
