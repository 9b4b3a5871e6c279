//! Where the belt runs: pulleys in belt order -> tangent points, arcs, spans, path length.
//!
//! The path is the belt's centre line on rigid pulleys. It leaves pulley i along the common tangent to
//! pulley i + 1, the last pulley leads back to the first. With `sigma = +1` for a pulley that the belt
//! turns about counter-clockwise and `-1` for clockwise, points as complex numbers, `D = c_B - c_A` and
//! `h = sigma_B R_B - sigma_A R_A`, the directed common tangent of two pulleys A and B is
//! ```text
//! L = sqrt(|D|² - h²),   t = D (L - i h) / |D|²,   p_A = c_A - sigma_A R_A i t,   p_B = p_A + L t,
//! ```
//! because `c = p + sigma R i t` on both circles. The wrap angle (sweep) of a pulley is the turn
//! from the incoming to the outgoing tangent, taken in the sense `sigma`, so `0 < sigma sweep < 2
//! pi`.
//!
//! # Sense of running along the list
//!
//! `sigma = sense` on pulleys inside the loop, `-sense` on pulleys outside of it. For three and
//! more pulleys the sense is the one whose path is a simple closed curve: total turning `2 pi
//! sense`, no span crossing another, none running through a pulley. Counter-clockwise is tried
//! first. Two pulleys can be walked either way; they are walked counter-clockwise (`sense = +1`).
//! Two pulleys, one inside and one outside, are a crossed belt: its total turning is zero and its
//! two spans cross. The counter-clockwise pulley is then the inside one.
//!
//! The path coordinate `s` starts at mid-wrap of the first pulley and grows in the order of the
//! list. It says nothing about the direction in which the belt moves.

use std::f64::consts::{PI, TAU};

use crate::drive::{Drive, Pulley, Wrap};

mod error;
mod tangent;

pub use error::LayoutError;
pub(crate) use tangent::{Circle, Tangent, sweep, turn};

/// A wrap angle below this is no contact [rad]: a micrometre on a pulley of a kilometre.
const SMALLEST_WRAP: f64 = 1.0e-9;

/// The closed path of a belt on its rigid pulleys.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The wrapped arcs; `arcs[i]` lies on pulley `i`.
    pub arcs: Vec<Arc>,
    /// The free spans; `spans[i]` runs from pulley `i` to pulley `i + 1`, the last one back to the
    /// first.
    pub spans: Vec<Span>,
    /// Total length of the path [m].
    pub length: f64,
    /// `+1`: pulleys inside the loop are walked counter-clockwise; `-1`: clockwise.
    pub sense: f64,
}

/// The part of a pulley's circle that the belt wraps.
#[derive(Clone, Debug, PartialEq)]
pub struct Arc {
    /// Index of the pulley.
    pub pulley: usize,
    /// Centre of the pulley [m].
    pub center: [f64; 2],
    /// Radius of the pulley [m].
    pub radius: f64,
    /// Polar angle of the first contact point about the centre [rad].
    pub start_angle: f64,
    /// Wrap angle, positive counter-clockwise [rad].
    pub sweep: f64,
    /// Path coordinate of the first contact point [m]; negative for the first pulley, whose middle
    /// has `s = 0`.
    pub start: f64,
    /// Length of the arc [m].
    pub length: f64,
}

/// A free span between two pulleys.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Index of the pulley where the span starts.
    pub from: usize,
    /// Index of the pulley where it ends.
    pub to: usize,
    /// First point [m].
    pub start: [f64; 2],
    /// Last point [m].
    pub end: [f64; 2],
    /// Length [m].
    pub length: f64,
    /// Path coordinate of the first point [m].
    pub at: f64,
}

/// A point of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Position [m].
    pub position: [f64; 2],
    /// Unit tangent, in the direction of growing path coordinate.
    pub tangent: [f64; 2],
    /// Curvature, positive where the path turns counter-clockwise [1/m].
    pub curvature: f64,
    /// The pulley or span that carries the point.
    pub on: Place,
}

/// A part of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the pulley of this index.
    Pulley(usize),
    /// In the free span of this index.
    Span(usize),
}

impl Layout {
    /// Lays a belt around `pulleys`, in their order, and finds the sense of running (see the
    /// module's head).
    pub fn new(pulleys: &[Pulley]) -> Result<Self, LayoutError> {
        check_pulleys(pulleys)?;
        let counter_clockwise = Self::walk(pulleys, 1.0);
        if pulleys.len() == 2 || counter_clockwise.is_ok() {
            return counter_clockwise;
        }
        let clockwise = Self::walk(pulleys, -1.0);
        if clockwise.is_ok() || center_area(pulleys) < 0.0 {
            clockwise
        } else {
            counter_clockwise
        }
    }

