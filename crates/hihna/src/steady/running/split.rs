//! Where an element touches a pulley, split at the kinks of the contact law.
//!
//! The force per length has corners where contact begins and ends (`d = 0`), where the normal force
//! changes its sign and where friction is exhausted. Pieces between them are smooth, so that a Gauss rule on
//! each converges fast and the integral is a continuous function of the state. The force itself jumps to
//! `c_p d'` only where `d = 0`: there the moving end adds to the derivative.
//!
//! Changes of sign are looked for between [`CELLS`] equally spaced points of an element, and beside the zeros of normal force and slip, and
//! where penetration or friction's reserve bend towards zero within an interval.

use super::line::Passage;
use crate::friction::{FrictionLaw, Slip};

/// Intervals of an element in which one change of sign is found.
const CELLS: usize = 16;
/// Bisections of a cell: to the last digit.
const BISECTIONS: usize = 60;

/// Step to the side that tells a slope, in cells.
const SLOPE_STEP: f64 = 1.0e-4;
/// Part that a golden section keeps, and how many there are: to a thousandth of a cell.
const GOLDEN: f64 = 0.618_033_988_749_895;
const GOLDEN_SECTIONS: usize = 15;

/// A smooth piece of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// First and last point, in `[0, 1]`.
    pub from: f64,
    pub to: f64,
    /// Whether contact begins at `from`, in the order of `xi`.
    pub begins: bool,
    /// Whether contact ends at `to`.
    pub ends: bool,
}

/// Writes the pieces of contact of `passage`, in the order of `xi`, to `pieces`.
pub(super) fn pieces(passage: &Passage<'_>, pieces: &mut Vec<Piece>) {
    pieces.clear();
    let depth = |xi: f64| passage.penetration(xi);
    let deepening = |xi: f64| passage.deepening(xi);
    let (mut last, mut before, mut rising) = (0.0, depth(0.0), deepening(0.0));
    let mut open = (before > 0.0).then_some((0.0, false));
    for i in 1..=CELLS {
        let end = i as f64 / CELLS as f64;
        let (now, rises) = (depth(end), deepening(end));
        // A gap or a touch within the cell shows by the depth's turning towards the other side and back.
        let turns =
            (before > 0.0) == (now > 0.0) && (now > 0.0) == (rising < 0.0) && rising * rises < 0.0;
        let middle = turns.then(|| root(deepening, last, rising, end, rises));
        for to in middle.into_iter().chain([end]) {
            let now = depth(to);
            if before <= 0.0 && now > 0.0 {
                open = Some((inner_end(depth, to, last), true));
            } else if before > 0.0
                && now <= 0.0
                && let Some((from, begins)) = open.take()
            {
                let edge = inner_end(depth, last, to);
                let whole = Piece {
                    from,
                    to: edge,
                    begins,
                    ends: true,
                };
                split(passage, whole, pieces);
            }
            (last, before) = (to, now);
        }
        rising = rises;
    }
    if let Some((from, begins)) = open {
        let whole = Piece {
            from,
            to: 1.0,
            begins,
            ends: false,
        };
        split(passage, whole, pieces);
    }
}

/// The last point with `depth > 0` on the way from `inside` to `outside`.
fn inner_end(depth: impl Fn(f64) -> f64, mut inside: f64, mut outside: f64) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        if depth(middle) > 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

/// Splits a stretch of contact where the normal force changes its sign and where friction is exhausted.
///
/// Friction is exhausted beside the zeros of the normal force and not exhausted beside those of the slip: both divide
/// a cell, so that the pairs of corners around them are not missed, however narrow.
fn split(passage: &Passage<'_>, whole: Piece, pieces: &mut Vec<Piece>) {
    let first = pieces.len();
    pieces.push(whole);
    let mut last = Sample::new(passage, whole.from);
    for i in 1..=CELLS {
        let next = (i as f64 / CELLS as f64).min(whole.to);
        if next <= last.xi {
            continue;
        }
        let next = Sample::new(passage, next);
        let pulls = crossing(passage, &last, &next, |sample| sample.normal);
        let turns = crossing(passage, &last, &next, |sample| sample.slip);
        let mut inner = [pulls, turns];
        inner.sort_by(|a, b| place(a.as_ref()).total_cmp(&place(b.as_ref())));
        let mut from = last;
        for to in inner.into_iter().flatten().chain([next]) {
            let middle = dip(passage, &from, &to);
            let mut low = from;
            for high in middle.into_iter().chain([to]) {
                if let Some(corner) = crossing(passage, &low, &high, |sample| sample.reserve) {
                    cut(pieces, first, corner.xi);
                }
                low = high;
            }
            if pulls.is_some_and(|pulls| pulls.xi.to_bits() == to.xi.to_bits()) {
                cut(pieces, first, to.xi);
            }
            from = to;
        }
        last = next;
        if last.xi >= whole.to {
            break;
        }
    }
}

