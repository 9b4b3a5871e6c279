//! Common tangents of pulleys and the wrap angles between them, in any number type: with dual numbers
//! the path carries its derivatives by radii and centres. Formulas in the head of the layout.

use std::f64::consts::TAU;

use crate::number::Number;

/// A pulley as the path sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle<D> {
    /// Centre [m].
    pub center: [D; 2],
    /// Radius [m].
    pub radius: D,
    /// `+1` where the path turns about it counter-clockwise, `-1` clockwise.
    pub side: f64,
}

/// A directed common tangent of two pulleys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tangent<D> {
    /// Point on the pulley that it leaves [m].
    pub start: [D; 2],
    /// Point on the pulley where it arrives [m].
    pub end: [D; 2],
    /// Unit vector from start to end.
    pub direction: [D; 2],
    /// Length [m].
    pub length: D,
}

impl<D: Number> Tangent<D> {
    /// From pulley `a` to pulley `b`. The circles do not overlap, so |h| <= R_A + R_B < |D|.
    pub fn between(a: &Circle<D>, b: &Circle<D>) -> Self {
        let d = [b.center[0] - a.center[0], b.center[1] - a.center[1]];
        let h = b.radius * b.side - a.radius * a.side;
        let square = d[0] * d[0] + d[1] * d[1];
        let distance = square.sqrt();
        let length = ((distance - h) * (distance + h)).sqrt();
        let direction = [
            (d[0] * length + d[1] * h) / square,
            (d[1] * length - d[0] * h) / square,
        ];
        let touch = |circle: &Circle<D>| {
            let offset = circle.radius * circle.side;
            [
                circle.center[0] + offset * direction[1],
                circle.center[1] - offset * direction[0],
            ]
        };
        Self {
            start: touch(a),
            end: touch(b),
            direction,
            length,
        }
    }
}

/// The turn from one direction to another, from -pi to pi [rad].
pub(crate) fn turn<D: Number>(incoming: [D; 2], outgoing: [D; 2]) -> D {
    let cross = incoming[0] * outgoing[1] - incoming[1] * outgoing[0];
    cross.atan2(incoming[0] * outgoing[0] + incoming[1] * outgoing[1])
}

/// The wrap angle that belongs to a turn about a pulley on `side`: of that side's sign, below a full
/// turn [rad].
pub(crate) fn sweep<D: Number>(turn: D, side: f64) -> D {
    if turn.re() * side > 0.0 {
        turn
    } else {
        turn + side * TAU
    }
}