    /// The path of the centre line of `drive`'s belt.
    pub fn of(drive: &Drive) -> Result<Self, LayoutError> {
        let mut pitch = drive.pulley.clone();
        for pulley in &mut pitch {
            pulley.radius += drive.pitch_offset_on(pulley);
        }
        Self::new(&pitch)
    }

    /// The point at path coordinate `s` [m], which wraps around the loop; `s = 0` is mid-wrap of
    /// the first pulley.
    pub fn point(&self, s: f64) -> PathPoint {
        let first = self.arcs[0].start;
        let s = first + (s - first).rem_euclid(self.length);
        let index = self
            .arcs
            .partition_point(|arc| arc.start <= s)
            .saturating_sub(1);
        let arc = &self.arcs[index];
        if s < arc.start + arc.length {
            arc.point(s - arc.start)
        } else {
            self.span_point(index, s)
        }
    }

    /// The path for a given sense, or what is wrong with it.
    fn walk(pulleys: &[Pulley], sense: f64) -> Result<Self, LayoutError> {
        let count = pulleys.len();
        let circles: Vec<_> = pulleys
            .iter()
            .map(|pulley| Circle {
                center: pulley.center,
                radius: pulley.radius,
                side: sense * wrap_sign(pulley.wrap),
            })
            .collect();
        let tangents: Vec<_> = (0..count)
            .map(|i| Tangent::between(&circles[i], &circles[(i + 1) % count]))
            .collect();
        let sweeps = (0..count)
            .map(|i| {
                let incoming = tangents[(i + count - 1) % count].direction;
                let turn = turn(incoming, tangents[i].direction);
                if turn.abs() < SMALLEST_WRAP {
                    return Err(LayoutError::NoContact {
                        pulley: pulleys[i].name.clone(),
                        wrap: pulleys[i].wrap,
                        turn,
                    });
                }
                Ok(sweep(turn, circles[i].side))
            })
            .collect::<Result<Vec<_>, _>>()?;
        check_path(pulleys, &tangents, &sweeps, sense)?;
        Ok(Self::assemble(pulleys, &tangents, &sweeps, sense))
    }

    fn assemble(pulleys: &[Pulley], tangents: &[Tangent<f64>], sweeps: &[f64], sense: f64) -> Self {
        let count = pulleys.len();
        let mut arcs = Vec::with_capacity(count);
        let mut spans = Vec::with_capacity(count);
        let mut at = -0.5 * sweeps[0].abs() * pulleys[0].radius;
        for (i, pulley) in pulleys.iter().enumerate() {
            let incoming = &tangents[(i + count - 1) % count];
            let outward = [
                incoming.end[0] - pulley.center[0],
                incoming.end[1] - pulley.center[1],
            ];
            let length = sweeps[i].abs() * pulley.radius;
            arcs.push(Arc {
                pulley: i,
                center: pulley.center,
                radius: pulley.radius,
                start_angle: outward[1].atan2(outward[0]),
                sweep: sweeps[i],
                start: at,
                length,
            });
            at += length;
            let span = &tangents[i];
            spans.push(Span {
                from: i,
                to: (i + 1) % count,
                start: span.start,
                end: span.end,
                length: span.length,
                at,
            });
            at += span.length;
        }
        Self {
            length: at - arcs[0].start,
            arcs,
            spans,
            sense,
        }
    }

    fn span_point(&self, index: usize, s: f64) -> PathPoint {
        let span = &self.spans[index];
        let tangent = [
            (span.end[0] - span.start[0]) / span.length,
            (span.end[1] - span.start[1]) / span.length,
        ];
        let along = s - span.at;
        PathPoint {
            position: [
                span.start[0] + along * tangent[0],
                span.start[1] + along * tangent[1],
            ],
            tangent,
            curvature: 0.0,
            on: Place::Span(index),
        }
    }
}

impl Arc {
    /// The point `along` [m] behind the first contact point.
    fn point(&self, along: f64) -> PathPoint {
        let sign = self.sweep.signum();
        let (sin, cos) = (self.start_angle + sign * along / self.radius).sin_cos();
        PathPoint {
            position: [
                self.center[0] + self.radius * cos,
                self.center[1] + self.radius * sin,
            ],
            tangent: [-sign * sin, sign * cos],
            curvature: sign / self.radius,
            on: Place::Pulley(self.pulley),
        }
    }
}