/// What the splitting looks at.
#[derive(Clone, Copy, Debug)]
struct Sample {
    xi: f64,
    /// Normal force before it is clamped [N/m].
    normal: f64,
    /// Slip velocity [m/s].
    slip: f64,
    /// What is left of friction; not a number for laws without a corner.
    reserve: f64,
}

impl Sample {
    fn new(passage: &Passage<'_>, xi: f64) -> Self {
        let contact = passage.contact(xi);
        let slip = Slip {
            velocity: contact.slip,
            displacement: 0.0,
        };
        let reserve = (passage.pulley.friction).reserve(slip, contact.normal_force.abs());
        Self {
            xi,
            normal: contact.penetration * passage.penalty.stiffness
                + contact.rate * passage.penalty.damping,
            slip: contact.slip,
            reserve: reserve.unwrap_or(f64::NAN),
        }
    }
}

/// Where the reserve, of one sign at both samples, has the other in between: found where it bends that way, by golden
/// sections.
fn dip(passage: &Passage<'_>, from: &Sample, to: &Sample) -> Option<Sample> {
    let sign = from.reserve.signum();
    let at = |xi: f64| Sample::new(passage, xi);
    let near = SLOPE_STEP * (to.xi - from.xi);
    let same_sign = from.reserve * to.reserve > 0.0;
    let falls = |a: f64, b: f64| sign * a > sign * b;
    if !same_sign
        || !falls(from.reserve, at(from.xi + near).reserve)
        || !falls(to.reserve, at(to.xi - near).reserve)
    {
        return None;
    }
    let (mut a, mut b) = (from.xi, to.xi);
    let (mut low, mut high) = (at(b - GOLDEN * (b - a)), at(a + GOLDEN * (b - a)));
    for _ in 0..GOLDEN_SECTIONS {
        let best = if falls(high.reserve, low.reserve) {
            low
        } else {
            high
        };
        if sign * best.reserve < 0.0 {
            return Some(best);
        }
        if falls(high.reserve, low.reserve) {
            (b, high) = (high.xi, low);
            low = at(b - GOLDEN * (b - a));
        } else {
            (a, low) = (low.xi, high);
            high = at(a + GOLDEN * (b - a));
        }
    }
    None
}

/// Where an absent sample sorts.
fn place(sample: Option<&Sample>) -> f64 {
    sample.map_or(f64::INFINITY, |sample| sample.xi)
}

/// The sample between two at which `what` changes its sign, if it does.
fn crossing(
    passage: &Passage<'_>,
    from: &Sample,
    to: &Sample,
    what: impl Fn(&Sample) -> f64,
) -> Option<Sample> {
    let (a, b) = (what(from), what(to));
    (a * b < 0.0).then(|| {
        let at = |xi: f64| what(&Sample::new(passage, xi));
        Sample::new(passage, root(at, from.xi, a, to.xi, b))
    })
}

/// Cuts the last piece at `at`, if that lies within it.
fn cut(pieces: &mut Vec<Piece>, first: usize, at: f64) {
    let Some(last) = pieces.get_mut(first..).and_then(<[Piece]>::last_mut) else {
        return;
    };
    if at > last.from && at < last.to {
        let rest = Piece {
            from: at,
            begins: false,
            ..*last
        };
        last.to = at;
        last.ends = false;
        pieces.push(rest);
    }
}

/// The root of `f` between `a` and `b`, where it has values `fa`, `fb` of different sign: regula falsi in
/// the Illinois form, by halves where that is slow, until it stays where it is.
fn root(f: impl Fn(f64) -> f64, a: f64, fa: f64, b: f64, fb: f64) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (a, fa, b, fb);
    for i in 0..BISECTIONS {
        if (b - a).abs() <= 4.0 * f64::EPSILON {
            break;
        }
        let x = if i < 20 {
            (a * fb - b * fa) / (fb - fa)
        } else {
            0.5 * (a + b)
        };
        if (x - b).abs() <= f64::EPSILON {
            return x;
        }
        let fx = f(x);
        if fx == 0.0 || !fx.is_finite() {
            return x;
        }
        if fx * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (x, fx);
    }
    b
}
