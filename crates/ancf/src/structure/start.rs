//! The start of a motion with given coordinates and velocities.

use super::StructureError;
use super::finite::finite;
use crate::dynamics::Motion;
use crate::element::Element;
use crate::system::{ForceLaw, Mechanics, State, System};

/// Largest violation of constraints by a start [m, m/s].
const CONSISTENT: f64 = 1.0e-9;

/// The state of `system` with the coordinates `q` and the velocities `v`, with or without places for multipliers
/// (there are `without_multipliers` others), and what is prescribed put in; an error where they break a constraint by
/// more than rounding.
pub(super) fn consistent<E: Element, L: ForceLaw>(
    system: &System<E, L>,
    without_multipliers: usize,
    q: &[f64],
    v: &[f64],
) -> Result<Motion, StructureError> {
    let mut motion = Motion::zero(system.structure().size());
    for (what, target, source) in [
        ("the coordinates", &mut motion.q, q),
        ("the velocities", &mut motion.v, v),
    ] {
        let (given, wanted) = (source.len(), target.len());
        if given != wanted && given != without_multipliers || given > wanted {
            return Err(StructureError::Foreign {
                what,
                given,
                wanted,
            });
        }
        finite(what, source.iter().copied())?;
        target[..given].copy_from_slice(source);
    }
    for (index, prescribed) in system.prescribed() {
        let [place, velocity, _] = prescribed.at(0.0);
        let differences = [motion.q[*index] - place, motion.v[*index] - velocity];
        for (difference, unit) in differences.into_iter().zip(["m", "m/s"]) {
            let name = || format!("that holds coordinate {index}");
            refuse(difference.abs(), name, unit)?;
        }
    }
    if let Some(constraints) = system.constraints() {
        let state = State {
            time: 0.0,
            q: &motion.q,
            v: &motion.v,
        };
        for ((amount, name), unit) in constraints.violation(state).into_iter().zip(["m", "m/s"]) {
            refuse(amount, || name.to_owned(), unit)?;
        }
    }
    system.prescribe(0.0, &mut motion.q, &mut motion.v, &mut motion.a);
    Ok(motion)
}

fn refuse(
    amount: f64,
    name: impl FnOnce() -> String,
    unit: &'static str,
) -> Result<(), StructureError> {
    if amount <= CONSISTENT {
        return Ok(());
    }
    let name = name();
    Err(StructureError::Start { name, amount, unit })
}