fn wrap_sign(wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Inside => 1.0,
        Wrap::Outside => -1.0,
    }
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn check_pulleys(pulleys: &[Pulley]) -> Result<(), LayoutError> {
    if pulleys.len() < 2 {
        return Err(LayoutError::TooFewPulleys {
            count: pulleys.len(),
        });
    }
    for pulley in pulleys {
        let finite = pulley.radius.is_finite() && pulley.center.iter().all(|c| c.is_finite());
        if !finite || pulley.radius <= 0.0 {
            return Err(LayoutError::BadPulley {
                pulley: pulley.name.clone(),
                radius: pulley.radius,
                center: pulley.center,
            });
        }
    }
    for (i, a) in pulleys.iter().enumerate() {
        for b in &pulleys[i + 1..] {
            let distance = (a.center[0] - b.center[0]).hypot(a.center[1] - b.center[1]);
            let needed = a.radius + b.radius;
            if distance <= needed {
                return Err(LayoutError::Overlap {
                    first: a.name.clone(),
                    second: b.name.clone(),
                    distance,
                    needed,
                });
            }
        }
    }
    if pulleys.iter().all(|pulley| pulley.wrap == Wrap::Outside) {
        return Err(LayoutError::AllOutside);
    }
    Ok(())
}

/// The path must be a simple loop: its total turning one full turn, no span blocked, none crossing
/// another. A pulley that the belt only reaches by running right around it is on the wrong side of
/// the belt.
fn check_path(
    pulleys: &[Pulley],
    tangents: &[Tangent<f64>],
    sweeps: &[f64],
    sense: f64,
) -> Result<(), LayoutError> {
    let turning: f64 = sweeps.iter().sum();
    let crossed = pulleys.len() == 2 && pulleys[0].wrap != pulleys[1].wrap;
    let wanted = if crossed { 0.0 } else { sense * TAU };
    // Turnings differ by full turns.
    let closes = (turning - wanted).abs() < 1.0;
    if !closes {
        let widest = (0..sweeps.len()).fold(0, |best, i| {
            if sweeps[i].abs() > sweeps[best].abs() {
                i
            } else {
                best
            }
        });
        if sweeps[widest].abs() > 1.5 * PI {
            let pulley = &pulleys[widest];
            return Err(LayoutError::NoContact {
                pulley: pulley.name.clone(),
                wrap: pulley.wrap,
                turn: sweeps[widest],
            });
        }
    }
    if !crossed {
        check_spans(pulleys, tangents)?;
        check_crossings(pulleys, tangents)?;
    }
    if closes {
        Ok(())
    } else {
        Err(LayoutError::NotClosed { turning })
    }
}

fn check_crossings(pulleys: &[Pulley], tangents: &[Tangent<f64>]) -> Result<(), LayoutError> {
    let names = |i: usize| {
        (
            pulleys[i].name.clone(),
            pulleys[(i + 1) % pulleys.len()].name.clone(),
        )
    };
    for (i, a) in tangents.iter().enumerate() {
        for (j, b) in tangents.iter().enumerate().skip(i + 1) {
            if spans_cross(a, b) {
                return Err(LayoutError::SelfCrossing {
                    spans: [names(i), names(j)],
                });
            }
        }
    }
    Ok(())
}

fn spans_cross(a: &Tangent<f64>, b: &Tangent<f64>) -> bool {
    let apart = |line: &Tangent<f64>, other: &Tangent<f64>| {
        let offset =
            |p: [f64; 2]| cross(line.direction, [p[0] - line.start[0], p[1] - line.start[1]]);
        offset(other.start) * offset(other.end) < 0.0
    };
    apart(a, b) && apart(b, a)
}

/// No span may run through a pulley that it does not belong to.
fn check_spans(pulleys: &[Pulley], tangents: &[Tangent<f64>]) -> Result<(), LayoutError> {
    let count = pulleys.len();
    for (i, span) in tangents.iter().enumerate() {
        let next = (i + 1) % count;
        for (k, pulley) in pulleys.iter().enumerate() {
            if k == i || k == next {
                continue;
            }
            let d = [
                pulley.center[0] - span.start[0],
                pulley.center[1] - span.start[1],
            ];
            let along =
                (d[0] * span.direction[0] + d[1] * span.direction[1]).clamp(0.0, span.length);
            let distance =
                (d[0] - along * span.direction[0]).hypot(d[1] - along * span.direction[1]);
            if distance < pulley.radius {
                return Err(LayoutError::SpanBlocked {
                    from: pulleys[i].name.clone(),
                    to: pulleys[next].name.clone(),
                    pulley: pulley.name.clone(),
                    depth: pulley.radius - distance,
                });
            }
        }
    }
    Ok(())
}

/// Twice the signed area of the polygon of centres, of the inside pulleys where there are three:
/// says which sense an error message should speak of.
fn center_area(pulleys: &[Pulley]) -> f64 {
    let inside: Vec<[f64; 2]> = pulleys
        .iter()
        .filter(|p| p.wrap == Wrap::Inside)
        .map(|p| p.center)
        .collect();
    let corners = if inside.len() > 2 {
        inside
    } else {
        pulleys.iter().map(|p| p.center).collect()
    };
    (0..corners.len())
        .map(|i| cross(corners[i], corners[(i + 1) % corners.len()]))
        .sum()
}

#[cfg(test)]
mod tests;
